#!/bin/sh
# host.sh EXAMPLES PROGRAM DECK FOLDER: ccx as the host of a deck. Ten frequencies agree with ccx's own to 6 digits, without contact
# and, where the meshes match, with every pair closed; the response curve has a peak inside its range, at which pairs open and close.
# Judged from the files, not from the program's own verdict. DECK: one of examples/decks, or "other", which is like none of them.
# PYTHON, PLM_LIBRARY and PYTHONPATH: as run.sh takes them.
set -eu
examples=$1 program=$2 deck=$3 folder=$4
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)
command -v ccx >/dev/null || { echo "skipped: no ccx"; exit 77; }
rm -rf "$folder"
mkdir -p "$folder"
case $deck in
other) "$PYTHON" "$here/other_deck.py" "$folder/deck.inp"; file=$folder/deck.inp; systems=open ;;
*) file=$examples/decks/$deck.inp; systems='open closed' ;;
esac
sh "$examples/calculix/run.sh" -p "$program" -o "$folder" "$file" >"$folder/output.txt" || { cat "$folder/output.txt"; exit 1; }
cat "$folder/output.txt"

for system in $systems; do
    # the .dat file's own column against the printed value of the library
    awk -v name="$system" '
        FNR == NR { if ($1 == n + 1 && NF == 5) { n++; ccx[n] = $4 } next }
        $1 == name && $2 ~ /^[0-9]+$/ {
            rows++
            d = $4 / ccx[$2] - 1
            if (d < 0) d = -d
            if (!(d <= 1e-6)) { print name " mode " $2 ": " $4 " Hz, ccx " ccx[$2] " Hz"; bad = 1 }
        }
        END { if (rows < 10) { print name ": " rows + 0 " frequencies compared"; bad = 1 } exit bad }
    ' "$folder/$system.dat" "$folder/output.txt"
done

# frequency_hz, amplitude, ..., n_switching
awk -F, '
    NR > 1 { n++; a[n] = $2; if ($2 > a[top] + 0) { top = n; switching = $NF } }
    END {
        ends = a[1] > a[n] ? a[1] : a[n]
        printf "curve: %d points, peak %.4g at point %d, %.4g at the higher end, %d pairs open and close there\n",
               n, a[top], top, ends, switching
        if (n < 20 || top == 1 || top == n || !(a[top] > 2 * ends) || !switching) { print "no peak"; exit 1 }
    }
' "$folder/curve.csv"
