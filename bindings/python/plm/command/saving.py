"""A curve that plm response writes while it is followed (--save-every), and that plm resume goes on with."""
import pathlib

from .. import _functions as constants
from .._reduction import Basis
from .._response import Branch
from ..fe.replacing import replacing
from .settings import Wrong

_CAN_GO_ON = {constants.REASON_CANCELLED, constants.REASON_EFFORT, constants.REASON_POINT_LIMIT, constants.REASON_UNFINISHED}
_REFINED = "refined_"
_EVERY = 10  # points, of a curve that goes on


class SavedCurve:
    """basis.plm and curve.plm in the folder of a response, and, where that basis turns out too small, refined_basis.plm and
    refined_curve.plm of the one that takes its place."""

    def __init__(self, settings, resumes, console):
        command = "resume" if resumes else "save_every"
        if not settings["out"]:
            raise Wrong(f"{command} needs --out FOLDER: the curve is there, with the basis that it is followed on")
        self._resumes, self._console, self._every = resumes, console, settings["save_every"] or _EVERY
        self._folder, self.files = pathlib.Path(settings["out"]), []
        self._take_names("")
        if resumes and not self._basis.exists():
            raise Wrong(f"resume: there is no {self._basis}; plm response --save-every N --out FOLDER leaves one there")

    def _take_names(self, stage):
        self._basis, self._curve = (self._folder / (stage + name) for name in ("basis.plm", "curve.plm"))
        self.files = [*self.files, self._basis.name, self._curve.name]

    def go_on_refined(self):
        """From now on it is about the basis that takes the place of the first, which may have been left there, too."""
        self._take_names(_REFINED)
        self._resumes = self._resumes and self._basis.exists()

    def basis(self, model, make):
        """The one that was left there, with its model; else what make() builds, left there."""
        if self._resumes:
            basis = Basis.from_bytes(self._basis.read_bytes(), model.context)
            basis.attach(model)
            return basis
        basis = make()
        for name in (self._curve.name, _REFINED + "basis.plm", _REFINED + "curve.plm"):
            (self._folder / name).unlink(missing_ok=True)  # of another basis
        with replacing(self._basis) as beside:
            pathlib.Path(beside).write_bytes(basis.to_bytes())
        return basis

    def sweep(self, hbm, basis, progress):
        """The whole curve: from its beginning, or from where the file has it."""
        hbm.save_every(self._every, self._curve)
        if not self._resumes:
            return hbm.sweep(progress)
        if not self._curve.exists():
            self._console.note(f"{self._curve} is not there: the curve begins anew")
            return hbm.sweep(progress)
        known = Branch.from_bytes(basis, self._curve.read_bytes())
        if known.end_reason not in _CAN_GO_ON:
            self._console.note(f"{self._curve} has the whole curve: {known.end_text}")
            return known
        self._console.note(f"{self._curve} has {len(known)} points; the curve goes on")
        return hbm.resume(known, progress)
