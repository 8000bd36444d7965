"""Random models on which more acts than a pre-load and a force: functions like those of families.py, with

    G          motion of the gaps at the excitation's frequency, complex amplitudes
    power      of the frequency, with which F grows
    given      forces of the pairs at rest, which the library is given in place of their gaps; NaN: none
"""
import numpy as np
import scipy.linalg

import families


def moving(rng):
    """Walls that move with the excitation, each by a phase of its own or all in step, beside the force or, where the pairs touch at
    rest, in its place."""
    m = (families.chains, families.breathing, families.beam_with_stops)[int(rng.integers(3))](rng)
    w2 = scipy.linalg.eigh(m["K"], m["M"], eigvals_only=True)
    q = np.linalg.solve(m["K"] - w2[0] * m["M"] + 1j * np.sqrt(w2[0]) * m["C"], m["F"])
    phase = rng.uniform(0, 2 * np.pi, len(m["B"])) if rng.random() < 0.5 else np.full(len(m["B"]), rng.uniform(0, 2 * np.pi))
    m["G"] = np.abs(m["B"] @ q).max() * 10 ** rng.uniform(-1.5, -0.5) * rng.uniform(0.5, 1, len(m["B"])) * np.exp(1j * phase)
    if m["kind"] in ("preload", "interference") and rng.random() < 0.4:
        m["F"] = np.zeros(len(m["F"]))
    return m


def unbalanced(rng):
    """A force that grows with the square of the frequency: at the lowest natural frequency it is what the family draws."""
    m = (families.chains, families.breathing, families.beam_with_stops)[int(rng.integers(3))](rng)
    return dict(m, F=m["F"] / scipy.linalg.eigh(m["K"], m["M"], eigvals_only=True)[0], power=2)


def given_forces(rng):
    """Forces at rest in place of the gaps of some pairs, or of all: the gaps at which these, and those that the others have, balance
    the pre-load are what is exact. Pairs that are given no force just touch."""
    m = (families.chains, families.breathing, families.beam_with_stops)[int(rng.integers(3))](rng)
    n, B, kn = len(m["B"]), m["B"], m["kn"]
    w2 = scipy.linalg.eigh(m["K"], m["M"], eigvals_only=True)
    moved = np.abs(B @ np.linalg.solve(m["K"] - w2[0] * m["M"] + 1j * np.sqrt(w2[0]) * m["C"], m["F"])).max()
    penetration = rng.uniform(0.2, 1, n) * moved * 10 ** rng.uniform(-0.8, 0.5)
    force = kn * penetration / (1 + kn * np.diag(B @ np.linalg.solve(m["K"], B.T)))
    force[rng.random(n) < 0.2] = 0
    given = rng.random(n) < 0.6
    if not given.any():
        given[:] = True
    q = np.linalg.solve(m["K"], m["P"] - B.T @ force)
    g = B @ q - force / kn + np.where(given | (force > 0), 0, penetration)
    return dict(m, g=g, given=np.where(given, force, np.nan), kind="given")


FAMILIES = (moving, unbalanced, given_forces)
