#!/bin/bash
# Renders the bundled scenes on the lavapipe of another release of Debian and compares the pictures with those of this system's:
#
#   tests/packages/mesa.sh SUITE FOLDER BUILD [TEST PROGRAM...]
#
# SUITE is a release of Debian, as trixie; in FOLDER, which is made, the bare system is kept for the next try (that of
# tests/packages/try.sh will do). BUILD is a build folder; what is in it runs there with libraries of this system, but for those
# of C and C++. With eight lanes, or as LP_NATIVE_VECTOR_WIDTH says. For pictures that have other bytes, relMSE says how far
# they are; the CPU seconds of a small picture, five of each in turn, how quick both are. Test programs (build/release/tests/
# shaders/shader_tests) run there too, with GTEST_FILTER. As root, with mmdebstrap and a mirror (STROMBOLI_MIRROR). Exit codes: 0 all
# bytes are the same and all tests pass; 1 else; 77 it could not be tried here, and why.

set -euo pipefail
root=$(cd "$(dirname "$(readlink -f "$0")")/../.." && pwd)
. "$root/tests/support/bare_debian.sh"
(($# >= 3)) || cannot "usage: $0 SUITE FOLDER BUILD [TEST PROGRAM...]"
need_bare "$@"
suite=$1
mkdir -p "$2"
bare=$(cd "$2" && pwd)/bare
program=$(cd "$3" && pwd)/bin/stromboli
shift 3
tests=()
for test in "$@"; do tests+=("$(readlink -f "$test")"); done

make_bare "$suite" "$bare" || cannot "mmdebstrap could not make $suite; see $bare.log"
mkdir -p "$bare$root" # the checkout and the build, where they are here
{ enter_bare "$bare" && mount --bind "$root" "$bare$root"; } || cannot "mounts are not allowed here"
width=${LP_NATIVE_VECTOR_WIDTH:-256}
export LP_NATIVE_VECTOR_WIDTH=$width
inside() { chroot "$bare" env -C "$root" HOME=/root LC_ALL=C LD_LIBRARY_PATH=/of_the_build "$@"; }
packages=(libvulkan1 mesa-vulkan-drivers vulkan-validationlayers)
for package in "${packages[@]}"; do
    inside dpkg -s "$package" >/dev/null 2>&1 || missing=yes
done
[[ -z ${missing-} ]] || { inside apt-get -qq update && inside env DEBIAN_FRONTEND=noninteractive apt-get -qq -y install \
    --no-install-recommends "${packages[@]}" >"$bare.log" 2>&1; } || cannot "there is no mirror for $suite; see $bare.log"

# The libraries that the build asks for.
mkdir -p "$bare/of_the_build"
of_system='/(ld-linux.*|lib(c|m|dl|pthread|rt|stdc\+\+|gcc_s|vulkan|z|zstd))\.so'
for library in $(ldd "$program" "${tests[@]}" | awk '$3 ~ /^\// {print $3}' | sort -u | grep -vE "$of_system"); do
    cp -Lu "$library" "$bare/of_the_build"
done

folder=$(mktemp -d "$root/build/mesa.XXXXXX")
trap 'rm -rf "$folder"' EXIT
failed=0
"$program" devices | grep driver:
inside "$program" devices | grep driver:
for scene in "$root"/scene/library/*.{dae,xml,glb}; do
    name=$(basename "${scene%.*}")
    picture=(render "$scene" -r 48 36 -s 4 --notes off -q -o)
    "$program" "${picture[@]}" "$folder/here.exr"
    inside timeout 600 "$program" "${picture[@]}" "$folder/there.exr" || { echo "$name: does not render"; failed=1; continue; }
    cmp -s "$folder"/{here,there}.exr && { echo "$name: the same bytes"; continue; }
    failed=1
    echo "$name: $("$program" compare "$folder"/{here,there}.exr | grep -i relmse | head -n 1)"
done

# The least CPU seconds of each, in turn.
TIMEFORMAT='%U %S'
picture=(render cornell_boxes -r 64 48 -s 1 -q -o "$folder/x.png")
for round in 1 2 3 4 5; do
    { time "$program" "${picture[@]}"; } 2>>"$folder/here"
    { time inside "$program" "${picture[@]}"; } 2>>"$folder/there"
done
least() { awk '{print $1 + $2}' "$folder/$1" | sort -g | head -n 1; }
echo "CPU s of cornell_boxes, 64 x 48, 1 sample: $(least here) here, $(least there) with the Mesa of $suite ($((width / 32)) lanes)"

for test in "${tests[@]}"; do
    inside "$test" --gtest_brief=1 || failed=1
done
exit $failed
