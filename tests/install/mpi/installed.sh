#!/bin/sh
# installed.sh PREFIX SOURCE FOLDER CC CMAKE...: hosts of many ranks on an installed libplm, by CMake and by pkg-config; none of them, nor
# libplm_mpi, gives MPI to libplm.
set -eu
prefix=$1 source=$2 folder=$3 cc=$4
shift 4
"$@" --fresh -S "$source" -B "$folder" "-DCMAKE_PREFIX_PATH=$prefix" -DCMAKE_BUILD_TYPE=Debug >"$folder.log" 2>&1 || { cat "$folder.log"; exit 1; }
"$1" --build "$folder" >"$folder.log" 2>&1 || { cat "$folder.log"; exit 1; }
for host in consumer consumer_cpp consumer_fortran; do "$folder/$host"; done

PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name plm-mpi.pc)"):${PKG_CONFIG_PATH:-}
export PKG_CONFIG_PATH
# shellcheck disable=SC2046
"$cc" "$source/consumer.c" -o "$folder/by_pkg_config" $(pkg-config --cflags --libs plm-mpi) $(pkg-config --cflags --libs ompi-c) -lm \
    "-Wl,-rpath,$(pkg-config --variable=libdir plm-mpi)"
"$folder/by_pkg_config"
echo "four hosts have found 1 Hz"
