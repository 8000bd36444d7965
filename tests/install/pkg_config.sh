#!/bin/sh
# pkg_config.sh CC PREFIX SOURCE FOLDER: plain cc with the flags of the installed plm.pc, shared, static, and without any shared
# library; and what the library says it is made of is what the installed NOTICE says, with the texts of its licences.
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

# as host programs for machines without our libraries are linked
whole=yes
for archive in libc.a libgfortran.a libarpack.a; do
    [ "$("$cc" -print-file-name=$archive)" != $archive ] || whole="no $archive"
done
if [ "$whole" = yes ]; then
    # shellcheck disable=SC2046
    "$cc" -static "$source" $(pkg-config --static --cflags --libs plm) -o "$folder/whole"
    "$folder/whole"
    ! readelf -d "$folder/whole" | grep NEEDED || { echo "the fully static consumer needs shared libraries"; exit 1; }
else
    echo "no fully static link here: $whole"
fi

cat >"$folder/info.c" <<'END'
#include <plm/plm.h>
#include <stdio.h>
int main(void) {
    char line[2000];
    return plm_build_info(sizeof line, line, NULL) || puts(line) < 0;
}
END
# shellcheck disable=SC2046
"$cc" "$folder/info.c" $(pkg-config --cflags --libs plm) -Wl,-rpath,"$libdir" -o "$folder/info"
info=$("$folder/info")
notice=$(find "$prefix" -name NOTICE)
for part in CHOLMOD SCOTCH FFTW Eigen "GPL"; do
    case $info in *"$part"*) said=yes ;; *) said=no ;; esac
    if grep -v "preset permissive\|no part under" "$notice" | grep -q "$part"; then noticed=yes; else noticed=no; fi
    [ $said = $noticed ] || { echo "$part: plm_build_info says $said, NOTICE $noticed"; exit 1; }
done
named=$(grep -o '[a-z0-9.-]*\.txt' "$notice" | sort -u)
installed=$(ls "$(dirname "$notice")/licences" 2>/dev/null | sort -u)
[ "$named" = "$installed" ] || { echo "NOTICE names $named; installed are $installed"; exit 1; }
