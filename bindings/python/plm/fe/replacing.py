"""Files that are whole or not there at all."""
import contextlib
import os
import pathlib
import secrets


@contextlib.contextmanager
def replacing(path):
    """Gives the name of a new file beside `path` to write to; when all went well it takes the place of `path` in one step,
    after its bytes are on the disk. A file that others have open, or that was there before, is never half written."""
    path = pathlib.Path(path)
    beside = path.with_name(f".{path.name}.{secrets.token_hex(4)}.part")
    os.close(os.open(beside, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o666))  # with the rights that files of this user have
    try:
        yield beside
        _to_disk(beside)
        os.replace(beside, path)
        _to_disk(path.parent)  # the name, too
    except BaseException:
        with contextlib.suppress(FileNotFoundError):
            os.unlink(beside)
        raise


def _to_disk(path):
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)
