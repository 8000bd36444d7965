#!/bin/sh
# Builds libplm with its tests and runs them.
#     sh tests/run.sh             preset dev
#     sh tests/run.sh --all       preset dev with a minute of each fuzzer, of asan the C API and hosts with half a minute of
#                                 scenarios drawn by chance, and of tsan, permissive and release what differs there from dev (all
#                                 of one, or asserting and libcxx: name it). dev is compiled as release is, so that the three share objects
#     sh tests/run.sh PRESET...   these presets of CMakePresets.json
# Missing packages are installed where that is possible. Works from any folder; everything goes to build/, but for what was compiled,
# which ccache keeps at its own place (CCACHE_DIR): another tree, or the next fresh clone, compiles only what differs.
set -u
root=$(CDPATH='' cd -- "$(dirname -- "$0")/.." && pwd) || exit 1
cd "$root" || exit 1
. cmake/packages.sh

all=
case ${1-} in
-h | --help) sed -n '2,9s/^# //p' tests/run.sh; exit 0 ;;
--all) set -- dev asan tsan permissive release; all=yes ;;
-*) echo "run.sh: unknown option $1 (see --help)" >&2; exit 2 ;;
'') set -- dev ;;
esac

# shellcheck disable=SC2086,SC2154
need_packages $plm_build_packages gfortran pkg-config libcmocka-dev python3 python3-numpy python3-scipy \
    python3-matplotlib python3-h5py python3-meshio python3-vtk9 xvfb xauth octave python3-pip calculix-ccx abigail-tools valgrind mkdocs libopenmpi-dev openmpi-bin libmumps-dev clang libclang-rt-dev libc++-dev libc++abi-dev make ccache

jobs=2
export CMAKE_GENERATOR="${CMAKE_GENERATOR:-Ninja}"
export OPENBLAS_NUM_THREADS="${OPENBLAS_NUM_THREADS:-1}" # the tests themselves run side by side
export UBSAN_OPTIONS="${UBSAN_OPTIONS:-print_stacktrace=1}"

# What two presets compile alike, or two trees, is compiled once.
if command -v ccache >/dev/null && [ -z "${CMAKE_CXX_COMPILER_LAUNCHER-}" ]; then
    export CMAKE_C_COMPILER_LAUNCHER=ccache CMAKE_CXX_COMPILER_LAUNCHER=ccache
    export CCACHE_BASEDIR="$root" CCACHE_NOHASHDIR=1
fi

summary=
failures=0

# stage NAME COMMAND...: runs it, keeps its time and verdict for the summary.
stage() {
    name=$1
    shift
    printf '\n== %s: %s\n' "$name" "$*"
    begin=$(date +%s)
    if "$@"; then verdict=passed; else verdict=FAILED failures=$((failures + 1)); fi
    summary="$summary$(printf '%-22s %-7s %5d s' "$name" $verdict $(($(date +%s) - begin)))
"
    [ $verdict = passed ]
}

# What --all builds and tests of a preset; empty: everything.
programs=
tests=
choose() {
    programs= tests=
    [ -n "$all" ] || return 0
    case $1 in
    asan) # hosts and the whole C API, which reaches every room
        programs='plm plm_static tests/capi/all tests/host/all'
        tests='^(host[.]|capi[.])' ;;
    permissive) # its own factorization and transforms
        programs='plm plm_static test_structure_factor test_linalg_dft test_capi_run test_capi_transient'
        tests='^(structure[.]factor|linalg[.]dft|capi[.](run|transient)|abi[.](object|ledger))$' ;;
    asserting | libcxx) # another C++ library under the rooms that ask it for most
        programs='plm plm_static test_orbits_flow test_orbits_orbit_equations test_contact_contact_force test_capi_run
                  test_capi_search_calls test_capi_transient_runs test_host_cancelled_thread test_host_scenarios'
        tests='^(orbits[.](flow|orbit_equations)|contact[.]contact_force|capi[.](run|search_calls|transient_runs)|host[.](cancelled_thread|scenarios))$' ;;
    release) # what the shared object carries and hides
        programs='plm plm_static test_capi_run test_host_own_lapack test_host_own_kernels test_host_quiet_blas test_host_ilp64 test_host_fork
                  test_host_limit test_host_starved test_host_unload test_host_plugin_shared test_host_plugin_static'
        tests='^(capi[.]run|host[.](own_lapack|own_kernels|quiet_blas|ilp64|fork|limit|starved_[a-z]*|unload|plugin_exports)|abi[.](object|ledger))$' ;;
    esac
}

for preset; do
    choose "$preset"
    options=
    if [ -n "$all" ]; then
        options=-DPLM_UNITY=ON # several files at once where all is built from nothing
        PLM_FUZZ_SECONDS=5 PLM_SCENARIO_SECONDS=10
        case $preset in
        dev) options="$options -DCMAKE_BUILD_TYPE=Release" PLM_FUZZ_SECONDS=60 ;;
        asan) PLM_SCENARIO_SECONDS=30 ;;
        esac
        export PLM_FUZZ_SECONDS PLM_SCENARIO_SECONDS
    fi
    # shellcheck disable=SC2086
    stage "$preset: configure" cmake --preset "$preset" $options &&
        stage "$preset: build" cmake --build --preset "$preset" --parallel $jobs ${programs:+--target $programs} &&
        stage "$preset: test" ctest --preset "$preset" --parallel $jobs --no-tests=error ${tests:+-R "$tests"}
done

printf '\n%s' "$summary"
if [ $failures = 0 ]; then
    echo "All stages passed."
else
    echo "$failures stage(s) FAILED."
    exit 1
fi
