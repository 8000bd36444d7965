"""The calls under way in this process: what Python raises on its way into their callbacks, and the end of the interpreter."""
import atexit
import os
import sys
import threading
import time
import weakref

_lock = threading.RLock()  # a handler of a signal may make a call of its own
_contexts = weakref.WeakSet()
_callbacks = set()  # codes of the methods that the library calls
_hook_before = None
_ending = False
if hasattr(os, "fork"):  # a child process must not find it taken by a thread that it has not got
    os.register_at_fork(before=_lock.acquire, after_in_parent=_lock.release, after_in_child=_lock.release)
PATIENCE = 5  # seconds that a function of the user may take at the end of the interpreter


def callback(function):
    """Marks a method of a host of callbacks as one that the library calls."""
    _callbacks.add(function.__code__)
    return function


def register(context):
    """Contexts whose calls are waited for."""
    with _lock:
        _contexts.add(context)


def begin(context):
    """A call begins, or one from inside a callback."""
    global _hook_before
    if _ending and threading.current_thread() is not threading.main_thread():
        raise SystemExit  # of this thread, and silent: Python would end it at its next step
    if context._depth == 1:
        context._thread = threading.get_ident()
    with _lock:
        if sys.unraisablehook is not _keep:
            _hook_before, sys.unraisablehook = sys.unraisablehook, _keep


def end():
    """Some call is over."""
    with _lock:
        if sys.unraisablehook is _keep and not any(c.is_busy() for c in _contexts):
            sys.unraisablehook = _hook_before


def _keep(unraisable):
    """Python asks for signals when it begins a function: what their handlers raise then (a time limit, Ctrl-C) leaves a callback
    before any try of its can catch it, and ctypes drops it. It is kept for the end of the call, as what callbacks raise is."""
    trace = unraisable.exc_traceback
    while trace is not None:
        frame, trace = trace.tb_frame, trace.tb_next
        if frame.f_code in _callbacks:
            frame.f_locals["self"].keep(unraisable.exc_value or unraisable.exc_type())
            return
    _hook_before(unraisable)


def _is_waited_for(context):
    """Whether another thread is inside a call of the context. (A fork leaves such a call, but not the thread.)"""
    since = context._host.in_function_since
    return (context.is_busy() and context._thread != threading.get_ident() and context._thread in sys._current_frames()
            and not (since is not None and time.monotonic() - since > PATIENCE))


@atexit.register
def _end_of_interpreter():
    """Daemon threads that want to run Python now are ended by it, inside a callback inside a call, and the process with them:
    their calls are cancelled and waited for, but for one that a function of the user holds up."""
    global _ending
    _ending = True
    with _lock:
        contexts = list(_contexts)
    for context in contexts:
        context._host.stopped = context.is_busy() and context._thread != threading.get_ident()
        while _is_waited_for(context):
            time.sleep(0.005)
