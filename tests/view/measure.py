#!/usr/bin/env python3
"""How quickly `stromboli view` shows what it is steered to, and what watching a render costs.

measure.py PROGRAM [SCENE] [--size W H] [--pairs N] [--samples N]

Prints a table. It is no test: the figures are those of the machine and of what else it does.
"""

import argparse
import json
import math
import os
import statistics
import subprocess
import tempfile
import threading
import time
import urllib.error

from program import Served


def quartiles(values):
    ordered = sorted(values)
    return [ordered[round(q * (len(ordered) - 1))] for q in (0.25, 0.5, 0.75)]


def orbited(pose, angle):
    d = [a - b for a, b in zip(pose["from"], pose["at"])]
    c, s = math.cos(angle), math.sin(angle)
    return [a + b for a, b in zip(pose["at"], (c * d[0] + s * d[2], d[1], c * d[2] - s * d[0]))]


def moving(program, scene, size, shown):
    """Seconds from a move to its first picture, and pictures a second of a view that is moved all the time."""
    firsts, rates, widths = [], [], []
    with Served(program, "view", scene, "-r", *map(str, size), "-s", "1000000") as view:
        text, _ = view.frame(0, shown)  # the kernel is compiled
        pose, angle = text["pose"], 0

        def move(still):
            nonlocal angle
            angle += 0.02
            view.look(orbited(pose, angle), pose["at"], pose["fov"], int(not still))

        for _ in range(20):  # at rest, then one move
            time.sleep(0.5)
            epoch, begun = text["epoch"], time.monotonic()
            move(still=True)
            while text["epoch"] == epoch:
                text, _ = view.frame(text["number"], shown)
            firsts.append(time.monotonic() - begun)
            widths.append(text["width"])
        for _ in range(5):  # two seconds of dragging, with a move for each picture
            count, begun = 0, time.monotonic()
            while time.monotonic() < begun + 2:
                epoch = text["epoch"]
                move(still=False)
                while text["epoch"] == epoch:
                    text, _ = view.frame(text["number"], shown)
                count += 1
            rates.append(count / (time.monotonic() - begun))
        view.end()
    return firsts, rates, widths


def render_seconds(program, scene, size, samples, folder, pages):
    """Seconds that the samples of a render take, which that many pages watch."""
    options = ["render", scene, "-r", *map(str, size), "-s", str(samples), "--even", "-o", "out.png",
               "--stats", "stats.json"]
    if pages == 0:
        subprocess.run([program, *options], cwd=folder, check=True, stderr=subprocess.DEVNULL)
    else:
        with Served(program, *options, "--watch", "0", folder=folder) as view:
            def look():
                after = 0
                try:
                    while True:
                        after = view.frame(after)[0]["number"]
                except (OSError, ValueError):
                    pass  # the render has ended
            threads = [threading.Thread(target=look) for _ in range(pages)]
            for thread in threads:
                thread.start()
            view.process.stdout.read()
            view.process.wait()
            for thread in threads:
                thread.join()
    with open(os.path.join(folder, "stats.json")) as file:
        return json.load(file)["seconds"]["render"]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program")
    parser.add_argument("scene", nargs="?", default="cornell_boxes")
    parser.add_argument("--size", nargs=2, type=int, default=[640, 360])
    parser.add_argument("--pairs", type=int, default=8, help="of renders with and without a page")
    parser.add_argument("--samples", type=int, default=32, help="of these renders")
    asked = parser.parse_args()
    program = os.path.abspath(asked.program)
    print(f"{asked.scene}, {asked.size[0]} x {asked.size[1]}; load of the machine {os.getloadavg()[0]:.1f}")
    for shown in ("picture", "denoised"):
        firsts, rates, widths = moving(program, asked.scene, asked.size, shown)
        low, middle, high = quartiles(firsts)
        print(f"{shown}: first picture after a move {middle:.2f} s (half of them {low:.2f} to {high:.2f}), "
              f"{statistics.median(widths):.0f} pixels wide; "
              f"{statistics.median(rates):.1f} pictures a second while moving (least {min(rates):.1f})")
    if asked.pairs == 0:
        return
    with tempfile.TemporaryDirectory() as folder:
        ratios = []
        for _ in range(asked.pairs):  # one after the other, so that both see the same load
            alone = render_seconds(program, asked.scene, asked.size, asked.samples, folder, 0)
            ratios.append(render_seconds(program, asked.scene, asked.size, asked.samples, folder, 1) / alone - 1)
        low, middle, high = quartiles(ratios)
        print(f"watching by one page: {100 * middle:+.1f} % of render time (half of {asked.pairs} pairs "
              f"{100 * low:+.1f} to {100 * high:+.1f})")


if __name__ == "__main__":
    main()
