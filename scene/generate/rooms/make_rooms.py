#!/usr/bin/python3
"""Writes the bundled rooms, scenes of Mitsuba 3 with meshes and pictures in folders: the same bytes on each run.

    scene/generate/rooms/make_rooms.py scene/library [ROOM...]
    scene/generate/rooms/make_rooms.py --check scene/library [ROOM...]

--check writes nothing and fails if a file is not what would be written, or is no longer."""

import pathlib
import sys

sys.path.insert(1, str(pathlib.Path(__file__).resolve().parent.parent / "gltf"))

from atrium import atrium
from bathroom import bathroom
from door_ajar import door_ajar
from reading_room import reading_room

ROOMS = (atrium, bathroom, door_ajar, reading_room)


def write(folder, room):
    files = room.made()
    (folder / room.name).mkdir(exist_ok=True)
    for name, data in files.items():
        (folder / name).write_bytes(data)
    for left in left_over(folder, room):
        left.unlink()
    print(f"{folder / room.name}: {len(files)} files, {sum(map(len, files.values()))} bytes, "
          f"{room.unique} triangles, {len(room.places)} instances")


def check(folder, room):
    for name, data in room.made().items():
        file = folder / name
        if not file.is_file() or file.read_bytes() != data:
            sys.exit(f"{file} is not what {__file__} writes")
    for left in left_over(folder, room):
        sys.exit(f"{left}: {__file__} does not write it")


def left_over(folder, room):
    return [file for file in sorted((folder / room.name).iterdir()) if f"{room.name}/{file.name}" not in room.files]


def main():
    words = sys.argv[1:]
    checks = words[:1] == ["--check"]
    words = words[checks:]
    rooms = [room for room in ROOMS if room.__name__ in words[1:] or not words[1:]]
    if not words or not pathlib.Path(words[0]).is_dir() or not rooms:
        sys.exit(__doc__)
    for room in rooms:
        (check if checks else write)(pathlib.Path(words[0]), room())


main()
