#!/usr/bin/env python3
"""How fast one build of the program is against another: whole paths in the bundled scenes.

    python3 host/bench/compare_builds.py OLD/build/release/bin/stromboli build/release/bin/stromboli

runs `bench SCENE --only paths` of the two in turn, old first in one round and new first in the
next, and prints for each scene the median over rounds of old time over new time (above 1: the new
build is faster), with the least and the most, by CPU time and by wall time, and their geometric
mean over scenes.
"""

import argparse
import json
import math
import pathlib
import statistics
import subprocess
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]


def seconds(program, scene, arguments):
    """Least CPU and wall seconds of a path over the repeats of one run."""
    with tempfile.TemporaryDirectory() as folder:
        report = pathlib.Path(folder) / "report.json"
        subprocess.run(
            [program, "bench", scene, "--only", "paths", "-r", "192", "192", "-s",
             str(arguments.samples), "--repeats", str(arguments.repeats), "--json", str(report)],
            check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        device = json.loads(report.read_text())["scenes"][0]["paths"]["contestants"][0]
    return device["cpuSeconds"]["least"], device["wallSeconds"]["least"]


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("old", help="program that is compared with")
    parser.add_argument("new", help="program that is judged")
    parser.add_argument("scenes", nargs="*", help="all of scene/library if none is named")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--repeats", type=int, default=3, help="measurements in a run")
    parser.add_argument("--samples", type=int, default=8, help="per pixel in a measurement")
    arguments = parser.parse_args()
    scenes = arguments.scenes or sorted(map(str, (ROOT / "scene" / "library").glob("*.dae")))
    medians = []
    for scene in scenes:
        ratios = []
        for number in range(arguments.rounds):
            order = [arguments.old, arguments.new]
            taken = {p: seconds(p, scene, arguments) for p in order[::-1 if number % 2 else 1]}
            ratios.append([a / b for a, b in zip(*map(taken.get, order))])
        cpu, wall = zip(*ratios)
        medians.append([statistics.median(cpu), statistics.median(wall)])
        print(f"{pathlib.Path(scene).stem:24s} CPU {medians[-1][0]:.3f} [{min(cpu):.3f} {max(cpu):.3f}]"
              f"  wall {medians[-1][1]:.3f}", flush=True)
    cpu, wall = (math.exp(statistics.fmean(map(math.log, column))) for column in zip(*medians))
    print(f"{'geometric mean':24s} CPU {cpu:.3f}  wall {wall:.3f}")


if __name__ == "__main__":
    main()
