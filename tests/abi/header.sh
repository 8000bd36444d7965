#!/bin/sh
# header.sh CC CXX INCLUDE FOLDER LIBPLM_SO: the header alone, in every dialect a host may speak, in two translation
# units linked together.
set -eu
cc=$1 cxx=$2 include=$3 folder=$4 library=$5
mkdir -p "$folder"
strict="-pedantic -Wall -Wextra -Wundef -Wshadow -Werror -I$include -c"
libdir=$(dirname "$library")

other='#include <plm/plm.h>
PLM_DECLARE plm_status other(void);
plm_status other(void) { int32_t a, b, c; return plm_version(&a, &b, &c); }'
main='#include <plm/plm.h>
#include <stddef.h>
#include <plm/plm.h>
PLM_DECLARE plm_status other(void);
int main(void) { return (int)other() + (int)plm_context_destroy(NULL); }'

try() { # COMPILER LANGUAGE STANDARD FLAGS...
    compiler=$1 language=$2 standard=$3
    shift 3
    name=$folder/$(basename "$compiler")-$standard
    declare=extern
    [ "$language" = c ] || declare='extern "C"'
    printf '%s\n' "$other" | sed "s/PLM_DECLARE/$declare/" >"$name-other.$language"
    printf '%s\n' "$main" | sed "s/PLM_DECLARE/$declare/" >"$name-main.$language"
    # shellcheck disable=SC2086
    for unit in other main; do
        "$compiler" -std="$standard" $strict "$@" "$name-$unit.$language" -o "$name-$unit.o"
    done
    "$compiler" "$name-main.o" "$name-other.o" $link "$library" -Wl,-rpath,"$libdir" -o "$name"
    "$name"
    echo "$compiler -std=$standard"
}
link=${PLM_LINK_FLAGS-}
c_only="-Wstrict-prototypes -Wmissing-prototypes -Wc++-compat -Wdeclaration-after-statement"
for standard in c89 c99 c17; do
    # shellcheck disable=SC2086
    try "$cc" c $standard $c_only
done
for standard in c++11 c++17 c++20; do try "$cxx" cpp $standard ; done
if [ "$(basename "$cc")" != clang ] && command -v clang++ >/dev/null; then
    try clang c c89 -Wno-unknown-warning-option
    try clang++ cpp c++20 -Wno-unknown-warning-option
fi
# a unit in C and one in C++ in one program
"$cxx" "$folder/$(basename "$cc")-c89-main.o" "$folder/$(basename "$cxx")-c++20-other.o" $link "$library" \
    -Wl,-rpath,"$libdir" -o "$folder/mixed"
"$folder/mixed"
