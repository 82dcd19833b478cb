#!/usr/bin/python3
"""Kills at any moment: kill.py DEMCAL DATA [--kills N] [--seed S]

A command is started, killed (SIGKILL) after a random time, started again, and so on until it ends by itself. Then its files
are those of a run that nobody killed: every text to the last character, runs, tables, posteriors and reports in all their numbers.
"""
import argparse
import collections
import itertools
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import time

import run

COMMANDS = ("train", "train on", "train at the posterior", "simulate", "design", "fit", "sample", "calibrate", "calibrate again", "plan",
            "observe", "export", "export again")


def numbers(folder):
    """All that must be equal: texts by their content, HDF5, netCDF and JSON by their values, without what tells of time."""
    return {name: value for name, value in run.digest(folder).items() if ".lock" not in name}


def fresh(program, command):
    folder = pathlib.Path(tempfile.mkdtemp())
    command.prepare(program, folder)
    return folder


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
    wanted, wanted_rows, duration, kills, failures = {}, {}, {}, collections.Counter(), []
    bases = pathlib.Path(tempfile.mkdtemp())
    for name in COMMANDS:
        folder = fresh(options.demcal, all_words[name])
        shutil.copytree(folder, bases / name)
        begin = time.monotonic()
        done = run.start(options.demcal, all_words[name].words, folder)
        duration[name] = time.monotonic() - begin
        assert done.returncode in (0, 2), done.stderr
        wanted[name] = numbers(folder)
        table = folder / "out/training.csv"
        wanted_rows[name] = run.rows(table) if table.exists() else set()
        shutil.rmtree(folder)
    for number in itertools.count():
        if kills.total() >= options.kills:
            break
        name = COMMANDS[number % len(COMMANDS)]
        folder = pathlib.Path(tempfile.mkdtemp())
        shutil.copytree(bases / name, folder, dirs_exist_ok=True)
        here = 0
        while True:
            process = started(options.demcal, all_words[name].words, folder)
            try:
                process.wait(chance.uniform(0.0, 1.1 * duration[name]) if here < 6 else None)
                break
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
                here += 1
        kills[name] += here
        said = process.stderr.read()
        if process.returncode not in (0, 2):
            failures.append(f"{name} after {here} kills: {process.returncode} {said[-300:]}")
        elif name == "train on" and wanted_rows[name] <= run.rows(folder / "out/training.csv"):
            pass  # killed at its very end, `train --runs 2` makes two further runs, as any later call
        elif (got := numbers(folder)) != wanted[name]:
            failures.append(f"{name} after {here} kills: {sorted(k for k in set(got) | set(wanted[name]) if got.get(k) != wanted[name].get(k))}")
        shutil.rmtree(folder)
    shutil.rmtree(bases)
    print(", ".join(f"{name} {count}" for name, count in kills.items()))
    for line in failures:
        print(line)
    print(f"{kills.total()} kills, {len(failures)} commands that did not end as if they had never been killed")
    sys.exit(bool(failures))


if __name__ == "__main__":
    main()
