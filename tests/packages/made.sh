#!/bin/bash
# Makes the Debian package or the wheel of a build, and looks into it:
#
#   tests/packages/made.sh deb|wheel BUILD
#
# Exit codes: 1 something is wrong with it, and what; 77 it cannot be made here, and why.

set -euo pipefail
kind=$1
build=$(cd "$2" && pwd)
root=$(cd "$(dirname "$(readlink -f "$0")")/../.." && pwd)
folder=$build/packages
version=$("$build/bin/stromboli" --version | cut -d' ' -f2)
private=(cpp-httplib fmt spdlog tinyxml2 zip) # cmake/Package.cmake
cannot() {
    echo "NOT TRIED: $*" >&2
    exit 77
}
fail() {
    echo "FAILED: $*" >&2
    exit 1
}
# has WHERE TEXT: what the package has to say or to hold.
has() { grep -qF -- "$2" <<<"${!1}" || fail "the $1 do not have $2"; }

if [[ $kind == deb ]]; then
    for tool in dpkg-deb dpkg-shlibdeps file patchelf; do
        command -v "$tool" >/dev/null || cannot "$tool is not installed"
    done
    mkdir -p "$folder"
    touch "$folder/stromboli_0.0.1_amd64.deb" # of an earlier version
    (cd "$build" && cpack -G DEB) >"$build/package_deb.log" 2>&1 || {
        tail -n 20 "$build/package_deb.log" >&2
        fail "no package"
    }
    made=("$folder"/stromboli_*.deb)
    ((${#made[@]} == 1)) || fail "expected one package, found ${made[*]}"
    fields=$(dpkg-deb -f "${made[0]}")
    files=$(dpkg-deb -c "${made[0]}")
    # Linked libraries by their packages; the loader and a driver, which are opened at run time.
    has fields "Version: $version"
    for needed in libopenexr- libtbb12 libvulkan1 'mesa-vulkan-drivers | vulkan-icd'; do has fields "$needed"; done
    for name in bin/stromboli share/stromboli/scenes/island.dae share/man/man1/stromboli.1.gz; do
        has files " ./usr/$name"
    done
    # What the two releases do not have alike is in the package, with its licence, and nowhere else.
    for library in "${private[@]}"; do
        has files " ./usr/lib/stromboli/lib$library.so."
        has files " ./usr/share/doc/stromboli/libraries/lib$library"
        ! grep -q "^Depends:.* lib$library" <<<"$fields" || fail "the package brings lib$library and asks for it too"
    done
    exit
fi

made=0
wheel=$("${PYTHON:-python3}" "$root/python/make_wheel.py" "$build") || made=$?
((made != 77)) || cannot "there is no auditwheel"
((made == 0)) || fail "no wheel"
files=$(unzip -l "$wheel" 2>/dev/null || "${PYTHON:-python3}" -m zipfile -l "$wheel")
# auditwheel has given it its name: a Debian 12 has glibc 2.36, and whatever is older does for it.
[[ $wheel =~ -manylinux_2_([0-9]+)_ ]] || fail "$wheel runs on one system only"
((BASH_REMATCH[1] <= 36)) || [[ $(ldd --version | sed -n '1s/.*\.//p') -gt 36 ]] || fail "$wheel is not for Debian 12"
for name in stromboli/__init__.py stromboli/py.typed stromboli/scenes/island.dae stromboli.libs/libOpenEXR \
    .dist-info/libraries/libopenexr .dist-info/copyright; do
    has files "$name"
done
! grep -q stromboli.libs/libvulkan <<<"$files" || fail "the wheel brings a Vulkan loader, which is the user's"
