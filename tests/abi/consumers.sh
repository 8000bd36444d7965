#!/bin/sh
# consumers.sh CC PYTHON LIBPLM_SO FOLDER: hosts compiled with the baseline header and linked with the baseline's symbols
# run under the library of today without being built again.
set -eu
. "$(dirname "$0")/stub.sh"
cc=$1 python=$2 library=$3 folder=$4
mkdir -p "$folder/old" "$folder/broken"
make_stub "$cc" "$python" "$here/baseline/plm/plm.h" "$folder/old/libplm.so"
for source in "$here"/consumers/*.c; do
    name=$(basename "$source" .c)
    "$cc" -std=c89 -I"$here/baseline" "$source" -L"$folder/old" -lplm -o "$folder/$name"
done

export LD_BIND_NOW=1
today=$(dirname "$library")
LD_LIBRARY_PATH=$today "$folder/run"
LD_LIBRARY_PATH=$today "$folder/keys" "$here/baseline/keys.txt"

# The gate bites: a library that lost a function does not start the old host.
sed '/^PLM_API plm_status plm_hbm_sweep/d' "$here/baseline/plm/plm.h" >"$folder/broken/plm.h"
make_stub "$cc" "$python" "$folder/broken/plm.h" "$folder/broken/libplm.so.0"
if LD_LIBRARY_PATH=$folder/broken "$folder/run" 2>"$folder/broken/log"; then
    echo "a library without plm_hbm_sweep still runs the old host: the gate is blunt"
    exit 1
fi
grep -q plm_hbm_sweep "$folder/broken/log"
echo "refused: $(cat "$folder/broken/log")"
