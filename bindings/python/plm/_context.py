"""The context: callbacks, the host's solver, failures turned into exceptions, cancel by Ctrl-C."""
import contextlib
import ctypes
import logging
import pathlib
import re
import sys
import threading
import time
import warnings

import numpy
import scipy.sparse

from . import _c, _calls
from ._calls import callback
from ._errors import PlmWarning, make_error
from ._handle import real_parts
from ._progress import make_bar

_logger = logging.getLogger("plm")
_LEVELS = (logging.DEBUG, logging.INFO, logging.WARNING)


def _log_to_logging(level, text):
    _logger.log(_LEVELS[max(0, min(level, 2))], "%s", text)


class _Host:
    """What runs inside a call: the user's functions, and what they raised. Apart from Context, so that no cycle forms."""

    def __init__(self):
        self.log = self.progress = self.bar = self.solver = self.inertia = None
        self.raised = None  # what a callback raised, or the handler of a signal meanwhile: Ctrl-C's, a time limit's
        self.stopped = False  # the interpreter ends
        self.in_function_since = None  # when a function of the user was called
        self.factors = {}

    def keep(self, error):
        """For the end of the call under way; the first one counts."""
        if self.raised is None:
            self.raised = error

    @callback
    def on_log(self, _ctx, level, text, _user):
        self.guarded(lambda: self.log(level, text.decode("utf-8", "replace")))

    @callback
    def on_progress(self, _ctx, stage, fraction, _user):
        stop = self.guarded(lambda: self._progress_now(stage.decode("utf-8", "replace"), fraction))
        return int(bool(stop) or self.raised is not None or self.stopped)

    def _progress_now(self, stage, fraction):
        if self.bar is not None:
            return self.bar(stage, fraction)
        return self.progress(stage, fraction) if callable(self.progress) else False

    def guarded(self, function):
        """Calls a function of the user; keeps what it raises."""
        if self.raised is not None:
            return None
        try:
            self.in_function_since = time.monotonic()
            return function()
        except BaseException as error:  # pylint: disable=broad-except
            self.keep(error)
            return None
        finally:
            self.in_function_since = None

    @callback
    def on_factor(self, _ctx, n, col_ptr, row, value, positive_definite, out, _user):
        def factor():
            starts = look(col_ptr, n + 1, ctypes.c_int64).copy()
            nnz = int(starts[n])
            lower = scipy.sparse.csc_matrix((look(value, nnz, ctypes.c_double).copy(),
                                             look(row, nnz, ctypes.c_int64).copy(), starts), shape=(n, n))
            matrix = (lower + scipy.sparse.tril(lower, -1).T).tocsc()
            solve = self.solver(matrix, bool(positive_definite))
            key = max(self.factors, default=0) + 1
            self.factors[key] = (solve, n)
            out[0] = key
            return True
        return 0 if self.guarded(factor) else 1

    @callback
    def on_solve(self, _ctx, key, n_rhs, x, ld, _user):
        def run():
            solve, n = self.factors[key]
            columns = look(x, ld * n_rhs, ctypes.c_double).reshape((ld, n_rhs), order="F")[:n]
            columns[...] = real_parts(solve(columns.copy(order="F")), "the solution").reshape(columns.shape)
            return True
        return 0 if self.guarded(run) else 1

    @callback
    def on_inertia(self, _ctx, key, negative, _user):
        def count():
            negative[0] = int(self.inertia(self.factors[key][0]))
            return True
        return 0 if self.guarded(count) else 1

    @callback
    def on_free(self, _ctx, key, _user):
        self.factors.pop(key, None)

    @callback
    def on_recover(self, recover, _ctx, n_dof, n_columns, reduced, size, full, _user):
        def run():
            q = look(reduced, n_dof * n_columns, ctypes.c_double).reshape((n_dof, n_columns), order="F")
            whole = real_parts(recover(q.copy(order="F")), "the recovered motion").reshape((size, n_columns))
            look(full, size * n_columns, ctypes.c_double).reshape((size, n_columns), order="F")[...] = whole
            return True
        return 0 if self.guarded(run) else 1


    @callback
    def on_write(self, write, _ctx, n, data, _user):
        def run():
            write(ctypes.string_at(data, n))
            return True
        return 0 if self.guarded(run) else 1


class Context:
    """What models share: log, progress, solver, the last error. Belongs to one thread at a time.

    log       None: silence; True: the logger "plm"; or a function of (level, text), level 0 detail, 1 information, 2 warning
    progress  None; True: a bar (tqdm if present); or a function of (stage, fraction) that returns True to cancel

    An exception that leaves a function given here stops the call under way, which raises it again; so does one that the
    handler of a signal raises meanwhile, Ctrl-C's or that of a time limit. When the interpreter ends, calls under way in daemon
    threads are cancelled.
    """

    def __init__(self, log=None, progress=None):
        self._h = ctypes.c_void_p()
        self._depth = 0  # calls under way: more than one when a callback calls in
        self._thread = None  # of the last call
        self._orphans = []  # handles that were collected while a call was under way
        self._host = _Host()
        # kept alive here: ctypes does not
        self._callbacks = [_c.LOG_FN(self._host.on_log), _c.PROGRESS_FN(self._host.on_progress)]
        self._solver_callbacks = [_c.FACTOR_FN(self._host.on_factor), _c.SOLVE_FN(self._host.on_solve),
                                  _c.FREE_FACTOR_FN(self._host.on_free)]
        self._inertia_callback = _c.INERTIA_FN(self._host.on_inertia)
        status = _c.lib.plm_context_create(_c.API_VERSION, ctypes.byref(self._h))
        if status != _c.OK:
            raise make_error("plm_context_create: " + status_text(status), status, function="plm_context_create")
        _calls.register(self)
        # always there: Ctrl-C cancels by way of it
        self.call("plm_context_set_progress", self._h, ctypes.cast(self._callbacks[1], ctypes.c_void_p), None)
        self.log, self.progress = log, progress

    def __repr__(self):
        return (f"<plm.Context: log {'on' if self.log else 'off'}, progress {'on' if self.progress else 'off'}, "
                f"{'a solver of the user' if self._host.solver else 'built-in solver'}>")

    def __del__(self):
        if getattr(self, "_h", None):
            _c.lib.plm_context_destroy(ctypes.byref(self._h))

    # ---- callbacks ----

    @property
    def log(self):
        """Where the log goes; see the class."""
        return self._host.log

    @log.setter
    def log(self, log):
        self._host.log = _log_to_logging if log is True else (log or None)
        function = ctypes.cast(self._callbacks[0], ctypes.c_void_p) if self._host.log else None
        self.call("plm_context_set_log", self._h, function, None)

    @property
    def progress(self):
        """What is told of the progress; see the class."""
        return self._host.progress

    @progress.setter
    def progress(self, progress):
        self._host.progress = progress

    def set_effort(self, seconds):
        """What a search (compute_response, sweep, ...) may cost, in seconds of one core as its operations are counted: 10 by
        default, or what making the basis took if that is more; 0: no limit. Results depend on it, not on the clock."""
        self.call("plm_context_set_effort", self._h, seconds)

    def set_threads(self, n):
        """How many threads a call may use, 1 by default; results are the same for any number."""
        self.call("plm_context_set_threads", self._h, n)

    # ---- the user's own solver ----

    def set_solver(self, factor, inertia=None):
        """Factorization by the user, for models built afterwards; None: the one built in.

        factor(matrix, positive_definite) receives a symmetric scipy.sparse.csc_matrix and returns a function that solves:
        solve(right_hand_sides) -> solutions, both n x n_rhs. Example:

            context.set_solver(lambda matrix, positive_definite: scipy.sparse.linalg.splu(matrix).solve)

        inertia(solve) returns the number of negative eigenvalues of the matrix that `solve` belongs to, or -1; with it the
        number of modes found is verified.
        """
        self._host.solver, self._host.inertia = factor, inertia
        functions = [ctypes.cast(f, ctypes.c_void_p) if factor else None for f in self._solver_callbacks]
        self.call("plm_context_set_solver", self._h, *functions, None)
        if factor and inertia:
            self.call("plm_context_set_inertia", self._h, ctypes.cast(self._inertia_callback, ctypes.c_void_p))

    # ---- calls ----

    def call(self, name, *arguments):
        """Calls a C function; returns its status when that is >= 0, else raises."""
        return self._checked(name, self._run(name, arguments))

    def run(self, name, *arguments, progress=None):
        """The same for work that takes time: with progress, Ctrl-C cancels. The status is checked by `finish`."""
        with self._showing(progress):
            return self._run(name, arguments)

    def finish(self, name, status, has_result=False):
        """What `run` returned, or an exception; a cancelled call without a result is one, too. Other outcomes above 0 are
        PlmWarnings."""
        self._checked(name, status)
        if status == _c.CANCELLED:
            if not has_result:
                self._fail(name, status)
        elif status > 0:
            known, reason = self._last(name, status)
            text = _c.text_of(_c.lib.plm_context_get_error_text, self._h) if known else f"{name}: {status_text(status)}"
            warnings.warn(PlmWarning(text, status, reason), stacklevel=_depth_of_caller())
        return status

    def _run(self, name, arguments):
        if not self._depth:
            self._host.raised = None
            while self._orphans:
                destroy, handle = self._orphans.pop()
                destroy(ctypes.byref(handle))
        self._depth += 1
        try:
            _calls.begin(self)
            return getattr(_c.lib, name)(*arguments)
        except ctypes.ArgumentError as error:
            raise TypeError(_in_words(name, str(error))) from None
        finally:
            self._depth -= 1
            _calls.end()

    def _checked(self, name, status):
        if self._depth == 0 and self._host.raised is not None:
            error, self._host.raised = self._host.raised, None
            raise error
        if self._depth == 0 and self._host.stopped:
            raise SystemExit  # the thread's, and silent
        if status < 0:
            self._fail(name, status)
        return status

    def _last(self, name, status):
        """(whether the context's text is about this call, its reason): of a dead handle, of a call from inside a callback or
        beside another thread's the context has not heard."""
        known, reason = ctypes.c_int32(0), ctypes.c_int32(0)
        _c.lib.plm_context_get_error_info(self._h, ctypes.byref(known), ctypes.byref(reason), None, None)
        function = _c.text_of(_c.lib.plm_context_get_error_function, self._h)
        return function == name and known.value == status, reason.value

    def _fail(self, name, status):
        known, reason = self._last(name, status)
        if not known:
            raise make_error(f"{name}: {status_text(status)}", status, function=name)
        index, code = ctypes.c_int64(-1), ctypes.c_int64(0)
        _c.lib.plm_context_get_error_info(self._h, None, None, ctypes.byref(index), ctypes.byref(code))
        raise make_error(_c.text_of(_c.lib.plm_context_get_error_text, self._h), status, reason=reason, function=name,
                         index=index.value, library_code=code.value,
                         argument=_c.text_of(_c.lib.plm_context_get_error_argument, self._h))

    def is_busy(self):
        """Whether a call is under way: in this thread, which then is inside a callback, or in another one."""
        return self._depth > 0

    def destroy(self, function, handle):
        """Destroys a child, or remembers to do so when a call is under way (garbage collected inside a callback)."""
        if self._depth:
            self._orphans.append((function, handle))
            return
        self._depth += 1
        try:
            function(ctypes.byref(handle))
        finally:
            self._depth -= 1

    @contextlib.contextmanager
    def _showing(self, progress):
        """progress of one call: None: the context's own; True: a bar; False: nothing; or a function."""
        before, bar = self._host.bar, None
        wanted = self.progress if progress is None else progress
        if wanted is True:
            self._host.bar = bar = make_bar()
        elif progress is not None:
            self._host.bar = progress or (lambda stage, fraction: False)
        try:
            yield
        finally:
            self._host.bar = before
            if bar is not None:
                bar.close()


def _in_words(name, told):
    """What ctypes says of an argument ("argument 2: TypeError: ..."), by the argument's name."""
    found = re.match(r"argument (\d+): (?:<class 'TypeError'>: |TypeError: )?(.*)", told)
    return f"{name}: {_c.lib.argument_names[name][int(found[1]) - 1]}: {found[2]}" if found else f"{name}: {told}"


_PACKAGE = str(pathlib.Path(__file__).parent)


def _depth_of_caller():
    """The stacklevel for warnings.warn, called one frame above, that names the user's line."""
    level, frame = 1, sys._getframe(1)
    while frame.f_back is not None and frame.f_code.co_filename.startswith(_PACKAGE):
        level, frame = level + 1, frame.f_back
    return level


def look(address, n, kind):
    """A NumPy array over n values in memory of the library."""
    if n == 0:
        return numpy.empty(0, dtype=kind)
    return numpy.ctypeslib.as_array(ctypes.cast(address, ctypes.POINTER(kind)), shape=(n,))


def status_text(status):
    """What a status means."""
    return _c.text_of(_c.lib.plm_status_text, status)


def version():
    """(major, minor, patch) of the library."""
    parts = [ctypes.c_int32() for _ in range(3)]
    _c.lib.plm_version(*map(ctypes.byref, parts))
    return tuple(p.value for p in parts)


def build_info():
    """One line: version, factorization, eigensolver, Fourier transform, BLAS, components built in, licence of the whole."""
    return _c.text_of(_c.lib.plm_build_info)


_default = threading.local()


def default_context():
    """The context of models made without one; each thread has its own."""
    if not hasattr(_default, "context"):
        _default.context = Context()
    return _default.context
