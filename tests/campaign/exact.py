"""Exact periodic motions of structures with contact, for checking the library: shares no code with it.

Between two contact events the structure is linear. For each set of closed pairs the state equation is solved by its
eigenvectors, events are located on the solution itself, and the monodromy is the product of the pieces' propagators (the
contact force is continuous, so nothing jumps). Periodic motions are zeros of flow minus state, by Newton's method; the
highest amplitude along a curve of them by steps in (state, frequency).
"""
import numpy as np
import scipy.linalg
from scipy.optimize import brentq


class NoPeriodicMotion(Exception):
    pass


class Piece:
    """x' = A x + b + Re(f exp(i omega t)) with one set of closed pairs, x = (q, v)."""

    def __init__(self, s, closed):
        n = s.n
        spring = np.where(closed, s.kn, 0.0)
        stiffness = s.K + s.B.T @ (spring[:, None] * s.B)
        a = np.zeros((2 * n, 2 * n))
        a[:n, n:] = np.eye(n)
        a[n:, :n] = -s.Minv @ stiffness
        a[n:, n:] = -s.Minv @ s.C
        self.values, self.vectors = np.linalg.eig(a)
        self.inverse = np.linalg.inv(self.vectors)
        load = np.concatenate([np.zeros(n), s.Minv @ (s.P + s.B.T @ (spring * s.g))])
        self.fixed = -np.linalg.solve(a, load)
        of_modes = lambda f: self.inverse @ np.concatenate([np.zeros(n), s.Minv @ f])
        self.drive = {power: of_modes(f) for power, f in s.F.items()}
        self.drive[0] = self.drive.get(0, 0) + of_modes(s.B.T @ (spring * s.G))
        self.gaps = s.B @ self.vectors[:n]

    def forced(self, omega):
        """Complex amplitude of the forced motion."""
        return self.vectors @ (sum(omega**power * f for power, f in self.drive.items()) / (1j * omega - self.values))


def condensation(M, K, kept, reach=40.0, fewest=20):
    """T of Hurty, Craig and Bampton: the DOFs `kept`, statically, and the modes of the rest up to `reach` times its lowest
    frequency. For meshes whose stiffest modes would dictate every step of the flow."""
    rest = np.setdiff1d(np.arange(len(M)), kept)
    w2, phi = scipy.linalg.eigh(K[np.ix_(rest, rest)], M[np.ix_(rest, rest)])
    phi = phi[:, :max(fewest, np.count_nonzero(w2 < reach**2 * w2[0]))]
    T = np.zeros((len(M), len(kept) + phi.shape[1]))
    T[kept, np.arange(len(kept))] = 1.0
    T[np.ix_(rest, np.arange(len(kept)))] = -np.linalg.solve(K[np.ix_(rest, rest)], K[np.ix_(rest, kept)])
    T[np.ix_(rest, np.arange(len(kept), T.shape[1]))] = phi
    return T


class Structure:
    """M q'' + C q' + K q + B' max(kn u, 0) = P + Re(F exp(i omega t)), u = B q - g - Re(G exp(i omega t)); F: a vector, or several by
    the power of omega they grow with; `out`: the DOF looked at, or several; `beside`: what is known to be added there, by powers, too."""

    def __init__(self, M, C, K, B, kn, g, P, F, out, G=None, beside=None):
        self.n = len(M)
        self.Minv = np.linalg.inv(M)
        self.C, self.K, self.B, self.kn, self.g, self.P, self.out = C, K, B, kn, g, P, out
        self.beside = beside or {}
        self.F = F if isinstance(F, dict) else {0: F}
        self.G = np.zeros(len(g)) if G is None else G
        self._pieces = {}

    def piece(self, closed):
        key = closed.tobytes()
        if key not in self._pieces:
            if len(self._pieces) > min(3000, 3e6 / self.n**2):  # some hundred megabytes
                self._pieces.clear()
            self._pieces[key] = Piece(self, closed)
        return self._pieces[key]

    def flow(self, x, omega, periods=1, derivative=False, samples=150):
        """State after the periods; with `derivative` the monodromy. Keeps the largest |q_out| as self.peak, one number for
        each DOF of `out`."""
        n, end = self.n, periods * 2 * np.pi / omega
        outs = np.atleast_1d(self.out)
        t, events, peak = 0.0, 0, np.zeros(len(outs))
        phi, known = np.eye(2 * n) if derivative else None, sum(omega**power * a for power, a in self.beside.items())
        u = self.B @ x[:n] - self.g - np.real(self.G)
        noise = 1e-13 * (np.abs(self.g) + np.abs(self.G) + np.abs(self.B) @ np.abs(x[:n]))
        closed = np.where(np.abs(u) > noise, u > 0, self.B @ x[n:] - np.real(1j * omega * self.G) > 0)
        while end - t > 1e-14 * end:
            p = self.piece(closed)
            f = p.forced(omega)
            fg, fo, out = self.B @ f[:n] - self.G, f[outs, None] + known, p.vectors[outs]
            xp = lambda time: np.real(f * np.exp(1j * omega * time)) + p.fixed
            c = p.inverse @ (x - xp(t))
            base = self.B @ p.fixed[:n] - self.g
            alone = lambda i: (
                lambda time: (np.dot(p.gaps[i] * c, np.exp(p.values * time)).real
                              + (fg[i] * np.exp(1j * omega * (t + time))).real + base[i]),
                lambda time: (np.dot(p.gaps[i] * c * p.values, np.exp(p.values * time)).real
                              + (1j * omega * fg[i] * np.exp(1j * omega * (t + time))).real))
            weight = np.abs(p.gaps) @ np.diag(np.abs(c))
            size = np.abs(base).max(initial=0) + np.abs(fg).max(initial=0) + weight.max(initial=0)
            live = (weight.max(axis=0, initial=0) > 1e-7 * size) & (np.abs(p.values.imag) > np.abs(p.values.real))
            fastest = np.abs(p.values.imag[live]).max(initial=omega)
            dt = min(end / periods / samples, 0.5 / fastest)
            tau, hit, chunk = 0.0, None, 16
            while hit is None and end - t - tau > 1e-14 * end:
                chunk = min(2 * chunk, 512)
                grid = tau + dt * np.arange(chunk + 1)
                if grid[-1] >= end - t - 1e-14 * end:
                    grid = np.append(grid[grid < end - t - 1e-14 * end], end - t)
                free, wave = c[:, None] * np.exp(np.outer(p.values, grid)), np.exp(1j * omega * (t + grid))
                rate, swing = p.values[:, None] * free, 1j * omega * wave
                if len(self.g):
                    gaps = np.real(p.gaps @ free) + np.real(np.outer(fg, wave)) + base[:, None]
                    hit = self._first_event(gaps, np.real(p.gaps @ rate) + np.real(np.outer(fg, swing)), alone, grid, closed)
                q = np.real(out @ free) + np.real(fo * wave) + p.fixed[outs, None]
                v = np.real(out @ rate) + np.real(fo * swing)
                stop = grid[-1]
                if hit is not None:
                    stop, before = hit[0], grid < hit[0]
                    free, wave = c * np.exp(p.values * stop), np.exp(1j * omega * (t + stop))
                    grid = np.append(grid[before], stop)
                    q = np.c_[q[:, before], np.real(out @ free + fo[:, 0] * wave) + p.fixed[outs]]
                    v = np.c_[v[:, before], np.real(out @ (p.values * free) + 1j * omega * fo[:, 0] * wave)]
                for i in range(len(outs)):
                    at = lambda time: (out[i] @ (c * np.exp(p.values * time)) + fo[i, 0] * np.exp(1j * omega * (t + time))
                                       ).real + p.fixed[outs[i]]
                    peak[i] = max(peak[i], largest(grid, q[i], v[i], at))
                tau = stop
            growth = np.exp(p.values * tau)
            if derivative:
                phi = np.real(p.vectors @ (growth[:, None] * (p.inverse @ phi)))
            x = np.real(p.vectors @ (growth * c)) + xp(t + tau)
            t += tau
            if hit is not None:
                closed = closed.copy()
                closed[hit[1]] = ~closed[hit[1]]
                events += 1
                if events > 4000 * periods or not np.all(np.isfinite(x)):
                    raise NoPeriodicMotion("chatter")
        self.peak, self.events = (peak if np.ndim(self.out) else peak[0]), events
        return (x, phi) if derivative else x

    @staticmethod
    def _first_event(gaps, rates, alone, grid, closed):
        """(time, pair) of the first change of sign after grid[0], or None; dips between grid points are looked at.
        gaps, rates: (pairs, times) on the grid; alone(i): the gap of pair i and its rate, as functions of one time."""
        sign = np.where(closed, 1.0, -1.0)
        g, r = gaps * sign[:, None], rates * sign[:, None]  # positive while the state lasts
        g[:, 0] = np.maximum(g[:, 0], 0.0)  # the piece may begin at an event
        suspect = (g[:, 1:] < 0) | ((r[:, :-1] < 0) & (r[:, 1:] > 0))
        first = None
        for i in np.nonzero(suspect.any(axis=1))[0]:
            value, rate = alone(i)
            one, slope = (lambda time: sign[i] * value(time)), (lambda time: sign[i] * rate(time))
            for k in np.nonzero(suspect[i])[0]:
                a, b = grid[k], grid[k + 1]
                if first is not None and a >= first[0]:
                    break
                if g[i, k + 1] >= 0:
                    b = brentq(slope, a, b, xtol=1e-15 * max(abs(b), 1e-300))  # a dip between two points
                    if one(b) >= 0:
                        continue
                if g[i, k] <= 0 or one(a) <= 0:  # leaves zero at once, perhaps after having risen a little
                    if r[i, k] <= 0:
                        time = a
                    else:
                        above = [s for s in np.linspace(a, b, 50)[1:] if one(s) > 0]
                        time = brentq(one, above[0], b, xtol=1e-16) if above else a
                else:
                    time = brentq(one, a, b, xtol=1e-15 * max(abs(b), 1e-300))
                if first is None or time < first[0]:
                    first = (time, i)
                break
        return first

    # ---- periodic motions

    def residual(self, x, omega, periods):
        y, phi = self.flow(x, omega, periods, True)
        return y - x, phi - np.eye(2 * self.n)

    def scales(self, x, omega):
        q, v = np.abs(x[:self.n]).max(), np.abs(x[self.n:]).max() / omega
        size = max(q, v, 1e-300)
        return np.concatenate([np.full(self.n, size), np.full(self.n, size * omega)])

    def periodic(self, x, omega, periods=1, tolerance=1e-9, most=15):
        """The periodic motion at omega nearest x: (state, monodromy)."""
        scale = self.scales(x, omega)
        for _ in range(most):
            r, jacobian = self.residual(x, omega, periods)
            step = np.linalg.solve(jacobian, -r)
            x = x + step
            if not np.all(np.isfinite(x)):
                break
            if np.abs(step / scale).max() < tolerance:
                return x, jacobian + np.eye(2 * self.n)
        raise NoPeriodicMotion("Newton's method does not converge at %.6g Hz" % (omega / 2 / np.pi))

    def amplitude(self, x, omega, periods=1):
        self.flow(x, omega, periods)
        return self.peak

    def on_curve(self, x, omega, tangent, periods, scale):
        """The point of the curve in the plane through (x, omega) across `tangent` (scaled), and the tangent there."""
        n2 = 2 * self.n
        jw = None
        for _ in range(12):
            r, jx = self.residual(x, omega, periods)
            self.here = self.peak
            if jw is None:
                h = 1e-7 * omega
                jw = (self.flow(x, omega + h, periods) - self.flow(x, omega - h, periods)) / (2 * h)
            a = np.zeros((n2 + 1, n2 + 1))
            a[:n2, :n2] = jx * scale[None, :-1] / scale[:-1, None]
            a[:n2, n2] = jw * scale[-1] / scale[:-1]
            a[n2] = tangent if tangent is not None else np.eye(n2 + 1)[n2]
            step = np.linalg.solve(a, np.append(-r / scale[:-1], 0.0))
            x, omega = x + step[:-1] * scale[:-1], omega + step[-1] * scale[-1]
            if not np.all(np.isfinite(x)) or omega <= 0:
                break
            if np.abs(step).max() < 1e-7:
                new = np.linalg.solve(a, np.eye(n2 + 1)[n2])
                return x, omega, new / np.linalg.norm(new), jx + np.eye(n2)
        raise NoPeriodicMotion("no point of the curve near %.6g Hz" % (omega / 2 / np.pi))

    def nearest(self, x, omega, width=1e-3, tolerance=1e-8):
        """The exact motion nearest (x, omega), state and frequency alike: (state, omega, monodromy). At folds, too."""
        scale = np.append(self.scales(x, omega), width * omega)
        h = 1e-7 * omega
        jw = (self.flow(x, omega + h) - self.flow(x, omega - h)) / (2 * h)
        for _ in range(12):
            r, jx = self.residual(x, omega, 1)
            a = np.c_[jx, jw] * scale / scale[:-1, None]
            step = np.linalg.lstsq(a, -r / scale[:-1], rcond=None)[0]
            x, omega = x + step[:-1] * scale[:-1], omega + step[-1] * scale[-1]
            if not np.all(np.isfinite(x)) or omega <= 0:
                break
            if np.abs(step).max() < tolerance:
                return x, omega, jx + np.eye(2 * self.n)
        raise NoPeriodicMotion("no motion near %.6g Hz" % (omega / 2 / np.pi))

    def peak_near(self, x, omega, periods=1, width=1e-3):
        """The highest amplitude along the curve of exact motions through the motion nearest (x, omega): (omega, amplitude,
        monodromy, moved): moved is how far along the curve, in steps of `width`."""
        scale = np.append(self.scales(x, omega), width * omega)
        try:
            x, omega, tangent, phi = self.on_curve(x, omega, None, periods, scale)
        except (NoPeriodicMotion, np.linalg.LinAlgError):
            # at a fold the frequency is no parameter: along the state instead
            x, omega, tangent, phi = self.on_curve(x, omega, scaled_direction(x, scale), periods, scale)
        here, h, moved = (x, omega, tangent, phi), 0.05, 0.0
        best = self.here
        ahead = 1.0
        for _ in range(60):
            climbed = False
            for direction in (ahead, -ahead):
                try:
                    there = self.on_curve(here[0] + direction * h * here[2][:-1] * scale[:-1],
                                          here[1] + direction * h * here[2][-1] * scale[-1], here[2], periods, scale)
                except (NoPeriodicMotion, np.linalg.LinAlgError):
                    continue
                if there[2] @ here[2] < 0:
                    there = (there[0], there[1], -there[2], there[3])
                a = self.here
                if a > best * (1 + 1e-13):
                    here, best, climbed, ahead, moved = there, a, True, direction, moved + h
                    break
            if climbed:
                h *= 1.6
            else:
                h *= 0.35
                if h < 1e-3:
                    break
        return here[1], best, here[3], moved


def scaled_direction(x, scale):
    d = np.append(x / scale[:-1], 0.0)
    return d / np.linalg.norm(d)


def largest(t, q, v, at):
    """max |q| of a function `at` that is known with its slope at the times t: at these and where the cubics between them turn."""
    top = np.abs(q).max()
    for k in np.nonzero(v[:-1] * v[1:] < 0)[0]:
        h = t[k + 1] - t[k]
        a, b = q[k], q[k + 1]
        c = np.array([2 * a + h * v[k] - 2 * b + h * v[k + 1], -3 * a - 2 * h * v[k] + 3 * b - h * v[k + 1], h * v[k], a])
        for s in np.roots(np.polyder(c)):
            if abs(s.imag) < 1e-12 and 0 < s.real < 1 and abs(np.polyval(c, s.real)) > 0.99 * top:
                top = max(top, abs(at(t[k] + s.real * h)))
    return top
