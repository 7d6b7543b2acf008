#!/usr/bin/python3
"""Writes the bundled glTF scenes and the bundled environments: the same bytes on each run.

    scene/generate/gltf/make_scenes.py scene/library
    scene/generate/gltf/make_scenes.py --check scene/library

--check writes nothing and fails if a file is not what would be written."""

import pathlib
import sys

from environments import interior, overcast, studio
from pictures import evening_sky
from still_life import still_life
from texture_chart import texture_chart

FILES = {"still_life.glb": still_life, "texture_chart.glb": texture_chart, "evening_sky.hdr": evening_sky,
         "studio.hdr": studio, "overcast.hdr": overcast, "interior.hdr": interior}


def main():
    check = sys.argv[1:2] == ["--check"]
    folder = pathlib.Path(sys.argv[-1])
    if len(sys.argv) != 2 + check or not folder.is_dir():
        sys.exit(__doc__)
    for name, make in FILES.items():
        made, file = make(), folder / name
        if not check:
            file.write_bytes(made)
            print(f"{file}: {len(made)} bytes")
        elif not file.is_file() or file.read_bytes() != made:
            sys.exit(f"{file} is not what {__file__} writes")


main()
