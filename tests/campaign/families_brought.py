"""Random models of the kinds on which users' structures were answered wrongly: functions of a random generator like those of
families.py, with more of what the judge should know:

    says       reasons (plm.REASON_...) that are true of every model of the family
    all_dofs   the motion of the peak is judged at all DOFs
    twin       (T, out): the same model in other coordinates, q = T q_twin; its answer must be the same
    K_library  what the library is given where the exact motion needs more (B_library likewise)
    exact_to   how exact the exact motion is, where not 1e-6
    G, power, drive, beside, given: see families_acting.py
    host       what the library is given in place of all this: DOFs q of which `rows` @ q = 0, or with `couplings` (methods of
               plm.Model and their arguments), the motions of the model by q = `to_host` times those here; with `base` (what
               plm.Model.set_base_motion takes) its DOFs that move are fixed
"""
import numpy as np
import scipy.linalg

import families
from families import beam_matrices, chain, finish, gap_row, membrane_matrices

ROUNDED, TIE = 29, 28  # PLM_REASON_..., whether the library at hand has them or not


def modal_matrix(M, K, ratios):
    """C of damping ratios for the modes of K, the last one for those beyond."""
    w2, phi = scipy.linalg.eigh(K, M)
    ratio = np.full(len(M), float(ratios[-1]))
    ratio[:len(ratios)] = ratios
    mp = M @ phi
    return (mp * (2 * ratio * np.sqrt(np.maximum(w2, 0)))) @ mp.T


def with_modal_damping(m, ratios):
    m["damping"], m["C"] = ("modal", ratios), modal_matrix(m["M"], m["K"], ratios)
    return m


def hard_stops(rng):
    """A cantilever beside stops of 1e1 to 1e5 of its stiffness there; a ratio for every mode. The force matches the damping."""
    ne = int(rng.integers(4, 11))
    M, K = (a[2:, 2:] for a in beam_matrices(ne))
    n = len(M)
    nodes = rng.choice(np.arange(ne // 2, ne), int(rng.integers(1, 3)), replace=False)
    B = [gap_row(n, (2 * int(i), 1.0)) for i in nodes]
    m = finish(rng, M, K, B, stiffness=(1, 5), gap=rng.choice(["zero", "open"]), drive=n - 2,
               out=int(rng.choice([n - 2, 2 * int(nodes[0])])))
    m["F"] *= 3.0  # with all its modes damped alike it moves less
    return with_modal_damping(m, np.full(n, 10 ** rng.uniform(-2.3, -1.3)))


def hard_stops_one_ratio(rng):
    """The same, one ratio given: it is that of all modes."""
    m = hard_stops(rng)
    return with_modal_damping(m, m["damping"][1][:1])


def many_gaps(rng):
    """A plate of masses and springs held at one edge over 30 to 100 stops; looked at anywhere, judged everywhere."""
    nx, ny = int(rng.integers(6, 11)), int(rng.integers(6, 11))
    n = nx * ny
    K = np.zeros((n, n))
    for i in range(n):
        if i < ny:
            K[i, i] += 2e4
        for j, k in ((i + ny, 1e4), (i + 1 if (i + 1) % ny else n, 5e3)):
            if j < n:
                row = gap_row(n, (i, 1.0), (j, -1.0))
                K += k * rng.uniform(0.9, 1.1) * np.outer(row, row)
    under = rng.choice(np.arange(n), int(rng.integers(30, min(n, 100) + 1)), replace=False)
    m = finish(rng, 0.1 * np.eye(n), K, [gap_row(n, (int(i), 1.0)) for i in under], stiffness=(-1, 1),
               gap=rng.choice(["open", "open", "zero"]), out=int(rng.integers(n)), drive=int(n - 1 - rng.integers(2 * ny)))
    if m["kind"] == "open":
        m["g"] = m["g"] * rng.uniform(0.2, 2, len(under))
    if m["damping"][0] == "modal":
        m = with_modal_damping(m, np.full(n, m["damping"][1]))
    return dict(m, all_dofs=True)


def twin_of(m, T, out):
    return dict(m, twin=(T, out))


def permuted(rng):
    """A model of the first families, its DOFs in another order."""
    of = (families.chains, families.beam_with_stops, families.plate, families.shrouds, families.close_modes, families.cracked_beam)
    m = of[int(rng.integers(len(of)))](rng)
    order = rng.permutation(len(m["M"]))
    return twin_of(m, np.eye(len(order))[:, order], int(np.argsort(order)[m["out"]]))


def turned(rng, n, groups, kept):
    """T: each group of DOFs (of one node) in axes of its own, but that of the DOF kept; then all in another order."""
    T = np.eye(n)
    for group in groups:
        if kept not in group:
            q, _ = np.linalg.qr(rng.normal(size=(len(group), len(group))))
            T[np.ix_(group, group)] = q
    order = rng.permutation(n)
    return T[:, order], int(np.argsort(order)[kept])


def turned_mesh(rng):
    """A cracked mesh, each node in axes of its own."""
    m = families.cracked_mesh(rng)
    n = len(m["M"])
    return twin_of(m, *turned(rng, n, np.arange(n).reshape(-1, 2), m["out"]))


def round_shaft(rng):
    """A round cantilever: two bending planes of one frequency, the stop in one of them, the force anywhere."""
    ne = int(rng.integers(4, 9))
    M, K = (np.kron(np.eye(2), a[2:, 2:]) for a in beam_matrices(ne))
    n = len(M)
    node = int(rng.integers(ne // 2, ne))
    F, angle = np.zeros(n), rng.uniform(-0.45, 0.45) * np.pi
    m = finish(rng, M, K, [gap_row(n, (2 * node, 1.0))], stiffness=(-1, 2), gap=rng.choice(["zero", "open"]), out=n // 2 - 2)
    F[[n // 2 - 2, n - 2]] = np.abs(m["F"]).max() * np.array([np.cos(angle), np.sin(angle)])
    groups = [[plane, n // 2 + plane] for plane in range(n // 2)]
    zeta = 10 ** rng.uniform(-2.3, -1.5)
    m = with_modal_damping(dict(m, F=F), np.full(n, zeta))
    return dict(twin_of(m, *turned(rng, n, groups, m["out"])), says={TIE})


def cantilever_mesh(nx, ny, length, height, below=0.0):
    nodes = np.array([[length * i / nx, below + height * j / ny] for i in range(nx + 1) for j in range(ny + 1)])
    at = lambda i, j: i * (ny + 1) + j
    elements = [[at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)] for x in range(nx) for y in range(ny)]
    return nodes, elements


def twin_plates(rng):
    """Two equal cantilevers that touch along their length; the force on one of them."""
    nx, ny = int(rng.integers(5, 10)), 1
    one, elements = cantilever_mesh(nx, ny, 200.0, 4.0)
    other = one + [0.0, 4.0]
    M, K = membrane_matrices(np.vstack([one, other]), elements + [[c + len(one) for c in e] for e in elements])
    held = np.concatenate([np.arange(4), 2 * len(one) + np.arange(4)])
    kept = np.setdiff1d(np.arange(len(M)), held)
    M, K = M[np.ix_(kept, kept)], K[np.ix_(kept, kept)]
    n = len(M)
    low = lambda i, j: 4 * (i - 1) + 2 * j + 1
    B = [gap_row(n, (low(i, 1), 1.0), (n // 2 + low(i, 0), -1.0)) for i in range(1, nx + 1)]
    out = low(nx, 0)
    m = finish(rng, M, K, B, stiffness=(-1, 1), gap=rng.choice(["zero", "zero", "open"]), out=out)
    m = with_modal_damping(m, np.full(n, 10 ** rng.uniform(-2.3, -1.7)))
    return dict(twin_of(m, *turned(rng, n, np.arange(n).reshape(-1, 2), out)), says={TIE})


def held_softly(m, w):
    """For the exact motion: what nothing holds is held by springs that are 2e-5 of what the motion is about: of 1e-6 rounding makes
    1e-3 of the amplitude, of 1e-5 to 1e-4 it is the same to 3e-5."""
    return dict(m, K_library=m["K"], K=m["K"] + (5e-3 * w) ** 2 * m["M"], exact_to=1e-4)


def pressed(rng, M, K, B, kn, load, drive, out):
    """Bodies that touch at B and are pressed together by `load`; the damping is that of the closed structure, so that nothing
    damps a motion of the whole."""
    closed = K + B.T @ (kn[:, None] * B)
    w2, phi = scipy.linalg.eigh(closed, M)
    elastic = w2 > 1e-9 * w2[-1]
    w1, zeta = np.sqrt(w2[elastic][0]), 10 ** rng.uniform(-2.3, -1.3)
    C = 2 * zeta / w1 * closed
    F = np.zeros(len(M))
    F[drive] = 1.0
    mode = np.flatnonzero(elastic)[int(np.argmax(np.abs(phi[drive] * phi[out])[elastic][:4] / w2[elastic][:4]))]
    q = np.linalg.solve(closed - w2[mode] * M + 1j * np.sqrt(w2[mode]) * C, F)
    rest = B @ np.linalg.lstsq(closed, load, rcond=1e-9)[0]
    F *= 10 ** rng.uniform(-0.5, 0.5) * np.median(np.abs(rest)) / np.abs(B @ q).max()
    m = dict(M=M, K=K, C=C, damping=("matrix",), B=B, kn=kn, g=np.zeros(len(B)), P=load, F=F, out=out, kind="preload")
    return held_softly(m, w1)


def free_strip(rng, n):
    """Masses in a line that move across it, joined by springs against bending: free to move and to turn."""
    bend = np.diff(np.eye(n), 2, axis=0)
    return np.diag(10 ** rng.uniform(-0.2, 0.2, n)), bend.T @ (1e4 * 10 ** rng.uniform(-0.2, 0.2, (n - 2, 1)) * bend)


def free_bodies(rng):
    """Two free strips pressed on each other; the rows interpolate between masses with the digits of a deck, so that they miss the
    rigid motions by about 1e-7. The exact motion is that of rows without rounding."""
    n1, n2 = int(rng.integers(4, 7)), int(rng.integers(7, 9))
    M, K = (scipy.linalg.block_diag(a, b) for a, b in zip(free_strip(rng, n1), free_strip(rng, n2)))
    n, rows, given = n1 + n2, [], []
    for mass in rng.choice(n1, int(rng.integers(2, 4)), replace=False):
        at = mass * (n2 - 1) / (n1 - 1)
        e = min(int(at), n2 - 2)
        for to, digits in ((rows, 16), (given, 7)):
            s = round(at - e, digits)
            to.append(gap_row(n, (int(mass), 1.0), (n1 + e, s - 1), (n1 + e + 1, -s)))
    B, given = np.array(rows), np.array(given)
    given *= 1 + 1e-7 * rng.uniform(-1, 1, given.shape) * (given != 0)
    kn = np.full(len(B), 1e4 * 10 ** rng.uniform(-0.5, 1.0))
    load = B.T @ rng.uniform(0.5, 1.5, len(B))  # presses, and has no resultant
    return dict(pressed(rng, M, K, B, kn, load, int(rng.integers(n1)), int(rng.integers(n1))), B_library=given, says={ROUNDED})


def hanging_parts(rng):
    """Parts that contact alone holds: a chain on the ground, and one or two bodies pressed on it."""
    n1 = int(rng.integers(2, 6))
    M, K = chain(rng, n1)
    rows, load = [], np.zeros(0)
    for _ in range(int(rng.integers(1, 3))):
        M2, K2 = chain(rng, int(rng.integers(1, 4)), grounded=False)
        n = len(M)
        M, K = scipy.linalg.block_diag(M, M2), scipy.linalg.block_diag(K, K2)
        rows.append((int(rng.integers(n1)), n))
        load = np.concatenate([load if len(load) else np.zeros(n1), np.zeros(len(M2))])
        load[-1] = -(10 ** rng.uniform(0, 1))
    B = np.array([gap_row(len(M), (a, 1.0), (b, -1.0)) for a, b in rows])
    kn = 1e4 * 10 ** rng.uniform(-0.5, 1.5, len(B))
    return pressed(rng, M, K, B, kn, load, int(rng.integers(n1)), int(rng.integers(n1)))


def dashpots(rng):
    """Dampers at a few DOFs, from hardly any damping to about critical there; nothing else damps but 1e-3."""
    m = (families.chains, families.beam_with_stops)[int(rng.integers(2))](rng)
    n = len(m["M"])
    w2 = scipy.linalg.eigh(m["K"], m["M"], eigvals_only=True)
    C = 2e-3 / np.sqrt(w2[0]) * m["K"]
    for dof in rng.choice(np.arange(0, n, 2), min(2, (n + 1) // 2), replace=False):
        local = np.sqrt(w2[0]) / np.linalg.inv(m["K"])[dof, dof] / w2[0]
        C[dof, dof] += local * 10 ** rng.uniform(-2.5, 0)
    q = np.linalg.solve(m["K"] - w2[0] * m["M"] + 1j * np.sqrt(w2[0]) * C, m["F"])
    before = np.linalg.solve(m["K"] - w2[0] * m["M"] + 1j * np.sqrt(w2[0]) * m["C"], m["F"])
    more = np.abs(m["B"] @ before).max() / np.abs(m["B"] @ q).max()
    return dict(m, C=C, damping=("matrix",), F=m["F"] * min(more, 100.0))


def superelements(rng):
    """A cracked mesh that the host has reduced: dense matrices in contact DOFs and modes. They are what is exact."""
    m = families.cracked_mesh(rng)
    from exact import condensation
    kept = np.flatnonzero(np.abs(m["B"]).sum(axis=0) + np.abs(m["F"]))
    T = condensation(m["M"], m["K"], kept, reach=8.0, fewest=6)
    small = dict(m, out=int(np.flatnonzero(kept == m["out"])[0]), condense=False, dense=True, exact_to=3e-6)
    small.update((name, T.T @ m[name] @ T) for name in "MCK")
    small.update((name, (a + a.T) / 2) for name, a in small.items() if name in ("M", "C", "K"))
    small.update(B=m["B"] @ T, P=T.T @ m["P"], F=T.T @ m["F"])
    if m["damping"][0] == "modal":
        small = with_modal_damping(small, np.full(len(small["M"]), m["damping"][1]))
    return small


def constrained(rng):
    """A model of the first families with some of its DOFs cut, masses and stiffness shared out to both sides, and constraints that
    tie them again: ties, sums of two DOFs, chains of them, some said twice. What is exact lives on a null space of all of them."""
    m = (families.chains, families.beam_with_stops, families.plate, families.cracked_beam)[int(rng.integers(4))](rng)
    n = len(m["M"])
    more = int(rng.integers(2, max(3, n // 2) + 1))
    T = np.vstack([np.eye(n), np.zeros((more, n))])  # the DOFs that are added, by those of the model
    rows = np.zeros((more, n + more))
    for k in range(more):
        row = rows[k]
        others = rng.choice(n + k, int(rng.integers(1, min(3, n + k) + 1)), replace=False)
        row[others] = rng.choice([1.0, -0.5, 2.0], len(others)) if len(others) > 1 else 1.0
        T[n + k] = row[:n + k] @ T[:n + k]
        row[n + k] = -1.0
    share = rng.uniform(0.1, 0.9, more)
    host = {}
    for name in "MK":  # bits of diagonal of their own, taken as part of the model
        host[name] = scipy.linalg.block_diag(m[name], np.diag(share * 0.3 * np.median(np.diag(m[name]))))
    C = scipy.linalg.block_diag(m["C"], np.zeros((more, more)))
    mixed = rng.normal(size=(2, more)) @ rows  # says nothing new
    rows = np.vstack([rows, mixed])[rng.permutation(more + 2)]
    null = scipy.linalg.null_space(rows)
    out, at = int(rng.integers(n + more)), 0
    while np.linalg.norm(null[out]) < 1e-3:
        out = int(rng.integers(n + more))
    turn, _ = np.linalg.qr(np.column_stack([null[out], rng.normal(size=(n, n - 1))]))
    N = null @ turn
    N[:, 0] /= N[out, 0]  # so that the first coordinate is the DOF that is looked at
    B, F, P = (np.hstack([np.atleast_2d(m[name]), np.zeros((len(np.atleast_2d(m[name])), more))]) for name in "BFP")
    moved = rng.random(len(B)) < 0.5
    for i in np.flatnonzero(moved):  # a pair that looks at a DOF by the one tied to it
        for k in range(more):
            if np.count_nonzero(T[n + k]) == 1 and B[i, np.argmax(np.abs(T[n + k]))] != 0 and np.abs(T[n + k]).max() == 1:
                d = int(np.argmax(np.abs(T[n + k])))
                B[i, n + k], B[i, d] = B[i, d] * T[n + k, d], 0
                break
    host.update(C=C, B=B, F=F[0], P=P[0], rows=rows, out=out, damping=("matrix",))
    small = {name: N.T @ host[name] @ N for name in "MCK"}
    small = {name: (a + a.T) / 2 for name, a in small.items()}
    return dict(m, **small, B=B @ N, F=N.T @ F[0], P=N.T @ P[0], out=at, damping=("matrix",), host=host, to_host=N)


def frame(rng, xyz):
    """Masses at these points, joined to their nearest by bars and to the ground by soft springs: M, K of three DOFs each."""
    n = len(xyz)
    K = np.diag(10 ** rng.uniform(1.5, 2, 3 * n))
    for i in range(n):
        for j in np.argsort(np.linalg.norm(xyz - xyz[i], axis=1))[1:5]:
            e = np.zeros(3 * n)
            e[3 * j:3 * j + 3] = (xyz[j] - xyz[i]) / np.linalg.norm(xyz[j] - xyz[i])
            e[3 * i:3 * i + 3] = -e[3 * j:3 * j + 3]
            K += 1e4 * 10 ** rng.uniform(-0.3, 0.3) * np.outer(e, e)
    return np.diag(np.repeat(10 ** rng.uniform(-0.2, 0.2, n), 3)), K


def arm(r):
    """u = u_0 + arm(r) @ theta."""
    return np.array([[0, r[2], -r[1]], [-r[2], 0, r[0]], [r[1], -r[0], 0]])


def coupled(rng):
    """A frame in space and hubs of six DOFs, joined by rigid links and distributing couplings, on one another too, in m or mm.
    The library makes the rows; what is exact lives on a null space of those written down here."""
    n, hubs, unit = int(rng.integers(6, 9)), int(rng.integers(1, 4)), float(rng.choice([1.0, 1e3]))
    xyz = rng.uniform(-1, 1, (n + hubs, 3))
    M, K = frame(rng, xyz[:n])
    for _ in range(hubs):
        M = scipy.linalg.block_diag(M, np.diag(np.repeat(rng.uniform(0.2, 1), 3)), np.diag(rng.uniform(0.02, 0.1, 3) * unit ** 2))
        K = scipy.linalg.block_diag(K, 50 * np.eye(3), 20 * unit ** 2 * np.eye(3))
    xyz, count, rows, couplings, free = unit * xyz, len(M), [], [], list(rng.permutation(n))

    def dof(i):
        return np.arange(3 * i, 3 * i + 3) if i < n else 3 * n + 6 * (i - n) + np.arange(6)

    def link(to, nodes):
        couplings.append(("add_rigid_link", dof(to), xyz[to], np.array([dof(i) for i in nodes]), xyz[nodes]))
        for i in nodes:
            row = np.zeros((len(dof(i)), count))
            row[:, dof(i)] = np.eye(len(dof(i)))
            row[:3, dof(to)] = -np.hstack([np.eye(3), arm(xyz[i] - xyz[to])])
            row[3:, dof(to)[3:]] = -np.eye(3)[:len(row) - 3]
            rows.append(row)

    def mean(to, nodes, weight):
        couplings.append(("add_distributing_coupling", dof(to), xyz[to], np.array([dof(i) for i in nodes]), xyz[nodes], weight))
        G = np.vstack([np.hstack([np.eye(3), arm(xyz[i] - xyz[to]) / unit]) for i in nodes])
        W = np.repeat(weight, 3)
        row = np.zeros((6, count))
        row[:, dof(to)] = np.eye(6)
        row[:, np.concatenate([dof(i) for i in nodes])] = -np.linalg.solve(G.T @ (W[:, None] * G), G.T * W)
        row[3:, :3 * n] /= unit
        rows.append(row)

    for k in range(n, n + hubs):
        way = rng.random()
        if k > n and way < 0.4:
            link(int(rng.integers(n, k)), [k])
        elif way < 0.6:
            link(k, [free.pop(), free.pop()])
        else:
            mean(k, rng.choice(n, 4, replace=False), rng.uniform(0.5, 2, 4))
    scale = np.ones(count)
    for k in range(n, n + hubs):
        scale[dof(k)[3:]] = 1 / unit
    null = scale[:, None] * scipy.linalg.null_space(np.vstack(rows) * scale)
    at, pairs = np.arange(3 * n), []
    while len(pairs) < int(rng.integers(1, 3)):
        i, j, k = *rng.choice(n, 2, replace=False), rng.integers(3)
        row = gap_row(count, (int(3 * i + k), 1.0), (int(3 * j + k), -1.0))
        if np.linalg.norm(row @ null) > 0.3:
            pairs.append(row)
    out = int(rng.choice(at[np.linalg.norm(null[:3 * n], axis=1) > 0.3]))
    turn, _ = np.linalg.qr(np.column_stack([null[out], rng.normal(size=(null.shape[1], null.shape[1] - 1))]))
    N = null @ turn
    N[:, 0] /= N[out, 0]  # so that the first coordinate is the DOF that is looked at
    B = np.array(pairs)
    small = {name: N.T @ a @ N for name, a in (("M", M), ("K", K))}
    m = finish(rng, *((a + a.T) / 2 for a in small.values()), B @ N, stiffness=(-1, 1.5), out=0)
    if m["damping"][0] == "matrix":
        w1 = np.sqrt(scipy.linalg.eigh(m["K"], m["M"], eigvals_only=True)[0])
        beta = 2 * 10 ** rng.uniform(-2.6, -1.3) / w1
        m.update(damping=("rayleigh", 0.0, beta), C=beta * m["K"])
    force = np.zeros(count)
    force[out] = m["F"][0]
    host = dict(M=M, K=K, B=B, F=force, P=B.T @ np.linalg.lstsq((B @ N).T, m["P"], rcond=None)[0], couplings=couplings, out=out)
    return dict(m, host=host, to_host=N)


FAMILIES = (hard_stops, hard_stops_one_ratio, many_gaps, permuted, turned_mesh, round_shaft, twin_plates, free_bodies, hanging_parts,
            dashpots, superelements, constrained, coupled)
