"""How long each format takes to read: a block of bricks' pattern, written and read back.

    fe_reading_times.py [CELLS [FORMAT ...]]    27 cells along each side by default: 59,049 DOFs, 2.2 million entries in a triangle
"""
import os
import sys
import tempfile
import time

import numpy
import scipy.sparse
from plm.fe import Matrices, read_matrices, write_matrices
from plm.fe.matrices import WRITERS


def block(cells):
    """Matrices with the pattern of a cube of 8-node bricks, values drawn by chance; nodes count from 1."""
    band = scipy.sparse.diags([1.0, 1.0, 1.0], [-1, 0, 1], shape=(cells, cells))
    pattern = scipy.sparse.kron(scipy.sparse.kron(band, band), scipy.sparse.kron(band, numpy.ones((3, 3))), "csr")
    pattern.data = numpy.random.default_rng(1).normal(size=pattern.nnz)
    lower = scipy.sparse.tril(pattern, -1, "csr")
    stiffness = lower + lower.T + 200.0 * scipy.sparse.identity(pattern.shape[0])
    nodes = numpy.arange(1, cells**3 + 1)
    return Matrices(stiffness, 1e-9 * stiffness, dofs=numpy.column_stack([numpy.repeat(nodes, 3), numpy.tile([1, 2, 3], len(nodes))]))


def main():
    matrices = block(int(sys.argv[1]) if len(sys.argv) > 1 else 27)
    print(f"{matrices.n_dof} DOFs, {scipy.sparse.tril(matrices.stiffness).nnz} entries in a triangle")
    for name in sys.argv[2:] or [name for name in WRITERS if name != "abaqus-substructure"]:  # which is dense
        with tempfile.TemporaryDirectory() as folder:
            paths = write_matrices(os.path.join(folder, "block"), matrices, name)
            begin, processor = time.monotonic(), time.process_time()
            found = read_matrices(paths[0])
            seconds, processor = time.monotonic() - begin, time.process_time() - processor
            size = sum(os.path.getsize(path) for path in found.source)
            print(f"{name:18s} {size / 1e6:6.0f} MB in {seconds:5.1f} s, {processor:5.1f} s of a processor", flush=True)


if __name__ == "__main__":
    main()
