#!/bin/sh
# fuzz.sh CLANG INCLUDE LIBPLM_SO FOLDER SECONDS: builds fuzz.c with libFuzzer and runs it; PLM_FUZZ_SECONDS in the
# environment goes before SECONDS. The inputs found are kept in FOLDER/corpus and are where the next run begins.
set -eu
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
clang=$1 include=$2 library=$3 folder=$4 seconds=${PLM_FUZZ_SECONDS:-$5}
mkdir -p "$folder/corpus"
"$clang" -g -O1 -fsanitize=fuzzer,address,undefined -I"$include" "$here/fuzz.c" "$library" \
    -Wl,-rpath,"$(dirname "$library")" -o "$folder/fuzz"
cd "$folder"
OPENBLAS_NUM_THREADS=1 ./fuzz -max_total_time="$seconds" -max_len=700 -len_control=0 -timeout=20 -rss_limit_mb=2000 -print_final_stats=1 \
    corpus 2>log || { tail -60 log; exit 1; }
grep -E 'INFO: Loaded .* modules|stat::number_of_executed_units|DONE' log
