#!/bin/sh
# The pictures of the motion of two decks in docs/images: the plate when its crack is widest open, and the bolted lap joint.
#     sh examples/plot/motion_pictures.sh [FOLDER]       FOLDER: of the pictures (docs/images)
# Needs the command plm (or PYTHONPATH and PLM_LIBRARY of a build), VTK and its Python package, xvfb where there is no display.
set -eu
root=$(CDPATH='' cd -- "$(dirname -- "$0")/../.." && pwd)
pictures=${1-$root/docs/images}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
plm() { python3 -m plm "$@" || [ $? -eq 1 ]; } # 1: done, with a warning, which it has printed

plm response "$root/examples/decks/cracked_plate.inp" --force TIP y 50 --accuracy 0.05 --length-unit mm --out "$work/plate"
python3 "$root/examples/plot/plot_motion.py" "$work/plate/peak.pvd" "$pictures/open_crack.png" --view 65 -80 --unit mm
plm response "$root/examples/decks/lap_joint.inp" --length-unit mm --out "$work/joint"
python3 "$root/examples/plot/plot_motion.py" "$work/joint/peak.pvd" "$pictures/lap_joint.png" --view 35 -60 --unit mm
