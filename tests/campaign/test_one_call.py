"""compute_response with nothing set, where it has no estimate to go by."""
import numpy as np

import campaign
import families


def two_bases_that_agree_tell_what_no_estimate_does():
    """The estimate of the first basis' error does not converge on this model. The next one that asks for more harmonics has the
    same coordinates and tells nothing; that after it is larger, and has the same peak."""
    m = families.cracked_mesh(np.random.default_rng(110324))
    response = campaign.build(m).compute_response(m["out"], measure="peak")
    assert response.hbm.warning == "", response.hbm.warning
    assert 0 < response.error < 1e-3, response.error


for test in (two_bases_that_agree_tell_what_no_estimate_does,):
    test()
    print(test.__name__, "ok")
