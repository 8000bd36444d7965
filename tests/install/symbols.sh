#!/bin/sh
# symbols.sh LIBPLM_SO SONAME: the shared object is called SONAME and gives its host plm_ symbols and nothing else.
set -eu
readelf -d "$1" | grep -F "SONAME" | grep -F "[$2]" || { echo "SONAME is not $2"; exit 1; }
strangers=$(nm -D --defined-only "$1" | awk '$3 !~ /^plm_[a-z0-9_]+(@@PLM_[0-9.]+)?$/ && !($2 == "A" && $3 ~ /^PLM_[0-9.]+/)')
[ -z "$strangers" ] || { echo "exported beside plm_:"; echo "$strangers"; exit 1; }
echo "$(nm -D --defined-only "$1" | grep -c ' T plm_') functions exported, all plm_"
! readelf -lW "$1" | grep GNU_STACK | grep -q RWE || { echo "executable stack"; exit 1; }
