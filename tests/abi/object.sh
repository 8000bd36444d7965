#!/bin/sh
# object.sh LIBPLM_SO SONAME "REQUIRED..." [LIBPLM_A]: what the loader sees. REQUIRED are names of libraries, each an
# extended regular expression ("none"; "-": no condition on NEEDED); besides them only the runtimes of the compilers are allowed.
# LIBPLM_A: given where its own objects must have been compiled with stack protector and checked copies (preset release).
set -eu
library=$1 soname=$2 required=${3-} hardened=${4-}
[ "$required" = none ] && required=
dynamic=$(readelf -dW "$library")
fail() { echo "$1"; exit 1; }

printf '%s\n' "$dynamic" | grep -q "SONAME.*\[$soname\]" || fail "SONAME is not $soname"
printf '%s\n' "$dynamic" | grep -qE 'TEXTREL' && fail "text relocations"
printf '%s\n' "$dynamic" | grep -qE 'RPATH|RUNPATH' && fail "a run path of the build machine"
stack=$(readelf -lW "$library" | grep GNU_STACK) || fail "no GNU_STACK header: the stack would be executable"
printf '%s\n' "$stack" | grep -q RWE && fail "executable stack"
readelf -lW "$library" | awk '$1 == "LOAD" && /RWE/ {exit 1}' || fail "a segment both writable and executable"
nm -D --defined-only "$library" | grep -E ' [uVvWBDR] ' && fail "exports data or weak symbols"
printf '%s\n' "$dynamic" | grep -qE 'BIND_NOW|FLAGS.* NOW' || fail "lazy binding: link with -z now"
readelf -lW "$library" | grep -q GNU_RELRO || fail "no GNU_RELRO segment: link with -z relro"
if [ -n "$hardened" ]; then # linalg/error.cpp formats text, by itself or in a unit with others (PLM_UNITY)
    imported=$(nm -A --undefined-only "$hardened" 2>/dev/null | grep -E ':(error[.]cpp|unity_[0-9]+_cxx[.]cxx)[.]o:') ||
        fail "linalg/error.cpp is not in the archive"
    printf '%s\n' "$imported" | grep -q __stack_chk_fail || fail "compiled without -fstack-protector-strong"
    printf '%s\n' "$imported" | grep -q __vsnprintf_chk || fail "compiled without _FORTIFY_SOURCE"
fi

needed=$(printf '%s\n' "$dynamic" | sed -n 's/.*NEEDED.*\[\(.*\)\]/\1/p')
echo "NEEDED:" $needed
[ "$required" != - ] || exit 0
runtimes='^(libstdc\+\+|libc\+\+|libc\+\+abi|libunwind|libm|libmvec|libgcc_s|libc|libpthread|ld-linux[-a-z0-9_]*|libgfortran|libquadmath)\.so'
for pattern in $required; do
    printf '%s\n' "$needed" | grep -qE "^lib$pattern\.so" || fail "does not need lib$pattern"
done
expected="^lib($(printf '%s' "$required" | tr ' ' '|'))\.so"
strangers=$(printf '%s\n' "$needed" | grep -vE "$runtimes" | grep -vE "$expected") || true
[ -z "$strangers" ] || fail "also needs: $strangers"
