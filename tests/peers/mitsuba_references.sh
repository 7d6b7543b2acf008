#!/bin/bash
# Mitsuba's render tests that lie beside this project, rendered and judged by Mitsuba's rule, and by
# means and blocks ('stromboli compare --ztest-variance ... --ztest-blocks'):
#
#   tests/peers/mitsuba_references.sh PROGRAM SCENES [SAMPLES [FOLDER]]
#
# PROGRAM: stromboli; SCENES: a folder like mitsuba/tests/scenes; SAMPLES: of each pixel (4096); FOLDER:
# where the pictures go (a new one in /tmp).
set -euo pipefail
program=$1
scenes=$2
samples=${3:-4096}
folder=${4:-$(mktemp -d)}
mkdir -p "$folder"
for reference in "$scenes"/*/refs/*_ref_rgb.exr; do
    name=$(basename "$reference" _ref_rgb.exr)
    scene=$(ls "$(dirname "$(dirname "$reference")")/${name}"_{path,direct}.xml 2>/dev/null | head -1 || true)
    [[ -n $scene ]] || continue
    "$program" render "$scene" -s "$samples" --terminator-offset off --even --aov -q -o "$folder/$name.exr"
    echo "$name:"
    "$program" compare "$reference" "$folder/$name.exr" -s "$samples" \
        --ztest-variance "${reference%.exr}_var.exr" 2>/dev/null | grep '^by \|^bias' || true
done
