#!/bin/sh
# installed.sh FC PREFIX SOURCE_DIR FOLDER: Fortran hosts without CMake on an installed libplm: the FORTRAN 77 example
# with the layer compiled from the installed source under the host's flags, a program over the installed .mod files, and
# that program over the installed sources.
set -eu
fc=$1 prefix=$2 source=$3 folder=$4
mkdir -p "$folder"
cd "$folder"
PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name plm.pc)")
export PKG_CONFIG_PATH
libdir=$(pkg-config --variable=libdir plm)
fortran=$(dirname "$(find "$prefix/include" -name plmf.inc)")
mods=$(dirname "$(find "$prefix" -name plm.mod)")
libs="$(pkg-config --libs plm) -Wl,-rpath,$libdir"

"$fc" -std=legacy -fdefault-integer-8 -I"$fortran" "$source/examples/fortran77/chain.f" -c -o chain77.o
for file in plm_c plm_f77 plm_f77_calls plm_f77_keys; do
    "$fc" -fdefault-integer-8 -c "$fortran/$file.f90" -o "f77_$file.o"
done
# shellcheck disable=SC2086
"$fc" chain77.o f77_*.o $libs -o chain77
./chain77 | grep peak_hz

set -- "$source/tests/fortran/watchers.f90" "$source/tests/fortran/chain.f90"
mkdir -p cached compiled
# shellcheck disable=SC2086
"$fc" -Jcached -I"$mods" "$@" -L"$libdir" -lplm_fortran $libs -o chain_cached
./chain_cached | grep peak_hz
ordered=
for file in c errors context keys methods model branch reduction response motion study facts; do ordered="$ordered $fortran/plm_$file.f90"; done
# shellcheck disable=SC2086
"$fc" -Jcompiled $ordered "$fortran/plm.f90" "$@" $libs -o chain_compiled
./chain_compiled | grep peak_hz
