#!/usr/bin/env python3
"""How one picture scales over workers that share it, on this machine: the table of docs/results.md, "How shares scale".

    python3 tests/farm/scaling.py build/release/bin/stromboli [--rounds 3]

Each worker is a process with one thread of lavapipe on one core (taskset), as if it were a machine of its own; N of
them take the shares 1/N to N/N at the same time, and `merge` puts them together when the last is done. More workers
than cores share the cores evenly. Seconds are of the wall clock, medians over the rounds; run it on a quiet machine.
All merged pictures must have the same bytes.
"""

import argparse
import filecmp
import json
import os
import pathlib
import statistics
import subprocess
import tempfile
import time

SCENE = ["cornell_spheres", "-r", "640", "480", "-s", "256", "--block", "16", "--branches", "1", "-q"]
WORKERS = (1, 2, 4)
STAGES = ("load", "build", "prepare", "render", "write")


def run_shares(program, folder, workers, cores):
    """Seconds until the last worker is done, the means over workers of its stages, and its start and end."""
    environment = {**os.environ, "LP_NUM_THREADS": "1"}
    begin = time.monotonic()
    processes = []
    for i in range(workers):
        command = ["taskset", "-c", str(cores[i % len(cores)]), program, "render", *SCENE, "--share",
                   f"{i + 1}/{workers}", "-o", folder / f"{i}.film", "--stats", folder / f"{i}.json"]
        processes.append(subprocess.Popen(command, env=environment))
    if any(process.wait() != 0 for process in processes):
        raise SystemExit("a share failed")
    whole = time.monotonic() - begin
    told = [json.loads((folder / f"{i}.json").read_text())["seconds"] for i in range(workers)]
    stages = {stage: statistics.mean(seconds[stage] for seconds in told) for stage in STAGES}
    stages["start, end"] = whole - sum(stages.values())
    return whole, stages


def run_merge(program, folder, workers):
    begin = time.monotonic()
    films = [folder / f"{i}.film" for i in range(workers)]
    subprocess.run([program, "merge", "-q", "--complete", *films, "-o", folder / "out.exr"], check=True)
    return time.monotonic() - begin


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("program")
    parser.add_argument("--rounds", type=int, default=3)
    arguments = parser.parse_args()
    cores = sorted(os.sched_getaffinity(0))[:4]
    measured = {workers: [] for workers in WORKERS}
    with tempfile.TemporaryDirectory() as scratch:
        first = None
        for _ in range(arguments.rounds):
            for workers in WORKERS:
                folder = pathlib.Path(tempfile.mkdtemp(dir=scratch))
                whole, stages = run_shares(arguments.program, folder, workers, cores)
                merge = run_merge(arguments.program, folder, workers)
                measured[workers].append((whole + merge, {**stages, "merge": merge}))
                if first and not filecmp.cmp(first, folder / "out.exr", shallow=False):
                    raise SystemExit("the merged pictures differ")
                first = first or folder / "out.exr"

    names = ["start, end", *STAGES, "merge"]
    table = {workers: (statistics.median(whole for whole, _ in runs),
                       {name: statistics.median(stages[name] for _, stages in runs) for name in names})
             for workers, runs in measured.items()}
    # One worker tells what is divided and what is not, two of them what a further film costs `merge`. With that the
    # model has to foretell the time of four.
    one, merge = table[1][1], table[1][1]["merge"]
    more = max(table[2][1]["merge"] - merge, 0)
    fixed = sum(one[name] for name in names if name not in ("render", "merge"))
    print(f"{len(cores)} cores, medians of {arguments.rounds} rounds; seconds, and of the whole\n")
    print("| workers | in all | " + " | ".join(names) + " | model |")
    print("|---|---|" + "---|" * len(names) + "---|")
    for workers, (whole, stages) in table.items():
        turns = max(workers / len(cores), 1)
        model = (one["render"] / workers + fixed) * turns + merge + more * (workers - 1)
        cells = [f"{stages[name]:.2f} ({100 * stages[name] / whole:.1f} %)" for name in names]
        print(f"| {workers} | {whole:.2f} | " + " | ".join(cells) + f" | {model:.2f} |")


main()
