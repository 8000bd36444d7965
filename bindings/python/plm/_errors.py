"""Exceptions of libplm."""
from . import _c


class PlmError(Exception):
    """A call of libplm failed and nothing has changed.

    status        plm.ERR_...
    reason        plm.REASON_..., 0: none
    function      the C function that refused
    argument      its argument at fault, "" if none
    index         the position in that argument, -1 if none
    library_code  code of LAPACK, the factorization or a callback, 0 if none
    """

    def __init__(self, text, status=_c.ERR_INTERNAL, reason=0, function="", argument="", index=-1, library_code=0):
        super().__init__(text)
        self.status, self.reason = status, reason
        self.function, self.argument = function, argument
        self.index, self.library_code = index, library_code


class PlmKeyError(PlmError, AttributeError):
    """No option or result has this name; the text proposes the nearest."""


class PlmCancelled(PlmError):
    """The progress callback stopped a call that has no partial result."""


class PlmWarning(UserWarning):
    """A call is done, and its result valid as far as it goes, but something should be looked at.

    status  plm.WARNING, NOT_CONVERGED or TRUNCATED
    reason  plm.REASON_...

    Issued by warnings.warn: warnings.simplefilter("error", plm.PlmWarning) makes exceptions of them.
    """

    def __init__(self, text, status=_c.WARNING, reason=0):
        super().__init__(text)
        self.status, self.reason = status, reason


def make_error(text, status, **details):
    """The exception that goes with a status."""
    kinds = {_c.ERR_KEY: PlmKeyError, _c.CANCELLED: PlmCancelled}
    return kinds.get(status, PlmError)(text, status, **details)
