"""Random models with nothing set whose curves were not right at first."""
import warnings

import numpy as np
import plm

import campaign
import families


def two_bases_that_agree_tell_what_no_estimate_does():
    """The estimate of the first basis' error does not converge on this model. The next one that asks for more harmonics has the
    same coordinates and tells nothing; that after it is larger, and has the same peak."""
    m = families.cracked_mesh(np.random.default_rng(110324))
    response = campaign.build(m).compute_response(m["out"], measure="peak")
    assert response.hbm.warning == "", response.hbm.warning
    assert 0 < response.error < 1e-3, response.error


def a_step_that_crosses_to_a_closed_curve_is_found_out():
    """Two masses, two stops: a step of the usual length meets a closed curve of motions that comes within a part of it, and goes
    round that for ever. With a third of the length it does not."""
    m = families.chains(np.random.default_rng(110078))
    response = campaign.build(m).compute_response(m["out"], measure="peak")
    assert response.curve.end_text == "reached the end of its range", response.curve.end_text
    assert abs(response.amplitude / 3.0512e-4 - 1) < 1e-3, response.amplitude  # the exact motion of exact.py


def a_sweep_begins_where_an_exact_motion_is_found():
    """No motion is stable at the first frequency of the range, and none is found there by marching; two per cent further on there is
    one. A curve of 20 harmonics is wrong by half of the amplitude where they are worst."""
    m = families.breathing(np.random.default_rng(110066))
    model = campaign.build(m)
    hbm = plm.Hbm(plm.Basis(model, plm.Sampler(model).run()).build())
    hbm.max_points = 20
    curve = hbm.sweep()
    assert curve.get("unknowns") == "state", curve.get("unknowns")


def a_refinement_under_stiff_contact_meets_its_tolerance():
    """Contact far stiffer than the structure: the steps of harmonic balance to a better solution converge on no curve. The whole
    structure's own motion is found, and the small basis has its peak."""
    m = families.stiff(np.random.default_rng(110140))
    model = campaign.build(m)
    sampler = plm.Sampler(model).run()
    hbm = plm.Hbm(plm.Basis(model, sampler).build())
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        refined = hbm.refine_basis(m["out"], 1e-3, measure="peak")
        assert refined.error <= 1e-3, refined.error
        amplitude = []
        for basis in (refined.basis, plm.Basis(model, sampler, kind="full").build()):
            solver = plm.Hbm(basis)
            amplitude.append(solver.find_peak(solver.sweep(), m["out"], measure="peak").amplitude)
    assert abs(amplitude[0] / amplitude[1] - 1) < 1e-3, amplitude


for test in (two_bases_that_agree_tell_what_no_estimate_does, a_step_that_crosses_to_a_closed_curve_is_found_out,
             a_sweep_begins_where_an_exact_motion_is_found, a_refinement_under_stiff_contact_meets_its_tolerance):
    test()
    print(test.__name__, "ok")
