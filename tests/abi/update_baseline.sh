#!/bin/sh
# update_baseline.sh LIST_KEYS: makes today's header and keys the baseline. To be run when a version is released (or a
# break was decided on), never to silence a gate. LIST_KEYS: the built program tests/abi/abi_list_keys.
set -eu
. "$(dirname "$0")/stub.sh"
folder=$(mktemp -d)
"$1" >"$folder/keys.txt" # first: where it cannot be run nothing changes
include=$here/../../include
cp "$include/plm/plm.h" "$here/baseline/plm/plm.h"
make_stub cc python3 "$include/plm/plm.h" "$folder/stub.so"
abidw --headers-dir "$include" --drop-private-types --no-show-locs --no-corpus-path --no-comp-dir-path --no-elf-needed \
    --no-parameter-names "$folder/stub.so" >"$here/baseline/plm.abi"
mv "$folder/keys.txt" "$here/baseline/keys.txt"
rm -r "$folder"
