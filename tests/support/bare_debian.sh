# A bare Debian in a folder, for scripts that try something there (tests/distributions, tests/packages), which read this file
# as root:
#
#   make_bare SUITE FOLDER   makes it by debootstrap from STROMBOLI_MIRROR, unless it is there; fails where that fails
#   enter_bare FOLDER        gives it what programs ask of a system that runs, until the script ends

make_bare() {
    [[ -e $2/made ]] && return
    # What is left of one that was broken off goes; a folder with anything else in it stays.
    if [[ -d $2/debootstrap ]]; then rm -rf --one-file-system "$2"; fi
    mkdir -p "$2"
    [[ -z $(ls -A "$2") ]] || {
        echo "$2 is not empty, and no bare Debian is there" >"$2.log"
        return 1
    }
    debootstrap --variant=minbase "$1" "$2" "${STROMBOLI_MIRROR:-http://deb.debian.org/debian}" >"$2.log" 2>&1 || return
    touch "$2/made"
}

mounted=()
leave_bare() {
    local i
    for ((i = ${#mounted[@]} - 1; i >= 0; --i)); do umount "${mounted[i]}"; done
}

enter_bare() {
    trap leave_bare EXIT
    local place
    for place in proc dev sys; do
        mountpoint -q "$1/$place" && continue
        mount --bind "/$place" "$1/$place" && mounted+=("$1/$place")
    done
    cp /etc/resolv.conf "$1/etc/resolv.conf"
}
