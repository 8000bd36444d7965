#!/bin/sh
# CalculiX as the host of libplm: a deck with contact, ccx runs, nonlinear response. See README.md in this folder.
#     run.sh [-p PROGRAM] [-o FOLDER] [DECK [options of host_files.py]]
set -eu
here=$(CDPATH='' cd -- "$(dirname -- "$0")" && pwd)

program= folder=
while getopts p:o: option; do
    case $option in
    p) program=$OPTARG ;;
    o) folder=$OPTARG ;;
    *) echo "usage: run.sh [-p PROGRAM] [-o FOLDER] [DECK [options of host_files.py]]" >&2; exit 2 ;;
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
python=${PYTHON:-python3}
"$python" -c 'import numpy, scipy' 2>/dev/null || { echo "run.sh: $python has no numpy and scipy; PYTHON names another" >&2; exit 1; }
if [ -z "${PLM_LIBRARY:-}" ]; then # plm.fe asks the library of the same build
    PLM_LIBRARY=$(dirname -- "$program")/../../src/libplm.so
    [ -e "$PLM_LIBRARY" ] && export PLM_LIBRARY || unset PLM_LIBRARY
fi

[ $# -gt 0 ] || set -- "$here/../decks/cracked_plate.inp"
deck=$1
shift
folder=${folder:-$(mktemp -d)}
mkdir -p "$folder"
rm -f "$folder"/open.* "$folder"/closed.* "$folder"/matrices.* "$folder"/model.txt
PYTHONPATH=${PYTHONPATH:-$here/../../bindings/python} "$python" "$here/host_files.py" "$deck" "$folder" "$@"
for job in open closed; do
    [ -e "$folder/$job.inp" ] || continue
    # ccx works in the current folder; its exit status is not reliable: its files are checked by their reader
    (cd "$folder" && OMP_NUM_THREADS=${OMP_NUM_THREADS:-1} ccx "$job" >"$job.log" 2>&1) || true
    if grep -q '\*ERROR' "$folder/$job.log"; then # libplm may take what ccx does not
        grep -A3 '\*ERROR' "$folder/$job.log" >&2
        rm -f "$folder/$job.dat"
    fi
done
"$program" "$folder"
