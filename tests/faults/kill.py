#!/usr/bin/python3
"""Kills at any moment: kill.py DEMCAL DATA [--kills N] [--seed S]

A command is started, killed (SIGKILL) after a random time, started again, and so on until it ends by itself. Then its files
are those of a run that nobody killed: tables to the last character, reports and posteriors in all their numbers.
"""
import argparse
import json
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import time

import run

COMMANDS = ("train", "calibrate", "sample", "fit", "design")


def numbers(folder):
    """All that must be equal: texts by their content, JSON without what tells of time."""
    found = run.digest(folder)
    for path in sorted(folder.rglob("report.json")):
        report = json.loads(path.read_text())
        report.pop("origin", None)
        report["provenance"] = {}
        found[path.name] = json.dumps(report, sort_keys=True)
    return {name: value for name, value in found.items() if ".lock" not in name}


def started(program, words, folder):
    return subprocess.Popen([program, *words], cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("demcal")
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--kills", type=int, default=20)
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    options.demcal = str(pathlib.Path(options.demcal).resolve())
    all_words = run.commands(options.data.resolve())
    chance = random.Random(options.seed)
    wanted, duration, kills, failures = {}, {}, 0, []
    for name in COMMANDS:
        folder = pathlib.Path(tempfile.mkdtemp())
        begin = time.monotonic()
        done = run.start(options.demcal, all_words[name], folder)
        duration[name] = time.monotonic() - begin
        assert done.returncode in (0, 2), done.stderr
        wanted[name] = numbers(folder)
        shutil.rmtree(folder)
    while kills < options.kills:
        name = chance.choice(COMMANDS)
        folder = pathlib.Path(tempfile.mkdtemp())
        here = 0
        while True:
            process = started(options.demcal, all_words[name], folder)
            try:
                process.wait(chance.uniform(0.0, 1.2 * duration[name]) if here < 6 else None)
                break
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
                here += 1
        kills += here
        said = process.stderr.read()
        if process.returncode not in (0, 2):
            failures.append(f"{name} after {here} kills: {process.returncode} {said[-300:]}")
        elif (got := numbers(folder)) != wanted[name]:
            failures.append(f"{name} after {here} kills: {sorted(k for k in set(got) | set(wanted[name]) if got.get(k) != wanted[name].get(k))}")
        shutil.rmtree(folder)
    for line in failures:
        print(line)
    print(f"{kills} kills, {len(failures)} commands that did not end as if they had never been killed")
    sys.exit(bool(failures))


if __name__ == "__main__":
    main()
