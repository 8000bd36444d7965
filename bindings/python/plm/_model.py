"""The model: matrices, supports, contact pairs, loads."""
import ctypes
import functools
from typing import NamedTuple

import numpy
import scipy.sparse

from . import _c
from ._context import default_context
from ._handle import Handle, address, alike, handle_of, integers, list_of_reals, real_parts, reals
from ._methods import ModelMethods

QUANTITIES = {"displacement": _c.DISPLACEMENT, "velocity": _c.VELOCITY, "acceleration": _c.ACCELERATION}
SYSTEMS = {"open": _c.SYSTEM_OPEN, "sliding": _c.SYSTEM_SLIDING, "rest": _c.SYSTEM_REST, "given": _c.SYSTEM_GIVEN}
MATRICES = {_c.MASS: "mass", _c.STIFFNESS: "stiffness", _c.DAMPING: "damping"}
COMPLEX_MATRIX = ("hand over the real part, and damping by set_structural_damping (a loss factor, K (1 + i eta)), "
                  "set_damping, set_rayleigh_damping or set_modal_damping")
OF_DOFS = "one for each DOF, the fixed ones included"
PARTS = {"full": _c.FULL, "lower": _c.LOWER, "upper": _c.UPPER}


def choice(value, words, name):
    """The number behind a word."""
    if value in words:
        return words[value]
    if value in words.values():
        return value
    raise ValueError(f"{name} is {value!r}; it must be one of {', '.join(words)}")


class Finding(NamedTuple):
    """One line of Model.audit. severity: 0 fact, 1 worth a look, 2 probably wrong."""
    severity: int
    value: float
    text: str


class Model(ModelMethods, Handle, noun="model", kind=_c.KIND_MODEL):
    """M q'' + C q' + K q = F(t) - B' N, N = max(k_n u, 0), u = B q - gap.

    Model(mass, stiffness, damping=None, n_dof=None, part="full", context=None, **options)

    Matrices are scipy.sparse (CSC, CSR or COO of double and 32- or 64-bit indices are used where they are, without a
    copy: leave them unchanged until build) or dense. part: "full", or the triangle that is stored, "lower" or "upper".
    DOFs and pairs count from 0. Call build() when all is set; afterwards the model no longer changes.
    """

    def __init__(self, mass=None, stiffness=None, damping=None, *, n_dof=None, part="full", context=None, **options):
        super().__init__(context or default_context())
        self._built = False
        self._borrowed = {}  # arrays the library looks at until build
        if n_dof is None:
            given = [m for m in (mass, stiffness, damping) if m is not None]
            if not given:
                raise TypeError("Model needs a matrix or n_dof")
            if numpy.ndim(given[0]) == 0 and not scipy.sparse.issparse(given[0]):
                raise TypeError(f"Model takes matrices, not {given[0]!r}; a number of DOFs alone is Model(n_dof=...)")
            n_dof = numpy.shape(given[0])[0]
        self.context.call("plm_model_create", self.context._h, n_dof, ctypes.byref(self._h))
        for which, matrix in ((_c.MASS, mass), (_c.STIFFNESS, stiffness), (_c.DAMPING, damping)):
            if matrix is not None:
                self._set_matrix(which, matrix, part)
        self.set_options(options)

    @classmethod
    def _adopted(cls, context):
        """An object whose handle another function than plm_model_create will write."""
        model = cls.__new__(cls)
        Handle.__init__(model, context)
        model._built, model._borrowed = False, {}
        return model

    # ---- matrices, damping, supports ----

    def set_mass(self, matrix, part="full"):
        """M, symmetric positive semi-definite."""
        self._set_matrix(_c.MASS, matrix, part)

    def set_stiffness(self, matrix, part="full"):
        """K, symmetric positive semi-definite."""
        self._set_matrix(_c.STIFFNESS, matrix, part)

    def set_damping(self, matrix, part="full"):
        """C, symmetric; adds to the other kinds of damping."""
        self._set_matrix(_c.DAMPING, matrix, part)

    def _set_matrix(self, which, matrix, part):
        name = f"the {MATRICES[which]} matrix"
        if not scipy.sparse.issparse(matrix):
            matrix = numpy.asfortranarray(real_parts(numpy.asarray(matrix), name, COMPLEX_MATRIX))
        if matrix.shape != (self.n_dof, self.n_dof):
            raise ValueError(f"{name} is {matrix.shape[0]} x {matrix.shape[1]}, but the model has {self.n_dof} DOFs; hand over "
                             f"all matrices as {self.n_dof} x {self.n_dof}, with the same numbering of the DOFs")
        if not scipy.sparse.issparse(matrix):
            self._call("set_dense_matrix", which, choice(part, PARTS, "part"), address(matrix), self.n_dof)
            self._borrowed.pop(which, None)
            return
        if matrix.format == "coo":
            storage, a, b = _c.TRIPLETS, matrix.row, matrix.col
        else:
            if matrix.format not in ("csc", "csr"):
                matrix = matrix.tocsc()
            storage, a, b = _c.CSC if matrix.format == "csc" else _c.CSR, matrix.indptr, matrix.indices
        (a, b), width = alike(a, b)
        nnz = matrix.nnz
        value = numpy.ascontiguousarray(real_parts(matrix.data[:nnz], name, COMPLEX_MATRIX))
        self._call("set_matrix" + width, which, storage, choice(part, PARTS, "part"), 0, _c.BORROW, nnz,
                   address(a), address(b), address(value))
        self._borrowed[which] = (a, b, value)

    def fix_dofs(self, dof):
        """DOFs held at zero: numbers, or a mask of n_dof."""
        dof = numpy.asarray(dof)
        if dof.dtype == numpy.bool_:
            if dof.shape != (self.n_dof,):
                raise ValueError(f"a mask of DOFs has one entry for each of the {self.n_dof} DOFs; this one has shape {dof.shape}")
            dof = numpy.flatnonzero(dof)
        (dof,), width = alike(integers(dof, "dof").ravel())
        self._call("fix_dofs" + width, 0, dof.size, address(dof))

    def add_constraints(self, rows):
        """Constraints rows @ q = 0 (n x n_dof, sparse or dense): ties, multi-point constraints, rigid links. Results stay in
        all DOFs of the model."""
        start, dof, coefficient, width = self._rows(rows, "it says nothing")
        self._call("add_constraints" + width, 0, start.size - 1, address(start), address(dof), address(coefficient))

    def add_outputs(self, rows):
        """Outputs rows @ q (n x n_dof, sparse or dense) beside the DOFs: a stress, a relative motion. Returns their numbers, each
        of which may stand wherever a dof is looked at. Before or after the build, also for branches that are there. With
        Model(..., absolute_outputs=1) they include the motion of moving supports."""
        start, dof, coefficient, width = self._rows(rows, "it never moves")
        first = ctypes.c_int64()
        self._call("add_outputs" + width, 0, start.size - 1, address(start), address(dof), address(coefficient),
                   ctypes.byref(first))
        return range(first.value, first.value + start.size - 1)

    def add_rigid_link(self, reference_dof, reference_xyz, dependent_dof, dependent_xyz):
        """Nodes that move with a reference node as one rigid body, at small rotations. reference_dof: its 3 or 6 DOFs;
        dependent_dof: n x 3 or n x 6 (-1: none); coordinates: 3, n x 3. A reference node of 3 DOFs does not turn."""
        xyz = self._points(dependent_xyz, "dependent_xyz")
        reference, at, nodes, width = self._coupled(reference_dof, reference_xyz, dependent_dof, "dependent_dof", len(xyz), (3, 6))
        self._call("add_rigid_link" + width, 0, reference.size, address(reference), address(at), len(xyz), nodes.shape[1],
                   address(nodes), address(xyz))

    def set_coordinates(self, dof, xyz):
        """Where the DOFs are, so that the audit can tell more. dof: n x 3 or n x 6 (-1: none); xyz: n x 3, in the unit of length
        of the matrices. DOFs in no node, as modal ones, may be left out. Results do not depend on it."""
        xyz = self._points(xyz, "xyz")
        (nodes,), width = alike(numpy.atleast_2d(integers(dof, "dof")))
        if nodes.ndim != 2 or len(nodes) != len(xyz) or nodes.shape[1] not in (3, 6):
            raise ValueError(f"dof has shape {nodes.shape}; needed is {len(xyz)} x 3 or 6: a row for each node")
        self._call("set_coordinates" + width, 0, len(xyz), nodes.shape[1], address(nodes), address(xyz))

    def add_distributing_coupling(self, reference_dof, reference_xyz, dof, xyz, weight=None):
        """RBE3: a reference node (3 or 6 DOFs) moves as the rigid body that fits the translations of nodes best, by least
        squares with these weights (n, or one number; None: all alike). dof: n x 3 (-1: none); xyz: n x 3."""
        xyz = self._points(xyz, "xyz")
        reference, at, nodes, width = self._coupled(reference_dof, reference_xyz, dof, "dof", len(xyz), (3,))
        weight = reals(weight, (len(xyz),), "weight", "one for each node, or one number for all")
        self._call("add_distributing_coupling" + width, 0, reference.size, address(reference), address(at), len(xyz),
                   address(nodes), address(xyz), address(weight))

    def add_tie(self, dependent_dof, dependent_xyz, surface_dof, surface_xyz, faces, tolerance):
        """Nodes that move as the points of a surface closest to them. DOFs and coordinates: n x 3 each, of the nodes and of those
        of the surface (-1: no such DOF); faces: rows of 3, 4, 6 or 8 places in the latter, an array or a list of lists.
        Nodes farther than the tolerance stay free, with a warning. Returns the distance of every node from the surface."""
        xyz, surface_xyz = self._points(dependent_xyz, "dependent_xyz"), self._points(surface_xyz, "surface_xyz")
        start, node = self._faces(faces)
        arrays = [integers(dependent_dof, "dependent_dof").reshape(-1, 3), integers(surface_dof, "surface_dof").reshape(-1, 3),
                  start, node]
        (dof, surface, start, node), width = alike(*arrays)
        for name, given, at in (("dependent", dof, xyz), ("surface", surface, surface_xyz)):
            if len(given) != len(at):
                raise ValueError(f"{name}_dof has {len(given)} nodes, {name}_xyz {len(at)}")
        distance = numpy.empty(len(xyz))
        self._work("add_tie" + width, 0, len(xyz), address(dof), address(xyz), len(surface), address(surface), address(surface_xyz),
                   len(start) - 1, address(start), address(node), tolerance, address(distance))
        return distance

    @staticmethod
    def _points(xyz, name):
        xyz = numpy.atleast_2d(real_parts(numpy.asarray(xyz), name))
        if xyz.ndim != 2 or xyz.shape[1] != 3:
            raise ValueError(f"{name} has shape {xyz.shape}; needed is n x 3, the coordinates of n nodes")
        return numpy.ascontiguousarray(xyz, dtype=float)

    @staticmethod
    def _coupled(reference_dof, reference_xyz, dof, name, n, widths):
        """A reference node and others, as C takes them."""
        (reference, nodes), width = alike(integers(reference_dof, "reference_dof").ravel(), numpy.atleast_2d(integers(dof, name)))
        if reference.size not in (3, 6):
            raise ValueError(f"reference_dof has {reference.size} DOFs; a node has 3 (translations), or 6 (and the rotations)")
        if nodes.ndim != 2 or len(nodes) != n or nodes.shape[1] not in widths:
            raise ValueError(f"{name} has shape {nodes.shape}; needed is {n} x {' or '.join(map(str, widths))}: a row for each node")
        return reference, reals(reference_xyz, (3,), "reference_xyz", "x, y, z"), nodes, width

    def set_multipliers(self, dof):
        """DOFs of the matrices that are Lagrange multipliers: their rows of K become constraints, and they leave what moves (fields
        are 0 there)."""
        (dof,), width = alike(integers(dof, "dof").ravel())
        self._call("set_multipliers" + width, 0, dof.size, address(dof))

    def set_elimination_order(self, dof):
        """A permutation of all DOFs: how the sparse factorization eliminates them, in place of the library's order."""
        (dof,), width = alike(integers(dof, "dof").ravel())
        self._call("set_elimination_order" + width, 0, dof.size, address(dof))

    # ---- contact ----

    def add_node_pairs(self, dof_a, dof_b, normal, stiffness=None, gap=None):
        """n pairs of nodes. dof_a, dof_b: n x 3, the x, y, z DOFs of the nodes (-1: none). normal: n x 3 or 3, unit, out
        of a's body towards b. stiffness: k_n (a number or n; None: chosen by the library). gap: a number or n; > 0 open.
        u = normal . (q_a - q_b) - gap, > 0 closed."""
        (a, b), width = alike(integers(dof_a, "dof_a").reshape(-1, 3), integers(dof_b, "dof_b").reshape(-1, 3))
        if len(a) != len(b):
            raise ValueError(f"dof_a has {len(a)} nodes, dof_b {len(b)}")
        normal, stiffness, gap = self._pairs(len(a), normal, stiffness, gap)
        self._call("add_node_pairs" + width, 0, len(a), address(a), address(b), address(normal), address(stiffness),
                   address(gap))

    def add_ground_contacts(self, dof, normal, stiffness=None, gap=None):
        """Nodes against rigid ground; the normal points into the ground: u = normal . q - gap. Else as add_node_pairs."""
        (dof,), width = alike(integers(dof, "dof").reshape(-1, 3))
        normal, stiffness, gap = self._pairs(len(dof), normal, stiffness, gap)
        self._call("add_ground_contacts" + width, 0, len(dof), address(dof), address(normal), address(stiffness),
                   address(gap))

    def add_gap_rows(self, rows, stiffness=None, gap=None):
        """Rows of the gap matrix B (n x n_dof, sparse or dense): u = B q - gap."""
        start, dof, coefficient, width = self._rows(rows, "its gap can never change")
        n = start.size - 1
        _, stiffness, gap = self._pairs(n, None, stiffness, gap)
        self._call("add_gap_rows" + width, 0, n, address(start), address(dof), address(coefficient), address(stiffness),
                   address(gap))

    def add_surface(self, dof, xyz, faces=(), area=None):
        """A surface for contact; returns its number. dof, xyz: n x 3 of a table of nodes (-1: no such DOF; dof None: a rigid
        wall); faces: rows of 3, 4, 6 or 8 places in it, normals (right-hand rule) out of the body; none: nodes alone, which
        can be a slave. area: n, what nodes stand for in place of what the faces give."""
        xyz = self._points(xyz, "xyz")
        start, node = self._faces(faces)
        dof = numpy.full((len(xyz), 3), -1) if dof is None else integers(dof, "dof").reshape(-1, 3)
        if len(dof) != len(xyz):
            raise ValueError(f"dof has {len(dof)} nodes, xyz {len(xyz)}")
        (table, start, node), width = alike(dof, start, node)
        area = reals(area, (len(xyz),), "area", "one for each node, or one number for all")
        number = ctypes.c_int64()
        self._call("add_surface" + width, 0, len(xyz), address(table), address(xyz), address(area), len(start) - 1, address(start), address(node), ctypes.byref(number))
        return number.value

    def add_surface_contact(self, slave, master, search, stiffness=None, closed=0.0, points=False, symmetric=False, smooth=False,
                            two_sided=False):
        """Contact between two surfaces (numbers from add_surface) whose meshes need not match: the slave's nodes, or the points
        that integrate over its faces (always, where these have middle nodes), against the master's faces within `search`.
        stiffness: by area (of each node where the slave has no faces; None: chosen by the library). Gaps and interferences up
        to `closed` are none. symmetric: both ways, half each, nodes that face each other exactly being one pair; smooth:
        normals and gaps of surfaces without edges, for curved ones of flat faces; two_sided: the master is a sheet."""
        options = (points * _c.SURFACE_POINTS + symmetric * _c.SURFACE_SYMMETRIC + smooth * _c.SURFACE_SMOOTH
                   + two_sided * _c.SURFACE_TWO_SIDED)
        self._work("add_surface_contact", slave, master, options, _c.AUTO_STIFFNESS if stiffness is None else stiffness, search,
                   closed)

    def set_rest_force(self, force):
        """Contact forces at rest of all pairs added so far (n; NaN: the pair keeps its gap), in place of their gaps, which the
        build finds ("initial_gap"). None removes them."""
        if force is None:
            return self._call("set_rest_force", 0, None)
        force = numpy.atleast_1d(numpy.asarray(force, dtype=float))
        force = list_of_reals(numpy.where(numpy.isnan(force), _c.KEEP_GAP, force), "force")
        self._call("set_rest_force", len(force), address(force))

    @staticmethod
    def _faces(faces):
        """As compressed rows."""
        faces = [integers(face, "faces").ravel() for face in faces]
        start = numpy.concatenate([[0], numpy.cumsum([face.size for face in faces])]).astype(numpy.int32)
        return start, numpy.concatenate(faces) if faces else start[:0]

    def _rows(self, rows, when_zero):
        rows = scipy.sparse.csr_matrix(rows)
        if not numpy.all(rows.data):  # and not in the caller's own arrays
            rows = rows.copy()
            rows.eliminate_zeros()
        coefficient = numpy.ascontiguousarray(real_parts(rows.data, "rows"))
        if rows.shape[1] != self.n_dof:
            raise ValueError(f"rows has {rows.shape[1]} columns; needed is n_dof = {self.n_dof}")
        empty = numpy.flatnonzero(numpy.diff(rows.indptr) == 0)
        if empty.size:
            raise ValueError(f"row {empty[0]} of rows is all zeros: it touches no DOF, and {when_zero}; leave it out, "
                             "or check the numbers of its DOFs")
        (start, dof), width = alike(rows.indptr, rows.indices)
        return start, dof, coefficient, width

    @staticmethod
    def _pairs(n, normal, stiffness, gap):
        stiffness = _c.AUTO_STIFFNESS if stiffness is None else stiffness
        of_pairs = "one for each pair, or one number for all"
        return (reals(normal, (n, 3), "normal", "a row for each pair, or three numbers for all"),
                reals(stiffness, (n,), "stiffness", of_pairs), reals(gap, (n,), "gap", of_pairs))

    # ---- superelements ----

    def set_recovery(self, recover, n_full):
        """The way from a superelement to the structure it was reduced from, before build: recover(q) of motions n_dof x k
        returns n_full x k, as T @ q. None: there is none."""
        # of the host, not of self: no cycle
        function = _c.RECOVER_FN(functools.partial(self.context._host.on_recover, recover)) if recover else None
        self._call("set_recovery", n_full, ctypes.cast(function, ctypes.c_void_p) if function else None, None)
        self._recovery = function  # kept alive here: ctypes does not

    def recover(self, q):
        """Motions in the model's DOFs (n_dof, or n_dof x k) on the whole structure: n_full, or n_full x k."""
        q = numpy.asarray(real_parts(numpy.asarray(q), "q"), dtype=float)
        columns = numpy.asfortranarray(q.reshape((len(q), -1)))
        if len(columns) != self.n_dof:
            raise ValueError(f"q has {len(columns)} rows; needed is n_dof = {self.n_dof}")
        full = numpy.empty((self.n_full, columns.shape[1]), order="F")
        self._work("recover", columns.shape[1], address(columns), self.n_full, address(full))
        return full[:, 0] if q.ndim == 1 else full

    def recover_amplitude(self, branch, full_dof, measure="half_peak_to_peak", harmonic=0):
        """As Branch.amplitude, of a DOF of the whole structure."""
        from ._response import MEASURES  # which needs a Model
        count = ctypes.c_int64(branch.n_points)
        values = numpy.empty(count.value)
        self._work("recover_amplitude", handle_of(branch, "branch", "branch"), full_dof, choice(measure, MEASURES, "measure"),
                   harmonic, values.size, address(values), ctypes.byref(count))
        return values

    # ---- loads ----

    def set_preload(self, force):
        """Static force, n_dof; None removes it."""
        force = reals(force, (self.n_dof,), "force", OF_DOFS)
        self._work("set_preload", self.n_dof, address(force))

    def set_base_motion(self, motion, quantity="displacement", harmonic=1):
        """Moving supports: Re(U_h exp(i h omega t)); motion: U_h, n_dof, real or complex, zero where a DOF is not fixed;
        quantity: "displacement", "velocity" or "acceleration". What constraints tie to the supports moves with them. Results are
        relative to the base; with the option absolute_outputs=1 those of add_outputs are absolute. None removes the harmonic."""
        if quantity not in QUANTITIES:
            raise ValueError(f"quantity must be one of {', '.join(QUANTITIES)}, not {quantity!r}")
        imaginary = None
        if numpy.iscomplexobj(motion):
            imaginary = reals(numpy.imag(motion), (self.n_dof,), "motion", OF_DOFS)
            motion = numpy.real(motion)
        motion = reals(motion, (self.n_dof,), "motion", OF_DOFS)
        self._call("set_base_motion", QUANTITIES[quantity], harmonic, self.n_dof, address(motion), address(imaginary))

    def set_excitation(self, force, harmonic=1, power=0):
        """F(t) = sum omega^power Re(F_h exp(i h omega t)); force: F_h, n_dof, real or complex; power: 0, 1 or 2 (an unbalance:
        mass times eccentricity), omega in rad/s; parts of different power add up. None removes the part."""
        imaginary = None
        if numpy.iscomplexobj(force):
            imaginary = reals(numpy.imag(force), (self.n_dof,), "force", OF_DOFS)
            force = numpy.real(force)
        force = reals(force, (self.n_dof,), "force", OF_DOFS)
        if power == 0:
            return self._work("set_excitation", harmonic, self.n_dof, address(force), address(imaginary))
        self._work("set_growing_excitation", harmonic, power, self.n_dof, address(force), address(imaginary))

    def set_gap_motion(self, motion, harmonic=1):
        """gap(t) = gap + sum Re(G_h exp(i h omega t)), of walls that move; motion: G_h of all pairs added so far, real or
        complex. force_scale multiplies it as it does the forces. None removes the harmonic."""
        if motion is None:
            return self._work("set_gap_motion", harmonic, 0, None, None)
        motion = numpy.atleast_1d(motion)
        real = list_of_reals(numpy.real(motion), "motion")
        imaginary = None
        if numpy.iscomplexobj(motion):
            imaginary = list_of_reals(numpy.imag(motion), "motion")
        self._work("set_gap_motion", harmonic, len(real), address(real), address(imaginary))

    # ---- work ----

    def build(self, progress=None):
        """Checks the whole, removes the fixed DOFs, factors K. Returns the model."""
        self._work("build", progress=progress)
        self._borrowed.clear()
        self._built = True
        return self

    def solve_rest(self, progress=None):
        """Static equilibrium under the pre-load; read by rest_displacement, rest_penetration, rest_closed, rest_force."""
        self._work("solve_rest", progress=progress)
        return self

    def compute_response(self, dof, accuracy=1e-3, measure="half_peak_to_peak", progress=None):
        """Response(frequency_hz, amplitude, error, curve, hbm): the whole way in one call, from the built model to the curve
        around the resonance that the excitation drives most and its peak, which may be wrong by `accuracy`. measure: "peak",
        "half_peak_to_peak" or "rms". Where a larger stable motion exists beside the curve, it warns, and `larger` has it."""
        from ._response import MEASURES, Branch, Hbm, Response  # which need a Model
        hz, amplitude, error = ctypes.c_double(), ctypes.c_double(), ctypes.c_double()
        hbm = Hbm._made_by(self)
        curve = Branch(hbm)
        curve._status = self._work("compute_response", dof, choice(measure, MEASURES, "measure"), accuracy,
                                   ctypes.byref(hz), ctypes.byref(amplitude), ctypes.byref(error), ctypes.byref(curve._h),
                                   ctypes.byref(hbm._h), progress=progress)
        return Response(hz.value, amplitude.value, error.value, curve, hbm)

    def modes(self, n, system="open", closed=None, shapes=False):
        """The n lowest natural frequencies (Hz) of the system "open", "sliding", "rest" or "given" (by closed, n_pairs);
        with shapes also the mass-normalised shapes, n_dof x n."""
        if closed is not None:
            closed = numpy.ascontiguousarray(numpy.broadcast_to(closed, (self.n_pairs,)), dtype=numpy.int32)
            system = "given"
        if isinstance(n, str):
            raise TypeError(f"n is {n!r}; the number of modes comes first, then the system: modes(2, {n!r})")
        frequency = numpy.empty(max(n, 0))
        shape = numpy.empty((self.n_dof, max(n, 0)), order="F") if shapes else None
        self._work("get_modes", choice(system, SYSTEMS, "system"), address(closed), n, address(frequency), address(shape))
        return (frequency, shape) if shapes else frequency

    def audit(self):
        """Findings about the built model: mass, rigid-body modes, gaps, stiffness, units that look off."""
        count = ctypes.c_int64(0)
        self._work("audit", ctypes.byref(count))
        return [self._finding(i) for i in range(count.value)]

    def _finding(self, index):
        severity, value, needed = ctypes.c_int32(), ctypes.c_double(), ctypes.c_int64()
        numbers = (ctypes.byref(severity), ctypes.byref(value))
        self._call("get_finding", index, *numbers, 0, None, ctypes.byref(needed))
        buffer = ctypes.create_string_buffer(max(needed.value, 1))
        self._call("get_finding", index, *numbers, len(buffer), buffer, None)
        return Finding(severity.value, value.value, _c.text_in(buffer))

    def _n_pairs(self):
        return self.n_pairs

    def _summary(self):
        return f"{self.n_dof} DOFs, contact pairs: {self.n_pairs}, {'built' if self._built else 'not built'}"
