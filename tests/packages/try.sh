#!/bin/bash
# Installs the Debian package in a bare system of its own, as a user would, renders there, and compares the picture with
# one of the build here:
#
#   tests/packages/try.sh SUITE FOLDER [PACKAGE.deb]
#
# SUITE is a release of Debian, as bookworm; in FOLDER, which is made, the bare system is kept for the next try. Without a
# PACKAGE, `./stromboli package` makes one. As root, with debootstrap and a mirror (STROMBOLI_MIRROR). Exit codes: 0 the
# picture has the same bytes; 1 something failed; 2 it could not be tried here, and why; 3 apt finds the package's
# dependencies nowhere in that release.

set -euo pipefail
cannot() {
    echo "NOT TRIED: $*" >&2
    exit 2
}
(($# == 2 || $# == 3)) || cannot "usage: $0 SUITE FOLDER [PACKAGE.deb]"
((EUID == 0)) || cannot "root is needed, for chroot"
command -v debootstrap >/dev/null || cannot "debootstrap is not installed"
suite=$1
mkdir -p "$2"
folder=$(cd "$2" && pwd)
root=$(cd "$(dirname "$(readlink -f "$0")")/../.." && pwd)
package=${3-$("$root/stromboli" package)}
bare=$folder/bare

. "$root/tests/support/bare_debian.sh"
make_bare "$suite" "$bare" || cannot "debootstrap could not make $suite; see $bare.log"
enter_bare "$bare"
cp "$package" "$bare/stromboli.deb"
inside() { chroot "$bare" env HOME=/root DEBIAN_FRONTEND=noninteractive "$@"; }

inside apt-get -qq update || cannot "there is no mirror for $suite"
if ! inside apt-get install -s --no-install-recommends /stromboli.deb >"$folder/apt.log" 2>&1; then
    echo "$(basename "$package") does not fit $suite:" >&2
    sed -n '/unmet dependencies/,$p' "$folder/apt.log" >&2
    exit 3
fi
inside apt-get -qq -y install --no-install-recommends /stromboli.deb >>"$folder/apt.log" 2>&1 || {
    tail -n 20 "$folder/apt.log" >&2
    exit 1
}

inside stromboli --version
inside stromboli devices
picture=(render cornell_mirror_glass -r 96 72 -s 8 --notes off -q)
inside stromboli "${picture[@]}" -o /there.exr
"$root/stromboli" "${picture[@]}" -o "$folder/here.exr"
cmp "$bare/there.exr" "$folder/here.exr"
echo "$suite: installed by apt, and the picture has the same bytes as here"
