#!/bin/sh
# fuzz_library.sh CMAKE GENERATOR CLANG CLANGXX SOURCE FOLDER OPTION...: libplm.so as libFuzzer wants it: each of its
# branches reports to the fuzzer, and AddressSanitizer watches its memory.
set -eu
cmake=$1 generator=$2 clang=$3 clangxx=$4 source=$5 folder=$6
shift 6
mkdir -p "$folder"
"$cmake" -S "$source" -B "$folder" -G "$generator" -DCMAKE_C_COMPILER="$clang" -DCMAKE_CXX_COMPILER="$clangxx" \
    -DCMAKE_BUILD_TYPE=Fuzz -DCMAKE_CXX_FLAGS_FUZZ="-O1 -gline-tables-only" -DPLM_SANITIZE=fuzzer-no-link,address \
    -DPLM_UNITY=ON -DPLM_SELF_CONTAINED=OFF -DPLM_BUILD_TESTS=OFF -DPLM_BUILD_EXAMPLES=OFF -DPLM_WITH_FORTRAN=OFF "$@" >"$folder/log"
"$cmake" --build "$folder" --target plm --parallel 2 >>"$folder/log" || { tail -40 "$folder/log"; exit 1; }
