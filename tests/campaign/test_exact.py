"""The exact motions of exact.py against closed forms."""
import numpy as np
import scipy.integrate
import scipy.linalg

import families
import families_brought
from exact import Structure, condensation


def bilinear(zeta, ratio):
    """Mass 1 on a spring 1, a second spring `ratio` - 1 where it is pushed: no gap."""
    return Structure(np.eye(1), np.array([[2 * zeta]]), np.eye(1), np.eye(1), np.array([ratio - 1]), np.zeros(1), np.zeros(1),
                     np.array([1 + 0j]), 0)


def linear_response():
    s = Structure(np.eye(1), np.array([[0.02]]), np.eye(1), np.eye(1), np.array([3.0]), np.array([1e9]), np.zeros(1),
                  np.array([1 + 0j]), 0)
    for omega in (0.5, 0.9, 1.3):
        x, phi = s.periodic(np.array([0.3, -0.2]), omega)
        expected = abs(1 / (1 - omega**2 + 0.02j * omega))
        assert abs(s.amplitude(x, omega) / expected - 1) < 2e-8, omega  # cubics over 1/150 period: (0.042)^4 / 384
        decay = np.exp(-0.01 * 2 * np.pi / omega)  # |multipliers| of a damped oscillator
        assert np.allclose(np.abs(np.linalg.eigvals(phi)), decay, rtol=1e-12)


def bilinear_resonance():
    """Two half-cycles of frequencies 1 and 2: the resonance tends to 2 * 1 * 2 / (1 + 2), its shift is of second order in damping,
    and half a cycle in each spring makes two events a period."""
    for zeta, allowed in ((1e-1, 2e-2), (1e-2, 2e-4)):
        s = bilinear(zeta, 4.0)
        expected = 4 / 3
        x, _ = settle(s, expected, zeta)
        omega, amplitude, phi, _ = s.peak_near(x, expected)
        assert abs(omega / expected - 1) < allowed, (zeta, omega)
        assert s.events == 2
        # over one period the free motion shrinks by exp(-zeta T): det(monodromy) = exp(-2 zeta T), whatever the events
        assert abs(np.linalg.det(phi) / np.exp(-2 * zeta * 2 * np.pi / omega) - 1) < 1e-8


def settle(s, omega, zeta):
    x = np.zeros(2)
    for _ in range(int(1.5 / zeta)):
        x = s.flow(x, omega)
    return s.periodic(x, omega)


def monodromy_is_the_derivative():
    K = np.array([[1.0, -1.0], [-1.0, 2.0]])
    s = Structure(np.eye(2), 0.03 * K, K, np.array([[1.0, 0.0]]), np.array([100.0]), np.array([1.0]), np.zeros(2),
                  np.array([0, 0.1 + 0j]), 0)
    x, omega = np.array([0.9, 0.4, 0.8, -0.2]), 0.62
    _, phi = s.flow(x, omega, 1, True)
    assert s.events >= 2
    for j in range(4):
        d = 1e-6 * np.eye(4)[j]
        assert np.allclose((s.flow(x + d, omega) - s.flow(x - d, omega)) / 2e-6, phi[:, j], atol=1e-6)


def condensation_keeps_statics_and_low_modes():
    """A mesh in few coordinates: what forces at the kept DOFs do there is exact, low modes nearly."""
    m = families.cracked_mesh(np.random.default_rng(7))
    kept = np.flatnonzero(np.abs(m["B"]).sum(axis=0) + np.abs(m["F"]))
    T = condensation(m["M"], m["K"], kept)
    M, K = T.T @ m["M"] @ T, T.T @ m["K"] @ T
    assert len(K) < len(m["K"]) / 2
    flexibility = np.linalg.inv(m["K"])[np.ix_(kept, kept)]
    assert np.allclose(np.linalg.inv(K)[:len(kept), :len(kept)], flexibility, rtol=1e-8, atol=1e-10 * np.abs(flexibility).max())
    few, all_of_them = scipy.linalg.eigh(K, M, eigvals_only=True), scipy.linalg.eigh(m["K"], m["M"], eigvals_only=True)
    assert np.allclose(few[:3], all_of_them[:3], rtol=1e-5)


def contact_alone_may_hold_a_body():
    """A mass that lies on a spring and takes off: the motion found with a soft ground spring beside the contact comes back to itself
    without that, by an integrator of its own. (It flies five times as far as it is pressed
    in: 2e-4 of the motion, by the soft spring, see held_softly.)"""
    kn, load, force, damping, omega = 1e4, 10.0, 8.0, 20.0, 60.0
    m = families_brought.held_softly(dict(M=np.eye(1), K=np.zeros((1, 1))), np.sqrt(kn))
    s = Structure(m["M"], np.array([[damping]]), m["K"], np.eye(1), np.array([kn]), np.zeros(1), np.array([load]),
                  np.array([force + 0j]), 0)
    x = np.array([load / kn, 0.0])
    for _ in range(40):
        x = s.flow(x, omega)
    x, _ = s.periodic(x, omega)
    contact = lambda t, y: y[0]
    contact.terminal = True
    t, y, end, changes = 0.0, x, 2 * np.pi / omega, 0
    while t < end:
        k = kn if y[0] > 0 or (y[0] == 0 and y[1] > 0) else 0.0
        run = scipy.integrate.solve_ivp(
            lambda t, y: [y[1], load + force * np.cos(omega * t) - damping * y[1] - k * y[0]], (t, end), y,
            method="DOP853", rtol=1e-12, atol=1e-15, events=contact)
        t, y = run.t[-1], run.y[:, -1].copy()
        if run.status == 1:
            y[0], changes = 0.0, changes + 1
            t, y = t + 1e-12, y + [1e-12 * y[1], 0]  # off the switching point
    assert changes >= 2, changes
    assert np.abs((y - x) / [load / kn, omega * load / kn]).max() < 2e-3, (y, x)


def nearest_motion_and_all_peaks():
    """The nearest motion lies on the curve, also from a state that is off; the peaks of all DOFs are those of each alone."""
    K = np.array([[2.0, -1.0], [-1.0, 1.0]])
    of = lambda out: Structure(np.eye(2), 0.02 * K, K, np.array([[0.0, 1.0]]), np.array([3.0]), np.array([0.2]), np.zeros(2),
                               np.array([0.0, 0.02 + 0j]), out)
    s, x, omega = of(np.arange(2)), np.zeros(4), 0.66
    for _ in range(150):
        x = s.flow(x, omega)
    x, _ = s.periodic(x, omega)
    y, w, _ = s.nearest(x * (1 + 1e-4), omega * (1 + 1e-5))
    assert np.abs(s.flow(y, w) - y).max() < 1e-8 * np.abs(y).max()
    assert np.abs(y / x - 1).max() < 1e-2 and abs(w / omega - 1) < 1e-3
    together = s.amplitude(x, omega)
    assert np.allclose(together, [of(d).amplitude(x, omega) for d in range(2)], rtol=1e-14)


def modal_damping_is_that_of_each_mode():
    M, K = families.chain(np.random.default_rng(3), 5)
    w2, phi = scipy.linalg.eigh(K, M)
    for ratios, all_of_them in (([0.01], [0.01] * 5), ([0.01, 0.03], [0.01] + [0.03] * 4)):
        C = families_brought.modal_matrix(M, K, ratios)
        assert np.allclose(phi.T @ C @ phi, np.diag(2 * np.array(all_of_them) * np.sqrt(w2)), atol=1e-9 * np.sqrt(w2[-1]))


def twins_are_the_same_structure():
    for k in range(6):
        for family in (families_brought.permuted, families_brought.round_shaft, families_brought.twin_plates):
            m = family(np.random.default_rng(k))
            T, out = m["twin"]
            assert np.allclose(T @ T.T, np.eye(len(T)), atol=1e-14) and T[m["out"], out] == 1


for test in (linear_response, bilinear_resonance, monodromy_is_the_derivative, condensation_keeps_statics_and_low_modes,
             contact_alone_may_hold_a_body, nearest_motion_and_all_peaks, modal_damping_is_that_of_each_mode, twins_are_the_same_structure):
    test()
    print(test.__name__, "ok")
