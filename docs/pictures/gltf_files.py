#!/usr/bin/python3
"""Makes contact sheets for docs/guide/gltf.md: glTF models as Stromboli shows them.

    docs/pictures/gltf_files.py MODELS ENVIRONMENT.hdr FOLDER SHEET.png

MODELS has a folder for each model, or folders of such folders. The pictures are rendered 640 x 480
into FOLDER, to be looked at, where they are not there yet; the sheet has them smaller. A model that
is refused has the message in its place. Needs the package python3-pil. Some minutes on two cores."""

import argparse
import math
import os
import pathlib
import re
import subprocess
import sys
import textwrap

from PIL import Image, ImageDraw

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("STROMBOLI", ROOT / "stromboli")  # another build of it
RENDERED = (640, 480)
WIDTH, HEIGHT, LABEL, GAP, COLUMNS = 200, 150, 14, 4, 5
FOV = 30  # degrees of the height: little perspective, since most models are charts

# Where solids are seen from: degrees about the vertical and above the horizon. All others are
# charts that are read from the front, +z.
VIEWS = {
    "Duck": (0, 10), "DamagedHelmet": (15, 5), "MultiUVTest": (30, 25), "SheenCloth": (0, 35),
    "SimpleInstancing": (30, 20), "LightsPunctualLamp": (20, 5), "TransmissionTest": (0, 10),
}


# Lamps of up to 180 candela.
OPTIONS = {"LightsPunctualLamp": ["--exposure", -5]}


class Refused(Exception):
    """The program's message."""


def stromboli(*words):
    run = subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True)
    if run.returncode != 0:
        raise Refused(run.stderr.strip().splitlines()[-1])
    return run


def bounds(model):
    """The least and the greatest corner."""
    corner = r"\(([^)]*)\)"
    found = re.search(f"bounds {corner} to {corner}", stromboli("info", model).stdout)
    if not found:
        raise Refused("nothing to see")
    return [[float(x) for x in text.split(",")] for text in found.groups()]


def view(model, name):
    """Options that show the whole bounding box, as large as it can be."""
    low, high = bounds(model)
    middle = [(a + b) / 2 for a, b in zip(low, high)]
    turn, rise = (math.radians(angle) for angle in VIEWS.get(name, (0, 0)))
    back = (math.sin(turn) * math.cos(rise), math.sin(rise), math.cos(turn) * math.cos(rise))
    right = (math.cos(turn), 0, -math.sin(turn))
    up = (back[1] * right[2], back[2] * right[0] - back[0] * right[2], -back[1] * right[0])
    tangent = math.tan(math.radians(FOV / 2))
    distance = 0
    for corner in range(8):
        offset = [(b - a) / 2 * (1 if corner >> axis & 1 else -1)
                  for axis, (a, b) in enumerate(zip(low, high))]
        x, y, z = (sum(a * b for a, b in zip(offset, axis)) for axis in (right, up, back))
        distance = max(distance, z + max(abs(y), abs(x) * HEIGHT / WIDTH) / tangent)
    distance *= 1.04  # a little air
    return ["--look-from", *(f"{m + distance * b:.6g}" for m, b in zip(middle, back)),
            "--look-at", *(f"{m:.6g}" for m in middle), "--fov", FOV]


def render(model, name, environment, picture):
    if not picture.exists():
        print(name, stromboli("render", model, "-o", picture, "-r", *RENDERED, "-s", 64,
                              "--env", environment, *view(model, name.split()[0]),
                              *OPTIONS.get(name, [])).stderr, flush=True)


def tile(picture, name, message):
    """A picture, or a message, above the name of its model."""
    image = Image.new("RGB", (WIDTH, HEIGHT + LABEL), (40, 40, 40))
    if message:
        lines = textwrap.fill(message, 32)
        ImageDraw.Draw(image).text((3, 3), lines, fill=(255, 200, 120))
    else:
        image.paste(Image.open(picture).convert("RGB").resize((WIDTH, HEIGHT), Image.LANCZOS))
    ImageDraw.Draw(image).text((3, HEIGHT + 1), name, fill=(255, 255, 255))
    return image


def models_of(folder):
    """Path by name: that of the folder, and of what else tells a file from others there."""
    files = sorted(f for f in folder.rglob("*.gl*") if f.suffix in (".glb", ".gltf"))
    found = {}
    for file in files:
        name = file.relative_to(folder).parts[0]
        for more in ("", f" {file.parent.name}", f" {file.stem}"):
            if name + more not in found:
                found[name + more] = file
                break
    return dict(sorted(found.items()))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    for name in ("models", "environment", "folder", "sheet"):
        parser.add_argument(name, type=pathlib.Path)
    arguments = parser.parse_args()
    models = models_of(arguments.models)
    if not models:
        sys.exit(f"{arguments.models} has no models")
    arguments.folder.mkdir(parents=True, exist_ok=True)

    rows = -(-len(models) // COLUMNS)
    step_x, step_y = WIDTH + GAP, HEIGHT + LABEL + GAP
    sheet = Image.new("RGB", (COLUMNS * step_x - GAP, rows * step_y - GAP), (90, 90, 90))
    for i, (name, model) in enumerate(models.items()):
        picture = arguments.folder / f"{name}.png"
        message = ""
        try:
            render(model, name, arguments.environment, picture)
        except Refused as refused:
            message = str(refused).replace(str(model.parent) + "/", "")
        sheet.paste(tile(picture, name, message), (i % COLUMNS * step_x, i // COLUMNS * step_y))
    # 256 colours are enough for pictures this small.
    sheet.quantize(256).save(arguments.sheet, optimize=True)


main()
