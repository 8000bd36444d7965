#!/bin/sh
# fuzz.sh CLANG INCLUDE LIBPLM_SO FOLDER SECONDS PROGRAM LONGEST [FORMATS]: builds PROGRAM.c with libFuzzer and runs it on
# inputs up to LONGEST bytes; PLM_FUZZ_SECONDS in the environment goes before SECONDS. The inputs found are kept in
# FOLDER/corpus and are where the next run begins, with the files of FORMATS.
set -eu
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
clang=$1 include=$2 library=$3 folder=$4 seconds=${PLM_FUZZ_SECONDS:-$5} program=$6 longest=$7 formats=${8:-}
mkdir -p "$folder/corpus"
"$clang" -g -O1 -fsanitize=fuzzer,address,undefined -fsanitize-link-c++-runtime -I"$include" -DPLM_FORMATS="\"$formats\"" "$here/$program.c" "$library" \
    -Wl,-rpath,"$(dirname "$library")" -o "$folder/fuzz"
cd "$folder"
set -- corpus
[ -z "$formats" ] || for version in "$formats"/version_*; do set -- "$@" "$version"; done
OPENBLAS_NUM_THREADS=1 ./fuzz -max_total_time="$seconds" -max_len="$longest" -len_control=0 -timeout=20 -rss_limit_mb=2000 \
    -print_final_stats=1 "$@" 2>log || { tail -60 log; exit 1; }
grep -E 'INFO: Loaded .* modules|stat::number_of_executed_units|DONE' log
