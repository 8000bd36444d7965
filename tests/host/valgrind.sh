#!/bin/sh
# valgrind.sh PROGRAM...: no error, nothing lost.
command -v valgrind >/dev/null || { echo "skipped: no valgrind (Debian: valgrind)"; exit 77; }
OPENBLAS_NUM_THREADS=1 OMP_NUM_THREADS=1 exec valgrind -q --leak-check=full --show-leak-kinds=definite,possible \
    --errors-for-leak-kinds=definite,possible --error-exitcode=9 "$@"
