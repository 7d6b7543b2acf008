#!/bin/bash
# How many files of formats that Assimp reads load (docs/guide/assimp.md):
#
#   tests/peers/assimp_files.sh PROGRAM [FOLDER]
#
# PROGRAM: stromboli; FOLDER: /usr/share/assimp/models of Debian's assimp-testmodels. Formats that the
# program reads by itself are left out, and pictures. 20 s for each file at most.
program=$1
folder=${2:-/usr/share/assimp/models}
errors=$(mktemp)
trap 'rm -f "$errors"' EXIT
find "$folder" -type f -not -iname '*.obj' -not -iname '*.ply' -not -iname '*.gl[tb]*' -not -iname '*.dae' -not -iname '*.png' |
    while read -r file; do
        timeout 20 "$program" info "$file" >/dev/null 2>"$errors"
        case $? in
            0) echo "load" ;;
            124) echo "take more than 20 s" ;;
            2) grep -q 'is in no format that is read' "$errors" && echo "of no format" || echo "end with an error" ;;
            *) echo "end otherwise: $file" ;;
        esac
    done | sort | uniq -c
