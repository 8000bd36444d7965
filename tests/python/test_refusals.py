"""What is refused, and what the exception tells."""
import math
import unittest

import numpy
import plm
import scipy.sparse

import models


class Refusals(unittest.TestCase):
    def refused(self, attempt, /, *arguments, kind=plm.PlmError, **fields):
        with self.assertRaises(kind) as caught:
            attempt(*arguments)
        for name, value in fields.items():
            self.assertEqual(getattr(caught.exception, name), value, name)
        self.assertTrue(str(caught.exception))
        return caught.exception

    def test_matrix_entries(self):
        mass, stiffness = models.matrices()
        stiffness.data[5] = math.nan
        self.refused(plm.Model, mass, stiffness, status=plm.ERR_MATRIX, function="plm_model_set_matrix_i32",
                     argument="value", index=5)
        stiffness = models.matrices()[1]
        stiffness[0, 3] = -5e3
        self.refused(plm.Model, mass, stiffness, status=plm.ERR_MATRIX)  # not symmetric
        twice = scipy.sparse.csc_matrix((numpy.ones(3), [0, 0, 1], [0, 2, 3]), shape=(2, 2))
        self.refused(plm.Model, twice, status=plm.ERR_MATRIX, argument="b")

    def test_complex_numbers(self):
        """The loss factor of a complex stiffness is not dropped on the way; zero imaginary parts are no loss."""
        mass, stiffness = models.matrices()
        lossy = stiffness * (1 + 0.02j)
        for matrix in (lossy, lossy.tocsr(), lossy.tocoo(), lossy.tolil(), lossy.toarray()):
            error = self.refused(plm.Model, mass, matrix, kind=ValueError)
            self.assertRegex(str(error), "^the stiffness matrix is complex.*set_structural_damping")
        self.assertEqual(plm.Model(mass, stiffness + 0j).n_dof, models.DOFS)
        model, force = plm.Model(mass, stiffness), models.force()
        for attempt, argument in ((model.set_preload, force * 1j), (model.set_modal_damping, [0.01j]),
                                  (model.add_gap_rows, force.reshape(1, -1) * 1j),
                                  (lambda n: model.add_ground_contacts([0, 1, 2], n), [1, 0.5j, 0])):
            self.assertIn("complex", str(self.refused(attempt, argument, kind=ValueError)))
        model.set_excitation(force * 1j)  # a phase is what complex numbers are for

    def test_matrices_of_different_size(self):
        mass, stiffness = models.matrices()
        error = self.refused(plm.Model, mass, stiffness[:9, :9], kind=ValueError)
        self.assertRegex(str(error), "the stiffness matrix is 9 x 9, but the model has 24 DOFs; hand over")

    def test_dofs(self):
        model = plm.Model(n_dof=4)
        self.refused(model.fix_dofs, [0, 4], status=plm.ERR_ARGUMENT, function="plm_model_fix_dofs_i64", argument="dof",
                     index=1)
        self.refused(model.fix_dofs, [0.5], kind=TypeError)
        self.refused(model.set_elimination_order, [0, 1], status=plm.ERR_ARGUMENT, argument="n")
        self.refused(model.set_elimination_order, numpy.array([3, 2, 1, 1], numpy.int32), status=plm.ERR_ARGUMENT,
                     function="plm_model_set_elimination_order_i32", argument="dof", index=3)
        self.refused(model.set_elimination_order, [0.5], kind=TypeError)
        model.set_elimination_order([3, 1, 0, 2])
        self.refused(model.add_ground_contacts, [0, 1, 2], [2, 0, 0], status=plm.ERR_ARGUMENT, argument="normal")
        self.refused(model.add_ground_contacts, [0, 1, 2], [1, 0], kind=ValueError)
        self.refused(model.add_node_pairs, [0, 1, 2], [0, 1, 2, 1, 2, 3], [1, 0, 0], kind=ValueError)
        self.refused(model.add_gap_rows, numpy.eye(3), kind=ValueError)
        self.refused(model.set_preload, [1, 2], kind=ValueError)
        self.refused(model.set_mass, numpy.eye(3), kind=ValueError)
        self.refused(plm.Model, kind=TypeError)
        self.assertIn("n_dof=", str(self.refused(plm.Model, 13, kind=TypeError)))

    def test_not_positive_definite(self):
        mass, stiffness = models.matrices()
        stiffness[9, 6] = stiffness[6, 9] = -1e6
        self.refused(plm.Model(mass, stiffness).build, status=plm.ERR_NOT_POSITIVE_DEFINITE, function="plm_model_build",
                     reason=plm.REASON_NOT_POSITIVE_DEFINITE)

    def test_keys(self):
        model = models.model()
        for attempt in (lambda: setattr(model, "space_tolerence", 1e-3), lambda: model.set("space_tolerence", 1e-3),
                        lambda: plm.Model(n_dof=2, space_tolerence=1e-3), lambda: model.get("space_tolerence")):
            error = self.refused(attempt, kind=plm.PlmKeyError, status=plm.ERR_KEY, argument="key")
            self.assertIn("space_tolerance", str(error))  # the nearest
        self.assertFalse(hasattr(model, "no_such_thing"))
        self.refused(setattr, model, "space_tolerance", 2.0, status=plm.ERR_ARGUMENT)
        self.refused(model.set, "space_tolerance", [1], kind=TypeError)
        self.assertEqual(str(self.refused(model.set, "space_tolerance", "fine", kind=TypeError)),
                         "space_tolerance is a number, not 'fine'")
        self.refused(model._get_string, b"space_tolerance", function="plm_model_get_string")
        self.refused(setattr, model, "n_free", 3, kind=AttributeError)
        self.refused(lambda: model.modes(3, "slidding"), kind=ValueError)

    def test_arguments_of_another_type(self):
        model, force = models.model(), numpy.zeros(models.DOFS)
        for attempt, arguments, told in ((model.set_excitation, (force, force), "an integer is needed, not ndarray"),
                                         (model.set_excitation, (force, 1.5), "an integer is needed, not float"),
                                         (model.set_excitation, (force, 2**32 + 1), "does not fit"),
                                         (model.set, ("space_tolerance", 2**64 + 1), "does not fit"),
                                         (model.set_rayleigh_damping, (0.1, "0"), "a real number is needed, not str")):
            error = self.refused(attempt, *arguments, kind=TypeError)
            self.assertRegex(str(error), "^plm_model_set_[a-z_]+: (harmonic|value|beta): .*" + told)
        model.set_rayleigh_damping(numpy.float32(0.5), numpy.int64(0))  # numbers all the same
        model.set_excitation(force, numpy.int32(2))

    def test_order(self):
        model = models.model()
        self.refused(plm.Sampler(model).run, status=plm.ERR_STATE, function="plm_sampler_run")
        self.refused(lambda: model.rest_force, status=plm.ERR_STATE)
        model.build()
        self.refused(model.fix_dofs, [0], status=plm.ERR_STATE)
        self.refused(plm.Model(n_dof=2).build, status=plm.ERR_STATE)

    def test_contexts_do_not_mix(self):
        basis = models.basis(plm.Context())
        other = models.model(context=plm.Context()).build()
        self.refused(basis.set_sampler, plm.Sampler(other), status=plm.ERR_HANDLE, argument="sampler")

    def test_points(self):
        curve = plm.Hbm(models.basis()).sweep()
        self.refused(curve.field, len(curve), status=plm.ERR_ARGUMENT, argument="point")
        self.refused(curve.amplitude, models.DOFS, status=plm.ERR_ARGUMENT, argument="dof")
        self.refused(curve.set, "n_points", 3, kind=AttributeError)

    def test_numbers_are_no_keys(self):
        curve = plm.Hbm(models.basis()).sweep()
        error = str(self.refused(lambda: curve[0], kind=TypeError))
        self.assertRegex(error, 'indexed by the names of its options and results.*branch\\["frequency_hz"\\]\\[i\\]')
        self.assertIn('model["space_tolerance"]', str(self.refused(lambda: models.model().set(3, 1), kind=TypeError)))
        self.refused(lambda: list(curve), kind=TypeError)
        self.assertIn("frequency_hz", curve)
        self.assertNotIn("frequency", curve)

    def test_repr(self):
        """Every object says what it is and how far it has come, also from inside a callback."""
        model = models.model()
        self.assertEqual(repr(model), "<plm.Model: 24 DOFs, contact pairs: 2, not built>")
        self.assertEqual(repr(model.build()), "<plm.Model: 24 DOFs, contact pairs: 2, built>")
        sampler = plm.Sampler(model, system="open", mode=1)
        self.assertEqual(repr(sampler), "<plm.Sampler: not run>")
        self.assertRegex(repr(sampler.run()), "^<plm.Sampler: [0-9]+ samples along mode 1 of the open system, "
                                              "window [0-9.]+ .. [0-9.]+ Hz>$")
        basis = plm.Basis(model, sampler)
        hbm = plm.Hbm(basis)
        self.assertEqual(repr(hbm), "<plm.Hbm: automatic harmonics, on <plm.Basis: not built>>")
        basis.build()
        hbm.n_harmonics = 5
        self.assertRegex(repr(hbm), "^<plm.Hbm: 5 harmonics, on <plm.Basis: plm, [0-9]+ columns, static ones: [0-9]+>>$")
        curve = hbm.sweep()
        self.assertRegex(repr(curve), f"^<plm.Branch: {len(curve)} points, [0-9.]+ .. [0-9.]+ Hz, reached the end of its range>$")
        motion = plm.Transient(basis, frequency_hz=10)
        motion.observe([3, 4])
        self.assertEqual(repr(motion), "<plm.Transient: reduced model at 10 Hz, observed DOFs: 2>")
        study = plm.Study(model)
        study.add_response("four", hbm)
        self.assertEqual(repr(study), "<plm.Study: methods: four; not run>")
        self.assertEqual(repr(plm.Context(log=True)), "<plm.Context: log on, progress off, built-in solver>")
        inside = []
        hbm.sweep(progress=lambda *_: inside.append(repr(curve)))
        self.assertEqual(set(inside), {"<plm.Branch>"})

    def test_any_order_of_destruction(self):
        context = plm.Context()
        basis = models.basis(context)
        hbm = plm.Hbm(basis)
        del context, basis
        curve = hbm.sweep()
        del hbm
        self.assertGreater(len(curve), 3)


if __name__ == "__main__":
    unittest.main()
