"""The C ABI: the shared library, its functions and its constants. Nothing above this file uses ctypes types of functions."""
import ctypes
import ctypes.util
import numbers
import operator
import os
import pathlib
import re

from ._functions import *  # noqa: F403 - the constants and the types of callbacks, as _c.NAME
from ._functions import FUNCTIONS, OK, pointer


def _candidates():
    """Where the library may be: $PLM_LIBRARY, beside this package, where the system keeps its libraries."""
    if os.environ.get("PLM_LIBRARY"):
        yield os.environ["PLM_LIBRARY"]
        return
    here = pathlib.Path(__file__).resolve().parent
    for folder in (here, here.parent):
        for name in ("libplm.so.0", "libplm.so", "libplm.dylib", "plm.dll"):
            if (folder / name).exists():
                yield str(folder / name)
    found = ctypes.util.find_library("plm")
    if found:
        yield found
    yield "libplm.so.0"


def _load():
    failures = []
    for name in _candidates():
        try:
            return ctypes.CDLL(name)
        except OSError as error:
            failures.append(str(error))
    raise ImportError("libplm was not found; install it, or let the environment variable PLM_LIBRARY name the shared "
                      "library (" + "; ".join(failures) + ")")


class _Integer:
    """An argument that holds an integer of this type; ctypes by itself would cut off what does not fit."""

    def __init__(self, c_type):
        self.limit, self.c_type = 2**(8 * ctypes.sizeof(c_type) - 1), c_type

    def from_param(self, value):
        try:
            number = operator.index(value)
        except TypeError:
            raise TypeError(f"an integer is needed, not {type(value).__name__}") from None
        if not -self.limit <= number < self.limit:
            raise TypeError(f"{number} does not fit into the library's integers, {-self.limit} to {self.limit - 1}")
        return self.c_type(number)


class _Real:
    """An argument that holds a double; any real number will do, of NumPy's too."""

    @staticmethod
    def from_param(value):
        if not isinstance(value, numbers.Real):
            raise TypeError(f"a real number is needed, not {type(value).__name__}")
        return ctypes.c_double(float(value))


class _Functions:
    """The C functions as attributes, with their argument types."""

    def __init__(self, library):
        letters = {"i": _Integer(ctypes.c_int32), "q": _Integer(ctypes.c_int64), "d": _Real, "s": ctypes.c_char_p, "p": pointer}
        self.path = library._name
        self.argument_names = {name: described.split()[1:] for name, described in FUNCTIONS.items()}
        for name, described in FUNCTIONS.items():
            arguments = described.split()[0]
            try:
                function = getattr(library, name)
            except AttributeError:
                raise ImportError(f"{library._name} has no {name}: it is not the libplm of this package") from None
            function.argtypes = [letters[a] for a in arguments]
            function.restype = ctypes.c_int32
            setattr(self, name, function)


lib = _Functions(_load())


def text_in(buffer):
    """A text of the library, with the constants of plm.h as they are called here: plm.LOWER."""
    text = buffer.value.decode("utf-8", "replace")
    return re.sub(r"\bPLM_([A-Z0-9_]+)", lambda found: f"plm.{found[1]}" if found[1] in globals() else found[0], text)


def text_of(function, *arguments):
    """A text the library copies out: function(*arguments, capacity, buffer, needed). Empty when it has none."""
    needed = ctypes.c_int64(0)
    if function(*arguments, 0, None, ctypes.byref(needed)) != OK:
        return ""
    buffer = ctypes.create_string_buffer(max(needed.value, 1))
    function(*arguments, len(buffer), buffer, None)
    return text_in(buffer)
