#!/usr/bin/python3
"""Makes the pictures of bundled scenes.

    docs/pictures/bundled_scenes.py overview FOLDER PICTURE.png
    docs/pictures/bundled_scenes.py contact FOLDER SHEET.webp

overview: the picture of README.md, the four rooms. contact: the sheet of docs/guide/denoise.md, a row for each
scene: 32 samples a pixel, the same picture denoised, the same through the agx curve, and 4,096 samples. Pictures that are
in FOLDER already are not rendered again. Needs the package python3-pil. The sheet takes some ten minutes on two cores."""

import argparse
import os
import pathlib
import subprocess

from PIL import Image, ImageDraw

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAM = os.environ.get("STROMBOLI", ROOT / "stromboli")  # another build of it

OVERVIEW = (480, 270)
OVERVIEW_SCENES = {
    "reading_room": ["-s", 256],
    "door_ajar": ["-s", 1024],
    "bathroom": ["-s", 768],
    "atrium": ["-s", 256],
}
OVERVIEW_COLUMNS = 2

SHEET, LABEL, GAP = (160, 120), 16, 4
SHEET_SCENES = ["cornell_boxes", "cornell_mirror_glass", "cornell_metal", "light_sphere", "island", "texture_chart",
                "lighthouse", "still_life"]
FEW, MANY = 32, 4096


def stromboli(*words):
    subprocess.run([PROGRAM, *map(str, words), "-q"], check=True)


def rendered(file, scene, size, *words):
    if not file.exists():
        stromboli("render", scene, "-o", file, "-r", *size, *words)
    return file


def shown(file, *words):
    """A picture for a screen of one with radiance."""
    png = file.with_name("shown.png")
    stromboli("tonemap", file, "-o", png, *words)
    return Image.open(png).convert("RGB")


def overview(folder, output):
    width, height = OVERVIEW
    rows = len(OVERVIEW_SCENES) // OVERVIEW_COLUMNS
    sheet = Image.new("RGB", (OVERVIEW_COLUMNS * (width + GAP) - GAP, rows * (height + GAP) - GAP), "white")
    for i, (scene, words) in enumerate(OVERVIEW_SCENES.items()):
        picture = rendered(folder / f"overview-{scene}.png", scene, OVERVIEW, "--denoise", "on", "--view", "agx", *words)
        row, column = divmod(i, OVERVIEW_COLUMNS)
        sheet.paste(Image.open(picture).convert("RGB"), (column * (width + GAP), row * (height + GAP)))
    sheet.save(output, optimize=True)


def contact(folder, output):
    width, height = SHEET
    columns = [f"{FEW} samples", "denoised", "denoised, agx", f"{MANY:,} samples"]
    sheet = Image.new("RGB", (len(columns) * (width + GAP) - GAP, LABEL + len(SHEET_SCENES) * (height + GAP)), "white")
    draw = ImageDraw.Draw(sheet)
    for column, title in enumerate(columns):
        draw.text((column * (width + GAP) + 2, 2), title, fill="black")
    for row, scene in enumerate(SHEET_SCENES):
        few = rendered(folder / f"{scene}-{FEW}.exr", scene, SHEET, "-s", FEW, "--denoise", "on")
        many = rendered(folder / f"{scene}-{MANY}.exr", scene, SHEET, "-s", MANY)
        for column, picture in enumerate([shown(few, "--layer", "noisy"), shown(few), shown(few, "--view", "agx"), shown(many)]):
            sheet.paste(picture, (column * (width + GAP), LABEL + row * (height + GAP)))
    sheet.save(output, quality=85)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["overview", "contact"])
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("output", type=pathlib.Path)
    o = parser.parse_args()
    o.folder.mkdir(parents=True, exist_ok=True)
    (overview if o.what == "overview" else contact)(o.folder, o.output)


if __name__ == "__main__":
    main()
