#!/bin/sh
# build_sizes.sh [FOLDER]: what leaving parts out of the build saves, as Markdown on standard output.
# Builds the library four times in FOLDER (build/sizes) and links examples/c/minimal.c to each archive, once with the
# system's shared libraries and once with its archives, as far as these can be linked. All is stripped.
set -eu
root=$(CDPATH='' cd -- "$(dirname -- "$0")/../.." && pwd)
folder=${1-$root/build/sizes}
export CMAKE_GENERATOR="${CMAKE_GENERATOR:-Unix Makefiles}"
mkdir -p "$folder"

kilobytes() { echo $(($(stat -L -c %s "$1") / 1000)); }
functions() { nm "$1" | grep -c ' [TtWw] .*plm' || true; } # of libplm in a linked program, before it is stripped

# build NAME OPTION...
build() {
    name=$1
    shift
    {
        cmake -S "$root" -B "$folder/$name" -DCMAKE_BUILD_TYPE=Release -DPLM_BUILD_TESTS=OFF -DPLM_BUILD_EXAMPLES=OFF "$@"
        cmake --build "$folder/$name" --parallel "${JOBS:-2}" --target plm plm_static
    } >"$folder/$name.log" 2>&1 || { tail -20 "$folder/$name.log" >&2; exit 1; }
}

# link NAME OUTPUT LIBRARY...: the host, its unused sections dropped.
link() {
    output=$folder/$1/$2
    archive=$folder/$1/src/libplm.a
    shift 2
    "${CC:-cc}" -O2 -I"$root/include" "$root/examples/c/minimal.c" "$archive" "$@" -Wl,--gc-sections -o "$output"
    cp "$output" "$output.named"
    strip "$output"
}

# row NAME LABEL FACTOR FFTW: FACTOR and FFTW are the libraries of the factorization and of the transforms, or nothing.
row() {
    shared=$folder/$1/libplm_stripped.so
    strip -o "$shared" "$folder/$1/src/libplm.so"
    exported=$(nm -D --defined-only "$shared" | grep -c ' T plm_')
    # shellcheck disable=SC2086
    link "$1" host -larpack -lopenblas -lstdc++ -lm -lpthread
    # shellcheck disable=SC2086
    link "$1" host_static -static-libgcc -Wl,-Bstatic -larpack -lopenblas -lgfortran -lquadmath -lstdc++ \
        -Wl,-Bdynamic -lm -lpthread
    left=$(readelf -d "$folder/$1/host_static" | sed -n 's/.*NEEDED.*\[\(.*\)\]/\1/p' | tr '\n' ' ')
    echo "| $2 | $(kilobytes "$shared") | $exported | $(kilobytes "$folder/$1/host") |" \
        "$(functions "$folder/$1/host.named") | $(kilobytes "$folder/$1/host_static") | $left|"
}

without="-DPLM_WITH_STUDY=OFF -DPLM_WITH_TRANSIENT=OFF"
permissive="-DPLM_WITH_CHOLMOD=OFF -DPLM_WITH_FFTW=OFF"
build all
# shellcheck disable=SC2086
build smallest $without
# shellcheck disable=SC2086
build permissive $permissive
# shellcheck disable=SC2086
build permissive_smallest $permissive $without

cat <<END
# Build sizes

    sh tests/bench/build_sizes.sh

\`$(${CC:-cc} --version | head -1)\`, \`CMAKE_BUILD_TYPE=Release\`, everything stripped; 1 kB = 1000 bytes. Measured on
$(date +%Y-%m-%d).

| build | libplm.so (kB) | exported functions | host (kB) | functions of libplm in it | host, archives too (kB) | what it still loads |
|---|--:|--:|--:|--:|--:|---|
END
row all "all components" -lcholmod fftw
row smallest "without study and transient: PLM + HBM" -lcholmod fftw
row permissive "\`permissive\` (Eigen, no FFTW), all components" "" ""
row permissive_smallest "\`permissive\` without study and transient" "" ""
cat <<'END'

The host is [`examples/c/minimal.c`](../c/minimal.c) linked to `libplm.a`, which therefore is in it; ARPACK, OpenBLAS, FFTW
and CHOLMOD are shared there. In the last column but one ARPACK, FFTW, OpenBLAS, libgfortran and libstdc++ come from
Debian's archives, too: nearly all of that size is OpenBLAS, which has kernels for every processor. CHOLMOD stays shared,
since Debian's archive of it needs METIS, which has none. The set of exported functions is the same in all builds: a part
that was left out answers `PLM_ERR_NOT_BUILT`.
END
