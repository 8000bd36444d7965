"""From scipy matrices to response curves: what the package computes and how it hands it over."""
import unittest

import numpy
import plm
import scipy.sparse
import scipy.sparse.linalg

import models


class Run(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.model = models.model()
        cls.model.estimate_memory()
        cls.model.build()
        cls.sampler = plm.Sampler(cls.model, system="open", mode=1, n_samples=4).run()
        cls.basis = plm.Basis(cls.model, cls.sampler).build()
        cls.hbm = plm.Hbm(cls.basis, n_harmonics=5)
        cls.curve = cls.hbm.sweep()

    def test_modes_are_those_of_scipy(self):
        mass, stiffness = models.matrices()
        wanted = numpy.sort(scipy.sparse.linalg.eigsh(stiffness, 4, mass, sigma=0)[0]) ** 0.5 / (2 * numpy.pi)
        hz, shape = self.model.modes(4, shapes=True)
        numpy.testing.assert_allclose(hz, wanted, rtol=1e-9)
        numpy.testing.assert_allclose(shape.T @ mass @ shape, numpy.eye(4), atol=1e-9)
        numpy.testing.assert_allclose(self.model.modes(2, closed=[1, 1]), self.model.modes(2, "sliding"), rtol=1e-6)

    def test_the_solver_is_chosen_by_name(self):
        model = models.model()
        model.solver = "eigen"
        numpy.testing.assert_allclose(model.build().modes(3), models.model().build().modes(3), rtol=1e-9)

    def test_the_whole_way_in_one_call(self):
        response = models.model().build().compute_response(models.WATCHED, accuracy=1e-3)
        self.assertLess(response.error, 1e-3)
        self.assertGreater(len(response.curve), 10)
        self.assertEqual((response.hbm.accuracy, response.curve.status), (1e-3, plm.OK))
        page = response.report()
        self.assertEqual(page, response.curve.describe())
        self.assertIn(f"  {response.amplitude:.6g} at {response.frequency_hz:.6g} Hz: half peak-to-peak displacement of DOF", page)
        self.assertIn(f"may be off by {response.error:.2g} of itself", page)
        again = response.hbm.find_peak(response.curve, models.WATCHED)
        self.assertEqual((again.frequency_hz, again.amplitude), (response.frequency_hz, response.amplitude))
        refined = response.hbm.refine_basis(models.WATCHED, 1e-2)  # which knows its model
        self.assertEqual(refined.basis.model.n_dof, response.curve.n_dof)
        with self.assertRaisesRegex(plm.PlmError, "measure"):
            models.model().build().compute_response(models.WATCHED, measure="harmonic")

    def test_every_result_is_an_attribute(self):
        self.model.solve_rest()
        for handle in (self.model, self.sampler, self.basis, self.hbm, self.curve):
            for name, key in handle.keys.items():
                value = getattr(handle, "lambda_" if name == "lambda" else name)
                kinds = {plm.TYPE_INT: int, plm.TYPE_DOUBLE: float, plm.TYPE_STRING: str}
                self.assertIsInstance(value, kinds.get(key.type, numpy.ndarray), name)
                self.assertIn(name if name != "lambda" else "lambda_", dir(handle))
                self.assertIn(key.description, type(handle).__doc__)
                if not isinstance(value, numpy.ndarray):
                    self.assertEqual(value, handle[name])

    def test_arrays_over_pairs_have_pairs_as_rows(self):
        self.assertEqual(self.sampler.selected_samples.shape, (2, self.sampler.n_selected))
        self.assertEqual(self.sampler.mode_penetration.shape, (2, 1))

    def test_options(self):
        hbm = plm.Hbm(self.basis, n_harmonics=3, direction="up", force_scale=2)
        self.assertEqual((hbm.n_harmonics, hbm.direction, hbm.force_scale), (3, "up", 2.0))
        hbm.max_points = 7
        hbm["tolerance"] = numpy.float64(1e-7)
        self.assertEqual((hbm["max_points"], hbm.tolerance), (7, 1e-7))
        self.assertEqual(set(hbm.options()), {k.name for k in plm.keys(plm.KIND_HBM) if k.is_option})
        with self.assertWarnsRegex(plm.PlmWarning, "^plm_hbm_sweep: max_points reached; raise it") as caught:
            self.assertEqual(hbm.sweep().status, plm.TRUNCATED)
        self.assertEqual(caught.filename, __file__)  # the line of the user, not one of the package
        self.assertEqual((caught.warning.status, caught.warning.reason), (plm.TRUNCATED, plm.REASON_POINT_LIMIT))

    def test_options_of_every_handle(self):
        self.assertEqual(models.model(verify_counts=True, space_tolerance=1e-9).build().verify_counts, 1)
        sampler = plm.Sampler(self.model, mode=1, window_half_width=0.04).run()
        self.assertEqual(plm.Basis(self.model, sampler, svd_tolerance=1e-8).build().svd_tolerance, 1e-8)

    def test_peak_and_points(self):
        peak = self.hbm.find_peak(self.curve, models.WATCHED)
        self.assertGreaterEqual(peak.amplitude, self.curve.amplitude(models.WATCHED).max() * (1 - 1e-9))
        self.assertEqual(len(peak.branch), 1)
        again = self.hbm.solve(peak.frequency_hz, peak.branch)
        self.assertAlmostEqual(again.amplitude(models.WATCHED)[0] / peak.amplitude, 1, places=6)
        self.hbm.solve(self.curve.frequency_hz[0])
        c = peak.branch.coefficients(0)
        numpy.testing.assert_array_equal(c[:, models.WATCHED], peak.branch.coefficients(-1, models.WATCHED))
        t = 2 * numpy.pi * 0.3
        wave = numpy.array([1] + [f(h * t) for h in range(1, 6) for f in (numpy.cos, numpy.sin)])
        numpy.testing.assert_allclose(peak.branch.field(0, 0.3), wave @ c, atol=1e-14)
        contact = peak.branch.contact(0, 4096)
        numpy.testing.assert_allclose(contact.closed.mean(axis=1), peak.branch.closed_share(0), atol=1e-3)
        k = self.model.contact_stiffness[:, None]
        numpy.testing.assert_allclose(contact.force, k * contact.penetration.clip(0), atol=1e-12 * abs(contact.force).max())
        self.assertEqual(peak.branch.harmonics(0, models.WATCHED)[0], c[0, models.WATCHED])
        self.assertGreater(peak.branch.full_residual(0), 0)
        error = self.hbm.estimate_error(peak.branch, -1, models.WATCHED)
        self.assertEqual(error.amplitude.total, error.amplitude.basis + error.amplitude.contact + error.amplitude.harmonics)
        self.assertLess(abs(error.amplitude.basis + error.amplitude.contact), 0.01 * peak.amplitude)
        self.assertLess(abs(error.frequency_hz.total), 0.01 * peak.frequency_hz)
        self.assertNotEqual(error, self.hbm.estimate_error(peak.branch, 0, models.WATCHED, measure="rms"))
        refined = self.hbm.refine_basis(models.WATCHED, 1e-3)
        self.assertLess(refined.error, 1e-3)
        small = plm.Hbm(refined.basis, n_harmonics=5).sweep()
        self.assertAlmostEqual(small.amplitude(models.WATCHED).max() / self.curve.amplitude(models.WATCHED).max(), 1, places=1)
        for measure in ("peak", "rms", "harmonic"):
            self.assertEqual(len(self.curve.amplitude(models.WATCHED, measure, 1)), len(self.curve))

    def test_basis(self):
        p = self.basis.vectors()
        self.assertEqual(p.shape, (models.DOFS, self.basis.size))
        self.assertEqual(self.basis.vectors(static=True).shape[1], self.basis.static_size)
        self.assertLess(self.basis.residual(p @ numpy.ones(self.basis.size), mass=True), 1e-9)
        full = plm.Basis(self.model, self.sampler, kind="full").build()
        child = plm.Basis(self.model, self.sampler, parent=full).build()
        self.assertIs(child.model, self.model)
        child.set_parent(None)
        pod = plm.Basis(self.model, parent=self.basis, responses=self.curve, kind="pod", pod_size=2).build()
        self.assertEqual(pod.size, 2)
        pod.set_responses([self.curve, self.curve])
        pod.pod_size = 0
        self.assertTrue(2 < pod.build().size <= self.basis.size)
        pod.set_responses(())
        with self.assertRaises(plm.PlmError) as refusal:
            pod.build()
        self.assertEqual(refusal.exception.argument, "responses")
        sampler = plm.Sampler(self.model, mode=1)
        sampler.add_dominant_mode("sliding", 1)
        self.assertEqual(sampler.run().n_dominant, 2)
        self.assertIs(sampler.model, self.model)

    def test_audit(self):
        findings = self.model.audit()
        self.assertTrue(all(f.text and 0 <= f.severity <= 2 for f in findings) and findings)

    def test_library(self):
        self.assertEqual(len(plm.version()), 3)
        self.assertIn(".", plm.build_info())
        self.assertTrue(plm.status_text(plm.ERR_MEMORY))
        self.assertIn("plot", dir(plm))


class Matrices(unittest.TestCase):
    def frequencies(self, mass, stiffness, part="full"):
        return plm.Model(mass, stiffness, part=part).build().modes(3)

    def test_every_format_gives_the_same(self):
        mass, stiffness = models.matrices()
        wanted = self.frequencies(mass, stiffness)
        for form in ("csc", "csr", "coo", "lil", "dia", "bsr"):
            numpy.testing.assert_allclose(self.frequencies(mass.asformat(form), stiffness.asformat(form)), wanted, rtol=1e-12)
        numpy.testing.assert_allclose(self.frequencies(mass.toarray(), stiffness.toarray()), wanted, rtol=1e-12)
        for part, cut in (("lower", scipy.sparse.tril), ("upper", scipy.sparse.triu)):
            for form in ("csc", "csr", "coo"):
                halves = cut(mass, format=form), cut(stiffness, format=form)
                numpy.testing.assert_allclose(self.frequencies(*halves, part), wanted, rtol=1e-12)
        wide = stiffness.copy()
        wide.indices, wide.indptr = wide.indices.astype(numpy.int64), wide.indptr.astype(numpy.int64)
        numpy.testing.assert_allclose(self.frequencies(mass.astype(numpy.float32), wide), wanted, rtol=1e-12)
        mixed = scipy.sparse.coo_matrix((stiffness.tocoo().data.astype(int), (stiffness.tocoo().row, stiffness.tocoo().col)))
        numpy.testing.assert_allclose(self.frequencies(mass, mixed), wanted, rtol=1e-12)

    def test_matrices_are_not_copied(self):
        for form in ("csc", "csr", "coo"):
            mass, stiffness = (m.asformat(form) for m in models.matrices())
            model = plm.Model(mass, stiffness)
            for array in model._borrowed[plm.STIFFNESS]:
                own = (stiffness.data, *((stiffness.row, stiffness.col) if form == "coo" else
                                         (stiffness.indptr, stiffness.indices)))
                self.assertTrue(any(numpy.shares_memory(array, a) for a in own))
            model.build()
            self.assertFalse(model._borrowed)

    def test_temporaries_live_until_build(self):
        model = plm.Model(n_dof=models.DOFS)
        model.set_mass(models.matrices()[0].toarray())
        model.set_stiffness(models.matrices()[1].astype(numpy.float32))
        model.set_damping(1e-3 * models.matrices()[1])
        junk = [numpy.full(models.DOFS + 1, 1e300) for _ in range(100)]
        numpy.testing.assert_allclose(model.build().modes(1), models.model().build().modes(1), rtol=1e-6)
        self.assertTrue(junk)

    def test_supports_and_loads(self):
        model = models.model()
        model.fix_dofs(numpy.arange(7, models.DOFS, 3))
        mask = numpy.zeros(models.DOFS, dtype=bool)
        mask[8::3] = True
        model.fix_dofs(mask)
        model.fix_dofs(numpy.array([7], dtype=numpy.int32))
        model.set_modal_damping(0.01)
        model.set_modal_damping([])
        model.set_structural_damping(0.001)
        model.set_preload(models.force())
        model.set_preload(None)
        model.set_excitation(1j * models.force(), harmonic=2)
        model.set_excitation(None, harmonic=2)
        wide = numpy.array([[0, 1, 2], [3, 4, 5]], dtype=numpy.int64)
        model.add_node_pairs(wide, wide + 3, [[1, 0, 0], [0, 1, 0]], stiffness=[1e3, 2e3], gap=0.1)
        model.add_ground_contacts(wide.astype(numpy.int32), [0, 0, 1], 5.0)
        model.add_node_pairs(wide.astype(numpy.int32), wide.astype(numpy.int32) + 3, [0, 0, 1])
        rows = scipy.sparse.csr_matrix(numpy.eye(2, models.DOFS))
        model.add_gap_rows(rows, 10.0)
        rows.indices, rows.indptr = rows.indices.astype(numpy.int64), rows.indptr.astype(numpy.int64)
        model.add_gap_rows(rows, 10.0, [0.1, 0.2])
        self.assertEqual(model.build().n_free, models.NODES + 4)
        numpy.testing.assert_array_equal(model.initial_gap, [0, 0, 0.1, 0.1, 0, 0, 0, 0, 0, 0, 0.1, 0.2])


if __name__ == "__main__":
    unittest.main()
