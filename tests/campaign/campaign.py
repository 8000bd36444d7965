"""Random models with nothing set, against exact motions: campaign.py [--count N] [--seed S] [--one_call | --steps] [--families SET] [--only FAMILIES] [--one K] [--limit S] [--markdown FILE]

Each model goes through compute_response, the whole way in one call, or with --steps through sampler, basis, sweep, peak and error
estimate with defaults. Its peak is then compared with the highest amplitude of the exact periodic motions of the unreduced model
(exact.py) along the curve through it; of plates over many gaps the motion of the peak with the nearest exact one, at all DOFs; of
twins (the same model in other coordinates) the answers with one another. Ends with 1 when a peak is wrong by more than 1e-3, or its
motion unstable, without a status or a warning, twins differ by more than 1e-9, a model was refused, its curve stopped, or it did not
end within --limit seconds of the processor; or when of more than 2 % of the models the stated error is below a third of the true one,
or more than 1 % were warned about though right to a third of 1e-3 and nothing is to say. The seed of model K is S + K: --one K runs
that one alone.
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
from verdicts import BROUGHT, EVERY, failed, line, odd, summary, table


def build(m):
    m = dict(m, **m.get("host", {}))
    of = (lambda a: a) if m.get("dense") else sp.csc_matrix
    damping, options = of(m["C"]) if m["damping"][0] == "matrix" else None, {"absolute_outputs": 1} if "absolute" in m else {}
    model = plm.Model(of(m.get("M_library", m["M"])), of(m.get("K_library", m["K"])), damping, **options)
    if m["damping"][0] == "rayleigh":
        model.set_rayleigh_damping(*m["damping"][1:])
    elif m["damping"][0] == "modal":
        model.set_modal_damping(m["damping"][1])
    if "rows" in m:
        model.add_constraints(m["rows"])
    for method, *arguments in m.get("couplings", ()):
        getattr(model, method)(*arguments)
    given = m.get("given", np.full(len(m["g"]), np.nan))
    model.add_gap_rows(sp.csr_matrix(m.get("B_library", m["B"])), stiffness=m["kn"], gap=np.where(np.isnan(given), m["g"], 0))
    if "given" in m:
        model.set_rest_force(given)
    if np.any(m["P"]):
        model.set_preload(m["P"])
    model.set_excitation(m["F"], power=m.get("power", 0))
    if "base" in m:
        model.fix_dofs(np.flatnonzero(m["base"][0]))
        model.set_base_motion(*m["base"])
    elif "G" in m:
        model.set_gap_motion(m["G"])
    model.build()
    if "absolute" in m:
        model.add_outputs(np.eye(len(m["M"]))[[m["absolute"]]])
    return model


def looked_at(m):
    """The DOF of the library's model."""
    return m.get("host", m)["out"]


def in_steps(m):
    """The curve, its peak, the stated error of it, and the hbm."""
    model = build(m)
    sampler = plm.Sampler(model).run()
    basis = plm.Basis(model, sampler).build()
    hbm = plm.Hbm(basis)
    curve = hbm.sweep()
    peak = hbm.find_peak(curve, looked_at(m), "peak")
    return curve, peak, stated_at(hbm, peak, looked_at(m)), hbm


def stated_at(hbm, peak, dof):
    """Of the point of the peak."""
    estimate = hbm.estimate_error(peak.branch, 0, dof, "peak")
    return abs(estimate.amplitude.total) / peak.branch.amplitude(dof, "peak")[0]


def in_one_call(m):
    response = build(m).compute_response(looked_at(m), measure="peak")
    with warnings.catch_warnings():  # what the call said is known; this is to have the point
        warnings.simplefilter("ignore")
        peak = response.hbm.find_peak(response.curve, looked_at(m), "peak")
    return response.curve, peak, response.error, response.hbm


def run_library(m, way, result):
    begin = time.process_time()
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always", plm.PlmWarning)
        try:
            curve, peak, stated, hbm = way(m)
        finally:
            result["seconds"] = time.process_time() - begin
    heights = curve.amplitude(looked_at(m), "peak")
    reasons = [(w.message.reason, str(w.message)) for w in said if isinstance(w.message, plm.PlmWarning)]
    if any(reason == plm.REASON_NO_PEAK for reason, _ in reasons):
        stated = np.nan  # the error of a point at the end of a curve says nothing of a peak beyond it
    result.update(points=len(curve), status=int(curve.status), end=curve.end_text, reasons=reasons, stated=float(stated),
                  said="; ".join(dict.fromkeys(text for _, text in reasons)),
                  hz=peak.frequency_hz, amplitude=peak.amplitude, harmonics=int(peak.branch.n_harmonics), r=int(curve.basis_size),
                  stable=int(curve.stable[int(np.argmax(heights))]),
                  highest_stable=float(np.max(heights, where=curve.stable == 1, initial=0)))
    return peak, hbm


def state_of(peak):
    """(q, v) at the beginning of the period."""
    q = peak.branch.coefficients(0)
    h = np.arange(1, (len(q) - 1) // 2 + 1)[:, None]
    omega = 2 * np.pi * peak.frequency_hz
    return np.concatenate([q[0] + q[1::2].sum(0), omega * (h * q[2::2]).sum(0)]), omega


def condensed(m, x):
    """A mesh and a state of it in so few coordinates that its exact motion can be had: the DOFs of contact, force and output
    first. The peak moves by less than 1e-5 when the modes kept reach twice as far."""
    kept = np.flatnonzero(np.abs(m["B"]).sum(axis=0) + np.abs(m["F"]) + (np.arange(len(m["M"])) == m["out"]))
    T = exact.condensation(m["M"], m["K"], kept, reach=80.0, fewest=40)
    small = dict(m, out=int(np.flatnonzero(kept == m["out"])[0]), B=m["B"] @ T, P=T.T @ m["P"], F=T.T @ m["F"])
    small.update((name, T.T @ m[name] @ T) for name in "MCK")
    state = np.linalg.solve(small["M"], T.T @ m["M"] @ x.reshape(2, -1).T)
    return small, state.T.ravel()


def force_of(m):
    """By the powers of the frequency."""
    return m.get("drive", {m.get("power", 0): m["F"].astype(complex)})


def compare(m, x, omega, result):
    """The exact peak nearest that of the library."""
    if m.get("condense"):
        m, x = condensed(m, x)
    s = exact.Structure(m["M"], m["C"], m["K"], m["B"], m["kn"], m["g"], m["P"], force_of(m), m["out"], m.get("G"), m.get("beside"))
    w, amplitude, phi, moved = s.peak_near(x, omega)
    result.update(exact_hz=w / 2 / np.pi, exact_amplitude=amplitude, moved=moved, events=s.events,
                  error=abs(result["amplitude"] / amplitude - 1), frequency_error=abs(omega / w - 1),
                  multiplier=float(np.abs(np.linalg.eigvals(phi)).max()))


def compare_everywhere(m, peak, hbm, x, omega, result):
    """The exact motion nearest that of the peak, at all DOFs: where it is off most (of those that move at least a hundredth of the
    largest), what is stated there, and the whole in the norm of energy. Curves over many gaps take too long to follow: the
    largest amplitude near a peak is that of any motion near it."""
    n = len(m["M"])
    s = exact.Structure(m["M"], m["C"], m["K"], m["B"], m["kn"], m["g"], m["P"], force_of(m), np.arange(n), m.get("G"))
    y, w, phi = s.nearest(x, omega)
    s.flow(y, w)
    true = s.peak
    of = np.array([peak.branch.amplitude(d, "peak")[0] for d in range(n)])
    off = np.abs(of / true - 1) * (true > 1e-2 * true.max())
    worst = int(np.argmax(off))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        stated = stated_at(hbm, peak, worst)
    energy = lambda z: np.sqrt(z[:n] @ m["K"] @ z[:n] + z[n:] @ m["M"] @ z[n:])
    result.update(exact_hz=w / 2 / np.pi, exact_amplitude=true[m["out"]], moved=0.0, events=s.events,
                  error=abs(of[m["out"]] / true[m["out"]] - 1), frequency_error=abs(omega / w - 1), multiplier=float(np.abs(np.linalg.eigvals(phi)).max()),
                  worst_dof=worst, worst_error=float(off[worst]), worst_stated=float(stated), energy_error=energy(x - y) / energy(y))


def twin_of(m):
    """The same model in the coordinates of its twin."""
    T, out = m["twin"]
    twin = dict(m, out=out, B=m["B"] @ T, P=T.T @ m["P"], F=T.T @ m["F"])
    for name in ("M", "C", "K"):
        a = T.T @ m[name] @ T
        twin[name] = (a + a.T) / 2
    return twin


def compare_twin(m, way, result):
    other = {}
    try:
        run_library(twin_of(m), way, other)
    except plm.PlmError as e:
        result.update(twin_error=np.inf, twin=str(e))
        return
    result["twin_error"] = max(abs(other[name] / result[name] - 1) for name in ("amplitude", "hz"))


def one(family, seed, way, keep=lambda result: None):
    """What came of a model; keep() is handed what is known after the library and again after the exact motion."""
    result = dict(family=family.__name__, seed=seed)
    m = family(np.random.default_rng(seed))
    result.update(n=len(m["M"]), pairs=len(m["B"]), kind=m["kind"], says=sorted(m.get("says", ())),
                  exact_to=m.get("exact_to", 3e-5 if m.get("condense") else 1e-6))
    try:
        peak, hbm = run_library(m, way, result)
    except plm.PlmError as e:
        result["refused"] = str(e)
        keep(result)
        return result
    result["truth"] = "the exact motion took too long"
    keep(result)
    if "twin" in m:
        compare_twin(m, way, result)
        keep(result)
    x, omega = state_of(peak)
    if "host" in m:
        x = np.linalg.lstsq(m["to_host"], x.reshape(2, -1).T, rcond=None)[0].T.ravel()
    try:
        with np.errstate(all="ignore"):
            compare_everywhere(m, peak, hbm, x, omega, result) if m.get("all_dofs") else compare(m, x, omega, result)
    except (exact.NoPeriodicMotion, np.linalg.LinAlgError, FloatingPointError, ValueError) as e:
        result["truth"] = str(e)
    keep(result)
    return result


class Worker:
    """A process that takes one model after the other, as a host does, and is replaced where one brings it down or does not end."""

    def __init__(self, way, limit):
        self.way, self.limit, self.pid = way, limit, None

    def _begin(self):
        theirs, self.orders = os.pipe()
        self.results, ours = os.pipe()
        self.pid = os.fork()
        if self.pid == 0:
            os.close(self.orders), os.close(self.results)
            self._serve(os.fdopen(theirs, "rb"), os.fdopen(ours, "wb"))
            os._exit(0)
        os.close(theirs), os.close(ours)
        self.orders, self.results = os.fdopen(self.orders, "wb"), os.fdopen(self.results, "rb")

    def _serve(self, orders, results):
        def keep(so_far):
            pickle.dump(so_far, results)
            results.flush()

        try:
            while True:
                family, seed = pickle.load(orders)
                most = int(time.process_time()) + 1 + self.limit
                resource.setrlimit(resource.RLIMIT_CPU, (most, resource.RLIM_INFINITY))
                keep(one(family, seed, self.way, keep))
                keep(None)
        except EOFError:
            pass

    def run(self, family, seed):
        """What is known of the model: a crash or a run without end is a result, too."""
        if self.pid is None:
            self._begin()
        pickle.dump((family, seed), self.orders)
        self.orders.flush()
        known = None
        try:
            while (so_far := pickle.load(self.results)) is not None:
                known = so_far
            return known
        except (EOFError, pickle.UnpicklingError):
            ended = self.end()
        if known:
            return known
        name = signal.Signals(os.WTERMSIG(ended)).name if os.WIFSIGNALED(ended) else f"exit {os.WEXITSTATUS(ended)}"
        return dict(family=family.__name__, seed=seed, died="no end" if name == "SIGXCPU" else name)

    def end(self):
        """How the process ended: as of os.waitpid."""
        if self.pid is None:
            return 0
        self.orders.close(), self.results.close()
        ended, self.pid = os.waitpid(self.pid, 0)[1], None
        return ended


def report(results, arguments):
    """The whole run as a page: the command, the table, and a line for each model that is not simply right."""
    return "\n".join(
        ["# Random models with nothing set", "", f"    python3 tests/campaign/campaign.py {arguments}", "", __doc__.split("\n\n")[1], "",
         table(results), "", summary(results), "",
         "Every model that is not right, or about which something was said:", "", "```"] + [line(r) for r in results if odd(r)] + ["```", ""])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--count", type=int, default=600)
    parser.add_argument("--seed", type=int, default=1)
    way = parser.add_mutually_exclusive_group()
    way.add_argument("--one_call", action="store_true", help="by compute_response (the default)")
    way.add_argument("--steps", action="store_true", help="sampler, basis, sweep, peak and its error instead")
    sets = {"first": families.FAMILIES, "brought": BROUGHT, "all": EVERY}
    parser.add_argument("--families", choices=sets, default="all", help="families.py, families_brought.py with families_acting.py, or all")
    parser.add_argument("--only", default="", metavar="FAMILY[,FAMILY...]")
    parser.add_argument("--one", type=int, default=-1)
    parser.add_argument("--limit", type=int, default=120, help="seconds of the processor a model may take, exact motion included")
    parser.add_argument("--markdown", default="", metavar="FILE", help="write the table and the models that are not simply right")
    parser.add_argument("--unknown", type=float, default=0.05, help="share of models whose exact motion may stay unknown")
    a = parser.parse_args()
    chosen = sets[a.families]
    way = in_steps if a.steps else in_one_call
    worker, results = Worker(way, a.limit), []
    for k in range(a.count) if a.one < 0 else [a.one]:
        family = chosen[k % len(chosen)]
        if a.only and family.__name__ not in a.only.split(","):
            continue
        r = worker.run(family, a.seed + k) if a.one < 0 else one(family, a.seed + k, way)
        results.append(r)
        print(f"{k:4d} " + line(r), flush=True)
    worker.end()
    print(table(results), summary(results), sep="\n\n")
    if a.markdown:
        with open(a.markdown, "w", encoding="utf-8") as page:
            page.write(report(results, " ".join(sys.argv[1:])))
    if failed(results, a.unknown):
        sys.exit(1)


if __name__ == "__main__":
    main()
