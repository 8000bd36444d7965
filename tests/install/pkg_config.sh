#!/bin/sh
# pkg_config.sh CC PREFIX SOURCE FOLDER: plain cc with the flags of the installed plm.pc, shared and static.
set -eu
cc=$1 prefix=$2 source=$3 folder=$4
mkdir -p "$folder"
PKG_CONFIG_PATH=$(dirname "$(find "$prefix" -name plm.pc)")
export PKG_CONFIG_PATH
libdir=$(pkg-config --variable=libdir plm)
[ -e "$libdir/libplm.so" ] || { echo "plm.pc: no libplm.so in libdir = $libdir"; exit 1; }

needs_shared() { readelf -d "$1" | grep -q 'NEEDED.*libplm'; }

# shellcheck disable=SC2046
"$cc" "$source" $(pkg-config --cflags --libs plm) -lm -Wl,-rpath,"$libdir" -o "$folder/shared"
"$folder/shared"
needs_shared "$folder/shared" || { echo "the shared consumer does not use libplm.so"; exit 1; }

# -l:libplm.a, as the linker would take libplm.so first
# shellcheck disable=SC2046
"$cc" "$source" $(pkg-config --static --cflags --libs plm | sed 's/-lplm\>/-l:libplm.a/') -o "$folder/static"
"$folder/static"
! needs_shared "$folder/static" || { echo "the static consumer needs libplm.so"; exit 1; }
