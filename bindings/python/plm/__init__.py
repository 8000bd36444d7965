"""libplm: piecewise-linear modes and harmonic balance for structures with intermittent contact.

    model = plm.Model(mass, stiffness)                  # scipy.sparse
    model.set_rayleigh_damping(0, 2e-4)
    model.add_node_pairs(dof_a, dof_b, normal)
    model.set_excitation(force)
    model.build()
    response = model.compute_response(dof=12)           # peak and curve, as accurate as asked; or step by step:
    sampler = plm.Sampler(model, mode=1, n_samples=4).run()
    basis = plm.Basis(model, sampler).build()
    hbm = plm.Hbm(basis, n_harmonics=7)
    curve = hbm.sweep(progress=True)
    peak = hbm.find_peak(curve, dof=12)
    plm.plot.response(curve, dof=12)
    motion = plm.Transient(basis, frequency_hz=peak.frequency_hz, periods=200).run()
    study = plm.Study(model)                            # error against run time
    study.set_output(dof=12)
    study.add_response("4 samples", hbm)
    plm.plot.study_errors(study.run())
    deck = plm.fe.read_deck("blade.inp")                 # files of other codes, and results for viewers:
    plm.fe.write_vtu_series("blade", peak.branch, 0, deck)

Options and results are attributes; help(plm.Sampler) lists those of a sampler. What a function computes is said in plm.h.
"""
import importlib
import os
import sys


def _end_of_command(missing):
    """The command plm, or python -m plm, ends with one line where the library or NumPy is missing; any other program hears of it as of
    any failed import."""
    words = getattr(sys, "orig_argv", [])
    module = words[words.index("-m") + 1:][:1] if "-m" in words else []
    if module == ["plm"] or os.path.basename(sys.argv[0] if sys.argv else "") == "plm":
        print(f"plm: {missing}", file=sys.stderr)
        sys.exit(3)


try:
    from . import _functions, _help
    from ._context import Context, build_info, default_context, status_text, version
    from ._errors import PlmCancelled, PlmError, PlmKeyError, PlmWarning
    from ._handle import Key, keys
    from ._model import Finding, Model
    from ._motion import MotionState, Transient
    from ._reduction import Basis, Sampler
    from ._response import Bifurcation, Branch, Contact, Energy, ErrorEstimate, ErrorParts, Hbm, Isolated, Larger, Peak, Refined, Response
    from ._study import Study, StudyPoints
except ImportError as missing:
    _end_of_command(missing)
    raise

__version__ = "0.1.0"
__all__ = ["Context", "Model", "Sampler", "Basis", "Hbm", "Branch", "Transient", "Study", "Peak", "Isolated", "Larger", "Bifurcation",
           "Energy", "ErrorEstimate", "ErrorParts", "Refined", "Response", "Contact", "MotionState", "StudyPoints", "Finding", "Key",
           "PlmError", "PlmKeyError", "PlmCancelled", "PlmWarning", "build_info", "default_context", "fe", "keys", "plot", "status_text", "version"]

_constants = [name for name, value in vars(_functions).items() if name.isupper() and isinstance(value, (int, float))]
globals().update({name: getattr(_functions, name) for name in _constants})  # plm.ERR_KEY, plm.REASON_SINGULAR, ...
__all__ += _constants


def __getattr__(name):
    """matplotlib is loaded with the first use of plm.plot, what reads and writes files with that of plm.fe, libplm_mpi with that of
    plm.mpi."""
    if name in ("plot", "fe", "mpi"):
        return importlib.import_module(f".{name}", __name__)
    raise AttributeError(f"module 'plm' has no attribute {name!r}")


def __dir__():
    return sorted(set(globals()) | set(__all__))


_help.attach((Context, Model, Sampler, Basis, Hbm, Branch, Transient, Study), (build_info, default_context, keys, status_text, version))
