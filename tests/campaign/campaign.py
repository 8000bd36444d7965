"""Random models with nothing set, against exact motions: campaign.py [--count N] [--seed S] [--one_call | --steps] [--only FAMILY] [--one K] [--limit S] [--markdown FILE]

Each model goes through compute_response, the whole way in one call, or with --steps through sampler, basis, sweep and peak with
defaults. Its peak is then compared with the highest amplitude of the exact periodic motions of the unreduced model (exact.py) along
the curve through it. Ends with 1 when a peak is wrong by more than 1 %, or its motion unstable, without a status or a warning, a
model was refused, its curve stopped, or it did not end within --limit seconds of the processor. The seed of model K is S + K: --one K
runs that one alone.
"""
import argparse
import os
import pickle
import resource
import signal
import sys
import time
import warnings

import numpy as np
import plm
import scipy.sparse as sp

import exact
import families

ALLOWED, RIGHT = 1e-2, 1e-3


def build(m):
    model = plm.Model(sp.csc_matrix(m.get("M_library", m["M"])), sp.csc_matrix(m["K"]),
                      sp.csc_matrix(m["C"]) if m["damping"][0] == "matrix" else None)
    if m["damping"][0] == "rayleigh":
        model.set_rayleigh_damping(*m["damping"][1:])
    elif m["damping"][0] == "modal":
        model.set_modal_damping(m["damping"][1])
    model.add_gap_rows(sp.csr_matrix(m["B"]), stiffness=m["kn"], gap=m["g"])
    if np.any(m["P"]):
        model.set_preload(m["P"])
    model.set_excitation(m["F"])
    return model.build()


def in_steps(m):
    """The curve, its peak and what was said."""
    model = build(m)
    sampler = plm.Sampler(model).run()
    basis = plm.Basis(model, sampler).build()
    hbm = plm.Hbm(basis)
    curve = hbm.sweep()
    peak = hbm.find_peak(curve, m["out"], "peak")
    said = [w for w in (sampler.warning, basis.warning, curve.warning, peak.branch.warning, hbm.warning) if w]
    return curve, peak, "; ".join(dict.fromkeys(said))


def in_one_call(m):
    response = build(m).compute_response(m["out"], measure="peak")
    said = response.hbm.warning  # before the next call
    return response.curve, response.hbm.find_peak(response.curve, m["out"], "peak"), said


def run_library(m, way, result):
    begin = time.process_time()
    try:
        curve, peak, said = way(m)
    finally:
        result["seconds"] = time.process_time() - begin
    heights = curve.amplitude(m["out"], "peak")
    result.update(points=len(curve), status=int(curve.status), end=curve.end_text, said=said,
                  hz=peak.frequency_hz, amplitude=peak.amplitude, harmonics=int(peak.branch.n_harmonics), r=int(curve.basis_size),
                  stable=int(curve.stable[int(np.argmax(heights))]),
                  highest_stable=float(np.max(heights, where=curve.stable == 1, initial=0)))
    q = peak.branch.coefficients(0)
    h = np.arange(1, (len(q) - 1) // 2 + 1)[:, None]
    omega = 2 * np.pi * peak.frequency_hz
    return np.concatenate([q[0] + q[1::2].sum(0), omega * (h * q[2::2]).sum(0)]), omega


def condensed(m, x):
    """A mesh and a state of it in so few coordinates that its exact motion can be had: the DOFs of contact, force and output
    first. The peak moves by less than 1e-5 when the modes kept reach twice as far."""
    kept = np.flatnonzero(np.abs(m["B"]).sum(axis=0) + np.abs(m["F"]) + (np.arange(len(m["M"])) == m["out"]))
    T = exact.condensation(m["M"], m["K"], kept)
    small = dict(m, out=int(np.flatnonzero(kept == m["out"])[0]), B=m["B"] @ T, P=T.T @ m["P"], F=T.T @ m["F"])
    small.update((name, T.T @ m[name] @ T) for name in "MCK")
    state = np.linalg.solve(small["M"], T.T @ m["M"] @ x.reshape(2, -1).T)
    return small, state.T.ravel()


def compare(m, x, omega, result):
    """The exact peak nearest that of the library."""
    if m.get("condense"):
        m, x = condensed(m, x)
    s = exact.Structure(m["M"], m["C"], m["K"], m["B"], m["kn"], m["g"], m["P"], m["F"].astype(complex), m["out"])
    try:
        w, amplitude, phi, moved = s.peak_near(x, omega)
    except (exact.NoPeriodicMotion, np.linalg.LinAlgError, FloatingPointError) as e:
        result["truth"] = str(e)
        return
    result.update(exact_hz=w / 2 / np.pi, exact_amplitude=amplitude, moved=moved,
                  error=abs(result["amplitude"] / amplitude - 1), frequency_error=abs(omega / w - 1),
                  multiplier=float(np.abs(np.linalg.eigvals(phi)).max()))


def one(family, seed, way, keep=lambda result: None):
    """What came of a model; keep() is handed what is known after the library and again after the exact motion."""
    result = dict(family=family.__name__, seed=seed)
    m = family(np.random.default_rng(seed))
    result["n"], result["pairs"], result["kind"] = len(m["M"]), len(m["B"]), m["kind"]
    try:
        x, omega = run_library(m, way, result)
    except plm.PlmError as e:
        result["refused"] = str(e)
        keep(result)
        return result
    keep(dict(result, truth="the exact motion took too long"))
    with np.errstate(all="ignore"):
        compare(m, x, omega, result)
    keep(result)
    return result


def in_child(family, seed, way, limit):
    """The result, from a process of its own: a crash or a run without end is a result, too."""
    read, write = os.pipe()
    child = os.fork()
    if child == 0:
        os.close(read)
        resource.setrlimit(resource.RLIMIT_CPU, (limit, limit + 2))
        with os.fdopen(write, "wb") as out:
            one(family, seed, way, lambda so_far: (pickle.dump(so_far, out), out.flush()))
        os._exit(0)
    os.close(write)
    known = None
    with os.fdopen(read, "rb") as source:
        try:
            while True:
                known = pickle.load(source)
        except (EOFError, pickle.UnpicklingError):
            pass
    _, ended = os.waitpid(child, 0)
    if known:
        return known
    name = signal.Signals(os.WTERMSIG(ended)).name if os.WIFSIGNALED(ended) else f"exit {os.WEXITSTATUS(ended)}"
    return dict(family=family.__name__, seed=seed, died="no end" if name in ("SIGXCPU", "SIGKILL") else name)


VERDICTS = ("right", "to 1 %", "warned", "SILENT", "REFUSED", "STOPPED", "UNKNOWN", "OVER TIME", "DIED")
BAD = ("SILENT", "REFUSED", "STOPPED", "OVER TIME", "DIED")


def spoke(r):
    return r["status"] != plm.OK or bool(r["said"])


def error_of(r):
    return max(r["error"], r["frequency_error"])


def unstable(r):
    """The exact motion at the peak is clearly unstable, and no stable one of the curve is nearly as high: what a host has to hear."""
    return r["multiplier"] > 1.01 and r["highest_stable"] < (1 - 1e-2) * r["amplitude"]


def cries_wolf(r):
    """Something was said of a peak that is right, other than that a peak which is unstable is unstable."""
    true = r.get("multiplier", 0) > 1 and r["said"].startswith("the motion of the peak") and ";" not in r["said"]
    return verdict(r) == "right" and spoke(r) and not true


def verdict(r):
    """right: to 1e-3; warned: wrong by more than 1 %, or not comparable, and said so; silent: wrong without a word, or right and
    unstable without a word."""
    if "died" in r:
        return "OVER TIME" if r["died"] == "no end" else "DIED"
    if "refused" in r:
        return "REFUSED"
    if r["status"] in (plm.NOT_CONVERGED, plm.TRUNCATED):
        return "STOPPED"
    if "error" in r and error_of(r) <= ALLOWED and (spoke(r) or not unstable(r)):
        return "right" if error_of(r) <= RIGHT else "to 1 %"
    return "warned" if spoke(r) else "SILENT" if "error" in r else "UNKNOWN"


def table(results):
    """Markdown: a row for each family and one for all."""
    rows = ["| family | models | " + " | ".join(v.lower() for v in VERDICTS) + " | right, yet warned | peak unstable | median s | longest s |",
            "|---" * (len(VERDICTS) + 6) + "|"]
    for name in [f.__name__ for f in families.FAMILIES] + ["all"]:
        of = [r for r in results if name in (r["family"], "all")]
        if not of:
            continue
        verdicts = [verdict(r) for r in of]
        times = [r["seconds"] for r in of if "seconds" in r] or [np.nan]
        cries = sum(map(cries_wolf, of))
        unstable_peaks = sum(r.get("multiplier", 0) > 1 and v in ("right", "to 1 %") for v, r in zip(verdicts, of))
        counts = [len(of)] + [verdicts.count(v) for v in VERDICTS] + [cries, unstable_peaks]
        rows.append(f"| {name} | " + " | ".join(map(str, counts)) + f" | {np.median(times):.2f} | {max(times):.1f} |")
    return "\n".join(rows)


def report(results, arguments):
    """The whole run as a page: the command, the table, and a line for each model that is not simply right."""
    odd = [line(r) for r in results if verdict(r) not in ("right", "to 1 %") or spoke(r)]
    return "\n".join(
        ["# Random models with nothing set", "", f"    python3 tests/campaign/campaign.py {arguments}", "", __doc__.split("\n\n")[1], "",
         table(results), "", summary(results), "",
         "Every model that is not right to 1 %, or about which something was said:", "", "```"] + odd + ["```", ""])


def summary(results):
    errors = np.array([error_of(r) for r in results if "error" in r])
    times = np.array([r["seconds"] for r in results if "seconds" in r])
    text = f"{len(results)} models"
    if len(errors):
        text += f"; error of the peak (amplitude or frequency): median {np.median(errors):.1e}, 95 % {np.quantile(errors, 0.95):.1e}"
    if len(times):
        text += f"; processor time: median {np.median(times):.2f} s, longest {times.max():.1f} s"
    return text + "."


def line(r):
    text = f"{r['family']:16s} {r['seed']:6d} {verdict(r):9s} "
    if "died" in r:
        return text + r["died"]
    text += f"n {r['n']:2d} pairs {r['pairs']} {r['kind']:12s} {r['seconds']:6.2f} s "
    if "refused" in r:
        return text + r["refused"]
    text += f"r {r['r']:2d} H {r['harmonics']:2d} {r['points']:4d} points, status {r['status']}, {r['hz']:.5g} Hz {r['amplitude']:.5g}"
    if "error" in r:
        text += f", error {r['error']:.1e} {r['frequency_error']:.1e}"
        if r["stable"] >= 0 and (r["multiplier"] < 1) != (r["stable"] == 1) and abs(r["multiplier"] - 1) > 1e-2:
            text += f", stable {r['stable']} but multiplier {r['multiplier']:.3f}"
    else:
        text += ", " + r["truth"]
    return text + (f" ({r['end']})" if r["status"] else "") + (f" [{r['said']}]" if r["said"] else "")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=500)
    parser.add_argument("--seed", type=int, default=1)
    way = parser.add_mutually_exclusive_group()
    way.add_argument("--one_call", action="store_true", help="by compute_response (the default)")
    way.add_argument("--steps", action="store_true", help="sampler, basis, sweep and peak instead")
    parser.add_argument("--only", default="")
    parser.add_argument("--one", type=int, default=-1)
    parser.add_argument("--limit", type=int, default=120, help="seconds of the processor a model may take, exact motion included")
    parser.add_argument("--markdown", default="", metavar="FILE", help="write the table and the models that are not simply right")
    parser.add_argument("--unknown", type=float, default=0.05, help="share of models whose exact motion may stay unknown")
    a = parser.parse_args()
    warnings.simplefilter("ignore", plm.PlmWarning)  # they are in the results
    results = []
    for k in range(a.count) if a.one < 0 else [a.one]:
        family = families.FAMILIES[k % len(families.FAMILIES)]
        if a.only and family.__name__ != a.only:
            continue
        way = in_steps if a.steps else in_one_call
        r = in_child(family, a.seed + k, way, a.limit) if a.one < 0 else one(family, a.seed + k, way)
        results.append(r)
        print(f"{k:4d} " + line(r), flush=True)
    print(table(results), summary(results), sep="\n\n")
    if a.markdown:
        with open(a.markdown, "w", encoding="utf-8") as page:
            page.write(report(results, " ".join(sys.argv[1:])))
    verdicts = [verdict(r) for r in results]
    if any(v in BAD for v in verdicts) or verdicts.count("UNKNOWN") > a.unknown * len(results):
        sys.exit(1)


if __name__ == "__main__":
    main()
