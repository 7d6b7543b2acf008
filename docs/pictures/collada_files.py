#!/usr/bin/python3
"""Makes docs/pictures/collada_files.png: the COLLADA files of Debian's package assimp-testmodels, as
Stromboli shows them. Prints what each was forgiven, for the table in docs/guide/collada.md.

Needs the packages assimp-testmodels and python3-pil. Half a minute on two cores."""

import pathlib
import subprocess
import sys
import tempfile

from PIL import Image, ImageDraw

ROOT = pathlib.Path(__file__).resolve().parents[2]
MODELS = pathlib.Path("/usr/share/assimp/models/Collada")
WIDTH, HEIGHT, LABEL, GAP, COLUMNS = 160, 120, 24, 4, 7
LETTERS = WIDTH // 6  # of Pillow's own font in a line


def render(model, picture):
    """What Stromboli says of the file; the picture is written."""
    run = subprocess.run(
        [ROOT / "stromboli", "render", model, "-o", picture, "-r", str(WIDTH), str(HEIGHT), "-s", "64"],
        stderr=subprocess.PIPE, text=True)
    if "nothing to draw" in run.stderr:
        Image.new("RGB", (WIDTH, HEIGHT)).save(picture)
    elif run.returncode != 0:
        sys.exit(f"{model}: {run.stderr}")
    return run.stderr.splitlines()


def tile(picture, name, lines):
    """A picture above the name of its file."""
    image = Image.new("RGB", (WIDTH, HEIGHT + LABEL), (40, 40, 40))
    image.paste(Image.open(picture).convert("RGB"))
    draw = ImageDraw.Draw(image)
    if any("nothing to draw" in line for line in lines):
        draw.text((36, HEIGHT // 2 - 6), "nothing to draw", fill=(160, 160, 160))
    for i in range(0, min(len(name), 2 * LETTERS), LETTERS):
        draw.text((3, HEIGHT + 1 + 11 * (i // LETTERS)), name[i : i + LETTERS], fill=(255, 255, 255))
    return image


def main():
    models = [m for m in MODELS.iterdir() if m.suffix.lower() in (".dae", ".zae")]
    models.sort(key=lambda m: m.name.lower())
    if not models:
        sys.exit(f"{MODELS} has no models: apt-get install assimp-testmodels")
    rows = -(-len(models) // COLUMNS)
    step_x, step_y = WIDTH + GAP, HEIGHT + LABEL + GAP
    sheet = Image.new("RGB", (COLUMNS * step_x - GAP, rows * step_y - GAP), (90, 90, 90))
    with tempfile.TemporaryDirectory() as folder:
        for i, model in enumerate(models):
            picture = pathlib.Path(folder) / "picture.png"
            lines = render(model, picture)
            sheet.paste(tile(picture, model.name, lines), (i % COLUMNS * step_x, i // COLUMNS * step_y))
            print(model.name)
            for line in lines:
                if line.startswith(("warning: ", "error: ")) or "light" in line or "camera" in line:
                    print("   ", line.replace(f"{model.parent}/", ""))
    # 64 colours are enough for pictures this small.
    sheet.quantize(64).save(ROOT / "docs/pictures/collada_files.png", optimize=True)


main()
