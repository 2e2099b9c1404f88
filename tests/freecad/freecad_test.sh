#!/bin/sh
# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
#
# freecad_test.sh PALMAR: makes redesigns of every kind and has FreeCAD open them, check them and go on
# with them (check_step.py). Skipped (77) where FreeCAD isn't installed (Debian: freecad-python3).
set -eu
palmar=$1
here=$(cd "$(dirname "$0")" && pwd)
command -v freecadcmd > /dev/null || { echo "freecadcmd isn't there: skipped"; exit 77; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
cd "$folder"
prism="made: prism width_mm=30 depth_mm=40 length_mm=130 fillet_mm=3"
few="--hands 2 --seed 2014 --no-compare --quiet"
"$palmar" product make pistol_grip --out pistol.step --quiet
"$palmar" redesign shape "$prism" --evaluations 4 --no-pictures $few --out prism
"$palmar" redesign shape "$prism" --vary width=32 --vary depth=40 --vary palm_swell=3 --vary thumb_rest=1.5 \
  --vary twist=8 --vary egg=0.1 --keep-ends-mm 10 --no-pictures $few --out kept
"$palmar" redesign shape pistol.step --evaluations 4 --no-pictures $few --out pistol
"$palmar" redesign fillet "$prism" --edges long --radius-mm 10 $few --out fillet
"$palmar" redesign press pistol.step --no-pictures $few --out pressed
"$palmar" redesign region "$prism" --no-pictures $few --out region
PALMAR_STEP_FILES=prism/redesign.step:kept/redesign.step:pistol/redesign.step:fillet/redesign.step
PALMAR_STEP_FILES=$PALMAR_STEP_FILES:region/region.step:region/redesign.step:pressed/pressed.step
PALMAR_MACROS=prism/handle.FCMacro:kept/handle.FCMacro:pistol/handle.FCMacro
export PALMAR_STEP_FILES PALMAR_MACROS
freecadcmd "$here/check_step.py" < /dev/null > report.txt 2>&1 || { cat report.txt; exit 1; }
grep -E "passed|FAILED" report.txt
