"""Loads, damping and moving walls changed after the build: all that follows is that of a model built with them, without another
factorization, and what was computed before stays what it is."""
import unittest

import numpy
import plm
import scipy.sparse.linalg
from test_outputs import N, matrices, pair_row, quietly

PAIRS = 2


class Scene:
    """What acts on the chain, by its setters."""

    def __init__(self, **changed):
        force, preload = numpy.zeros(N), numpy.zeros(N)
        force[4], preload[2] = 2.0, 3.0
        self.acts = {"excitation": [force], "second": [1e-1 * force, 2], "preload": [preload], "gap_motion": [None, 2],
                     "rayleigh_damping": [1.0, 1e-4], "modal_damping": [[]], "structural_damping": [0.0], **changed}

    def put(self, model, names=None):
        for name in names or self.acts:
            getattr(model, "set_" + {"second": "excitation"}.get(name, name))(*self.acts[name])

    def model(self, context=None):
        made = plm.Model(*matrices(), context=context)
        rows = numpy.array([pair_row(), numpy.eye(N)[7]])
        made.add_gap_rows(rows, stiffness=[plm.AUTO_STIFFNESS, 2e4], gap=[1e-4, 2e-3])
        self.put(made)
        return quietly(made.build)


def chain_of(model):
    sampler = plm.Sampler(model)
    basis = plm.Basis(model, sampler, n_harmonics=5)
    return sampler, basis, plm.Hbm(basis, n_harmonics=5)


def computed(sampler, basis, hbm):
    """Numbers of everything on the way."""
    model = basis.model
    quietly(sampler.run)
    quietly(basis.build)
    curve = quietly(hbm.sweep)
    quietly(model.solve_rest)
    one = quietly(hbm.solve, 5.0)
    return {"rest": model.rest_displacement, "modes": model.modes(5, "rest"), "lambda": basis.lambda_,
            "hz": curve.frequency_hz, "amplitude": curve.amplitude(6), "field": one.field(0, 0.3),
            "residual": numpy.array([one.full_residual(0)])}


class ChangedLoads(unittest.TestCase):
    CHANGES = {
        "excitation": [numpy.linspace(1, 2, N) + 1j * numpy.linspace(0, 1, N)],
        "second": [None, 2],
        "preload": [numpy.linspace(-2, 5, N)],
        "gap_motion": [[0, 2e-4 + 1e-4j], 2],
        "rayleigh_damping": [0.5, 3e-4],
        "modal_damping": [[0.02, 0.03]],
        "structural_damping": [0.01],
    }

    def same(self, got, want, tolerance=1e-10):
        self.assertEqual(got.keys(), want.keys())
        for name in want:
            if name == "residual":  # a difference of large numbers
                numpy.testing.assert_allclose(got[name], want[name], rtol=1e-6, atol=1e-12, err_msg=name)
                continue
            scale = numpy.abs(want[name]).max()
            self.assertEqual(got[name].shape, want[name].shape, name)
            numpy.testing.assert_allclose(got[name], want[name], rtol=0, atol=tolerance * scale, err_msg=name)

    def test_each_change_gives_what_a_model_built_with_it_gives(self):
        for name, value in self.CHANGES.items():
            with self.subTest(name):
                model = Scene().model()
                chain = chain_of(model)
                before = computed(*chain)
                quietly(Scene(**{name: value}).put, model, [name])
                after = computed(*chain)
                self.same(after, computed(*chain_of(Scene(**{name: value}).model())))
                self.assertFalse(numpy.array_equal(after["field"], before["field"]))

    def test_all_changes_at_once_and_back(self):
        model = Scene().model()
        before = computed(*chain_of(model))
        other = Scene(**self.CHANGES)
        quietly(other.put, model)
        self.same(computed(*chain_of(model)), computed(*chain_of(other.model())))
        quietly(Scene().put, model)
        self.same(computed(*chain_of(model)), before)

    def test_one_call_after_a_change(self):
        model = Scene().model()
        first = quietly(model.compute_response, 6)
        change = {"preload": self.CHANGES["preload"]}
        quietly(Scene(**change).put, model, ["preload"])
        got, want = (quietly(m.compute_response, 6) for m in (model, Scene(**change).model()))
        numpy.testing.assert_allclose([got.frequency_hz, got.amplitude], [want.frequency_hz, want.amplitude], rtol=1e-9)
        self.assertGreater(abs(got.frequency_hz / first.frequency_hz - 1), 1e-6)

    def test_nothing_is_factored_again(self):
        factored = []

        def factor(matrix, positive_definite):
            factored.append(matrix.shape)
            return scipy.sparse.linalg.splu(matrix).solve
        context = plm.Context()
        context.set_solver(factor)
        model = Scene().model(context)
        context.set_solver(None)  # the model keeps it
        many = len(factored)
        self.assertGreater(many, 0)
        quietly(Scene(**self.CHANGES).put, model)
        quietly(model.solve_rest)
        self.assertEqual(len(factored), many)
        want = Scene(**self.CHANGES).model()
        quietly(want.solve_rest)
        numpy.testing.assert_allclose(model.rest_displacement, want.rest_displacement, rtol=1e-9)

    def test_results_of_before_stay(self):
        model = Scene().model()
        sampler, basis, hbm = chain_of(model)
        computed(sampler, basis, hbm)
        curve = quietly(hbm.sweep)
        read = [curve.amplitude(3), curve.field(4, 0.1), curve.full_residual(4), curve.history(4, 2, 16)]
        quietly(Scene(**self.CHANGES).put, model)
        again = [curve.amplitude(3), curve.field(4, 0.1), curve.full_residual(4), curve.history(4, 2, 16)]
        for one, other in zip(read, again):
            self.assertTrue(numpy.array_equal(one, other))
        for call, argument in ((hbm.sweep, "basis"), (basis.build, "sampler"), (lambda: hbm.find_peak(curve, 3), "basis"),
                               (lambda: hbm.find_backbones(10.0), "basis"), (plm.Transient(basis).run, "basis")):
            with self.assertRaises(plm.PlmError) as caught:
                quietly(call)
            self.assertEqual((caught.exception.status, caught.exception.argument), (plm.ERR_STATE, argument))

    def test_a_parent_of_other_loads_is_refused(self):
        model = Scene().model()
        sampler, basis, hbm = chain_of(model)
        computed(sampler, basis, hbm)
        parent = quietly(plm.Basis(model, sampler, kind="full", n_harmonics=5).build)
        below = plm.Basis(model, sampler, parent=parent, kind="plm", n_harmonics=5)
        quietly(below.build)
        quietly(model.set_structural_damping, 0.01)
        quietly(sampler.run)
        with self.assertRaises(plm.PlmError) as caught:
            quietly(below.build)
        self.assertEqual((caught.exception.status, caught.exception.argument), (plm.ERR_STATE, "parent"))

    def test_loads_on_what_the_build_held(self):
        """DOFs with a spring to the ground each, that nothing moves, are held by the build; a load on one needs another build."""
        m, k = numpy.eye(N + 2), numpy.eye(N + 2)
        m[:N, :N], k[:N, :N] = matrices()
        made = plm.Model(m, k)
        made.add_gap_rows(pair_row(N + 2)[None], stiffness=5e4)
        made.set_rayleigh_damping(1.0, 0.0)
        made.set_excitation(numpy.eye(N + 2)[4])
        quietly(made.build)
        held = numpy.eye(N + 2)[N + 1]
        for call in (lambda: made.set_preload(held), lambda: made.set_excitation(1j * held, 3),
                     lambda: made.set_modal_damping([0.1, 0.2])):
            with self.assertRaises(plm.PlmError) as caught:
                quietly(call)
            self.assertEqual(caught.exception.status, plm.ERR_STATE)
            self.assertIn("make a new model", str(caught.exception))
        quietly(made.set_preload, numpy.eye(N + 2)[3])

    def test_rounding_of_unheld_loads_is_said_as_by_the_build(self):
        """A free chain: a pre-load that balances but for a printed digit is balanced and said, in the build or after it."""
        def free():
            k = 1e4 * (2 * numpy.eye(N) - numpy.eye(N, k=1) - numpy.eye(N, k=-1))
            k[0, 0] = k[-1, -1] = 1e4
            made = plm.Model(numpy.eye(N), k)
            made.add_gap_rows(pair_row()[None], stiffness=5e4)
            made.set_rayleigh_damping(1.0, 0.0)
            made.set_excitation(numpy.eye(N)[4])
            return made
        load = numpy.zeros(N)
        load[[0, 7]] = 1, -1.0001
        given = free()
        given.set_preload(load)
        quietly(given.build)
        changed = quietly(free().build)
        self.assertNotIn("pre-load", changed.warning)
        with self.assertWarns(plm.PlmWarning):
            changed.set_preload(load)
        self.assertIn("pre-load acts on rigid-body motion", changed.warning)
        self.assertEqual(changed.warning, given.warning)
        for made in (given, changed):
            quietly(made.solve_rest)
        numpy.testing.assert_allclose(changed.rest_penetration, given.rest_penetration, rtol=1e-10)
        quietly(changed.set_preload, None)
        self.assertNotIn("pre-load", changed.warning)

    def test_misuse_changes_nothing(self):
        model = Scene().model()
        sampler, basis, hbm = chain_of(model)
        computed(sampler, basis, hbm)
        for call in (lambda: model.set_excitation(numpy.ones(N), -1), lambda: model.set_rayleigh_damping(-1, 0),
                     lambda: model.set_gap_motion([1e-4], 1), lambda: model.set_modal_damping([2.0])):
            self.assertRaises(plm.PlmError, call)
        self.assertRaises(plm.PlmError, model.set_damping, numpy.eye(N))  # a matrix belongs to the build
        quietly(hbm.sweep)  # of the model as it was: no state error


if __name__ == "__main__":
    unittest.main()
