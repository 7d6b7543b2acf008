#!/usr/bin/env python3
"""before_and_after.py OLD NEW SCENE...: time to error of two builds of the program, in turn.

Each scene is rendered with several seeds by both. Shown for each of them: CPU seconds a picture, less those of a picture
of 4 samples; the variance of a pixel over the seeds, relative to its square, mean over the pixels; the same without the
thousandth of the pixels that have the most of both; and by how much less time the new build needs for the same error, by
either. Pictures are read by Mitsuba's Python module.
"""
import argparse
import os
import resource
import subprocess
import tempfile

import mitsuba as mi
import numpy as np


def cpu_seconds():
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def render(program, scene, size, samples, seed, path):
    """Returns CPU seconds and the picture."""
    before = cpu_seconds()
    command = [program, "render", scene, "-r", *map(str, size), "-s", str(samples), "--seed", str(seed), "-o", path]
    subprocess.run(command, check=True, capture_output=True)
    seconds = cpu_seconds() - before
    picture = mi.Bitmap(path).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False)
    return seconds, np.array(picture).astype(float)


def measure(programs, scene, arguments, path):
    seconds, pictures = [0.0, 0.0], [[], []]
    for program in programs:
        render(program, scene, arguments.size, 4, 0, path)  # compiles the kernel
    for seed in range(arguments.seeds):
        for which in (0, 1) if seed % 2 else (1, 0):
            start, _ = render(programs[which], scene, arguments.size, 4, seed, path)
            taken, picture = render(programs[which], scene, arguments.size, arguments.samples, seed, path)
            seconds[which] += (taken - start) / arguments.seeds
            pictures[which].append(picture)
    pictures = np.array(pictures)
    mean = pictures.mean(axis=(0, 1))
    variance = pictures.var(axis=1, ddof=1) / (mean**2 + (0.1 * np.median(mean)) ** 2)
    both = variance.sum(axis=0)
    usual = both <= np.quantile(both, 0.999)
    every = [v.mean() for v in variance]
    most = [v[usual].mean() for v in variance]
    gain = [v[0] * seconds[0] / (v[1] * seconds[1]) for v in (every, most)]
    difference = 100 * (pictures[1].mean() / pictures[0].mean() - 1)
    print(
        f"| {scene} | {seconds[0]:.2f}, {every[0]:.3g}, {most[0]:.3g} | {seconds[1]:.2f}, {every[1]:.3g}, {most[1]:.3g} "
        f"| {gain[0]:.2f}, {gain[1]:.2f} | {difference:+.2f} % |",
        flush=True,
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("scenes", nargs="+")
    parser.add_argument("--size", type=int, nargs=2, default=[160, 100])
    parser.add_argument("--samples", type=int, default=64)
    parser.add_argument("--seeds", type=int, default=8)
    arguments = parser.parse_args()
    mi.set_variant("scalar_rgb")
    print("| scene | old: s, relative variance, without outliers | new | gain, without outliers | means |")
    print("|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        for scene in arguments.scenes:
            measure((arguments.old, arguments.new), scene, arguments, os.path.join(folder, "picture.exr"))


if __name__ == "__main__":
    main()
