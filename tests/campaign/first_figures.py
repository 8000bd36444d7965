"""What hosts met with version 0.1 when they set nothing, measured anew: first_figures.py [--markdown FILE]

Each row is a model of one of the kinds of this folder. Stability flags are compared with those of exact motions by exact.py, which
shares no code with the library. Seconds are those of the processor. Ends with 1 where a row is not as it should be.
"""
import argparse
import sys
import time
import warnings

import numpy as np
import plm
import scipy.sparse as sp

import campaign
import exact
import families


def two_masses():
    """The oscillator of the literature: two masses beside a hard stop."""
    M, K = np.eye(2), np.array([[1.0, -1.0], [-1.0, 2.0]])
    return dict(M=M, K=K, C=0.03 * K, damping=("rayleigh", 0.0, 0.03), B=np.array([[1.0, 0.0]]), kn=np.array([100.0]), g=np.ones(1),
                P=np.zeros(2), F=np.array([0.0, 0.1]), out=0)


def cracked_cantilever(cracked=3, nx=48, ny=6, at=12):
    """Plane elements in N-mm-t, a crack across from the upper face of so many elements, a force at the tip."""
    number = lambda i, j: i * (ny + 1) + j
    nodes = [[480.0 * i / nx, 30.0 * j / ny] for i in range(nx + 1) for j in range(ny + 1)]
    twin = {}
    for j in range(ny, ny - cracked, -1):
        twin[number(at, j)] = len(nodes)
        nodes.append(nodes[number(at, j)])
    elements = []
    for x in range(nx):
        for y in range(ny):
            corners = [number(x, y), number(x + 1, y), number(x + 1, y + 1), number(x, y + 1)]
            elements.append([twin.get(c, c) if x >= at else c for c in corners])
    M, K = families.membrane_matrices(np.array(nodes), elements)
    held = 2 * (ny + 1)
    M, K = M[held:, held:], K[held:, held:]
    B = np.array([families.gap_row(len(M), (2 * a - held, 1.0), (2 * b - held, -1.0)) for a, b in twin.items()])
    tip = 2 * number(nx, ny) + 1 - held
    return dict(M=M, K=K, damping=("modal", 0.01), B=B, kn=None, g=np.zeros(len(B)), P=np.zeros(len(M)),
                F=np.eye(len(M))[tip], out=tip)


def basis_of(m, **options):
    model = campaign.build(m)
    return plm.Basis(model, plm.Sampler(model, **options).run(), n_harmonics=options.get("n_harmonics", 0)).build()


def timed(work):
    begin = time.process_time()
    result = work()
    return result, time.process_time() - begin


def said(text):
    return f"said: \"{text.split(';')[0].split('. ')[0]}\"" if text else "nothing said"


# ---- rows: what, what version 0.1 was measured at, now, and whether it is as it should be

def automatic_harmonics():
    curve, seconds = timed(lambda: plm.Hbm(basis_of(cracked_cantilever())).sweep())
    false = [b for b in curve.bifurcations if b.kind != "fold"]
    return ("crack of 3 pairs, modal damping 1 %, basis for 5 harmonics",
            "138 of 473 points unstable, 16 false bifurcations, harmonic_error up to 12, status 0",
            f"{np.sum(curve.stable == 0)} of {len(curve)} points unstable, {len(false)} bifurcations, harmonic_error "
            f"{curve.harmonic_error.max():.1g}, status {curve.status}, {seconds:.2f} s", not false and np.all(curve.stable == 1))


def harmonic_tolerance_out_of_reach():
    M, K = families.beam_matrices(20)
    M, K = M[2:, 2:], K[2:, 2:]
    n = len(M)
    m = dict(M=M, K=K, damping=("modal", 0.005), B=np.array([families.gap_row(n, (n - 2, 1.0)), families.gap_row(n, (18, 1.0))]),
             kn=np.array([2e3, 1e3]), g=np.array([1e-4, 2e-4]), P=np.zeros(n), F=2e-3 * np.eye(n)[n - 2], out=n - 2)
    model = campaign.build(m)
    basis = plm.Basis(model, plm.Sampler(model, n_harmonics=60).run(), kind="full", n_harmonics=60).build()
    curve = plm.Hbm(basis).sweep()
    by_harmonics = plm.Hbm(basis, motion="harmonics", max_harmonics=10).sweep()
    over, of_harmonics = (int(np.sum(c.harmonic_error > 5e-4)) for c in (curve, by_harmonics))
    return ("harmonic_tolerance out of reach (beam beside two stops)", "points left at 3 to 14 harmonics with 2.5e-2, status 0",
            f"{over} of {len(curve)} points over; with at most 10 harmonics {of_harmonics} of {len(by_harmonics)}, status "
            f"{by_harmonics.status}, {said(by_harmonics.warning)}", over == 0 and of_harmonics > 0 and by_harmonics.status != plm.OK)


def deep_crack():
    m = cracked_cantilever(cracked=5)
    basis = basis_of(m)
    hbm = plm.Hbm(basis)
    peak = hbm.find_peak(hbm.sweep(), m["out"], "peak")
    _, frequency, _ = bilinear(basis.model)
    return ("deep crack, resonance outside the first window", "end of the range returned as peak, status 0",
            f"peak at {peak.frequency_hz:.2f} Hz (bilinear frequency {frequency:.2f} Hz), status {peak.branch.status}",
            abs(peak.frequency_hz / frequency - 1) < 1e-2)


def bilinear(model):
    open_, closed = model.modes(1)[0], model.modes(1, "sliding")[0]
    return open_, 2 * open_ * closed / (open_ + closed), closed


def far_outside():
    basis = basis_of(cracked_cantilever())
    _, hz, _ = bilinear(basis.model)
    curve = plm.Hbm(basis, frequency_min_hz=20 * hz, frequency_max_hz=22 * hz).sweep()
    return ("sweep far outside what the basis was made for", "full residual 0.5 to 1.1, status 0", f"status {curve.status}, {said(curve.warning)}",
            curve.status != plm.OK)


def flags_of_two_masses():
    m = two_masses()
    model = campaign.build(m)
    hz = 1 / (2 * np.pi)
    basis = plm.Basis(model, kind="full", frequency_min_hz=0.5 * hz, frequency_max_hz=0.8 * hz).build()
    curve, seconds = timed(lambda: plm.Hbm(basis).sweep())
    s = exact.Structure(m["M"], m["C"], m["K"], m["B"], m["kn"], m["g"], m["P"], m["F"].astype(complex), 0)
    wrong = looked_at = 0
    for k in range(0, len(curve), 2):
        q = np.array([curve.coefficients(k, d) for d in range(2)]).T
        w, h = 2 * np.pi * curve.frequency_hz[k], np.arange(1, (len(q) - 1) // 2 + 1)[:, None]
        try:
            phi = s.periodic(np.concatenate([q[0] + q[1::2].sum(0), w * (h * q[2::2]).sum(0)]), w)[1]
        except (exact.NoPeriodicMotion, np.linalg.LinAlgError):
            continue
        size = np.abs(np.linalg.eigvals(phi)).max()
        looked_at += 1
        wrong += int(size < 1) != curve.stable[k] and abs(size - 1) > 1e-3
    return ("two masses beside a hard stop: stability flags", "8 of 112 wrong", f"{wrong} of {looked_at} wrong, curve in {seconds:.2f} s", wrong == 0)


def cold_start():
    m = cracked_cantilever()
    basis = basis_of(m)
    hbm = plm.Hbm(basis)
    peak = hbm.find_peak(hbm.sweep(), m["out"])
    solved, seconds = timed(lambda: plm.Hbm(basis, motion="harmonics", n_harmonics=60).solve(peak.frequency_hz))
    off = abs(solved.amplitude(m["out"])[0] / peak.amplitude - 1)
    return ("cold start at the peak with 60 harmonics", "180 s and no solution",
            f"{seconds:.2f} s, status {solved.status}, {off:.1g} from the exact peak", solved.status == plm.OK and off < 1e-3)


def solves_from_beside():
    m = cracked_cantilever()
    basis = basis_of(m)
    texts, all_near = [], True
    for aft in ("event", "sampled"):
        hbm = plm.Hbm(basis, motion="harmonics", n_harmonics=5, aft=aft)
        curve = hbm.sweep()
        hz, height = curve.frequency_hz, curve.amplitude(m["out"])
        solved = far = 0
        for k in range(len(curve)):
            for to in (0.98 * hz[k], 1.02 * hz[k]):
                spans = np.nonzero((hz[:-1] - to) * (hz[1:] - to) <= 0)[0]
                if not len(spans):
                    continue
                found = hbm.solve(to, curve, k)
                on_curve = height[spans] + (height[spans + 1] - height[spans]) * (to - hz[spans]) / (hz[spans + 1] - hz[spans])
                solved += 1
                far += found.status == plm.OK and np.min(np.abs(found.amplitude(m["out"])[0] / on_curve - 1)) > 0.2
        texts.append(f"{aft}: {far} of {solved}")
        all_near = all_near and far == 0
    return ("solve from a start 2 % away: answers more than 20 % off the curve, status 0", "sampled: 48 of 898, event: 2", ", ".join(texts), all_near)


def nothing_holds():
    M, K = np.eye(2), 1e4 * np.array([[1.0, -1.0], [-1.0, 1.0]])
    m = dict(M=M, K=K, damping=("modal", 0.01), B=np.array([[0.0, 1.0]]), kn=np.array([2e4]), g=np.ones(1), P=np.zeros(2),
             F=np.array([0.0, 2e-3]), out=1)
    response = campaign.build(m).compute_response(1)
    mean = np.abs(response.curve.amplitude(1, "harmonic", 0)).max()
    return ("no support and a stop out of reach", "a LAPACK error, or an arbitrary mean position with status 0",
            f"mean position {mean:.1g}, status {response.curve.status}, {said(response.hbm.warning)}", mean < 1e-12)


def mode_in_rad_s():
    model = campaign.build(cracked_cantilever())
    sampler = plm.Sampler(model, mode_frequency_hz=2 * np.pi * model.modes(1)[0]).run()
    return ("mode_frequency_hz in rad/s", "another mode, status 0", said(sampler.warning), "rad/s" in sampler.warning)


ROWS = (automatic_harmonics, harmonic_tolerance_out_of_reach, deep_crack, far_outside, flags_of_two_masses, cold_start, solves_from_beside,
        nothing_holds, mode_in_rad_s)


ELSEWHERE = ("Curves of the examples' plates and cylinders with nothing set (143 s and minutes with version 0.1), s: the output of",
             "`build/release/tests/bench/bench_defaults` and, at the paper's size, `bench_defaults cracked_plate paper`.",
             "An isolated branch beside a curve, found and followed with nothing set: `build/release/tests/bench/bench_isolated`.",
             "Impacts: [extreme.md](extreme.md); random models: [campaign.md](campaign.md).")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--markdown", default="", metavar="FILE")
    arguments = parser.parse_args()
    warnings.simplefilter("ignore", plm.PlmWarning)  # they are in the rows
    lines, as_it_should_be = ["| what | version 0.1 | now |", "|---|---|---|"], True
    for row in ROWS:
        *texts, met = row()
        as_it_should_be = as_it_should_be and met
        lines.append("| " + " | ".join(texts) + " |")
        print(lines[-1], flush=True)
    if arguments.markdown:
        with open(arguments.markdown, "w", encoding="utf-8") as page:
            page.write("\n".join(["# What hosts that set nothing met, and meet", "",
                                  f"    python3 tests/campaign/first_figures.py --markdown {arguments.markdown}", "", __doc__.split("\n\n")[1],
                                  "", *lines, "", *ELSEWHERE, ""]))
    sys.exit(0 if as_it_should_be else 1)


if __name__ == "__main__":
    main()
