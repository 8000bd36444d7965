"""Handles, and their options and results as attributes made from the library's own table."""
import ctypes
import difflib
import functools
import numbers
import re
from typing import NamedTuple

import numpy

from . import _c
from ._errors import PlmError


class Key(NamedTuple):
    """A row of the table."""
    name: str
    type: int
    is_option: bool
    description: str
    default: str
    choices: str
    minimum: float
    maximum: float

    def doc(self):
        """What help() shows."""
        if not self.is_option:
            return self.description
        allowed = self.choices
        if not allowed and self.maximum:
            upper = "" if self.maximum >= 1e60 else f"{self.maximum:.12g}"
            allowed = f"{self.minimum:.12g} .. {upper}" if self.minimum > -1e60 else "any number"
        return f"{self.description} [option; default {self.default}; {allowed}]"


def keys(kind):
    """The table of a kind of handle (plm.KIND_...), in its order."""
    count = ctypes.c_int32(0)
    _c.lib.plm_key_count(kind, ctypes.byref(count))
    table = []
    for i in range(count.value):
        kind_of_value, is_option = ctypes.c_int32(), ctypes.c_int32()
        low, high = ctypes.c_double(), ctypes.c_double()
        _c.lib.plm_key_info(kind, i, *map(ctypes.byref, (kind_of_value, is_option, low, high)))
        name, text, default, choices = (_c.text_of(_c.lib.plm_key_text, kind, i, field) for field in
                                        (_c.KEY_NAME, _c.KEY_DESCRIPTION, _c.KEY_DEFAULT, _c.KEY_CHOICES))
        table.append(Key(name, kind_of_value.value, bool(is_option.value), text, default, choices, low.value, high.value))
    return table


def attribute_name(key):
    """"lambda" is a word of Python: its attribute is lambda_."""
    return key + "_" if key == "lambda" else key


def _make_property(key):
    def read(self):
        return self.get(key.name)

    def write(self, value):
        self.set(key.name, value)
    return property(read, write if key.is_option else None, doc=key.doc())


def handle_of(value, noun, argument, *others):
    """The handle in an object of this kind; others: what else may stand there, None for one."""
    if isinstance(value, Handle) and value._noun == noun:
        return value._h
    if value is None and None in others:
        return None
    raise TypeError(f"{argument} must be a plm.{noun.capitalize()}, not {type(value).__name__}")


def context_of(value, noun, argument):
    """The context of an object that must be of this kind."""
    handle_of(value, noun, argument)
    return value.context


def branch_array(branches):
    """(array of handles, its length) of one branch or several."""
    branches = [branches] if isinstance(branches, Handle) else list(branches)
    handles = [handle_of(branch, "branch", "each of the branches").value for branch in branches]
    return (ctypes.c_void_p * len(branches))(*handles), len(branches)


class Handle:
    """Base of Model, Sampler, Basis, Hbm, Branch, Transient and Study.

    Options and results are attributes (tab completion and help() show them all), and items: sampler["n_samples"].
    """

    def __init_subclass__(cls, noun="", kind=0, **more):
        super().__init_subclass__(**more)
        cls._noun, cls.keys = noun, {key.name: key for key in keys(kind)}
        lines = []
        for key in cls.keys.values():
            name = attribute_name(key.name)
            if hasattr(cls, name):
                raise TypeError(f"{cls.__name__}.{name} hides the key of this name")
            setattr(cls, name, _make_property(key))
            lines.append(f"    {name}: {key.doc()}")
        cls.__doc__ = (cls.__doc__ or "") + "\n\nOptions and results:\n\n" + "\n".join(lines) + "\n"

    def __init__(self, context):
        object.__setattr__(self, "context", context)
        object.__setattr__(self, "_h", ctypes.c_void_p())

    def __del__(self):
        if getattr(self, "_h", None):
            self.context.destroy(getattr(_c.lib, f"plm_{self._noun}_destroy"), self._h)

    def _bytes(self):
        """The state of a basis or a branch."""
        needed = ctypes.c_int64()
        self._call("write", 0, None, ctypes.byref(needed))
        data = ctypes.create_string_buffer(needed.value)
        self._call("write", needed.value, data, ctypes.byref(needed))
        return data.raw

    def _hand_to(self, write, function, *arguments):
        """By one of the functions that hand bytes to one of the user's."""
        if not callable(write):
            raise TypeError(f"write is {write!r}; needed is a function of bytes, as the write of a file opened with 'wb'")
        self._call(function, *arguments, _c.WRITE_FN(functools.partial(self.context._host.on_write, write)), None)

    def __setattr__(self, name, value):
        if name.startswith("_") or hasattr(type(self), name):
            object.__setattr__(self, name, value)
        else:
            self.set(name, value)  # the library refuses and names the nearest key

    def __getattr__(self, name):  # only where nothing else is found
        if name.startswith("_"):
            raise AttributeError(name)
        near = difflib.get_close_matches(name, [n for n in dir(type(self)) if not n.startswith("_")], 1)
        raise AttributeError(f"a plm.{type(self).__name__} has no attribute {name!r}"
                             + (f"; did you mean {near[0]!r}?" if near else f"; help(plm.{type(self).__name__}) lists them"))

    def __repr__(self):
        """What it is and how far it has come; nothing is computed for it."""
        name = f"plm.{type(self).__name__}"
        if self.context.is_busy():  # asked from inside a callback, where the library does not answer
            return f"<{name}>"
        try:
            return f"<{name}: {self._summary()}>"
        except PlmError as error:
            return f"<{name}: {self._unfinished if error.status == _c.ERR_STATE else 'without a handle'}>"

    _unfinished = "not built"  # what repr says where _summary is too early

    def _summary(self):
        """What repr says, from results that are at hand."""
        raise NotImplementedError

    # ---- options and results ----

    def set(self, key, value):
        """Sets an option to an int, float or str."""
        if self._noun == "branch":
            raise AttributeError(f"a branch is read-only: {key}")
        name = self._name_of(key)
        self._check_type(key, value)
        if isinstance(value, (bool, numpy.bool_, numbers.Integral)):
            self._call("set_int", name, int(value))
        elif isinstance(value, str):
            self._call("set_string", name, value.encode())
        elif isinstance(value, numbers.Real):
            self._call("set_double", name, float(value))
        else:
            raise TypeError(f"{key}: options are int, float or str, not {type(value).__name__}")

    def _check_type(self, key, value):
        """In the words of Python; what is no key, the library refuses."""
        row = self.keys.get(key)
        if row is None or not row.is_option:
            return
        if row.type == _c.TYPE_STRING and not isinstance(value, str):
            raise TypeError(f"{key} is one of the words {row.choices.replace(',', ', ')}, not {value!r}")
        if row.type == _c.TYPE_INT and not isinstance(value, (bool, numpy.bool_, numbers.Integral)):
            raise TypeError(f"{key} is an integer, not {value!r}")
        if row.type == _c.TYPE_DOUBLE and not isinstance(value, numbers.Real):
            raise TypeError(f"{key} is a number, not {value!r}")

    def set_options(self, options):
        """Sets options from a dict."""
        for key, value in options.items():
            self.set(key, value)

    def get(self, key):
        """An option or result: int, float, str or NumPy array; arrays over pairs are n_pairs x n."""
        name = self._name_of(key)
        row = self.keys.get(key)
        kind = row.type if row else _c.TYPE_INT  # unknown: the library refuses and names the nearest
        if kind == _c.TYPE_STRING:
            return self._get_string(name)
        if kind == _c.TYPE_ARRAY:
            return self._shaped(row, self._get_array("get_array", name, numpy.float64))
        if kind == _c.TYPE_INT_ARRAY:
            return self._shaped(row, self._get_array("get_int_array", name, numpy.int64))
        value = ctypes.c_int64() if kind == _c.TYPE_INT else ctypes.c_double()
        self._call("get_int" if kind == _c.TYPE_INT else "get_double", name, ctypes.byref(value))
        return value.value

    def options(self):
        """All options with their present values."""
        return {name: self.get(name) for name, key in self.keys.items() if key.is_option}

    def _name_of(self, key):
        if isinstance(key, str):
            return key.encode()
        raise TypeError(f"a {self._noun} is indexed by the names of its options and results, such as "
                        f"{self._noun}[\"{next(iter(self.keys))}\"], not by {key!r}{self._instead_of_index}")

    _instead_of_index = ""

    def __getitem__(self, key):
        return self.get(key)

    def __setitem__(self, key, value):
        self.set(key, value)

    def __contains__(self, key):
        return key in self.keys

    __iter__ = None  # else Python would try the indices 0, 1, ...

    def _ipython_key_completions_(self):
        return list(self.keys)

    def _get_string(self, name):
        needed = ctypes.c_int64(0)
        self._call("get_string", name, 0, None, ctypes.byref(needed))
        buffer = ctypes.create_string_buffer(max(needed.value, 1))
        self._call("get_string", name, len(buffer), buffer, None)
        return _c.text_in(buffer)

    def _get_array(self, verb, name, dtype):
        count = ctypes.c_int64(0)
        self._call(verb, name, 0, None, ctypes.byref(count))
        values = numpy.empty(count.value, dtype=dtype)
        if count.value:
            self._call(verb, name, values.size, address(values), ctypes.byref(count))
        return values

    def _get_complex(self, verb, *arguments):
        """Numbers the library copies out as verb(*arguments, capacity, real, imaginary, count)."""
        count = ctypes.c_int64(0)
        self._call(verb, *arguments, 0, None, None, ctypes.byref(count))
        real, imaginary = numpy.empty(count.value), numpy.empty(count.value)
        if count.value:
            self._call(verb, *arguments, real.size, address(real), address(imaginary), ctypes.byref(count))
        return real + 1j * imaginary

    def _shaped(self, key, values):
        if re.search(r"\bn_pairs x\b", key.description) and self._n_pairs():
            return values.reshape((self._n_pairs(), -1), order="F")
        return values

    def _n_pairs(self):
        return 0

    # ---- calls ----

    def _call(self, verb, *arguments):
        return self.context.call(f"plm_{self._noun}_{verb}", self._h, *arguments)

    def _work(self, verb, *arguments, progress=None):
        name = f"plm_{self._noun}_{verb}"
        return self.context.finish(name, self.context.run(name, self._h, *arguments, progress=progress))


def address(array):
    """Where the values of an array (or None) are."""
    return None if array is None else array.ctypes.data


def real_parts(values, name, remedy="give its real part, if the rest means nothing"):
    """An array of doubles; complex numbers are refused unless their imaginary parts are zero: nothing is cut off silently."""
    array = numpy.asarray(values)
    if numpy.iscomplexobj(array):
        largest = numpy.max(numpy.abs(array.imag), initial=0.0)
        if largest != 0:
            raise ValueError(f"{name} is complex (imaginary parts up to {largest:g}), where real numbers are needed; {remedy}")
        array = array.real
    return numpy.asarray(array, dtype=numpy.float64)


def reals(values, shape, name, what="as many as there are"):
    """A contiguous array of doubles of this shape (a number is repeated); None stays None. what: of which there are so many."""
    if values is None:
        return None
    array = real_parts(values, name)
    try:
        array = numpy.broadcast_to(array, shape)
    except ValueError:
        raise ValueError(f"{name} has shape {array.shape}; needed is {shape}, {what}") from None
    return numpy.ascontiguousarray(array)


def list_of_reals(values, name):
    """A contiguous array of doubles, as many as there are; a number is one."""
    return numpy.ascontiguousarray(numpy.atleast_1d(real_parts(values, name)))


def integers(values, name):
    """A contiguous array of int32 or int64, without a copy where it is one already."""
    array = numpy.asarray(values)
    if array.size == 0 or array.dtype == numpy.bool_:
        array = array.astype(numpy.int64)
    if not numpy.issubdtype(array.dtype, numpy.integer):
        raise TypeError(f"{name} must hold integers, not {array.dtype}")
    if array.dtype not in (numpy.int32, numpy.int64):
        array = array.astype(numpy.int64)
    return numpy.ascontiguousarray(array)


def alike(*arrays):
    """Integer arrays of one common width, and the ending of the C function for it."""
    wide = any(a.dtype != numpy.int32 for a in arrays)
    dtype = numpy.int64 if wide else numpy.int32
    return [numpy.ascontiguousarray(a, dtype=dtype) for a in arrays], "_i64" if wide else "_i32"
