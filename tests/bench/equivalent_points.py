#!/usr/bin/env python3
"""Whether the DEM agrees with the surrogate along a ridge: python3 tests/bench/equivalent_points.py RESULTS
[--demcal PROGRAM] [--study FOLDER] [--seeds N] [--jobs N] [--out FOLDER]

RESULTS is the folder of `demcal calibrate STUDY`. Where a case cannot part two parameters its report names equivalent
points, pairs that the torque cannot tell from each other, and the surrogate's torque at each over the control's range.
Each point is run with the material of the case's name, at the least, middle and largest control, with N seeds that no
training run uses, and compared:
  z = (mean over the seeds - surrogate) / error of that mean, the runs' stated one or that of their scatter, the larger
The surrogate's own error is not in it, so z is too large where the surrogate says that it does not know.
Runs are kept below --out, so that a second start goes on.
"""
import argparse
import concurrent.futures
import json
import math
import pathlib
import statistics
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("results", type=pathlib.Path)
    parser.add_argument("--demcal", default=str(ROOT / "demcal"))
    parser.add_argument("--study", default=str(ROOT / "data" / "developer"))
    parser.add_argument("--out", default="equivalent-runs", type=pathlib.Path)
    parser.add_argument("--seeds", default=2, type=int)
    parser.add_argument("--jobs", default=1, type=int)
    return parser.parse_args()


def points_of(report):
    """(case, number, parameters, control, its value, the surrogate's torque) of every equivalent point."""
    for case in report["cases"]:
        for relation in case["traded"]:
            for number, at in enumerate(relation["equivalent"]):
                curve = relation["equivalent_curves"][number]
                for k in (0, len(curve["x"]) // 2, len(curve["x"]) - 1):
                    yield case["name"], number + 1, at, curve["control"], curve["x"][k], curve["mean"][k]


def simulate(options, case, number, at, control, value, seed):
    point = ",".join([*(f"{name}={x!r}" for name, x in at.items()), f"{control}={value:g}"])
    command = [options.demcal, "simulate", options.study, "--material", case, "--at", point, "--seed", str(seed), "--json",
               "--quiet", "--out", str(options.out / f"{case}-{number}-{value:g}-{seed}")]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode not in (0, 2):  # 2: done, with a warning
        raise RuntimeError(f"{' '.join(command)}\n{done.stderr}")
    found = json.loads(done.stdout)
    torque = found["outputs"]["torque"]
    return found["state"], torque["mean"], torque["standard_error"]


def main():
    options = parse_arguments()
    points = list(points_of(json.loads((options.results / "report.json").read_text())))
    if not points:
        raise SystemExit(f"{options.results}/report.json has no equivalent points: every case parts its parameters")
    seeds = range(7000, 7000 + options.seeds)
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        runs = [[pool.submit(simulate, options, *point[:5], seed) for seed in seeds] for point in points]
    print("| point | control | surrogate | DEM | z | runs |\n|---|---|---|---|---|---|")
    squares = []
    for (case, number, at, control, value, expected), made in zip(points, runs):
        results = [run.result() for run in made]
        means = [mean for _, mean, _ in results]
        stated = math.hypot(*(error for _, _, error in results)) / len(results)
        scatter = statistics.stdev(means) / math.sqrt(len(means)) if len(means) > 1 else 0.0
        error = max(stated, scatter)
        z = (statistics.fmean(means) - expected) / error
        squares.append(z * z)
        where = ", ".join(f"{name} {x:.4g}" for name, x in at.items())
        states = ", ".join(sorted({state for state, _, _ in results}))
        print(f"| {case} {number}: {where} | {control} {value:g} | {expected:.2f} | {statistics.fmean(means):.2f} +- {error:.2f} | "
              f"{z:+.1f} | {len(means)} {states} |")
    print(f"\nchi-squared {sum(squares):.1f} of {len(squares)} values, the largest |z| {math.sqrt(max(squares)):.1f}")


main()
