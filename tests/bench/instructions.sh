#!/bin/sh
# Instructions of two fixed scenes by phase, counted by callgrind on one thread with OpenBLAS's kernels for AVX2: figures
# that no neighbour on the machine disturbs. The set-up is that of the small cracked plate with nothing set, the curve that
# of examples/c/minimal.c: valgrind has no arithmetic of 80 bits, which OpenBLAS's norms count on, and the multipliers of
# larger exact motions do not converge in it. Not a test: prints Markdown.
#
#     sh tests/bench/instructions.sh build/release
set -eu
counts=$(mktemp)
trap 'rm -f "$counts"' EXIT

# rows SCENE FUNCTIONS PROGRAM ARGUMENT...
rows() {
    scene=$1 functions=$2
    shift 2
    OPENBLAS_NUM_THREADS=1 OPENBLAS_CORETYPE=HASWELL \
        valgrind -q --tool=callgrind --callgrind-out-file="$counts" "$@" > /dev/null
    callgrind_annotate --inclusive=yes --threshold=100 "$counts" | awk -v scene="$scene" -v wanted=":plm_($functions) " '
        match($0, wanted) {
            name = substr($0, RSTART + 1, RLENGTH - 2)
            gsub(",", "", $1)
            printf "| %s | `%s` | %.1f |\n", scene, name, $1 / 1e6
        }'
}

echo "| scene | function | instructions, millions |"
echo "|--|--|--:|"
rows "cracked plate, quick" "model_build|sampler_run|basis_build" "$1/tests/bench/bench_defaults" cracked_plate quick no-preload set-up
rows "minimal.c" "hbm_sweep|hbm_find_peak" "$1/examples/c/minimal"
