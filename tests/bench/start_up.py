#!/usr/bin/env python3
"""Torque and kinetic energy by parts of the first turns: start_up.py RUNS OLD.csv > NEW.csv

RUNS is the folder that steady.py leaves its runs in (--out), references among them. Each part is a mean over seeds,
with its error from their scatter; the last part of a point is its level, all that its references measured from there
on. A point that has fewer than two references keeps the level of OLD.csv. From here come the table of dem/STEADY.md and
tests/dem/series/start_up.csv, to which tests/dem/run/steady_flow holds run.start_up_turns.
"""
import pathlib
import re
import statistics
import sys

import h5py
import numpy

PARTS = [0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 2.0, 2.5, 3.0]
HEAD = """\
# Runs of tests/bench/steady.py (data/developer, friction 0.4, Hamaker constants 0, 2.0e-18 and 9.0e-18 J), averaged by
# tests/bench/start_up.py: means over seeds of the torque [uN m] and kinetic energy [nJ] between these turns of the
# tool, errors from the seeds' scatter. The last part of each point is its level: from 3 turns on, of runs of at least
# 15 turns; where it begins at 2, of all that earlier runs, long and short, measured from there on.
material,rpm,from_turns,to_turns,runs,torque,torque_se,kinetic_energy,kinetic_energy_se"""


def mean_and_error(values):
    return statistics.fmean(values), statistics.stdev(values) / len(values) ** 0.5


def longest(folder, rpm):
    """Turns, and torque and kinetic energy, of the longest run kept in a folder: all of one seed are one course."""
    best = (numpy.zeros(1), numpy.zeros((2, 1)))
    for path in folder.glob("run*.h5"):
        with h5py.File(path) as run:
            series = run["series"]
            turns = series["time"][:] * rpm / 60.0
            if turns[-1] > best[0][-1]:
                best = turns, numpy.stack([series["torque"][:] * 1e6, series["kinetic_energy"][:] * 1e9])
    return best


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    levels = {}
    for line in pathlib.Path(sys.argv[2]).read_text().splitlines():
        material, rpm, _, to, *_ = [*line.split(","), "", "", ""]
        if rpm.isdigit() and not to:
            levels[material, int(rpm)] = line
    points = {}
    for folder in sorted(pathlib.Path(sys.argv[1]).iterdir()):
        found = re.match(r"(.*)-friction0\.4-hamaker[^-]*(?:-\d+)?-rpm(\d+)-\d+-(run|reference)$", folder.name)
        if not found:
            continue
        material, rpm = found.group(1), int(found.group(2))
        turns, both = longest(folder, rpm)
        parts = points.setdefault((material, rpm), {})
        for low, high in zip(PARTS, [*PARTS[1:], numpy.inf]):
            inside = (turns >= low) & (turns < high)
            whole = turns[-1] >= high - 0.02 if high < numpy.inf else turns[-1] >= low + 5.0
            if whole:
                parts.setdefault((low, high), []).append(both[:, inside].mean(axis=1))
    print(HEAD)
    order = ["zirconia-800", "zirconia-100", "carrier"]
    for (material, rpm), parts in sorted(points.items(), key=lambda item: (order.index(item[0][0]), item[0][1])):
        for (low, high), means in sorted(parts.items()):
            if len(means) < 2:
                continue
            (torque, torque_se), (energy, energy_se) = (mean_and_error([m[i] for m in means]) for i in (0, 1))
            to = f"{high:g}" if high < numpy.inf else ""
            numbers = f"{torque:.3f},{torque_se:.3f},{energy:.2f},{energy_se:.2f}"
            print(f"{material},{rpm},{low:g},{to},{len(means)},{numbers}")
        if len(parts.get((PARTS[-1], numpy.inf), [])) < 2:
            print(levels[material, rpm])


main()
