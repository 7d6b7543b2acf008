#!/usr/bin/env python3
"""measure.py PROGRAM FOLDER SCENE... [--samples 16,64,256] [--seeds N] [--reference N] [--size W H]

What the denoiser gains: renders each scene with --denoise on, and compares both the noisy picture and the denoised one
(channels of one file) with two references of other seeds, which are kept in FOLDER and have the same number of samples for
all pixels. The product of the differences to both
has the expectation of the squared error: the references' own errors do not count. For each number of samples a line: the
noise and the error of the denoised picture (square roots of relMSE), by how much relMSE is divided, what the program has
stated of its error and whether its range held, and by how much the light of the whole picture changed.
"""
import argparse
import json
import math
import os
import struct
import subprocess
import zlib
from array import array


def read_exr(path):
    """The channels of a scan-line file of floats that Stromboli has written (ZIP, 16 lines a block)."""
    data = open(path, "rb").read()
    at, attributes = 8, {}
    while data[at]:
        words = []
        for _ in range(2):
            end = data.index(0, at)
            words.append(data[at:end].decode())
            at = end + 1
        size = struct.unpack_from("<i", data, at)[0]
        attributes[words[0]] = data[at + 4 : at + 4 + size]
        at += 4 + size
    at += 1
    left, top, right, bottom = struct.unpack("<4i", attributes["dataWindow"])
    width, height = right - left + 1, bottom - top + 1
    names, channels = [], attributes["channels"]
    place = 0
    while channels[place]:
        end = channels.index(0, place)
        names.append(channels[place:end].decode())
        place = end + 17
    values = {name: array("f", bytes(4 * width * height)) for name in names}
    blocks = struct.unpack_from(f"<{(height + 15) // 16}Q", data, at)
    for offset in blocks:
        row, size = struct.unpack_from("<ii", data, offset)
        rows = min(16, bottom - row + 1)
        packed = data[offset + 8 : offset + 8 + size]
        full = rows * width * 4 * len(names)
        raw = bytes(packed) if size == full else unpacked(packed)
        at = 0
        for line in range(row - top, row - top + rows):
            for name in names:
                values[name][line * width : (line + 1) * width] = array("f", raw[at : at + 4 * width])
                at += 4 * width
    return values


def unpacked(packed):
    """ZIP of OpenEXR: differences of bytes, of which every other one is in the second half."""
    data = bytearray(zlib.decompress(packed))
    last = data[0]
    for i in range(1, len(data)):
        last = (last + data[i] - 128) & 255
        data[i] = last
    half = (len(data) + 1) // 2
    raw = bytearray(len(data))
    raw[0::2], raw[1::2] = data[:half], data[half:]
    return bytes(raw)


def errors(picture, references, layer=""):
    """What each pixel adds to the relMSE as stromboli compare has it (host/compare/metrics.hpp), without the references' own
    errors."""
    one, other = references
    colors = [array("f", ((a + b) / 2 for a, b in zip(one[c], other[c]))) for c in "RGB"]
    mean = sum(sum(c) for c in colors) / (3 * len(colors[0]))
    epsilon = 0.01 * mean * mean
    added = [0.0] * len(colors[0])
    for c, true in zip("RGB", colors):
        for i, (x, a, b, t) in enumerate(zip(picture[layer + c], one[c], other[c], true)):
            added[i] += (x - a) * (x - b) / (t * t + epsilon) / (3 * len(true))
    return added


def without_worst(errors):
    """Their sum without the largest thousandth: single pixels at the edge of a lamp may have most of a picture's relMSE."""
    return sum(sorted(errors)[: len(errors) - len(errors) // 1000])


def light(picture, layer=""):
    return sum(sum(picture[layer + c]) for c in "RGB")


def run(*words):
    subprocess.run([str(word) for word in words], check=True, stdout=subprocess.DEVNULL)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("folder")
    parser.add_argument("scenes", nargs="+")
    parser.add_argument("--samples", default="16,64,256")
    parser.add_argument("--seeds", type=int, default=1)
    parser.add_argument("--reference", type=int, default=1024)
    parser.add_argument("--size", nargs=2, default=[320, 180])
    parser.add_argument("--denoise", default="on", help="or oidn")
    parser.add_argument("--options", default="", help="of all renders")
    o = parser.parse_args()
    os.makedirs(o.folder, exist_ok=True)
    gains = {}
    print("| scene | samples | noise | denoised | relMSE divided by | without the worst 0.1 % | stated | range | held | light | moved | noisy share |")
    print("|---|---|---|---|---|---|---|---|---|---|---|---|")
    for scene in o.scenes:
        name = os.path.splitext(os.path.basename(scene))[0]
        if name in ("mitsuba3", "scene"):
            name = os.path.basename(os.path.dirname(scene))
        common = ["-r", *o.size, *o.options.split(), "-q"]
        references = []
        for seed in (4711, 4712):
            file = os.path.join(o.folder, f"{name}-{o.reference}-{seed}.exr")
            if not os.path.exists(file):
                run(o.program, "render", scene, "-o", file, "-s", o.reference, "--even", "--seed", seed, *common)
            references.append(read_exr(file))
        for samples in map(int, o.samples.split(",")):
            for seed in range(1, o.seeds + 1):
                picture, stats = (os.path.join(o.folder, f"{name}-{samples}-{seed}-{o.denoise}.{end}") for end in ("exr", "json"))
                run(o.program, "render", scene, "-o", picture, "-s", samples, "--seed", seed, "--denoise", o.denoise,
                    "--stats", stats, *common)
                channels = read_exr(picture)
                said = json.load(open(stats))["denoised"]
                before, after = errors(channels, references, "noisy."), errors(channels, references)
                noisy, denoised = sum(before), sum(after)
                trimmed = without_worst(before) / without_worst(after)
                gains.setdefault(samples, []).append((noisy / denoised, trimmed))
                true, stated, span = math.sqrt(max(denoised, 0)), said["noise"], said["noiseRange"]
                known = stated is not None
                print(f"| {name} | {samples} | {100 * math.sqrt(max(noisy, 0)):.2f} % | {100 * true:.2f} % | {noisy / denoised:.2f} | {trimmed:.2f} | "
                      + (f"{100 * stated:.2f} % | {100 * span[0]:.2f} to {100 * span[1]:.2f} % | "
                         f"{'yes' if span[0] <= true <= span[1] else 'NO'}" if known else "unknown | | ")
                      + f" | {100 * (light(channels) / light(channels, 'noisy.') - 1):+.2f} % | {100 * said['movedLight']:.2f} % | "
                      f"{100 * said['noisyShare']:.0f} % |", flush=True)
    for samples, all_gains in gains.items():
        for what, some in zip(("", " without the worst 0.1 % of pixels"), zip(*all_gains)):
            mean = math.exp(sum(map(math.log, some)) / len(some))
            print(f"{samples} samples: relMSE{what} divided by {mean:.2f} (geometric mean), {min(some):.2f} at least")


if __name__ == "__main__":
    main()
