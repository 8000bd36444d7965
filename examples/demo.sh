#!/bin/sh
# The demo: how good is a basis of piecewise-linear modes, and what does it cost?
#     sh examples/demo.sh [OPTION...]
# Builds the library and plm-study, runs the cracked plate of the paper and plots what came out. Options go to the
# program (--size quick, --scene coaxial_cylinders, --no-preload, --study all, ...; plm-study --help tells all).
# Missing packages are installed where that is possible. Works from any folder; everything goes to build/.
set -eu
root=$(CDPATH='' cd -- "$(dirname -- "$0")/.." && pwd)
cd "$root"
. cmake/packages.sh

case ${1-} in
-h | --help) sed -n '2,6s/^# //p' examples/demo.sh; exit 0 ;;
esac

jobs=2
build=build/demo-release # apart from build/release, which has the tests
output=build/demo
begin=$(date +%s)

# A Python that can plot; the default one may be another than the one of the system's packages.
find_python() {
    for python in python3 /usr/bin/python3; do
        "$python" -c 'import numpy, scipy, matplotlib' 2>/dev/null && return
    done
    return 1
}

packages=$plm_build_packages
find_python || packages="$packages python3-numpy python3-scipy python3-matplotlib"
# shellcheck disable=SC2086,SC2154
need_packages $packages

export CMAKE_GENERATOR="${CMAKE_GENERATOR:-Ninja}"
cmake --preset release -B "$build" -DPLM_BUILD_TESTS=OFF
cmake --build "$build" --parallel $jobs --target plm-study
built=$(date +%s)
echo

# One thread for OpenBLAS: the dense systems here have a few hundred unknowns, too few to share. Threads that wait for
# each other cost more than they bring.
mkdir -p "$output"
rm -f "$output"/*.csv "$output"/*.png "$output"/*.pdf "$output"/*.svg "$output"/*/*.csv
OPENBLAS_NUM_THREADS=1 "$build/examples/c/plm-study" --size paper --study short --samples 1,2,4 --repeats 0 "$@" --output "$output"

echo
if find_python; then
    PYTHONPATH=bindings/python PLM_LIBRARY="$build/src/libplm.so" "$python" examples/plot/plot_study.py "$output"
else
    echo "No pictures: no Python with numpy, scipy and matplotlib was found." >&2
fi
end=$(date +%s)
echo "Report: $root/$output/report.md, with curves, contact and tables as CSV beside it"
echo "Total time $((end - begin)) s, $((built - begin)) s of it for the build."
