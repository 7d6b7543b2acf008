#!/bin/bash
# Installs the wheel and the Debian package in a bare system, as a user would, renders there with each of them, and compares
# the pictures with those of the build here:
#
#   tests/packages/try.sh SUITE FOLDER BUILD
#
# SUITE is a release of Debian, as bookworm; in FOLDER, which is made, the bare system is kept for the next try. BUILD is the
# build folder where ./stromboli package and ./stromboli wheel have made the package and the wheel; for a release with
# another Python the wheel is made here, by the headers of that Python. As root, with mmdebstrap and a mirror
# (STROMBOLI_MIRROR). Exit codes: 0 all pictures have the same bytes; 1 something failed, and what; 77 it could not be tried
# here, and why.

set -euo pipefail
fail() {
    echo "FAILED on $suite: $*" >&2
    exit 1
}
root=$(cd "$(dirname "$(readlink -f "$0")")/../.." && pwd)
. "$root/tests/support/bare_debian.sh"
(($# == 3)) || cannot "usage: $0 SUITE FOLDER BUILD"
need_bare "$@"
suite=$1
mkdir -p "$2"
folder=$(cd "$2" && pwd)
build=$(cd "$3" && pwd)
bare=$folder/bare
log=$folder/log
: >"$log"

# The one file that a pattern stands for.
only() {
    (($# == 1)) && [[ -e $1 ]] || cannot "expected one file, found: $*"
    echo "$1"
}
package=$(only "$build"/packages/stromboli_*.deb)

make_bare "$suite" "$bare" || cannot "mmdebstrap could not make $suite; see $bare.log"
enter_bare "$bare" || cannot "mounts are not allowed here"
inside() { chroot "$bare" env HOME=/root LC_ALL=C DEBIAN_FRONTEND=noninteractive "$@"; }
install() { inside apt-get -qq -y install --no-install-recommends "$@" >>"$log" 2>&1; }
remove() { inside apt-get -qq -y autoremove --purge stromboli >>"$log" 2>&1; }
say() { echo "$suite: $*"; }
inside apt-get -qq update >>"$log" 2>&1 || cannot "there is no mirror for $suite; see $log"
# What a try that failed has left.
[[ ! -e $bare/usr/bin/stromboli ]] || remove || cannot "the package of an earlier try cannot be removed; see $log"

# What apt finds lacking: in the bare system, before anything else is there.
cp "$package" "$bare/stromboli.deb"
inside apt-get install -s --no-install-recommends /stromboli.deb >"$folder/apt.log" 2>&1 || {
    sed -n '/unmet dependencies/,$p' "$folder/apt.log" >&2
    fail "apt finds the dependencies of $(basename "$package") nowhere (above)"
}
grep -q '^Inst stromboli ' "$folder/apt.log" || fail "apt would not install the package"

# The wheel first, where none of the package's libraries are: with a driver, a loader and Python.
install libvulkan1 mesa-vulkan-drivers python3-venv || cannot "there is no mirror for $suite; see $log"
version=$(inside python3 -c 'import sys; print("3.%d" % sys.version_info.minor)')
python=cp${version/./}
if [[ ! -e $(echo "$build"/python/_stromboli.cpython-"${version/./}"-*.so) ]]; then
    if [[ ! -e $folder/headers ]]; then
        inside sh -c "cd /tmp && apt-get -qq download libpython$version-dev pybind11-dev" >>"$log" 2>&1 ||
            cannot "the headers of Python $version cannot be had; see $log"
        rm -rf "$folder/unpacked"
        mkdir "$folder/unpacked"
        for part in "$bare"/tmp/*-dev_*.deb; do dpkg-deb -x "$part" "$folder/unpacked"; done
        mv "$folder/unpacked" "$folder/headers"
    fi
    made=0
    "${PYTHON:-python3}" "$root/python/make_wheel.py" "$build" "$folder/headers/usr/include" >>"$log" 2>&1 || made=$?
    ((made != 77)) || cannot "$(tail -n 1 "$log")"
    ((made == 0)) || fail "the wheel for Python $version could not be made; see $log"
fi
wheel=$(only "$build"/packages/stromboli-*-"$python"-manylinux*.whl)
[[ -e $(echo "$folder"/wheels/numpy-*) ]] ||
    "${PYTHON:-python3}" -m pip download -q --only-binary :all: --python-version "$version" --platform "manylinux2014_$(uname -m)" \
        --platform "manylinux_2_28_$(uname -m)" -d "$folder/wheels" numpy >>"$log" 2>&1 || cannot "numpy cannot be had; see $log"

picture=(cornell_mirror_glass -r 96 72 -s 8 --notes off -q)
"$build/bin/stromboli" render "${picture[@]}" -o "$folder/here.exr"
"$build/bin/stromboli" render "${picture[@]}" --aov -o "$bare/with_layers.exr"
rm -rf "$bare/wheels" "$bare/env"
mkdir "$bare/wheels"
cp "$wheel" "$folder"/wheels/numpy-* "$bare/wheels"
inside python3 -m venv /env
inside /env/bin/pip install -q --no-compile --no-index --find-links /wheels stromboli >>"$log" 2>&1 || {
    tail -n 20 "$log" >&2
    fail "pip does not install $(basename "$wheel")"
}
# Both pictures take less than a second; with lanes that a Mesa cannot do, minutes (docs/results.md, "Mesa 25").
inside timeout 600 /env/bin/python -B - <<'PYTHON' || fail "the module of the wheel does not work, or takes more than 10 min"
import numpy
import stromboli

picture = stromboli.render("cornell_mirror_glass", width=96, height=72, samples=8, progress=False)
expected = stromboli.read("/with_layers.exr")
assert numpy.array_equal(picture, expected), "the module's picture is not that of the program here"
assert numpy.array_equal(picture.variance, expected.variance), "nor is its variance"
PYTHON
say "$(basename "$wheel") installed by pip, and its picture has the numbers of the program here"

install --download-only /stromboli.deb || cannot "the package's dependencies cannot be had; see $log"
install /stromboli.deb || {
    tail -n 20 "$log" >&2
    fail "apt does not install $(basename "$package")"
}
inside stromboli --version || fail "the installed program does not start"
inside stromboli devices || fail "the installed program finds no device"
inside timeout 600 stromboli render "${picture[@]}" -o /there.exr || fail "the installed program does not render in 10 min"
cmp "$bare/there.exr" "$folder/here.exr" || fail "the picture of the installed program has other bytes"
say "$(basename "$package") installed by apt, and its picture has the same bytes as here"

rm -rf "$bare/env" "$bare/wheels"
remove || fail "apt does not remove the package"
for left in "$bare"/usr/{bin,lib,share,share/doc}/stromboli; do
    [[ ! -e $left ]] || fail "the removed package leaves ${left#"$bare"}"
done
