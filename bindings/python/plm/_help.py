"""What help() adds to the text of a function: its arguments, each with meaning, shape and unit, and an example. Written once for all
functions: a name means the same wherever it stands. Nothing of the package is needed to read this file: the reference does."""
import inspect
import pathlib
import re
import textwrap

EXAMPLES = pathlib.Path(__file__).with_name("_examples.py")
ARGUMENTS = {
    "accuracy": "relative error that the peak may have, 1e-8 to 0.5",
    "alpha": "share of the mass in the damping matrix (1/time)",
    "amplitude_max": "where the path ends: amplitude of the first harmonic of the DOF (length); 0: chosen",
    "area": "n areas that the nodes stand for (length^2), or one number; None: by the faces",
    "basis": "a plm.Basis that is built",
    "basis_or_model": "a plm.Basis that is built: the reduced model by its exact flow; or a plm.Model: the full one by time steps",
    "beta": "share of the stiffness in the damping matrix (time)",
    "branch": "a plm.Branch, computed on the basis of this object",
    "branches": "a plm.Branch, or several, computed on the parent",
    "closed": "n_pairs booleans: which pairs are closed",
    "context": "a plm.Context; None: the one of this thread",
    "damping": "viscous damping matrix (force time/length), n_dof x n_dof; None: none",
    "data": "bytes that to_bytes() gave",
    "dependent_dof": "n x 3 or n x 6 numbers of DOFs, from 0, a row for each node; -1: no such DOF",
    "dependent_xyz": "n x 3 coordinates (length)",
    "dof": "number of a DOF or of an output, from 0",
    "dof_a": "n x 3 numbers of DOFs, from 0: x, y, z of the node of each pair on the first body; -1: none",
    "dof_b": "n x 3, of the second body",
    "eta": "loss factor, without unit",
    "faces": "rows of 3, 4, 6 or 8 places in the table of nodes, from 0: corners around, then middles of sides",
    "factor": "function of (sparse matrix, positive_definite) that returns a function which solves; None: the built-in solver",
    "folder": "path of a folder, which is made if its parent exists",
    "force": "n_dof forces (force), real or complex amplitudes; None removes them",
    "force_max": "largest factor on the excitation that is looked at; 0: eight times force_scale",
    "force_min": "smallest factor on the excitation",
    "force_scales": "n factors on the excitation",
    "frequency_hz": "frequency (Hz)",
    "full_dof": "number of a DOF of the structure that a superelement was reduced from, from 0",
    "gap": "n initial gaps (length), or one number; > 0 open, < 0 interference; None: 0",
    "harmonic": "number of a harmonic of the excitation: 1 is its frequency",
    "hbm": "a plm.Hbm",
    "inertia": "function of what `factor` returned: number of negative eigenvalues, or -1; None: not known",
    "key": "name of an option or result",
    "kind": "plm.KIND_MODEL, KIND_SAMPLER, ...",
    "known": "a plm.Branch, or several, that need not be found again",
    "level": "number of a force level, from 0",
    "log": "None, True (the logger \"plm\"), or a function of (level, text)",
    "main_branch": "a plm.Branch, the whole curve",
    "mass": "mass matrix (mass), n_dof x n_dof, sparse or dense",
    "master": "number of a surface",
    "matrix": "n_dof x n_dof, symmetric, sparse or dense",
    "measure": "\"peak\", \"half_peak_to_peak\", \"rms\" or \"harmonic\" (length)",
    "method": "name or number of a method, from 0; -1 or \"reference\": the reference",
    "mirrored": "True: leave on the other side",
    "mode": "number of a mode, from 1",
    "model": "a plm.Model",
    "motion": "amplitudes, real or complex; None removes them",
    "n": "how many",
    "n_dof": "number of DOFs, where no matrix tells it",
    "n_frequencies": "how many frequencies of the range",
    "n_points": "points of a curve from one time that it is written to the next; 0: never",
    "n_full": "number of DOFs of the whole structure",
    "n_states": "how many states beside rest the motions begin from",
    "n_times": "how many equidistant times of the period, from 0",
    "name": "of the method, used once",
    "normal": "n x 3 unit vectors, or one for all: out of the first body, towards the second or into the ground",
    "options": "options by name, as those that the class lists",
    "parent": "a plm.Basis that is built; None: none",
    "part": "\"full\", or the triangle that is stored: \"lower\", \"upper\"",
    "path": "of the file",
    "point": "number of a point of the branch, from 0; -1: the last",
    "points": "True: pairs at the points that integrate over the faces, not at nodes",
    "power": "of omega (rad/s) that the force grows with: 0, 1 or 2",
    "progress": "None: as the context has it; True: a bar; or a function of (stage, fraction) that returns True to cancel",
    "q": "n_dof displacements (length); None: zero",
    "quantity": "\"displacement\", \"velocity\" or \"acceleration\"",
    "ratio": "shares of critical damping, one for each mode or one for all, in [0, 1)",
    "recover": "function of n_dof x k motions that returns n_full x k",
    "reference_dof": "3 or 6 numbers of DOFs, from 0",
    "reference_xyz": "3 coordinates (length)",
    "responses": "a plm.Branch, or several, for kind \"pod\"",
    "rows": "n x n_dof coefficients, sparse or dense",
    "sampler": "a plm.Sampler; None: none",
    "scale": "n factors > 0 on the excitation",
    "search": "largest distance of a node from its partner (length)",
    "seconds": "of one core; 0: no limit",
    "shapes": "True: also the shapes",
    "size": "number of columns; 0: as pod_tolerance asks for",
    "slave": "number of a surface",
    "smooth": "True: normals of smooth surfaces, not those of flat faces",
    "start": "a plm.Branch; None: from rest",
    "static": "True: of P_0, the mean part",
    "status": "plm.OK, plm.WARNING, plm.ERR_...",
    "stiffness": "contact stiffness of the n pairs (force/length), or one number; None: chosen by the library",
    "surface_dof": "n_surface x 3 numbers of DOFs, from 0; -1: no such DOF",
    "surface_xyz": "n_surface x 3 coordinates (length)",
    "symmetric": "True: each surface's nodes against the other, half the stiffness each",
    "system": "\"open\", \"sliding\", \"rest\" or \"given\"",
    "time_fraction": "time, as a share of the period",
    "tolerance": "relative error that is allowed",
    "transient": "a plm.Transient",
    "two_sided": "True: the master is a sheet",
    "v": "n_dof velocities (length/time); None: zero",
    "value": "int, float or str",
    "weight": "n weights > 0, or one number; None: all alike",
    "write": "a function of bytes, called with piece after piece",
    "xyz": "n x 3 coordinates (length)",
}
OTHERWISE = {  # where a name means something of its own
    "Basis.residual.mass": "True: in the norm of M",
    "Basis.residual.q": "n_dof displacements (length)",
    "Model.stiffness": "stiffness matrix (force/length), n_dof x n_dof, sparse or dense",
    "Model.add_surface_contact.stiffness": "by area (force/length^3), or of each pair (force/length) where the slave has no faces; None: chosen",
    "Model.add_surface_contact.closed": "gaps and interferences up to this length are none",
    "Model.add_tie.tolerance": "largest distance of a node from the surface (length)",
    "Model.fix_dofs.dof": "numbers of DOFs, from 0, or a mask of n_dof",
    "Model.modes.n": "how many of the lowest modes",
    "Model.recover.q": "n_dof, or n_dof x k, motions in the model's DOFs (length)",
    "Model.set_base_motion.motion": "n_dof amplitudes, real or complex, of `quantity`; zero where a DOF is not fixed; None removes them",
    "Model.set_gap_motion.motion": "n_pairs amplitudes (length), real or complex; None removes them",
    "Model.set_rest_force.force": "n_pairs contact forces (force), >= 0; NaN: the pair keeps its gap; None removes them",
    "Model.set_preload.force": "n_dof static forces (force); None removes them",
    "Hbm.resume.branch": "a plm.Branch that was stopped, of this object or read from bytes",
    "Hbm.save_every.path": "of the file; None: none",
    "Context.set_threads.n": "how many threads, the calling one among them",
    "Branch.coefficients.dof": "number of a DOF, from 0; None: all",
    "Transient.history.dof": "number of an observed DOF, from 0; None: all of them",
    "Transient.observe.dof": "numbers of DOFs, from 0",
    **{f"Model.{method}.dof": f"n x {width} numbers of DOFs, from 0, a row for each node; -1: no such DOF" for method, width in
       (("add_distributing_coupling", "3"), ("add_ground_contacts", "3"), ("add_surface", "3"), ("set_coordinates", "3 or 6"))},
    **{f"Model.{method}.dof": "numbers of DOFs, from 0" for method in ("set_elimination_order", "set_multipliers")},
    **{f"{owner}.harmonic": "number of the harmonic where measure is \"harmonic\"; 0: the mean" for owner in
       ("Model.recover_amplitude", "Hbm.estimate_error", "Hbm.find_peak", "Hbm.refine_basis", "Branch.amplitude", "Branch.write_csv", "Branch.write_csv_to", "Study.set_output")},
}


def examples():
    """{name: its example}: what stands between two lines with the name in brackets."""
    found, opened = {}, {}
    for line in EXAMPLES.read_text(encoding="utf-8").splitlines():
        marks = re.findall(r"\[([\w.]+)\]", line) if re.match(r"\s*# \[", line) else []
        for mark in marks:
            if mark in opened:
                found[mark] = textwrap.dedent("\n".join(opened.pop(mark)))
            else:
                opened[mark] = []
        if not marks:
            for lines in opened.values():
                lines.append(line)
    return found


def meaning(owner, function, argument):
    """Of an argument, "" where nothing is said of it."""
    for place in filter(None, (f"{owner}.{function}.{argument}".removeprefix("."), f"{owner}.{argument}" if function == "__init__" else "")):
        if place in OTHERWISE:
            return OTHERWISE[place]
    return ARGUMENTS.get(argument, "")


def completed(text, owner, function, code, example):
    """The text of a function with its arguments and an example."""
    names = [name for name in code.co_varnames[:code.co_argcount + code.co_kwonlyargcount] if name not in ("self", "cls")]
    said = [f"{name}: {meaning(owner, function, name)}" for name in names if meaning(owner, function, name)]
    parts = [text.rstrip() if text else ""]
    if said:
        parts.append("Arguments:\n\n" + "\n".join(textwrap.fill(line, 100, initial_indent="    ", subsequent_indent="        ") for line in said))
    if example:
        parts.append("Example:\n\n" + textwrap.indent(example, "    "))
    return "\n\n".join(parts) + "\n"


def complete(owner, where, shown):
    """Of all public methods that a class has of its own or by its base."""
    for name, member in inspect.getmembers(where):
        function = getattr(member, "__func__", member)
        if name.startswith("_") or not inspect.isfunction(function) or function.__doc__ is None or "\nExample:\n" in function.__doc__:
            continue
        example = shown.get(f"{owner}.{name}", "") or shown.get(f"Handle.{name}", "")
        function.__doc__ = completed(inspect.cleandoc(function.__doc__), owner, name, function.__code__, example)


def attach(classes, functions):
    """To all that the package hands out."""
    shown = examples()
    for one in classes:
        complete(one.__name__, one, shown)
        if one.__name__ in shown:
            text, _, keys = (one.__doc__ or "").partition("\n\nOptions and results:\n\n")
            text = completed(inspect.cleandoc(text), one.__name__, "__init__", one.__init__.__code__, shown[one.__name__])
            one.__doc__ = text + ("\nOptions and results:\n\n" + keys if keys else "")
    for function in functions:
        function.__doc__ = completed(inspect.cleandoc(function.__doc__ or ""), "", function.__name__, function.__code__, shown.get(function.__name__, ""))


def explain(functions, said):
    """To functions that explain their own arguments: those that mean the same in all of them, where the text does not speak of them."""
    for function in functions:
        text = inspect.cleandoc(function.__doc__)
        lines = [f"{name}: {said[name]}" for name in inspect.signature(function).parameters
                 if name in said and not re.search(rf"(?<![\w.]){name}(:|  )", text)]
        if lines:
            wrapped = (textwrap.fill(line, 100, initial_indent="    ", subsequent_indent="        ") for line in lines)
            function.__doc__ = text + "\n\nArguments:\n\n" + "\n".join(wrapped) + "\n"
