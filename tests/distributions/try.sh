#!/bin/bash
# Builds this checkout on another release of Debian, tries it there, and compares a picture with one
# of the build here:
#
#   tests/distributions/try.sh trixie /tmp/trixie [ARGUMENT...]
#
# As root, with mmdebstrap, in a folder that is made. The arguments are those of ./stromboli; without
# them `stress` is run. The folder may be deleted afterwards; nothing is mounted when this ends.

set -euo pipefail
(($# >= 2)) && ((EUID == 0)) || {
    echo "usage, as root: $0 SUITE FOLDER [ARGUMENT...]" >&2
    exit 1
}
. "$(dirname "$(readlink -f "$0")")/../support/bare_debian.sh"
own_mounts "$@" || {
    echo "mounts are not allowed here" >&2
    exit 1
}
suite=$1
mkdir -p "$2"
folder=$(cd "$2" && pwd)
shift 2
root=$(cd "$(dirname "$(readlink -f "$0")")/../.." && pwd)

make_bare "$suite" "$folder" || {
    echo "mmdebstrap could not make $suite; see $folder.log" >&2
    exit 1
}
mkdir -p "$folder/stromboli"
(cd "$root" && git ls-files -z | tar c --null -T -) | tar x -C "$folder/stromboli"

enter_bare "$folder"

inside() { chroot "$folder" env -C /stromboli HOME=/root STROMBOLI_PRESET=ci ./stromboli "$@"; }
if (($#)); then
    inside "$@"
    exit
fi
inside stress
picture=(render cornell_mirror_glass -r 96 72 -s 8 --notes off -q)
inside "${picture[@]}" -o /there.exr
"$root/stromboli" "${picture[@]}" -o "$folder/here.exr"
cmp "$folder/there.exr" "$folder/here.exr" && echo "the picture has the same bytes as here"
