"""measure.py: the same response by libplm and by other ways, side by side, for docs/comparison.md.

    PYTHONPATH=bindings/python PLM_LIBRARY=build/release/src/libplm.so OPENBLAS_NUM_THREADS=1 python3 examples/comparison/measure.py [--quick]
        [--tmdsimpy FOLDER] [--nlvib FOLDER]

Two masses beside a stop (docs/getting-started.md), a row of twenty masses with five stops, and the cracked cantilever of
examples/python/cracked_beam.py. Asked for is the peak of the curve. Ways: libplm in one call; its harmonic balance with a fixed number of
harmonics; Craig-Bampton's reduction on the same solver; marching in time, by SciPy's solve_ivp and by Newmark's method on the unreduced
structure; TMDSimPy (a checkout of it in FOLDER); NLvib (its folder SRC, and octave-cli). Errors are against exact motions at an accuracy of
1e-8. Times are seconds of the processor, of one core. --quick: the two masses without marching, and the exit status tells whether the errors
are as the page has them.
"""
import argparse
import contextlib
import dataclasses
import io
import pathlib
import subprocess
import sys
import tempfile
import time
import warnings

import numpy
import plm
from scipy.integrate import solve_ivp

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "python"))
import cracked_beam  # noqa: E402

SETTLED = 1e-4  # change of the state from one period to the next, relative to the motion
SAMPLES = 256  # in a period, for codes that sample contact forces


@dataclasses.dataclass
class Row:
    """Masses of 1 kg on springs (N/m), stops beside the last ones; 1 N on the last, damping proportional to stiffness."""
    n: int
    spring: float
    stop: float
    n_stops: int
    range_hz: tuple
    beta: float = 2e-4

    def __post_init__(self):
        self.mass = numpy.eye(self.n)
        self.stiffness = self.spring * (2 * numpy.eye(self.n) - numpy.eye(self.n, k=1) - numpy.eye(self.n, k=-1))
        self.stiffness[-1, -1] = self.spring
        self.stops = numpy.eye(self.n)[self.n - self.n_stops:]
        self.force = numpy.eye(self.n)[-1]

    def model(self):
        model = plm.Model(mass=self.mass, stiffness=self.stiffness)
        model.set_rayleigh_damping(0, self.beta)
        model.add_gap_rows(self.stops, stiffness=self.stop)
        model.set_excitation(self.force)
        return model.build()


TWO = Row(n=2, spring=1e4, stop=5e3, n_stops=1, range_hz=(9.0, 14.0))
TWENTY = Row(n=20, spring=1e6, stop=2e5, n_stops=5, range_hz=(12.0, 22.0))


def timed(work):
    """(what it returns, seconds of the processor)."""
    start = time.process_time()
    return work(), time.process_time() - start


def in_one_call(make, dof, accuracy):
    response = make().compute_response(dof=dof, accuracy=accuracy)
    return response.frequency_hz, response.amplitude


def by_harmonics(make, dof, n_harmonics, kind, dominant):
    """The same solver with a fixed number of harmonics, on a basis of this kind."""
    model = make()
    sampler = plm.Sampler(model, **dominant).run()
    hbm = plm.Hbm(plm.Basis(model, sampler, kind=kind).build(), n_harmonics=n_harmonics, motion="harmonics", stability="off")
    peak = hbm.find_peak(hbm.sweep(), dof=dof)
    return peak.frequency_hz, peak.amplitude


def settled_amplitude(hz, state, rtol):
    """Half peak to peak of the second of two masses once solve_ivp's motion repeats itself, and the state there."""
    omega, damping = 2 * numpy.pi * hz, TWO.beta * TWO.stiffness

    def slope(t, y):
        q, v = y[:2], y[2:]
        force = numpy.array([0.0, numpy.cos(omega * t) - TWO.stop * max(q[1], 0.0)])
        return numpy.concatenate([v, force - TWO.stiffness @ q - damping @ v])

    times = numpy.linspace(0, 1 / hz, 201)
    for _ in range(2000):
        motion = solve_ivp(slope, (0, 1 / hz), state, t_eval=times, rtol=rtol, atol=rtol * 1e-4).y
        change = numpy.max(abs(motion[:2, -1] - state[:2])) / numpy.max(abs(motion[:2]))
        state = motion[:, -1]
        if change < SETTLED:
            break
    return numpy.ptp(motion[1]) / 2, state


def by_solve_ivp(n_frequencies, rtol):
    """Each frequency from the state of the one before, as a stepped sine test does."""
    state, best = numpy.zeros(4), (0.0, 0.0)
    for hz in numpy.linspace(*TWO.range_hz, n_frequencies):
        amplitude, state = settled_amplitude(hz, state, rtol)
        best = max(best, (amplitude, hz))
    return best[1], best[0]


def by_newmark(hz, dof):
    """The unreduced cracked beam marched from rest at the frequency of the peak alone: one point, where a curve needs some twenty."""
    model, _ = cracked_beam.make_model()
    motion = plm.Transient(model, frequency_hz=hz, periods=3000, settled=SETTLED)
    motion.observe([dof])
    motion.run()
    last = motion.history(dof)[-motion.steps_per_period - 1:]
    return hz, numpy.ptp(last) / 2


def by_tmdsimpy(row, n_harmonics):
    """Its continuation over the same range, from a Newton solution at the lower end; the peak is the highest of its points."""
    from tmdsimpy.continuation import Continuation
    from tmdsimpy.nlforces.unilateral_spring import UnilateralSpring
    from tmdsimpy.solvers import NonlinearSolver
    from tmdsimpy.utils import harmonic
    from tmdsimpy.vibration_system import VibrationSystem
    system = VibrationSystem(row.mass, row.stiffness, ab=[0, row.beta])
    for stop in row.stops:
        system.add_nl_force(UnilateralSpring(stop[None, :], stop[:, None], row.stop))
    h, solver = numpy.arange(n_harmonics + 1), NonlinearSolver()
    n = harmonic.Nhc(h) * row.n
    load = numpy.zeros(n)
    load[row.n:2 * row.n] = row.force  # cosine of the first harmonic
    low, high = (2 * numpy.pi * hz for hz in row.range_hz)
    start = numpy.zeros(n)
    linear = numpy.linalg.solve(row.stiffness * (1 + 1j * low * row.beta) - low**2 * row.mass, row.force)
    start[row.n:3 * row.n] = numpy.concatenate([linear.real, -linear.imag])
    first = solver.nsolve(lambda u: system.hbm_res(numpy.hstack((u, low)), load, h, Nt=SAMPLES)[:2], start, verbose=False)[0]
    point = numpy.hstack((first, low))
    scale = harmonic.harmonic_wise_conditioning(point, row.n, h, delta=1e-4)
    scale[-1] = high
    slope = system.hbm_res(point, load, h, Nt=SAMPLES)[1] * scale[:-1]
    path = Continuation(solver, ds0=0.01, CtoP=scale, RPtoC=1 / numpy.max(abs(numpy.diag(slope))),
                        config={"DynamicCtoP": True, "TargetNfev": 10, "MaxSteps": 2000, "dsmin": 1e-4, "dsmax": 0.05, "verbose": 0,
                                "xtol": 1e-9 * n, "corrector": "Ortho"})
    with contextlib.redirect_stdout(io.StringIO()):
        points = path.continuation(lambda x: system.hbm_res(x, load, h, Nt=SAMPLES), point, low, high)
    t = numpy.linspace(0, 2 * numpy.pi, 2000, endpoint=False)
    series = numpy.vstack([numpy.ones_like(t), *(f(k * t) for k in range(1, n_harmonics + 1) for f in (numpy.cos, numpy.sin))])
    amplitudes = numpy.ptp(points[:, row.n - 1:n:row.n] @ series, axis=1) / 2
    best = numpy.argmax(amplitudes)
    return points[best, -1] / 2 / numpy.pi, amplitudes[best]


def by_nlvib(row, n_harmonics, source):
    """Its continuation by nlvib.m in a process of Octave, which takes its own time: (frequency, amplitude, seconds)."""
    given = {"M": row.mass, "D": row.beta * row.stiffness, "K": row.stiffness, "W": row.stops.T, "k": numpy.full(row.n_stops, row.stop),
             "f": row.force, "range": 2 * numpy.pi * numpy.array(row.range_hz), "observed": numpy.array([row.n])}
    with tempfile.TemporaryDirectory() as case:
        for name, numbers in given.items():
            numpy.savetxt(pathlib.Path(case, name), numbers, fmt="%.17g")
        script = pathlib.Path(__file__).with_name("nlvib.m")
        done = subprocess.run(["octave-cli", "--no-window-system", "--quiet", script, source, case, str(n_harmonics)], text=True,
                              capture_output=True, check=False)
    if done.returncode:
        sys.exit(done.stderr)  # else it has a word about an object on leaving
    omega, amplitude, seconds = (float(word) for word in done.stdout.split()[-3:])
    return omega / 2 / numpy.pi, amplitude, seconds


def line(name, work, truth):
    (hz, amplitude, *own), seconds = timed(work)
    errors = abs(hz / truth[0] - 1), abs(amplitude / truth[1] - 1)
    if numpy.isnan(amplitude):
        print(f"| {name} | {(own or [seconds])[0]:.3g} | ended at {hz:.1f} Hz | - |", flush=True)
        return errors
    shown = (f"{error:.0e}" if error > 1e-12 else "below 1e-12" for error in errors)
    print(f"| {name} | {(own or [seconds])[0]:.3g} | {' | '.join(shown)} |", flush=True)
    return errors


def head(title, truth):
    print(f"\n{title}: {1e3 * truth[1]:.5g} mm at {truth[0]:.5f} Hz\n\n| way to the peak | time (s) | error of frequency | error of amplitude |")
    print("|---|--:|--:|--:|")


def rows_of(structure, title, given, few, many):
    """The table of a row of masses, and the errors of the one call. few: numbers of harmonics for all codes, many: for libplm, too."""
    last = structure.n - 1
    truth = in_one_call(structure.model, last, 1e-8)
    head(title, truth)
    default = line("libplm, one call, nothing set", lambda: in_one_call(structure.model, last, 1e-3), truth)
    for n in (*few, *many):
        line(f"libplm, harmonic balance, H = {n}", lambda: by_harmonics(structure.model, last, n, "full", {}), truth)
    for n in few if given.tmdsimpy else ():
        line(f"TMDSimPy, harmonic balance, H = {n}", lambda: by_tmdsimpy(structure, n), truth)
    for n in few if given.nlvib else ():
        line(f"NLvib, harmonic balance, H = {n}", lambda: by_nlvib(structure, n, given.nlvib), truth)
    return default, truth


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--tmdsimpy", help="folder of a checkout")
    parser.add_argument("--nlvib", help="its folder SRC")
    given = parser.parse_args()
    warnings.simplefilter("ignore", plm.PlmWarning)  # of few harmonics, which are asked for here
    if given.tmdsimpy:
        sys.path.append(given.tmdsimpy)
    default, truth = rows_of(TWO, "Two masses", given, (5, 9), (20,))
    if given.quick:
        return int(max(default) > 1e-3)
    for n in (26, 51):
        line(f"solve_ivp, {n} frequencies", lambda: by_solve_ivp(n, 1e-6), truth)
    rows_of(TWENTY, "Twenty masses", given, (5,), (9, 20))
    beam, dominant = lambda: cracked_beam.make_model()[0], {"system": "open", "mode": 1}
    _, tip = cracked_beam.make_model()
    truth = in_one_call(beam, tip, 1e-8)
    head("Cracked beam", truth)
    line("libplm, one call, nothing set", lambda: in_one_call(beam, tip, 1e-3), truth)
    for n in (5, 20):
        line(f"Craig-Bampton, H = {n}", lambda: by_harmonics(beam, tip, n, "craig_bampton", dominant), truth)
    line("Newmark, unreduced, this frequency alone", lambda: by_newmark(truth[0], tip), truth)
    return 0


sys.exit(main())
