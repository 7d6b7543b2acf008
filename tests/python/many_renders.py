#!/usr/bin/env python3
"""many_renders.py PROGRAM [COUNT]: small renders in one process of Python against as many processes.

COUNT (100) settings of cornell_boxes, 48 x 36, that differ in samples, bounces, seed and view: how
long all take by `stromboli.render` and by PROGRAM render, and whether the numbers are the same. Run by hand:
what it measures depends on the machine and on what else that does.
"""

import os
import resource
import subprocess
import sys
import tempfile
import time

import numpy as np

import stromboli


def settings_of(i):
    return {
        "samples": 4 + i % 5,
        "max_bounces": 2 + i % 4,
        "seed": i,
        "look_from": (0.2 * np.cos(i), 0.5 + 0.01 * i, 2.0),
        "look_at": (0, 0.5, 0),
        "even": True,
    }


def words_of(settings):
    names = {"samples": "-s", "max_bounces": "-m", "seed": "--seed", "even": "--even"}
    for name, value in settings.items():
        yield names.get(name) or "--" + name.replace("_", "-")
        if value is not True:
            yield from map(repr, map(float, value)) if isinstance(value, tuple) else [str(value)]


def cpu_seconds():
    use = [resource.getrusage(w) for w in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(u.ru_utime + u.ru_stime for u in use)


def measured(what, work):
    begun, cpu = time.monotonic(), cpu_seconds()
    result = work()
    seconds, cpu = time.monotonic() - begun, cpu_seconds() - cpu
    print(f"{what:<12} {seconds:7.2f} s, {cpu:7.2f} s of CPU time")
    return result, seconds, cpu


def main():
    program = sys.argv[1]
    count = int(sys.argv[2]) if len(sys.argv) > 2 else 100
    all_ = [settings_of(i) for i in range(count)]

    def in_one():
        scene = stromboli.load("cornell_boxes")
        return [np.array(stromboli.render(scene, width=48, height=36, progress=False, **s)) for s in all_]

    def in_many():
        pictures = []
        with tempfile.TemporaryDirectory() as folder:
            file = os.path.join(folder, "a.exr")
            for settings in all_:
                command = [program, "render", "cornell_boxes", "-r", "48", "36", "-o", file]
                subprocess.run([*command, *words_of(settings)], check=True, capture_output=True)
                pictures.append(np.array(stromboli.read(file)))
        return pictures

    one, seconds, cpu = measured("one process", in_one)
    many, seconds_of_many, cpu_of_many = measured(f"{count} processes", in_many)
    same = sum(np.array_equal(a, b) for a, b in zip(one, many))
    print(f"ratio {seconds / seconds_of_many:.3f} of the time, {cpu / cpu_of_many:.3f} of the CPU time")
    print(f"{same} of {count} pictures are the same")
    return 0 if same == count else 1


if __name__ == "__main__":
    sys.exit(main())
