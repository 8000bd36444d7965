#!/bin/sh
# abidiff.sh CC PYTHON INCLUDE FOLDER LIBPLM_SO: the ABI of today's header, and of the shared object where it carries
# full debug information, against the committed baseline. What an old host uses stays; functions may be added.
set -eu
. "$(dirname "$0")/stub.sh"
command -v abidiff >/dev/null || skip "no abidiff (Debian: abigail-tools)"
cc=$1 python=$2 include=$3 folder=$4 library=$5
mkdir -p "$folder"

# Against the committed baseline, whose private types were dropped when it was written (abidiff 2.2 aborts on
# --headers-dir1 with a written ABI), and against the baseline header built again, with both header folders.
compare() { # INCLUDE LIBRARY
    abidiff --no-added-syms --drop-private-types --headers-dir2 "$1" "$here/baseline/plm.abi" "$2" &&
        abidiff --no-added-syms --drop-private-types --headers-dir1 "$here/baseline" --headers-dir2 "$1" \
            "$folder/baseline.so" "$2"
}

make_stub "$cc" "$python" "$here/baseline/plm/plm.h" "$folder/baseline.so"
make_stub "$cc" "$python" "$include/plm/plm.h" "$folder/now.so"
compare "$include" "$folder/now.so"
echo "the header keeps the baseline"
if readelf --debug-dump=info "$library" 2>/dev/null | grep -q 'DW_AT_name.*: plm_status$'; then
    compare "$include" "$library"
    echo "the shared object keeps the baseline"
else
    echo "the shared object has no types to compare (no -g); its symbols are checked by abi.ledger"
fi

# The gate bites: each of these changes would break an old host and is refused.
try() { # NAME SED_EXPRESSION
    mkdir -p "$folder/$1/plm"
    sed "$2" "$include/plm/plm.h" >"$folder/$1/plm/plm.h"
    ! cmp -s "$folder/$1/plm/plm.h" "$include/plm/plm.h" || { echo "$1: the mutation does not apply"; exit 1; }
    if "$python" "$here/constants.py" "$here/baseline/plm/plm.h" "$folder/$1/plm/plm.h" >"$folder/$1.log" 2>&1 &&
        make_stub "$cc" "$python" "$folder/$1/plm/plm.h" "$folder/$1.so" &&
        compare "$folder/$1" "$folder/$1.so" >"$folder/$1.log" 2>&1; then
        echo "$1: NOT refused"
        exit 1
    fi
    echo "refused: $1"
}
try narrower_argument 's/plm_model_create(plm_context \*ctx, int64_t n_dof/plm_model_create(plm_context *ctx, int32_t n_dof/'
try wider_status 's/^typedef int32_t plm_status/typedef int64_t plm_status/'
try other_argument_order 's/int64_t point, double time_fraction/double time_fraction, int64_t point/'
try missing_function '/^PLM_API plm_status plm_model_build/d'
try other_callback 's/const char \*stage, double fraction/const char *stage, float fraction/'
try other_constant 's/^#define PLM_CANCELLED 3/#define PLM_CANCELLED 4/'
try output_by_other_type 's/int64_t index, int32_t \*severity/int64_t index, int64_t *severity/'
