#!/bin/sh
# frequencies.sh RUN_SH PROGRAM FOLDER: the ten lowest frequencies, crack open and closed, agree with ccx's to 6 digits,
# and the response curve has a peak inside its range. Judged from the files, not from the program's own verdict.
set -eu
run=$1 program=$2 folder=$3
for tool in ccx python3; do
    command -v $tool >/dev/null || { echo "skipped: no $tool"; exit 77; }
done
rm -rf "$folder"
mkdir -p "$folder"
sh "$run" -p "$program" "$folder" >"$folder/output.txt" || { cat "$folder/output.txt"; exit 1; }
cat "$folder/output.txt"

for system in open closed; do
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

awk -F, '
    NR > 1 { n++; a[n] = $2; if ($2 > a[top] + 0) top = n; if ($4 > 0) switching++ }
    END {
        ends = a[1] > a[n] ? a[1] : a[n]
        printf "curve: %d points, peak %.4g mm at point %d, %.4g mm at the higher end, %d points with switching pairs\n",
               n, a[top], top, ends, switching
        if (n < 20 || top == 1 || top == n || !(a[top] > 2 * ends) || !switching) { print "no peak"; exit 1 }
    }
' "$folder/curve.csv"
