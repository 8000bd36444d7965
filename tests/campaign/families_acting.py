"""Random models on which more acts than a pre-load and a force: functions like those of families.py, with

    G          motion of the gaps at the excitation's frequency, complex amplitudes
    power      of the frequency, with which F grows
    drive      the force by powers of the frequency, where it is not F alone
    beside     what is added to the DOF `out`, by powers of the frequency, too: there the library is looked at in absolute motion
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


def shaken(rng):
    """Supports that move, one or two of them and each by a phase of its own, what the structure does being counted from how it
    follows them at rest, by r: K_fs = -K r. Masses, dampers and pairs reach to the supports, too. With pairs that see the base
    (walls that stand still, strained structures) its displacement is given, else any of the three. Half of them are looked at in absolute motion."""
    m = (families.chains, families.breathing, families.beam_with_stops, families.cracked_beam)[int(rng.integers(4))](rng)
    n, s = len(m["M"]), int(rng.integers(1, 3))
    r = rng.normal(size=(n, s))
    loose = rng.random() < 0.4  # no pair sees the base
    reach = np.zeros((n, s))
    reach[:min(2, n)] = 0.2 * np.diag(m["M"])[:min(2, n), None]
    host = {"M": np.block([[m["M"], reach], [reach.T, np.eye(s) * m["M"].max()]]),
            "K": np.block([[m["K"], -m["K"] @ r], [-r.T @ m["K"], r.T @ m["K"] @ r]])}
    dashpot = 0.0
    of_base = reach * (m["damping"][1] if m["damping"][0] == "rayleigh" else 0)
    if m["damping"][0] == "matrix":
        dashpot = rng.uniform(0, 0.3) * np.diag(m["C"])[0]
        host["C"] = np.block([[m["C"], np.zeros((n, s))], [np.zeros((s, n)), np.zeros((s, s))]])
        host["C"][0, n:] = host["C"][n:, 0] = -dashpot / s
    host["B"] = np.hstack([m["B"], -m["B"] @ r if loose else np.zeros((len(m["B"]), s))])
    loss = m["C"] @ r + host["C"][:n, n:] if m["damping"][0] == "matrix" else \
        m["damping"][1] * m["M"] @ r + of_base if m["damping"][0] == "rayleigh" else np.zeros((n, s))
    inertia = m["M"] @ r + reach
    phase = np.exp(2j * np.pi * rng.random(s)) * rng.uniform(0.5, 1, s)
    w = np.sqrt(scipy.linalg.eigh(m["K"], m["M"], eigvals_only=True)[0])
    dynamic = m["K"] - w**2 * m["M"] + 1j * w * m["C"]
    wanted, moved = (np.abs(m["B"] @ np.linalg.solve(dynamic, f)).max() for f in (m["F"], (w**2 * inertia - 1j * w * loss) @ phase))
    u = phase * wanted / moved
    quantity = ("displacement", "velocity", "acceleration")[int(rng.integers(3)) if loose else 0]
    power = ("displacement", "velocity", "acceleration").index(quantity)
    given = u * (1j * w)**power  # at w the same motion
    u = given / 1j**power  # times omega^-power
    drive = {2 - power: inertia @ u, 1 - power: -1j * loss @ u}
    host.update(F=np.zeros(n + s), P=np.append(m["P"], np.zeros(s)), out=m["out"], base=(np.append(np.zeros(n), given), quantity))
    beside = {}
    if rng.random() < 0.5:  # its absolute motion, as the sum that comes after all DOFs
        host.update(absolute=m["out"], out=n + s)
        beside[-power] = r[m["out"]] @ u
    small = dict(m, F=np.zeros(n), beside=beside, drive=drive, host=host, to_host=np.eye(n + s, n))
    return small if loose else dict(small, G=-(m["B"] @ r) @ u)


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


FAMILIES = (moving, unbalanced, shaken, given_forces)
