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


def a_refinement_without_an_estimate_ends_and_says_so():
    """Contact far stiffer than the structure: the steps to a better solution converge on no curve. Three in a row are enough."""
    m = families.stiff(np.random.default_rng(110140))
    model = campaign.build(m)
    hbm = plm.Hbm(plm.Basis(model, plm.Sampler(model).run()).build())
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        refined = hbm.refine_basis(m["out"], 1e-3, measure="peak")
    assert not np.isfinite(refined.error), refined.error
    texts = [str(w.message) for w in said]
    assert any("after 3 curves" in t and "is not known" in t for t in texts), texts


for test in (two_bases_that_agree_tell_what_no_estimate_does, a_step_that_crosses_to_a_closed_curve_is_found_out,
             a_sweep_begins_where_an_exact_motion_is_found, a_refinement_without_an_estimate_ends_and_says_so):
    test()
    print(test.__name__, "ok")
