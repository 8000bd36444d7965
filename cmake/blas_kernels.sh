#!/bin/sh
# blas_kernels.sh CC AR OBJCOPY LIBOPENBLAS_A OUTPUT: the kernels for small products from the archive as one object, calling
# carried_blas_malloc and carried_blas_free in place of malloc and free.
set -eu
cc=$1 ar=$2 objcopy=$3 archive=$4 output=$5
folder=$output.members
rm -rf "$folder" && mkdir -p "$folder" && cd "$folder"
members=$("$ar" t "$archive" | grep 'gemm_small_kernel' | sort -u) || members=
if [ -z "$members" ]; then # an OpenBLAS without them
    : >empty.c && "$cc" -c empty.c -o "$output"
    exit 0
fi
# shellcheck disable=SC2086
"$ar" x "$archive" $members
"$cc" -r -nostdlib -o all.o ./*.o
"$objcopy" --redefine-sym malloc=carried_blas_malloc --redefine-sym free=carried_blas_free all.o "$output"
rm -f ./*.o
