#!/bin/bash
# Makes docs/pictures/study.png, the plot in the README, by a study of two scenes; prints the table.
# Needs the package chromium. Some ten minutes on two cores; goes on if it was stopped.
set -euo pipefail
root=$(dirname "$(readlink -f "$0")")/../..
work=${1:-$root/build/readme-study}
"$root/stromboli" study cornell_boxes cornell_mirror_glass -o "$work" -r 480 360 -m 5 --target-samples 64 \
    -c independent -c even -c default -c hemisphere -s 16,32,64 --seeds 3 --reference-samples 2048 --most-seconds 60
profile=$(mktemp -d)
trap 'rm -rf "$profile"' EXIT
chromium --headless --no-sandbox --disable-gpu --hide-scrollbars --user-data-dir="$profile" \
    --window-size=1100,430 --blink-settings=preferredColorScheme=1 --virtual-time-budget=3000 \
    --screenshot="$root/docs/pictures/study.png" "file://$(readlink -f "$work")/report.html#figure" 2>/dev/null
