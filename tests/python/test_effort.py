"""What a search may cost: it ends after as much work on any machine, with the best that it has by then."""
import unittest
import warnings

import numpy
import plm
import scipy.sparse


def lattice(nx, ny, nz, n_pairs, damping=(0, 2e-5)):
    """Two blocks of masses of 1 kg, face to face in pairs without gap: all of them bounce, and motions are proportional to
    the force."""
    def chain(k, grounded):
        diagonal = numpy.r_[2.0 if grounded else 1.0, 2 * numpy.ones(k - 2), 1.0]
        return scipy.sparse.diags([diagonal, -numpy.ones(k - 1), -numpy.ones(k - 1)], [0, 1, -1])
    ones = [scipy.sparse.identity(k) for k in (nx, ny, nz)]
    kron = scipy.sparse.kron
    half = 1e6 * (kron(kron(chain(nx, True), ones[1]), ones[2]) + kron(kron(ones[0], chain(ny, False)), ones[2]) +
                  kron(kron(ones[0], ones[1]), chain(nz, False))).tocsr()
    n, face = half.shape[0], ny * nz
    stiffness = scipy.sparse.block_diag([half, half[::-1][:, ::-1]], format="csc")
    pick = numpy.linspace(0, face - 1, n_pairs).round().astype(int)
    rows = numpy.r_[numpy.arange(n_pairs), numpy.arange(n_pairs)]
    columns = numpy.r_[n - face + pick, n + face - 1 - (face - 1 - pick)[::-1]]
    signs = numpy.r_[numpy.ones(n_pairs), -numpy.ones(n_pairs)]
    tip = n - face + face // 2
    context = plm.Context()
    m = plm.Model(scipy.sparse.identity(2 * n, format="csc"), stiffness, context=context)
    m.add_gap_rows(scipy.sparse.csr_matrix((signs, (rows, columns)), (n_pairs, 2 * n)))
    m.set_rayleigh_damping(*damping)
    force = numpy.zeros(2 * n)
    force[tip] = 1
    m.set_excitation(force)
    return m.build(), tip, context


class Effort(unittest.TestCase):
    def one_call(self, effort, threads=1, accuracy=1e-3):
        m, tip, context = lattice(5, 4, 3, 8)
        context.set_threads(threads)
        if effort is not None:
            context.set_effort(effort)
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always", plm.PlmWarning)
            r = m.compute_response(tip, accuracy=accuracy)
        return r, " ".join(str(w.message) for w in said)

    def test_however_little_is_allowed_there_is_an_answer_that_says_how_good_it_is(self):
        exact, quiet = self.one_call(None)
        little, said = self.one_call(1e-3, accuracy=1e-6)
        self.assertNotIn("effort", quiet)
        self.assertLess(exact.error, 1e-3)
        true = abs(little.amplitude / exact.amplitude - 1)
        self.assertIn("effort", said)
        self.assertGreater(little.error, max(1e-6, true / 3))
        self.assertLess(true, 1e-3)  # few harmonics along the curve, and more at its peak

    def test_the_same_work_in_every_run(self):
        first, more = self.one_call(0.3), self.one_call(0.3, threads=2)
        for a, b in zip(first[0][:3], more[0][:3]):
            self.assertEqual(a, b)

    def test_a_first_curve_that_gets_lost_has_fewer_harmonics(self):
        m, tip, context = lattice(5, 4, 3, 8, damping=(0.3, 0))  # high modes ring: all pairs bounce in a tangle
        context.set_effort(1e-3)
        said = []
        context.log = lambda level, text: said.append(text)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", plm.PlmWarning)
            r = m.compute_response(tip)
        self.assertTrue(any(text.startswith("250 points") for text in said))
        self.assertEqual(r.curve.status, plm.WARNING)  # whole all the same
        hz = r.curve.frequency_hz
        self.assertGreater(max(hz) - min(hz), 0.09 * r.frequency_hz)  # the window, +- 5 %
        self.assertGreater(r.error, 0)

    def test_a_sweep_that_gets_nowhere_says_so(self):
        m, _, context = lattice(5, 4, 3, 8)
        basis = plm.Basis(m, plm.Sampler(m).run()).build()
        context.set_effort(0)
        self.assertEqual(plm.Hbm(basis, n_harmonics=3).sweep().status, 0)
        # what the basis took is allowed anyhow, here a fiftieth of a second
        context.set_effort(1e-9)
        with self.assertRaises(plm.PlmError) as refused:
            plm.Hbm(basis, n_harmonics=60, max_step=0.001, max_points=100000, frequency_min_hz=10).sweep()
        self.assertEqual(refused.exception.status, plm.ERR_CONVERGENCE)


if __name__ == "__main__":
    unittest.main()
