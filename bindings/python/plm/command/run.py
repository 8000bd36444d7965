"""Runs a command, and says in an exit status how it went."""
import importlib
import os
import sys
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
    except (ValueError, FileNotFoundError, FileExistsError, IsADirectoryError, NotADirectoryError, PermissionError) as error:
        return _end(error, WRONG)
    except (OSError, ImportError, MemoryError) as error:
        return _end(str(error) or type(error).__name__, FAILED)
    except Exception:  # pylint: disable=broad-except
        traceback.print_exc()
        return _end("this is a defect of plm: please report the lines above", FAILED)


def _run(arguments):
    command, settings, quiet = read_arguments(arguments)
    if settings["out"]:
        os.makedirs(settings["out"], exist_ok=True)  # before hours of work for it
    console = Console(quiet)
    console.context.set_threads(settings["threads"])
    if settings["effort"] is not None:
        console.context.set_effort(settings["effort"])
    work = importlib.import_module(f".{command}", __package__)
    work.run(settings, console)
    return LOOK_AT_IT if console.matters else ALL_WELL


def _end(message, status):
    print(f"plm: {message}", file=sys.stderr)
    return status
