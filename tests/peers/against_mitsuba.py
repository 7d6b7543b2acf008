#!/usr/bin/env python3
"""Time to the same error, Stromboli against Mitsuba 3: whole processes, CPU time.

    against_mitsuba.py STROMBOLI ROOM.xml... [--samples 64] [--seeds 4] [--size 160x90]

ROOM.xml is a scene in Mitsuba 3's syntax; both programs render it at the same size and depth. Each is
compared with a reference of its own with many samples (kept in --work), so that the error is noise and
nothing else; how far the two references' means differ is said. The error is relMSE, the mean over pixels
and channels of error^2 / (reference^2 + 0.01 mean^2), without the worst 0.1 % of pixels.

A process takes t0 + samples * t1. Both follow from two counts, --samples and four times as many, and the
time to Mitsuba's error is t0 + (time - t0) * error / (Mitsuba's error): noise falls as 1 / samples, or
faster. "speed" is Mitsuba's time over that, above 1 where Stromboli is the faster: geometric mean over
seeds with its 95 % interval (Student's t). Programs run in turn, A B A B, after a run of each that is not
counted and fills caches.

Needs mitsuba from PyPI and an LLVM of 16 or later (Debian: libllvm19; DRJIT_LIBLLVM_PATH).
"""
import argparse
import math
import os
import re
import resource
import subprocess
import sys
import tempfile

import numpy as np

RENDER = """
import sys, mitsuba as mi
mi.set_variant(sys.argv[1])
scene = mi.load_file(sys.argv[2])
image = mi.render(scene, spp=int(sys.argv[4]), seed=int(sys.argv[5]))
mi.util.write_bitmap(sys.argv[3], image, write_async=False)
"""

# Two-sided 95 % quantiles of Student's t, by degrees of freedom.
STUDENT = [12.71, 4.303, 3.182, 2.776, 2.571, 2.447, 2.365, 2.306, 2.262, 2.228]


def read_picture(path):
    import mitsuba as mi

    if not mi.variant():
        mi.set_variant("scalar_rgb")
    bitmap = mi.Bitmap(str(path)).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False)
    return np.array(bitmap, dtype=np.float64)


def cpu_seconds(command, environment=None):
    """Runs a command and returns the CPU time of it and of all its threads and children."""
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(command, env=environment, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{' '.join(command)}\n{done.stderr[-2000:]}")
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def error_of(picture, reference):
    mean = reference.mean()
    errors = ((picture - reference) ** 2 / (reference**2 + 0.01 * mean**2)).mean(axis=2).ravel()
    return np.sort(errors)[: max(1, int(len(errors) * 0.999))].mean()


def restated(room, size, depth, folder):
    """The room with the size and depth of this comparison, in a folder with links to its files."""
    text = open(room, encoding="utf-8").read()
    for name, value in (("width", size[0]), ("height", size[1]), ("max_depth", depth)):
        text, count = re.subn(
            rf'(<integer\s+name="{name}"\s+value=")[^"]*"', rf'\g<1>{value}"', text
        )
        if count == 0:
            sys.exit(f'{room}: has no <integer name="{name}">')
    source = os.path.dirname(os.path.abspath(room))
    folder = os.path.join(folder, "scene_" + os.path.basename(source))
    os.makedirs(folder, exist_ok=True)
    for entry in os.listdir(source):
        link = os.path.join(folder, entry)
        if not os.path.lexists(link):
            os.symlink(os.path.join(source, entry), link)
    path = os.path.join(folder, "against_mitsuba.xml")
    with open(path, "w", encoding="utf-8") as file:
        file.write(text)
    return path


class Mitsuba:
    name = "Mitsuba"

    def __init__(self, variant):
        self.variant = variant

    def render(self, scene, out, samples, seed):
        return cpu_seconds(
            [sys.executable, "-c", RENDER, self.variant, scene, out, str(samples), str(seed)]
        )


class Stromboli:
    name = "Stromboli"

    def __init__(self, program, options):
        self.program = program
        self.options = options

    def render(self, scene, out, samples, seed):
        command = [self.program, "render", scene, "-o", out, "-s", str(samples), "--seed", str(seed)]
        return cpu_seconds(command + self.options)


def interval(logs):
    """Geometric mean and its 95 % interval."""
    mean = float(np.mean(logs))
    if len(logs) < 2:
        return math.exp(mean), float("nan"), float("nan")
    half = STUDENT[min(len(logs) - 2, len(STUDENT) - 1)] * float(np.std(logs, ddof=1)) / math.sqrt(len(logs))
    return math.exp(mean), math.exp(mean - half), math.exp(mean + half)


def label_of(room):
    """Of all rooms of a comparison another one: the file's name, or the folder's where files are named after a format."""
    folder, name = os.path.split(os.path.abspath(room))
    stem = os.path.splitext(name)[0]
    return os.path.basename(folder) if stem in ("scene", "mitsuba3") else stem


def compare(room, programs, arguments):
    size = tuple(int(n) for n in arguments.size.split("x"))
    scene = restated(room, size, arguments.depth, arguments.work)
    label = label_of(room)
    references = {}
    for program in programs:
        path = os.path.join(
            arguments.work,
            f"{label}_{program.name}_{size[0]}x{size[1]}_{arguments.depth}_{arguments.reference}.exr",
        )
        if not os.path.exists(path):
            program.render(scene, path, arguments.reference, 4711)
        references[program.name] = read_picture(path)
    out = os.path.join(arguments.work, "picture.exr")
    for program in programs:
        program.render(scene, out, 1, 0)
    counts = (arguments.samples, 4 * arguments.samples)
    times = {p.name: {n: [] for n in counts} for p in programs}
    errors = {p.name: [] for p in programs}
    for seed in range(1, arguments.seeds + 1):
        for program in programs:
            for count in counts:
                times[program.name][count].append(program.render(scene, out, count, seed))
                if count == arguments.samples:
                    errors[program.name].append(
                        error_of(read_picture(out), references[program.name])
                    )
    few, many = counts
    start = {}
    for program in programs:
        slope = (np.median(times[program.name][many]) - np.median(times[program.name][few])) / (many - few)
        start[program.name] = max(0.0, float(np.median(times[program.name][few]) - slope * few))
    target = float(np.exp(np.mean(np.log(errors["Mitsuba"]))))
    logs = []
    for own, its, error in zip(times["Stromboli"][few], times["Mitsuba"][few], errors["Stromboli"]):
        begin = min(start["Stromboli"], own)
        logs.append(math.log(its / (begin + (own - begin) * error / target)))
    speed, low, high = interval(logs)
    steady = [
        (np.median(times[n][many]) - np.median(times[n][few])) / (many - few)
        for n in ("Mitsuba", "Stromboli")
    ]
    bias = references["Stromboli"].mean() / references["Mitsuba"].mean() - 1
    cells = [label]
    for program in ("Mitsuba", "Stromboli"):
        cells.append(
            f"{np.median(times[program][few]):.1f} s ({start[program]:.1f}), "
            f"{float(np.exp(np.mean(np.log(errors[program])))):.3g}"
        )
    cells.append(f"{speed:.2f} ({low:.2f}..{high:.2f})")
    cells.append(f"{steady[0] / steady[1]:.2f}")
    cells.append(f"{100 * bias:+.2f} %")
    print("| " + " | ".join(cells) + " |", flush=True)
    return math.log(speed)


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("stromboli", help="the program")
    parser.add_argument("rooms", nargs="+", metavar="ROOM.xml")
    parser.add_argument("--samples", type=int, default=64, help="of a pixel (64)")
    parser.add_argument("--reference", type=int, default=8192, help="samples of the references (8192)")
    parser.add_argument("--seeds", type=int, default=4)
    parser.add_argument("--size", default="160x90")
    parser.add_argument("--depth", type=int, default=17, help="max_depth (17)")
    parser.add_argument("--variant", default="llvm_ad_rgb")
    parser.add_argument("--work", default=os.path.join(tempfile.gettempdir(), "against_mitsuba"))
    parser.add_argument("--options", default="", help="more options of render, as one word")
    arguments = parser.parse_args()
    os.makedirs(arguments.work, exist_ok=True)
    programs = (Mitsuba(arguments.variant), Stromboli(arguments.stromboli, arguments.options.split()))
    print(f"CPU seconds of {arguments.samples} samples (of it the start), and the error")
    print("| room | Mitsuba | Stromboli | speed to Mitsuba's error | a sample's time | means |")
    print("|---|---|---|---|---|---|")
    logs = [compare(room, programs, arguments) for room in arguments.rooms]
    print(f"geometric mean: {math.exp(np.mean(logs)):.2f}, worst {math.exp(min(logs)):.2f}")


if __name__ == "__main__":
    main()
