"""Random models as engineers make them, one function a family: families.NAME(rng) gives a dict with M, C, K, the gap rows B,
contact stiffnesses kn, gaps g, pre-load P, force F (real amplitude of cos), the DOF `out` to look at, and how the damping is
told to the library. Units are N-m-kg or N-mm-t by chance; forces are drawn so that the contact opens or closes."""
import numpy as np
import scipy.linalg


def chain(rng, n, grounded=True):
    k = 1e4 * 10 ** rng.uniform(-0.3, 0.3, n)
    K = np.diag(k) + np.diag(np.append(k[1:], 0.0)) - np.diag(k[1:], 1) - np.diag(k[1:], -1)
    if not grounded:
        K[0, 0] -= k[0]
    return np.diag(10 ** rng.uniform(-0.3, 0.3, n)), K


def beam_matrices(n, length=1.0, bending=175.0, mass=0.78):
    """Euler-Bernoulli elements, DOFs (w, theta) a node, node 0 first."""
    h = length / n
    k = bending / h**3 * np.array([[12, 6*h, -12, 6*h], [6*h, 4*h*h, -6*h, 2*h*h], [-12, -6*h, 12, -6*h], [6*h, 2*h*h, -6*h, 4*h*h]])
    m = mass * h / 420 * np.array([[156, 22*h, 54, -13*h], [22*h, 4*h*h, 13*h, -3*h*h], [54, 13*h, 156, -22*h],
                                   [-13*h, -3*h*h, -22*h, 4*h*h]])
    M, K = np.zeros((2 * n + 2, 2 * n + 2)), np.zeros((2 * n + 2, 2 * n + 2))
    for e in range(n):
        s = slice(2 * e, 2 * e + 4)
        M[s, s] += m
        K[s, s] += k
    return M, K


def gap_row(n, *entries):
    row = np.zeros(n)
    for dof, value in entries:
        row[dof] = value
    return row


def finish(rng, M, K, B, stiffness=(-1, 2.5), gap="any", preload=None, out=None, drive=None, force=None, kn=None, **more):
    """Contact stiffness in local stiffnesses (decades), gap and pre-load and a force to match."""
    n, B = len(M), np.atleast_2d(B)
    flexibility = np.diag(B @ np.linalg.solve(K, B.T))
    local = 1 / np.median(flexibility)
    if kn is None:
        kn = np.full(len(B), local * 10 ** rng.uniform(*stiffness))
    damping, C = random_damping(rng, M, K)
    out = int(rng.integers(n)) if out is None else out
    drive = out if drive is None else drive
    F = np.zeros(n)
    F[drive] = 1.0
    # the linear response near the mode that the force moves most, for a unit force
    w2, phi = scipy.linalg.eigh(K, M)
    kept = w2 < 1e6 * w2[0]
    participation = np.abs(phi[drive] * phi[out])[kept] / w2[kept]
    mode = int(np.argmax(participation[:6]))
    omega = np.sqrt(w2[mode])
    q = np.linalg.solve(K - omega**2 * M + 1j * omega * C, F)
    moved = np.abs(B @ q).max()
    g, P = np.zeros(len(B)), np.zeros(n)
    kind = gap if gap != "any" else rng.choice(["zero", "open", "preload", "interference"])
    size = 1e-4 * 10 ** rng.uniform(-1, 1)
    if kind == "open":
        g = size * rng.uniform(0.5, 1.5, len(B))
        level = rng.uniform(1.1, 6) * size
    elif kind == "interference":
        g = -size * rng.uniform(0.5, 1.5, len(B))
        level = 10 ** rng.uniform(-0.5, 0.8) * size
    elif kind == "preload" or preload is not None:
        P = B.T @ rng.uniform(0.3, 1, len(B)) * local * size if preload is None else preload * local * size
        level = 10 ** rng.uniform(-0.5, 0.8) * size
    else:
        level = size
    F *= level / moved if force is None else force
    return dict(M=M, K=K, C=C, damping=damping, B=B, kn=kn, g=g, P=P, F=F, out=out, kind=kind, **more)


def random_damping(rng, M, K):
    """As the library is told, and as a matrix."""
    w2, phi = scipy.linalg.eigh(K, M)
    w1 = np.sqrt(w2[w2 > 1e-14 * w2[-1]][0])  # penalties and pads without mass have modes far above the first
    zeta = 10 ** rng.uniform(-2.6, -1.3)
    kind = rng.choice(["beta", "alpha_beta", "modal", "matrix"])
    if kind == "beta":
        return ("rayleigh", 0.0, 2 * zeta / w1), 2 * zeta / w1 * K
    if kind == "alpha_beta":
        return ("rayleigh", zeta * w1, zeta / w1), zeta * w1 * M + zeta / w1 * K
    if kind == "modal":
        mp = M @ phi
        return ("modal", zeta), (mp * (2 * zeta * np.sqrt(np.maximum(w2, 0)))) @ mp.T
    C = 2 * zeta / w1 * K + 0.3 * zeta * w1 * np.diag(np.diag(M)) * rng.uniform(0, 1, len(M))
    C = (C + C.T) / 2
    return ("matrix",), C


# ---- families

def chains(rng):
    n = int(rng.integers(2, 9))
    M, K = chain(rng, n)
    B = [gap_row(n, (int(d), 1.0)) for d in rng.choice(n, min(n, int(rng.integers(1, 4))), replace=False)]
    return finish(rng, M, K, B)


def breathing(rng):
    """A chain with a joint that opens: two neighbours touch in compression."""
    n = int(rng.integers(3, 9))
    M, K = chain(rng, n)
    j = int(rng.integers(1, n))
    soft = rng.uniform(0.2, 0.8) * -K[j, j - 1]
    cut = gap_row(n, (j - 1, 1.0), (j, -1.0))
    return finish(rng, M, K - soft * np.outer(cut, cut), [cut])


def beam_with_stops(rng):
    ne = int(rng.integers(4, 11))
    M, K = beam_matrices(ne)
    M, K = M[2:, 2:], K[2:, 2:]
    n = len(M)
    nodes = rng.choice(np.arange(1, ne), int(rng.integers(1, 4)), replace=False)
    B = [gap_row(n, (2 * int(i), 1.0)) for i in nodes]
    return finish(rng, M, K, B, out=n - 2, drive=int(2 * rng.integers(ne // 2, ne)))


def cracked_beam(rng):
    """Two beams joined by a rotation spring, closed on one side by contact: a breathing crack."""
    ne = int(rng.integers(4, 9))
    M, K = beam_matrices(ne)
    n = len(M) + 1  # the last DOF: the second rotation at the crack
    crack = int(rng.integers(1, ne))
    big_m, big_k = np.zeros((n, n)), np.zeros((n, n))
    m1, k1 = beam_matrices(1, 1 / ne, mass=0.78)
    for e in range(ne):
        dofs = [2 * e, 2 * e + 1, 2 * e + 2, 2 * e + 3]
        if e == crack:
            dofs[1] = n - 1
        big_m[np.ix_(dofs, dofs)] += m1
        big_k[np.ix_(dofs, dofs)] += k1
    turn = gap_row(n, (2 * crack + 1, 1.0), (n - 1, -1.0))
    big_k += 175.0 * rng.uniform(0.3, 3) * np.outer(turn, turn)
    M, K = big_m[2:, 2:], big_k[2:, 2:]
    return finish(rng, M, K, [turn[2:]], out=2 * ne - 2, stiffness=(-0.5, 1.5))


def plate(rng):
    """Masses on a grid with springs along and across, one edge held, stops under a line of it."""
    nx, ny = int(rng.integers(3, 6)), int(rng.integers(2, 5))
    n = nx * ny
    K = np.zeros((n, n))
    join = lambda i, j, k: K.__setitem__(np.ix_([i, j], [i, j]), K[np.ix_([i, j], [i, j])] + k * np.array([[1, -1], [-1, 1]]))
    for x in range(nx):
        for y in range(ny):
            if x == 0:
                K[y, y] += 2e4
            else:
                join((x - 1) * ny + y, x * ny + y, 1e4)
            if y:
                join(x * ny + y - 1, x * ny + y, 5e3 * rng.uniform(0.9, 1.1))
    B = [gap_row(n, ((nx - 1) * ny + y, 1.0)) for y in range(ny)]
    return finish(rng, np.eye(n) * 0.1, K, B, out=n - 1, drive=int(n - ny + rng.integers(ny)))


def pressed_bodies(rng):
    """A body that nothing but very soft springs and a pre-load holds against a chain."""
    n1, n2 = int(rng.integers(2, 6)), int(rng.integers(1, 5))
    M1, K1 = chain(rng, n1)
    M2, K2 = chain(rng, n2, grounded=False)
    M, K = scipy.linalg.block_diag(M1, M2), scipy.linalg.block_diag(K1, K2)
    n = n1 + n2
    K[n1, n1] += 10 ** rng.uniform(0, 2)
    row = gap_row(n, (n1 - 1, 1.0), (n1, -1.0))
    kn = 1e4 * 10 ** rng.uniform(-0.5, 1.5)
    P = np.zeros(n)
    P[-1] = -10 ** rng.uniform(0, 1)
    closed = K + kn * np.outer(row, row)
    F = np.zeros(n)
    out = n1 - 1
    F[0] = 1.0
    damping, C = random_damping(rng, M, closed)
    if damping[0] == "modal":
        damping, C = ("matrix",), C
    elif damping[0] == "rayleigh":
        C = damping[1] * M + damping[2] * K
        damping = ("rayleigh", damping[1], damping[2])
    w2, phi = scipy.linalg.eigh(closed, M)
    mode = int(np.argmax(np.abs(phi[0] * phi[out]) / w2))
    q = np.linalg.solve(closed - w2[mode] * M + 1j * np.sqrt(w2[mode]) * C, F)
    rest = -P[-1] / kn
    F *= 10 ** rng.uniform(-0.3, 0.5) * rest / np.abs(row @ q)
    return dict(M=M, K=K, C=C, damping=damping, B=row[None], kn=np.array([kn]), g=np.zeros(1), P=P, F=F, out=out, kind="preload")


def shrouds(rng):
    """Blades on a ring, neighbours touch at their shrouds."""
    n = int(rng.integers(3, 8))
    M = np.diag(rng.uniform(0.98, 1.02, n))
    K = np.diag(np.full(n, 1e4) * rng.uniform(0.98, 1.02, n))
    c = 1e4 * 10 ** rng.uniform(-2, -0.7)
    B = []
    for i in range(n):
        row = gap_row(n, (i, 1.0), ((i + 1) % n, -1.0))
        K += c * np.outer(row, row)
        B.append(row)
    return finish(rng, M, K, B[:int(rng.integers(1, n + 1))], stiffness=(-1.5, 1))


def massless(rng):
    """The contact DOF carries no mass: a light pad on a spring. The exact motion is that of a very small one."""
    model = chains(rng)
    n = len(model["M"])
    M, K = np.zeros((n + 1, n + 1)), np.zeros((n + 1, n + 1))
    M[:n, :n], K[:n, :n] = model["M"], model["K"]
    at = int(rng.integers(n))
    pad = gap_row(n + 1, (at, 1.0), (n, -1.0))
    K += 1e4 * 10 ** rng.uniform(-0.5, 1) * np.outer(pad, pad)
    light = 1e-6 * np.trace(model["M"]) / n  # of 1e-9 the exact motion is 3 % wrong: rounding
    M[n, n] = light
    m = finish(rng, M, K, [gap_row(n + 1, (n, 1.0))], out=at, gap=rng.choice(["zero", "open", "preload"]))
    m["exact_to"] = 1e-5  # by the mass left
    m["M_library"] = M.copy()
    m["M_library"][n, n] = 0.0
    if m["damping"][0] in ("modal", "matrix"):
        zeta_beta = 2e-2 / np.sqrt(scipy.linalg.eigh(K, M, eigvals_only=True)[0])
        m["damping"], m["C"] = ("rayleigh", 0.0, zeta_beta), zeta_beta * K
    return m


def penalty_held(rng):
    """A support made by a stiff spring instead of a fixed DOF."""
    n = int(rng.integers(3, 8))
    M, K = chain(rng, n)
    K[0, 0] += 1e4 * 10 ** rng.uniform(4, 8)
    return finish(rng, M, K, [gap_row(n, (n - 1, 1.0))], out=n - 1)


def close_modes(rng):
    """Two nearly equal oscillators with a weak coupling, one beside a stop."""
    n = int(rng.integers(2, 5))
    M = np.eye(n)
    K = 1e4 * np.diag(1 + rng.uniform(-0.01, 0.01, n))
    for i in range(n - 1):
        row = gap_row(n, (i, 1.0), (i + 1, -1.0))
        K += 10 ** rng.uniform(1.5, 2.5) * np.outer(row, row)
    return finish(rng, M, K, [gap_row(n, (n - 1, 1.0))], out=int(rng.integers(n)), stiffness=(-2, 0.5))


def stiff(rng):
    """Contact far stiffer than the structure, damped well."""
    n = int(rng.integers(2, 7))
    M, K = chain(rng, n)
    m = finish(rng, M, K, [gap_row(n, (n - 1, 1.0))], out=n - 1, stiffness=(2, 4))
    m["damping"], m["C"] = ("rayleigh", 0.0, 1e-3), 1e-3 * K
    return m


def rotations(rng):
    """Translations and rotations in one vector, in millimetres and tonnes; the stop acts on both."""
    ne = int(rng.integers(3, 8))
    M, K = beam_matrices(ne, 1000.0, 2.1e5 * 833.3, 7.8e-9 * 100)
    M, K = M[2:, 2:], K[2:, 2:]
    n = len(M)
    B = [gap_row(n, (n - 2, 1.0), (n - 1, rng.uniform(-20, 20)))]
    return finish(rng, M, K, B, out=n - 2)


def membrane_matrices(nodes, elements, modulus=2.1e5, poisson=0.3, density=7.8e-9):
    """Plane stress of unit thickness by bilinear quadrilaterals: DOFs (x, y) a node; N-mm-t."""
    n = 2 * len(nodes)
    M, K = np.zeros((n, n)), np.zeros((n, n))
    elastic = modulus / (1 - poisson**2) * np.array([[1, poisson, 0], [poisson, 1, 0], [0, 0, (1 - poisson) / 2]])
    corner = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
    for e in elements:
        m, k = np.zeros((8, 8)), np.zeros((8, 8))
        for gauss in corner / np.sqrt(3):
            shape = (1 + corner[:, 0] * gauss[0]) * (1 + corner[:, 1] * gauss[1]) / 4
            slope = np.array([corner[:, 0] * (1 + corner[:, 1] * gauss[1]), corner[:, 1] * (1 + corner[:, 0] * gauss[0])]) / 4
            jacobian = slope @ nodes[e]
            slope = np.linalg.solve(jacobian, slope)
            strain = np.zeros((3, 8))
            strain[0, 0::2], strain[1, 1::2], strain[2, 0::2], strain[2, 1::2] = slope[0], slope[1], slope[1], slope[0]
            area = np.linalg.det(jacobian)
            k += area * strain.T @ elastic @ strain
            m += area * density * np.kron(np.outer(shape, shape), np.eye(2))
        dofs = np.stack([2 * np.array(e), 2 * np.array(e) + 1], axis=1).ravel()
        M[np.ix_(dofs, dofs)] += m
        K[np.ix_(dofs, dofs)] += k
    return M, K


def cracked_mesh(rng):
    """A cantilever of plane elements, cracked across from its upper face, or along (delaminated): a crack of two to eight pairs."""
    nx, ny = int(rng.integers(8, 15)), int(rng.integers(3, 6))
    length, height = 100.0, 100.0 * rng.uniform(0.08, 0.2)
    at = lambda i, j: i * (ny + 1) + j
    nodes = [[length * i / nx, height * j / ny] for i in range(nx + 1) for j in range(ny + 1)]
    if rng.uniform() < 0.5:  # across: the elements on the right have nodes of their own
        i = int(rng.integers(1, nx // 2))
        faces, normal = [at(i, j) for j in range(ny, ny - int(rng.integers(2, ny)), -1)], 0
        is_other = lambda x, y: x >= i
    else:  # along: those above
        j, first = int(rng.integers(1, ny)), int(rng.integers(1, nx // 2))
        faces, normal = [at(i, j) for i in range(first, min(nx, first + int(rng.integers(2, 8))))], 1
        is_other = lambda x, y: y >= j
    twin = {}
    for node in faces:
        twin[node] = len(nodes)
        nodes.append(nodes[node])
    elements = []
    for x in range(nx):
        for y in range(ny):
            corners = [at(x, y), at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)]
            elements.append([twin.get(c, c) if is_other(x, y) else c for c in corners])
    M, K = membrane_matrices(np.array(nodes), elements)
    held = 2 * (ny + 1)
    M, K = M[held:, held:], K[held:, held:]
    # positive: the faces press, the other one lies to the right or above
    B = [gap_row(len(M), (2 * a + normal - held, 1.0), (2 * b + normal - held, -1.0)) for a, b in twin.items()]
    tip = 2 * at(nx, ny) + 1 - held
    return finish(rng, M, K, B, out=tip, drive=tip, stiffness=(0, 2), condense=True)


FAMILIES = (chains, breathing, beam_with_stops, cracked_beam, plate, pressed_bodies, shrouds, massless, penalty_held, close_modes,
            stiff, rotations, cracked_mesh)
