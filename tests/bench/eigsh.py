#!/usr/bin/env python3
"""Set-up of the solid block of bench_scale against one modal analysis by SciPy's eigsh (ARPACK, shift-invert) with the
library's own factor of K, in one process. Seconds of the processor; prints Markdown.

    OPENBLAS_NUM_THREADS=1 python3 tests/bench/eigsh.py build/release/tests/bench/libeigsh_factor.so [DOFS]
"""
import ctypes
import sys
import time

import numpy
import scipy.sparse
from scipy.sparse.linalg import LinearOperator, eigsh

N_MODES = 30


def seconds_of(step):
    begin = time.process_time()
    result = step()
    return time.process_time() - begin, result


def matrix(library, which, n, entries):
    pointers, rows = numpy.empty(n + 1, numpy.int64), numpy.empty(entries, numpy.int64)
    values = numpy.empty(entries)
    library.eigsh_matrix(which, *(a.ctypes.data_as(ctypes.c_void_p) for a in (pointers, rows, values)))
    return scipy.sparse.csc_matrix((values, rows, pointers), shape=(n, n))


def main():
    if len(sys.argv) < 2:
        sys.exit(__doc__)
    library = ctypes.CDLL(sys.argv[1])
    library.eigsh_set_up.restype = ctypes.c_int64
    sizes = (ctypes.c_int64 * 4)()
    dofs = float(sys.argv[2]) if len(sys.argv) > 2 else 70000.0
    if library.eigsh_make(ctypes.c_double(dofs), sizes) != 0:
        sys.exit("the solid was not made")
    n = sizes[0]
    stiffness, mass = matrix(library, 0, n, sizes[1]), matrix(library, 1, n, sizes[2])

    def solve(b):
        x = numpy.array(b, dtype=float).ravel()
        library.eigsh_solve(x.ctypes.data_as(ctypes.c_void_p))
        return x

    factor, _ = seconds_of(library.eigsh_factor)
    inverse = LinearOperator((n, n), matvec=solve, dtype=float)
    modes, values = seconds_of(
        lambda: eigsh(stiffness, N_MODES, mass, sigma=0, OPinv=inverse, return_eigenvectors=True)[0])
    highest = float(numpy.sqrt(values.max()))
    set_up, size = seconds_of(lambda: library.eigsh_set_up(ctypes.c_double(highest), N_MODES))
    print("| DOFs | pairs | factor | eigsh, 30 modes | set-up | size of the contact space | set-up / (factor + eigsh) |")
    print("|--|--|--|--|--|--|--|")
    print(f"| {n} | {sizes[3]} | {factor:.2f} | {modes:.2f} | {set_up:.2f} | {size} | {set_up / (factor + modes):.2f} |")


main()
