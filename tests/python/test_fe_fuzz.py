"""Mutated files of every format: whatever stands in them, matrices or a FileError come out, and no absurd size is asked for.

    test_fe_fuzz.py [SECONDS [SEED]]    see fuzzing.py
"""
import os
import pathlib
import random
import resource
import sys
import tempfile
import time
import warnings

from plm.fe import FileError, read_matrices
from plm.fe.matrices import READERS

from fuzzing import seconds_and_seed
from test_fe_formats import FORMATS, GOOD, unpacked

MEMORY = 3 << 30  # bytes of address space: a size that was believed unchecked shows as a MemoryError
SECONDS_EACH = 1.0  # of processor time for a file of a few hundred bytes; it takes a thousandth of that
LEAST = 150  # files, however busy the machine is
NUMBERS = [b"0", b"-1", b"1", b"7", b"99999", b"2147483648", b"-9223372036854775808", b"1e999", b"nan", b"4294967296", b"16777216",
           b"1_0"]


def mutated(data, rng):
    """One to four changes: bits, bytes, pieces cut, doubled or moved, numbers and lines changed for others."""
    data = bytearray(data)
    for _ in range(rng.randint(1, 4)):
        if not data:
            return bytes(data)
        at, length = rng.randrange(len(data)), rng.choice((1, 2, 4, 8, 30))
        kind = rng.randrange(8)
        if kind == 0:
            data[at] ^= 1 << rng.randrange(8)
        elif kind == 1:
            data[at:at + length] = bytes(rng.randrange(256) for _ in range(length))
        elif kind == 2:
            del data[at:at + length]
        elif kind == 3:
            data[at:at] = data[at:at + length]
        elif kind == 4:
            del data[at:]
        elif kind == 5:
            begin = at
            while begin < len(data) and data[begin:begin + 1].isspace():
                begin += 1
            end = begin
            while end < len(data) and not data[end:end + 1].isspace() and data[end:end + 1] != b",":
                end += 1
            data[begin:end] = rng.choice(NUMBERS)
        elif kind == 6:
            lines = bytes(data).split(b"\n")
            i, j = rng.randrange(len(lines)), rng.randrange(len(lines))
            lines[i], lines[j] = lines[j], lines[i]
            data = bytearray(b"\n".join(lines))
        else:
            data[at:at + 4] = rng.choice((b"\xff\xff\xff\x7f", b"\x00\x00\x00\x80", b"\x7f\xff\xff\xff", b"\0\0\0\0", b"\xff\xff\xff\xff"))
    return bytes(data)


def tried(path, format):
    """True if matrices came out, False for a FileError. Anything else is the failure that is looked for."""
    begin = time.process_time()
    try:
        found = read_matrices(path, format=format)
    except FileError as error:
        assert error.text and error.file and error.line >= 0
        assert time.process_time() - begin < SECONDS_EACH, error
        return False
    assert time.process_time() - begin < SECONDS_EACH
    assert found.stiffness.shape == found.mass.shape == (len(found.dofs),) * 2
    assert abs(found.stiffness - found.stiffness.T).max() <= 1e-9 * abs(found.stiffness).max()
    return True


def main():
    seconds, seed = seconds_and_seed(3.0, 20)
    if "asan" not in os.environ.get("LD_PRELOAD", ""):  # which takes all of the address space for itself
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, resource.getrlimit(resource.RLIMIT_AS)[1]))
    warnings.simplefilter("ignore")
    rng, counts, read = random.Random(seed), {}, 0
    with tempfile.TemporaryDirectory() as folder:
        folder = unpacked(FORMATS / "good", pathlib.Path(folder))
        originals = {path: path.read_bytes() for path in sorted(folder.iterdir()) if path.is_file()}
        end = time.monotonic() + seconds
        while time.monotonic() < end or sum(counts.values()) < LEAST:
            victim = rng.choice(list(originals))
            opened = folder / rng.choice(list(GOOD)) if rng.random() < 0.2 or victim.suffix in (".dof", ".mapping") else victim
            data = mutated(originals[victim], rng)
            victim.write_bytes(data)
            try:
                read += tried(opened, rng.choice(READERS).NAME if rng.random() < 0.1 else None)
            except Exception as error:
                kept = pathlib.Path(tempfile.gettempdir(), f"fe_fuzz_{seed}_{victim.name}")
                kept.write_bytes(data)
                sys.exit(f"{type(error).__name__}: {error}\n{victim.name} changed, {opened.name} opened; the file is kept as {kept}")
            victim.write_bytes(originals[victim])
            counts[victim.suffix] = counts.get(victim.suffix, 0) + 1
    total = sum(counts.values())
    print(f"{total} mutated files, {read} read, {total - read} refused: {counts}")
    # both must happen, else the fuzzer tries nothing
    sys.exit(0 if read > 0.02 * total and total - read > 0.2 * total else f"read {read} of {total}")


if __name__ == "__main__":
    main()
