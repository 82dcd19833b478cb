#!/usr/bin/env python3
"""Torque and kinetic energy by parts of the first turns: start_up.py RUNS > tests/dem/series/start_up.csv

RUNS is the folder that steady.py leaves its runs in (--out), references among them. Each part is a mean over seeds,
with its error from their scatter; the last part of a point is its level, all that its references measured from there
on. From here come the table of dem/STEADY.md and the numbers that test_steady_flow holds run.start_up_turns to.
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
# tool, errors from the seeds' scatter. The last part of each point is its level.
material,rpm,from_turns,to_turns,runs,torque,torque_se,kinetic_energy,kinetic_energy_se"""


def mean_and_error(values):
    return statistics.fmean(values), statistics.stdev(values) / len(values) ** 0.5


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    points = {}
    for path in sorted(pathlib.Path(sys.argv[1]).glob("*/run.h5")):
        found = re.match(r"(.*)-friction0\.4-hamaker[^-]*(?:-\d+)?-rpm(\d+)-\d+-(run|reference)$", path.parent.name)
        if not found:
            continue
        material, rpm = found.group(1), int(found.group(2))
        with h5py.File(path) as run:
            series = run["series"]
            turns = series["time"][:] * rpm / 60.0
            both = numpy.stack([series["torque"][:] * 1e6, series["kinetic_energy"][:] * 1e9])
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


main()
