#!/usr/bin/env python3
"""Stromboli against Blender's Cycles on glTF models, as an independent second opinion.

    python3 -m venv cycles && cycles/bin/pip install bpy==5.0.1 numpy    # Python 3.11
    python3 tests/peers/against_cycles.py --python cycles/bin/python ENVIRONMENT.hdr MODEL.glb...

(or, without --python, Debian's Blender: apt-get install blender python3-numpy) renders each model with both programs, with the same camera, environment and pixel filter, and prints how
far the means are apart, in percent of Cycles', for each channel: of the model as it is, and of the same
model with matte materials, where both programs have the same model of light (Lambert's), so that what
differs is geometry, textures, opacity, camera or light. With --time it prints how much processor
time Stromboli takes, as a whole process, to the relMSE that Cycles has at 64 samples, and Cycles'
for the render alone.
"""

import argparse
import json
import math
import os
import pathlib
import re
import resource
import shutil
import struct
import subprocess
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parents[1]
FOV = 40  # degrees, of the picture's height
BOUNCES = 8


def run(*command):
    # Blender takes the modules of the Python that it finds first: the system's, which has numpy.
    environment = os.environ | {"PATH": "/usr/bin:" + os.environ["PATH"]}
    done = subprocess.run([str(c) for c in command], capture_output=True, text=True, check=False,
                          env=environment)
    if done.returncode:
        raise SystemExit(f"{command[0]} failed:\n{done.stderr}{done.stdout[-2000:]}")
    return done.stdout + done.stderr


def processor_seconds():
    """Of the programs that have been run so far."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def make_matte(document):
    """Lambert's surfaces: no metal, no specular reflection, no layers. Texels are not interpolated:
    Cycles interpolates sRGB bytes before it decodes them, which is darker where they differ. Normal
    maps are left out, under which Cycles dims diffuse surfaces that light grazes ("Taming the Shadow
    Terminator", Conty Estevez et al. 2019)."""
    document["samplers"] = document.get("samplers", []) + [{}]
    for sampler in document["samplers"]:
        sampler.update(magFilter=9728, minFilter=9728)
    for texture in document.get("textures", []):
        texture.setdefault("sampler", len(document["samplers"]) - 1)
    kept = {"KHR_materials_unlit", "KHR_materials_emissive_strength", "KHR_texture_transform"}
    for material in document.get("materials", []):
        pbr = material.setdefault("pbrMetallicRoughness", {})
        pbr.pop("metallicRoughnessTexture", None)
        material.pop("normalTexture", None)
        pbr.update(metallicFactor=0, roughnessFactor=1)
        extensions = {k: v for k, v in material.get("extensions", {}).items() if k in kept}
        extensions["KHR_materials_specular"] = {"specularFactor": 0}
        material["extensions"] = extensions
    used = document.setdefault("extensionsUsed", [])
    if "KHR_materials_specular" not in used:
        used.append("KHR_materials_specular")


def matte_copy(model, folder):
    """Of a .gltf with its files, or of a .glb."""
    if model.suffix == ".gltf":
        shutil.copytree(model.parent, folder / "matte")
        copy = folder / "matte" / model.name
        document = json.loads(copy.read_text())
        make_matte(document)
        copy.write_text(json.dumps(document))
        return copy
    data = model.read_bytes()
    (length,) = struct.unpack_from("<I", data, 12)
    document = json.loads(data[20 : 20 + length])
    make_matte(document)
    text = json.dumps(document).encode()
    text += b" " * (-len(text) % 4)
    rest = data[20 + length :]
    copy = folder / "matte.glb"
    copy.write_bytes(struct.pack("<4sIII4s", b"glTF", 2, 20 + len(text) + len(rest), len(text),
                                 b"JSON") + text + rest)
    return copy


def view_of(program, model):
    """From the front and a little above, so that the sphere around the model fills the picture."""
    text = run(program, "info", model)
    numbers = re.search(r"bounds \((.*?)\) to \((.*?)\) m", text)
    low, high = ([float(x) for x in group.split(",")] for group in numbers.groups())
    at = [(a + b) / 2 for a, b in zip(low, high)]
    radius = math.dist(low, high) / 2
    direction = [0.4, 0.25, 1.0]
    scale = radius / math.sin(math.radians(FOV / 2)) / math.hypot(*direction)
    return [a + scale * d for a, d in zip(at, direction)], at


class Comparison:
    def __init__(self, arguments, model, folder):
        self.arguments, self.model, self.folder = arguments, model, folder
        self.start, self.at = view_of(arguments.program, model)

    def stromboli(self, samples, name, *options):
        picture = self.folder / f"{name}.exr"
        before = processor_seconds()
        run(self.arguments.program, "render", self.model, "--env", self.arguments.environment,
            "-r", self.arguments.size, self.arguments.size, "-s", samples, "-m", BOUNCES, "--fov",
            FOV, "--look-from", *self.start, "--look-at", *self.at, "--default-light", "off",
            "-o", picture, *options)
        return picture, processor_seconds() - before

    def cycles(self, samples, name, matte, seed=0):
        picture, settings = self.folder / f"{name}.exr", self.folder / "settings.json"
        settings.write_text(json.dumps({
            "model": str(self.model), "environment": str(self.arguments.environment),
            "width": self.arguments.size, "height": self.arguments.size, "samples": samples,
            "bounces": BOUNCES, "fov": FOV, "from": self.start, "at": self.at, "matte": matte,
            "seed": seed, "picture": str(picture)}))
        python = self.arguments.python
        program = [python] if python else ["blender", "-b", "-P"]
        text = run(*program, HERE / "render_with_cycles.py", "--", settings)
        if not picture.exists():
            raise SystemExit(f"Blender wrote no picture:\n{text[-2000:]}")
        return picture, float(re.search(r"RENDER_SECONDS (\S+)", text).group(1))

    def compare(self, reference, picture):
        text = run(self.arguments.program, "compare", reference, picture, "--json", "-")
        return json.loads(text)

    def means(self, matte):
        ours, _ = self.stromboli(self.arguments.samples, "ours", "--even")
        theirs, _ = self.cycles(self.arguments.samples, "theirs", matte)
        return self.compare(theirs, ours)

    def time_to_error(self):
        """relMSE of a picture is half of that between two with different seeds, in both programs."""
        def error(pictures):
            return self.compare(*pictures)["relMse"] / 2
        theirs = [self.cycles(64, f"cycles{seed}", False, seed) for seed in (1, 2)]
        goal = error([picture for picture, _ in theirs])
        for samples in (8, 12, 16, 20, 24, 32, 48, 64, 96, 128):
            ours = [self.stromboli(samples, f"ours{seed}", "--seed", seed) for seed in (1, 2)]
            if error([picture for picture, _ in ours]) <= goal:
                break
        seconds = min(s for _, s in ours), min(s for _, s in theirs)
        print(f"{self.model.stem}: Cycles, 64 samples: relMSE {goal:.4f} in {seconds[1]:.1f} CPU s; "
              f"Stromboli, {samples} samples: {error([p for p, _ in ours]):.4f} in "
              f"{seconds[0]:.1f} CPU s, the whole process: {seconds[1] / seconds[0]:.2f} times as fast")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("environment", type=pathlib.Path)
    parser.add_argument("models", nargs="+", type=pathlib.Path)
    parser.add_argument("--python", help="a Python that has bpy, in place of Blender's program")
    parser.add_argument("--program", default=ROOT / "build/release/bin/stromboli")
    parser.add_argument("--samples", type=int, default=1024)
    parser.add_argument("--size", type=int, default=128, help="width and height of the pictures")
    parser.add_argument("--time", action="store_true", help="time to error, in place of means")
    parser.add_argument("--keep", type=pathlib.Path, help="folder for the pictures")
    arguments = parser.parse_args()
    arguments.environment = arguments.environment.resolve()
    if not arguments.time:
        print("| model | as it is (r, g, b) | matte |\n|---|---|---|")
    for model in arguments.models:
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            if arguments.time:
                Comparison(arguments, model.resolve(), folder).time_to_error()
                continue
            cells = []
            for matte in (False, True):
                used = matte_copy(model.resolve(), folder) if matte else model.resolve()
                result = Comparison(arguments, used, folder).means(matte)
                cells.append(", ".join(f"{100 * b:+.2f} %" for b in result["relativeBias"]))
                if arguments.keep:
                    arguments.keep.mkdir(parents=True, exist_ok=True)
                    for which in ("ours", "theirs"):
                        kind = "_matte" if matte else ""
                        shutil.copy(folder / f"{which}.exr",
                                    arguments.keep / f"{model.stem}{kind}_{which}.exr")
            print(f"| {model.stem} | {cells[0]} | {cells[1]} |", flush=True)


if __name__ == "__main__":
    main()
