#!/bin/sh
# CalculiX as the host of libplm: decks, three ccx runs, nonlinear response. See README.md in this folder.
#     run.sh [-p PROGRAM] [FOLDER]
set -eu
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)

program=
while getopts p: option; do
    case $option in
    p) program=$OPTARG ;;
    *) echo "usage: run.sh [-p PROGRAM] [FOLDER]" >&2; exit 2 ;;
    esac
done
shift $((OPTIND - 1))

if [ -z "$program" ]; then # any build of this tree
    for program in "$here"/../../build/*/examples/calculix/calculix_response; do
        [ -x "$program" ] && break
    done
fi
[ -x "$program" ] || { echo "run.sh: calculix_response is not built; give it by -p PROGRAM" >&2; exit 1; }
command -v ccx >/dev/null || { echo "run.sh: no ccx (Debian and Ubuntu: package calculix-ccx)" >&2; exit 1; }
command -v python3 >/dev/null || { echo "run.sh: no python3" >&2; exit 1; }

folder=${1:-$(mktemp -d)}
mkdir -p "$folder"
python3 "$here/plate.py" "$folder"
for job in open closed matrices; do
    # ccx works in the current folder; its exit status is not reliable: its files are checked by their reader
    rm -f "$folder/$job.dat" "$folder/$job.sti" "$folder/$job.mas" "$folder/$job.dof"
    (cd "$folder" && OMP_NUM_THREADS=${OMP_NUM_THREADS:-1} ccx "$job" >"$job.log" 2>&1) || true
    if grep -q '\*ERROR' "$folder/$job.log"; then
        grep -A3 '\*ERROR' "$folder/$job.log" >&2
        exit 1
    fi
done
"$program" "$folder"
