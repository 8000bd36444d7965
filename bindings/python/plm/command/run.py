"""Runs a command, and says in an exit status how it went."""
import contextlib
import importlib
import os
import sys
import tempfile
import traceback

from .. import _functions as constants
from .._errors import PlmError
from ..fe.errors import FileError
from .arguments import read_arguments
from .console import Console
from .settings import Wrong

ALL_WELL, LOOK_AT_IT, WRONG, FAILED, STOPPED = 0, 1, 2, 3, 130
# refused by the library for what it was given
_REFUSED = {constants.ERR_ARGUMENT, constants.ERR_KEY, constants.ERR_MATRIX, constants.ERR_NOT_POSITIVE_DEFINITE}


def main(arguments=None):
    """The exit status of `plm arguments`."""
    with contextlib.suppress(AttributeError):  # names of a deck that the terminal cannot show
        sys.stdout.reconfigure(errors="backslashreplace")
    try:
        status = _run(sys.argv[1:] if arguments is None else arguments)
        sys.stdout.flush()
        return status
    except BrokenPipeError:  # who reads the results has seen enough
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return ALL_WELL
    except KeyboardInterrupt:
        return _end("stopped", STOPPED)
    except (Wrong, FileError) as error:
        return _end(error, WRONG)
    except PlmError as error:
        return _end(error, WRONG if error.status in _REFUSED else FAILED)
    except (FileNotFoundError, FileExistsError, IsADirectoryError, NotADirectoryError, PermissionError) as error:
        return _end(_in_words(error), WRONG)
    except ValueError as error:
        return _end(error, WRONG)
    except (OSError, ImportError, MemoryError) as error:
        return _end(_in_words(error), FAILED)
    except Exception:  # pylint: disable=broad-except
        traceback.print_exc()
        return _end("this is a defect of plm: please report the lines above", FAILED)


def _run(arguments):
    command, settings, quiet = read_arguments(arguments)
    if settings["out"]:
        _make_folder(settings["out"])  # before hours of work for it
    console = Console(quiet)
    console.context.set_threads(settings["threads"])
    if settings["effort"] is not None:
        console.context.set_effort(settings["effort"])
    work = importlib.import_module(f".{command}", __package__)
    with console.explaining():
        work.run(settings, console)
    return LOOK_AT_IT if console.matters else ALL_WELL


def _make_folder(folder):
    """Makes it where it is not there; refuses one that takes no files."""
    try:
        os.makedirs(folder, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
    except (FileExistsError, NotADirectoryError):
        raise Wrong(f"out: {folder} is a file, or a part of it is; name a folder") from None
    except OSError as error:
        raise Wrong(f"out: no files can be written to {folder}: {error.strerror or error}") from None


def _in_words(error):
    """Which file and what, without the number of the system."""
    if isinstance(error, OSError) and error.strerror:
        return f"{error.filename}: {error.strerror}" if error.filename else error.strerror
    return str(error) or type(error).__name__


def _end(message, status):
    print(f"plm: {message}", file=sys.stderr)
    return status
