# A bare Debian in a folder, for scripts that try something there (tests/distributions, tests/packages), which read this file
# as root:
#
#   own_mounts "$@"          begins the script anew with mounts of its own, which end with it, however it ends: /dev is not
#                            in the folder for those who delete it later. Fails where mounts are not allowed
#   cannot WHY               ends the script with 77, the exit code of what was not tried
#   need_bare "$@"           own_mounts, or cannot: no root, no mmdebstrap, no mounts
#   make_bare SUITE FOLDER   makes it with mmdebstrap from STROMBOLI_MIRROR, unless it is there; fails where that fails
#   enter_bare FOLDER        gives it what programs ask of a system that runs
#
# mmdebstrap, because debootstrap takes twice the CPU time for the same system.

own_mounts() {
    [[ -z ${STROMBOLI_OWN_MOUNTS-} ]] || return 0
    unshare --mount true 2>/dev/null || return
    STROMBOLI_OWN_MOUNTS=1 exec unshare --mount "$0" "$@"
}

cannot() {
    echo "NOT TRIED: $*" >&2
    exit 77
}

need_bare() {
    ((EUID == 0)) || cannot "root is needed, for chroot"
    command -v mmdebstrap >/dev/null || cannot "mmdebstrap is not installed"
    own_mounts "$@" || cannot "mounts are not allowed here"
}

make_bare() {
    [[ -e $2/made ]] && return
    mkdir -p "$(dirname "$2")"
    # What is left of one that was broken off goes; a folder with anything else in it stays.
    if [[ -e $2.unfinished ]]; then rm -rf --one-file-system "$2"; fi
    [[ -z $(ls -A "$2" 2>/dev/null) ]] || {
        echo "$2 is not empty, and no bare Debian is there" >"$2.log"
        return 1
    }
    touch "$2.unfinished"
    mmdebstrap --quiet --mode=root --variant=apt --skip=cleanup/apt/lists --format=directory "$1" "$2" \
        "${STROMBOLI_MIRROR:-http://deb.debian.org/debian}" >"$2.log" 2>&1 || return
    touch "$2/made"
    rm "$2.unfinished"
}

enter_bare() {
    local place
    for place in proc dev sys; do mount --bind "/$place" "$1/$place"; done
    cp /etc/resolv.conf "$1/etc/resolv.conf"
}
