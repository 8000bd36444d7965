#!/bin/sh
# blas_kernels.sh CC AR OBJCOPY LIBOPENBLAS_A OUTPUT: what of the archive asks the system for something, as one object that asks us:
# the kernels for small products for memory, the choice of the processor for the environment.
set -eu
cc=$1 ar=$2 objcopy=$3 archive=$4 output=$5
folder=$output.members
rm -rf "$folder" && mkdir -p "$folder" && cd "$folder"
members=$("$ar" t "$archive" | grep -E 'gemm_small_kernel|^dynamic\.o$' | sort -u) || members=
if [ -z "$members" ]; then # an OpenBLAS for one processor, without them
    : >empty.c && "$cc" -c empty.c -o "$output"
    exit 0
fi
# shellcheck disable=SC2086
"$ar" x "$archive" $members
"$cc" -r -nostdlib -o all.o ./*.o
"$objcopy" --redefine-sym malloc=carried_blas_malloc --redefine-sym free=carried_blas_free \
    --redefine-sym getenv=carried_blas_getenv all.o "$output"
rm -f ./*.o
