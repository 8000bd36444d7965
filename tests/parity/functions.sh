#!/bin/sh
# functions.sh CXX INCLUDE_DIR: plm.hpp uses every function of plm.h. Lists those it lacks.
set -eu
header=$2/plm/plm.h
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
# plm.hpp after its macros, without plm.h
"$1" -std=c++17 -E -P -DPLM_PLM_H -I"$2" "$2/plm/plm.hpp" -o "$work/hpp"
grep -o 'plm_[a-z0-9_]*' "$work/hpp" | sort -u >"$work/used"
sed -n 's/^PLM_API plm_status \(plm_[a-z0-9_]*\)(.*/\1/p' "$header" | sort -u >"$work/declared"
count=$(wc -l <"$work/declared")
[ "$count" -gt 90 ] || { echo "only $count functions found in $header"; exit 1; }
missing=$(comm -23 "$work/declared" "$work/used")
[ -z "$missing" ] || { echo "plm.hpp lacks:"; echo "$missing"; exit 1; }
echo "plm.hpp uses all $count functions of plm.h"
