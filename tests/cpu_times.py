#!/usr/bin/env python3
"""Runs the test suite and says how much CPU time its tests take, by program and by test.

    tests/cpu_times.py BUILD [-j N] [-R REGEX] [-LE LABEL] [--top N] [--out TIMES.tsv]

BUILD is a build folder with the tests in it. CPU time hardly depends on what else the machine does, so two
states of the suite can be compared. Exit code 1 if a test fails.
"""
import argparse
import collections
import concurrent.futures
import json
import os
import re
import subprocess
import sys
import tempfile


def tests_of(build, arguments):
    command = ["ctest", "--test-dir", build, "--show-only=json-v1"]
    if arguments.regex:
        command += ["-R", arguments.regex]
    if arguments.label_exclude:
        command += ["-LE", arguments.label_exclude]
    listed = json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)
    for test in listed["tests"]:
        if "command" not in test:
            continue
        yield test["name"], test["command"], {p["name"]: p["value"] for p in test.get("properties", [])}


def environment_of(properties):
    environment = dict(os.environ)
    for assignment in properties.get("ENVIRONMENT", []):
        name, _, value = assignment.partition("=")
        environment[name] = value
    for change in properties.get("ENVIRONMENT_MODIFICATION", []):
        name, _, operation = change.partition("=")
        kind, _, value = operation.partition(":")
        if kind == "set":
            environment[name] = value
    return environment


def run(test):
    """Name, program, CPU seconds of the process and its children, and whether it passed."""
    name, command, properties = test
    with tempfile.TemporaryFile() as output:
        process = subprocess.Popen(
            command,
            env=environment_of(properties),
            cwd=properties.get("WORKING_DIRECTORY"),
            stdout=output,
            stderr=subprocess.STDOUT,
        )
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        output.seek(0)
        text = output.read().decode(errors="replace")
    skipped = properties.get("SKIP_RETURN_CODE") == process.returncode
    for expression in properties.get("SKIP_REGULAR_EXPRESSION", []):
        skipped = skipped or re.search(expression, text, re.MULTILINE)
    passed = process.returncode == 0 or bool(skipped)
    return name, os.path.basename(command[0]), used.ru_utime + used.ru_stime, passed, text


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("build")
    parser.add_argument("-j", type=int, default=2, dest="jobs")
    parser.add_argument("-R", dest="regex")
    parser.add_argument("-LE", dest="label_exclude")
    parser.add_argument("--top", type=int, default=40)
    parser.add_argument("--out")
    arguments = parser.parse_args()
    by_program = collections.defaultdict(lambda: [0.0, 0])
    times, failed = [], []
    # Tests that others make something for (fixtures) come when all of these have ended.
    tests = list(tests_of(arguments.build, arguments))
    last = [test for test in tests if "FIXTURES_REQUIRED" in test[2]]
    first = [test for test in tests if "FIXTURES_REQUIRED" not in test[2]]
    with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
        results = (result for some in (first, last) for result in pool.map(run, some))
        for name, program, seconds, passed, text in results:
            times.append((seconds, name, program))
            by_program[program][0] += seconds
            by_program[program][1] += 1
            if not passed:
                failed.append(name)
                print(f"FAILED {name}\n{text[-3000:]}", flush=True)
    if arguments.out:
        with open(arguments.out, "w", encoding="utf-8") as file:
            for seconds, name, program in times:
                file.write(f"{seconds:.3f}\t{program}\t{name}\n")
    print("CPU s  tests  program")
    for program, (seconds, count) in sorted(by_program.items(), key=lambda item: -item[1][0]):
        print(f"{seconds:7.1f} {count:5}  {program}")
    print("CPU s  test")
    for seconds, name, _ in sorted(times, reverse=True)[: arguments.top]:
        print(f"{seconds:7.1f}  {name}")
    print(f"{len(times)} tests, {sum(t[0] for t in times) / 60:.1f} CPU minutes, {len(failed)} failed")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
