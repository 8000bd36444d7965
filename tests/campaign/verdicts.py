"""What the campaign makes of a result: the verdict on a model, counts and the tables."""
import numpy as np
import plm

import families
import families_acting
import families_brought

ACCURACY = 1e-3  # what is asked for where nothing is set
BROUGHT = families_brought.FAMILIES + families_acting.FAMILIES
EVERY = families.FAMILIES + BROUGHT
TWIN = 1e-9
STATED_SHARE, CRIES_SHARE = 0.02, 0.01  # of the models, at most

# What a sweep says of the points of its curve, which are not looked at here: the peak has more harmonics, and an error of its own.
OF_CURVE = (plm.REASON_HARMONICS_TOO_FEW, plm.REASON_EFFORT, plm.REASON_UNVERIFIED)

VERDICTS = ("right", "warned", "SILENT", "REFUSED", "STOPPED", "UNKNOWN", "OVER TIME", "DIED")
BAD = ("SILENT", "REFUSED", "STOPPED", "OVER TIME", "DIED")


def spoke(r):
    return r["status"] != plm.OK or bool(r["said"])


def error_of(r):
    return max(r["error"], r["frequency_error"])


def unstable(r):
    """The exact motion at the peak is clearly unstable, and no stable one of the curve is nearly as high: what a host has to hear."""
    return r["multiplier"] > 1.01 and r["highest_stable"] < (1 - 1e-2) * r["amplitude"]


def understated(r):
    """The stated error of the amplitude asked for is below a third of the true one. NaN states nothing."""
    return "error" in r and r["error"] > r["exact_to"] and r["stated"] < r["error"] / 3


def wrong_elsewhere(r):
    """At some DOF the motion of the peak is off by more than allowed, and what is stated there is below a third of it."""
    return r.get("worst_error", 0) > ACCURACY and not r["worst_stated"] >= r["worst_error"] / 3 and not spoke(r)


def twins_differ(r):
    return r.get("twin_error", 0) > TWIN


def cries_wolf(r):
    """Something was said of a peak that is right to a third of the accuracy, other than what is true: that it is unstable, that
    no pair opens or closes, what holds of every model of the family, or what a sampler cannot know better (a mode lost among the
    samples, another resonance that is driven alike). Of a larger motion beside the curve the text itself tells how to check it."""
    if "error" not in r or error_of(r) > ACCURACY / 3 or verdict(r) == "STOPPED":
        return False
    true = set(r["says"]) | {getattr(plm, "REASON_LARGER_MOTION", 27), plm.REASON_LOST_MODE, plm.REASON_TIE}
    if r["multiplier"] > 1:
        true.add(plm.REASON_UNSTABLE_PEAK)
    if r["events"] == 0:
        true.add(plm.REASON_NO_SWITCHING)
    of_peak = [(reason, text) for reason, text in r["reasons"] if not (text.startswith("plm_hbm_sweep: ") and reason in OF_CURVE)]
    return any(reason not in true for reason, _ in of_peak)


def verdict(r):
    """right: to the accuracy; warned: wrong, or not comparable, and said so; silent: wrong without a word, or right and unstable
    without a word."""
    if "died" in r:
        return "OVER TIME" if r["died"] == "no end" else "DIED"
    if "refused" in r:
        return "REFUSED"
    if r["status"] in (plm.NOT_CONVERGED, plm.TRUNCATED):
        return "STOPPED"
    if "error" in r and error_of(r) <= ACCURACY and (spoke(r) or not unstable(r)):
        return "right"
    return "warned" if spoke(r) else "SILENT" if "error" in r else "UNKNOWN"


COUNTS = (("wrong elsewhere", wrong_elsewhere), ("stated error below a third", understated), ("right, yet warned", cries_wolf),
          ("twins differ", twins_differ), ("peak unstable", lambda r: r.get("multiplier", 0) > 1 and verdict(r) == "right"))


def failed(results, unknown_share):
    """Whether the run is not as it must be."""
    count, at_most = lambda test: sum(map(test, results)), lambda share: max(1, share * len(results))  # of a few models: one
    return (count(lambda r: verdict(r) in BAD or wrong_elsewhere(r) or twins_differ(r)) > 0
            or count(lambda r: verdict(r) == "UNKNOWN") > unknown_share * len(results)
            or count(understated) > at_most(STATED_SHARE) or count(cries_wolf) > at_most(CRIES_SHARE))


def odd(r):
    """Whether a result is worth a line."""
    return verdict(r) != "right" or spoke(r) or any(test(r) for _, test in COUNTS)


def table(results):
    """Markdown: a row for each family and one for all."""
    rows = ["| family | models | " + " | ".join(v.lower() for v in VERDICTS) + " | " + " | ".join(name for name, _ in COUNTS)
            + " | median s | longest s |", "|---" * (len(VERDICTS) + len(COUNTS) + 4) + "|"]
    for name in [f.__name__ for f in EVERY] + ["all"]:
        of = [r for r in results if name in (r["family"], "all")]
        if not of:
            continue
        verdicts = [verdict(r) for r in of]
        times = [r["seconds"] for r in of if "seconds" in r] or [np.nan]
        counts = [len(of)] + [verdicts.count(v) for v in VERDICTS] + [sum(test(r) for r in of) for _, test in COUNTS]
        rows.append(f"| {name} | " + " | ".join(map(str, counts)) + f" | {np.median(times):.2f} | {max(times):.1f} |")
    return "\n".join(rows)


def summary(results):
    errors = np.array([error_of(r) for r in results if "error" in r])
    times = np.array([r["seconds"] for r in results if "seconds" in r])
    text = f"{len(results)} models"
    if len(errors):
        text += f"; error of the peak (amplitude or frequency): median {np.median(errors):.1e}, 95 % {np.quantile(errors, 0.95):.1e}"
    judged = [r["stated"] / r["error"] for r in results if "error" in r and r["error"] > r["exact_to"] and np.isfinite(r["stated"])]
    if judged:
        text += f"; stated error over the true one, where that can be seen ({len(judged)}): median {np.median(judged):.2g}"
    if len(times):
        text += f"; processor time: median {np.median(times):.2f} s, longest {times.max():.1f} s"
    return text + "."


def line(r):
    text = f"{r['family']:20s} {r['seed']:6d} {verdict(r):9s} "
    if "died" in r:
        return text + r["died"]
    text += f"n {r['n']:2d} pairs {r['pairs']} {r['kind']:12s} {r.get('seconds', np.nan):6.2f} s "
    if "refused" in r:
        return text + r["refused"]
    text += f"r {r['r']:2d} H {r['harmonics']:2d} {r['points']:4d} points, status {r['status']}, {r['hz']:.5g} Hz {r['amplitude']:.5g}"
    if "error" in r:
        text += f", error {r['error']:.1e} {r['frequency_error']:.1e} stated {r['stated']:.1e}"
        if r["stable"] >= 0 and (r["multiplier"] < 1) != (r["stable"] == 1) and abs(r["multiplier"] - 1) > 1e-2:
            text += f", stable {r['stable']} but multiplier {r['multiplier']:.3f}"
    else:
        text += ", " + r["truth"]
    if "worst_error" in r:
        text += f", worst DOF {r['worst_dof']}: {r['worst_error']:.1e} stated {r['worst_stated']:.1e}, in energy {r['energy_error']:.1e}"
    if "twin_error" in r:
        text += f", twin {r['twin_error']:.1e}"
    text += "".join(f" ({name})" for name, test in COUNTS[:4] if test(r))
    return text + (f" ({r['end']})" if r["status"] else "") + (f" [{r['said']}]" if r["said"] else "")
