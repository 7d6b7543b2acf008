#!/usr/bin/python3
"""Writes an animation to measure sequences with: a box that goes around, for two seconds, over hills of 500,000
triangles that stand still.

    scene/generate/gltf/moving_box.py moving_box.glb"""

import math
import pathlib
import sys

from files import FLOAT, Gltf
from shapes import Mesh

PATCHES, SQUARES = 4, 125  # on a side; a patch has fewer than 65536 corners
KEYS = 9


def hills(column, row):
    mesh = Mesh()
    for j in range(SQUARES + 1):
        for i in range(SQUARES + 1):
            x = 20 * (column + i / SQUARES) / PATCHES - 10
            z = 20 * (row + j / SQUARES) / PATCHES - 10
            mesh.positions.append((x, 0.5 * math.sin(1.3 * x) * math.cos(1.7 * z) + 0.02 * math.sin(40 * x * z), z))
    for j in range(SQUARES):
        for i in range(SQUARES):
            a = j * (SQUARES + 1) + i
            b = a + SQUARES + 1
            mesh.triangles += [(a, b, b + 1), (a, b + 1, a + 1)]
    return mesh


def box():
    mesh = Mesh()
    mesh.positions = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
    for a, b, c, d in ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)):
        mesh.triangles += [(a, b, c), (a, c, d)]
    return mesh


def moving_box():
    gltf = Gltf("a box over hills")
    grey = gltf.material("grey", (0.6, 0.6, 0.6, 1))
    for column in range(PATCHES):
        for row in range(PATCHES):
            gltf.place(f"hills {column} {row}", hills(column, row), grey)
    gltf.place("box", box(), gltf.material("red", (0.7, 0.2, 0.1, 1)))
    moving = len(gltf.document["nodes"]) - 1
    gltf.camera("camera", 0.8, (0, 6, 16), (0, 0, 0))
    turns = [2 * math.pi * k / (KEYS - 1) for k in range(KEYS)]
    times = gltf.accessor([(2 * k / (KEYS - 1),) for k in range(KEYS)], FLOAT, bounds=True)
    places = gltf.accessor([(4 * math.cos(t), 2, 4 * math.sin(t)) for t in turns], FLOAT)
    gltf.add("animations", {"samplers": [{"input": times, "output": places}],
                            "channels": [{"sampler": 0, "target": {"node": moving, "path": "translation"}}]})
    return gltf.glb()


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    pathlib.Path(sys.argv[1]).write_bytes(moving_box())


main()
