#!/bin/sh
# Copyright the Palmar authors.
# SPDX-License-Identifier: Apache-2.0
#
# Makes the pictures of docs/images anew with a built program, in a few minutes:
#
#     scripts/docs_pictures.sh [PRODUCTS]
#
# PRODUCTS is a folder with the ten scanned products of docs/using/grips.md (screwdriver_phillips.obj
# ...), which the repository doesn't have; without it their pictures stay as they are. Needs a browser
# (chromium), which lays pictures side by side.
set -eu
cd "$(dirname "$0")/.."
palmar=$(pwd)/build/release/bin/palmar
products=${1:-}
images=$(pwd)/docs/images
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
browser=$(command -v chromium || command -v chromium-browser || command -v google-chrome) || {
  echo "docs_pictures.sh: no browser: chromium or google-chrome is needed" >&2
  exit 1
}

# sheet OUT COLUMNS WIDTH HEIGHT PICTURE...: pictures in so many columns, each WIDTH x HEIGHT pixels
sheet() {
  out=$1 columns=$2 width=$3 height=$4
  shift 4
  rows=$((($# + columns - 1) / columns))
  {
    echo "<body style=\"margin:0;background:#fff;display:grid;grid-template-columns:repeat($columns,${width}px)\">"
    for one in "$@"; do
      echo "<img src=\"file://$one\" style=\"width:${width}px;height:${height}px;object-fit:contain\">"
    done
  } > "$work/sheet.html"
  "$browser" --headless=new --no-sandbox --hide-scrollbars --user-data-dir="$work/profile" \
    --window-size=$((columns * width)),$((rows * height)) --screenshot="$out" \
    "file://$work/sheet.html" 2> /dev/null
}

# held NAME PRODUCT OPTION...: assesses and leaves the folder of pictures in $work/NAME
held() {
  name=$1 product=$2
  shift 2
  "$palmar" --quiet assess "$product" --unit mm --out "$work/$name" "$@" > /dev/null
}

# folder NAME: where the pictures of the one product of that run are
folder() {
  for one in "$work/$1"/*/; do echo "${one%/}"; done
}

for posture in flat relaxed spread point fist thumb_to_little key_pinch tip_pinch tripod \
  cylinder_grip; do
  "$palmar" --quiet hand pose --posture $posture --out "$work/$posture.png" > /dev/null
  sheet "$images/postures/$posture.png" 1 720 300 "$work/$posture.png"
done

"$palmar" --quiet product make cylinder --diameter-mm 48 --out "$work/handle.stl" > /dev/null
held handle "$work/handle.stl"
sheet "$images/assess-cylinder.png" 2 550 385 "$(folder handle)/grasp_palm.png" \
  "$(folder handle)/pressure_palm.png"

"$palmar" --quiet study run examples/xie2014-chapter5/study.toml --out "$work/study.palmar" \
  > /dev/null
"$palmar" --quiet study report "$work/study.palmar" --out "$work/study" > /dev/null
cp "$work/study/figures/peak_pressure_cells_mpa.png" "$images/study-peak-pressure.png"

[ -n "$products" ] || exit 0
"$palmar" --quiet grasp holds "$products/mustard_bottle.obj" --unit mm \
  --png "$images/holds-sheet.png" > /dev/null

"$palmar" --quiet product make prism --width-mm 22 --depth-mm 3 --length-mm 55 --fillet-mm 0.8 \
  --out "$work/key.stl" > /dev/null
"$palmar" --quiet product make sphere --diameter-mm 65 --out "$work/ball.stl" > /dev/null
held tripod_marker "$products/large_marker.obj" --grip tripod
held lateral_key "$work/key.stl" --grip lateral
held five_ball "$work/ball.stl" --grip precision_sphere
held pinched_drive "$products/portable_drive.obj" --grip palmar_pinch
sheet "$images/precision-grips.png" 4 300 210 "$(folder tripod_marker)/grasp_thumb.png" \
  "$(folder lateral_key)/grasp_thumb.png" "$(folder five_ball)/grasp_thumb.png" \
  "$(folder pinched_drive)/grasp_thumb.png"

set --
for one in screwdriver_phillips rubber_mallet power_drill mug mustard_bottle portable_speaker \
  cookie_spatula large_marker portable_drive handheld_console; do
  held $one "$products/$one.obj"
  set -- "$@" "$(folder $one)/grasp_palm.png"
done
sheet "$images/grasps/ten-products.png" 5 300 210 "$@"
