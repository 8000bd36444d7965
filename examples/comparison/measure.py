"""measure.py: the same response by libplm and by other ways, side by side, for docs/comparison.md.

    PYTHONPATH=bindings/python PLM_LIBRARY=build/release/src/libplm.so OPENBLAS_NUM_THREADS=1 python3 examples/comparison/measure.py [--quick]
        [--tmdsimpy FOLDER]

Two masses beside a stop (docs/getting-started.md) and the cracked cantilever of examples/python/cracked_beam.py. Asked for is the peak of
the curve. Ways: libplm in one call; its harmonic balance with a fixed number of harmonics; Craig-Bampton's reduction on the same solver;
marching in time, by SciPy's solve_ivp and by Newmark's method on the unreduced structure; TMDSimPy (a checkout of it in FOLDER, which
needs NumPy and SciPy). Errors are against exact motions at an accuracy of 1e-8. Times are seconds of the processor, of one core.
--quick: the two masses without marching, and the exit status tells whether the errors are as the page has them.
"""
import argparse
import contextlib
import io
import pathlib
import sys
import time
import warnings

import numpy
import plm
from scipy.integrate import solve_ivp

sys.path.append(str(pathlib.Path(__file__).resolve().parents[1] / "python"))
import cracked_beam  # noqa: E402

MASS, STIFFNESS, STOP, BETA = numpy.eye(2), numpy.array([[2e4, -1e4], [-1e4, 1e4]]), 5e3, 2e-4
RANGE_HZ = (9.0, 14.0)
SETTLED = 1e-4  # change of the state from one period to the next, relative to the motion


def timed(work):
    """(what it returns, seconds of the processor)."""
    start = time.process_time()
    return work(), time.process_time() - start


def two_masses():
    model = plm.Model(mass=MASS, stiffness=STIFFNESS)
    model.set_rayleigh_damping(0, BETA)
    model.add_gap_rows([[0, 1]], stiffness=STOP)
    model.set_excitation([0, 1])
    return model.build()


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
    """Half peak to peak of the second mass once solve_ivp's motion repeats itself, and the state there."""
    omega, damping = 2 * numpy.pi * hz, BETA * STIFFNESS
    inverse = numpy.linalg.inv(MASS)

    def slope(t, y):
        q, v = y[:2], y[2:]
        force = numpy.array([0.0, numpy.cos(omega * t) - STOP * max(q[1], 0.0)])
        return numpy.concatenate([v, inverse @ (force - STIFFNESS @ q - damping @ v)])

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
    for hz in numpy.linspace(*RANGE_HZ, n_frequencies):
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


def by_tmdsimpy(n_harmonics):
    """Its continuation over the same range, from a Newton solution at the lower end; the peak is the highest of its points."""
    from tmdsimpy.continuation import Continuation
    from tmdsimpy.nlforces.unilateral_spring import UnilateralSpring
    from tmdsimpy.solvers import NonlinearSolver
    from tmdsimpy.utils import harmonic
    from tmdsimpy.vibration_system import VibrationSystem
    stop = numpy.array([[0.0, 1.0]])
    system = VibrationSystem(MASS, STIFFNESS, ab=[0, BETA])
    system.add_nl_force(UnilateralSpring(stop, stop.T, STOP))
    h, solver = numpy.arange(n_harmonics + 1), NonlinearSolver()
    n = harmonic.Nhc(h) * 2
    load = numpy.zeros(n)
    load[3] = 1.0  # cosine of the first harmonic on the second mass
    low, high = (2 * numpy.pi * hz for hz in RANGE_HZ)
    start = numpy.zeros(n)
    start[2:6] = system.linear_frf(numpy.array([low]), load[2:4], solver, neigs=2)[0][:4]
    first = solver.nsolve(lambda u: system.hbm_res(numpy.hstack((u, low)), load, h, Nt=256)[:2], start, verbose=False)[0]
    point = numpy.hstack((first, low))
    scale = harmonic.harmonic_wise_conditioning(point, 2, h, delta=1e-4)
    scale[-1] = high
    slope = system.hbm_res(point, load, h, Nt=256)[1] * scale[:-1]
    path = Continuation(solver, ds0=0.01, CtoP=scale, RPtoC=1 / numpy.max(abs(numpy.diag(slope))),
                        config={"DynamicCtoP": True, "TargetNfev": 10, "MaxSteps": 2000, "dsmin": 1e-4, "dsmax": 0.05, "verbose": 0,
                                "xtol": 1e-9 * n, "corrector": "Ortho"})
    with contextlib.redirect_stdout(io.StringIO()):
        points = path.continuation(lambda x: system.hbm_res(x, load, h, Nt=256), point, low, high)
    t = numpy.linspace(0, 2 * numpy.pi, 2000, endpoint=False)
    series = numpy.vstack([numpy.ones_like(t), *(f(k * t) for k in range(1, n_harmonics + 1) for f in (numpy.cos, numpy.sin))])
    amplitudes = numpy.ptp(points[:, 1:n:2] @ series, axis=1) / 2
    best = numpy.argmax(amplitudes)
    return points[best, -1] / 2 / numpy.pi, amplitudes[best]


def row(name, work, truth):
    (hz, amplitude), seconds = timed(work)
    errors = abs(hz / truth[0] - 1), abs(amplitude / truth[1] - 1)
    print(f"| {name} | {seconds:.3g} | {errors[0]:.0e} | {errors[1]:.0e} |", flush=True)
    return errors


def head(title, truth):
    print(f"\n{title}: {1e3 * truth[1]:.5g} mm at {truth[0]:.5f} Hz\n\n| way to the peak | time (s) | error of frequency | error of amplitude |")
    print("|---|--:|--:|--:|")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--tmdsimpy")
    given = parser.parse_args()
    warnings.simplefilter("ignore", plm.PlmWarning)  # of few harmonics, which are asked for here
    truth = in_one_call(two_masses, 1, 1e-8)
    head("Two masses", truth)
    default = row("libplm, one call, nothing set", lambda: in_one_call(two_masses, 1, 1e-3), truth)
    for n in (5, 9, 20):
        row(f"libplm, harmonic balance, H = {n}", lambda: by_harmonics(two_masses, 1, n, "full", {}), truth)
    if given.tmdsimpy:
        sys.path.append(given.tmdsimpy)
        for n in (5, 9):
            row(f"TMDSimPy, harmonic balance, H = {n}", lambda: by_tmdsimpy(n), truth)
    if given.quick:
        return int(max(default) > 1e-3)
    for n in (26, 51):
        row(f"solve_ivp, {n} frequencies", lambda: by_solve_ivp(n, 1e-6), truth)
    beam, dominant = lambda: cracked_beam.make_model()[0], {"system": "open", "mode": 1}
    _, tip = cracked_beam.make_model()
    truth = in_one_call(beam, tip, 1e-8)
    head("Cracked beam", truth)
    row("libplm, one call, nothing set", lambda: in_one_call(beam, tip, 1e-3), truth)
    for n in (5, 20):
        row(f"Craig-Bampton, H = {n}", lambda: by_harmonics(beam, tip, n, "craig_bampton", dominant), truth)
    row("Newmark, unreduced, this frequency alone", lambda: by_newmark(truth[0], tip), truth)
    return 0


sys.exit(main())
