#!/usr/bin/env python3
"""Remakes the synthetic torque series of a shipped study: python3 data/make_observed.py FOLDER [DEMCAL]

FOLDER/observed/truth.toml says the truth of each material and how it is observed. Each point is the mean of `demcal
simulate` of the study, of the steady flow, with several seeds that no training run uses; its error is that of the runs or of their scatter,
whichever is larger, as runs scatter more than one run's own error says. Then measurement noise of a stated share of torque is added, from a
seeded generator and with the same standard normal draws at every share. The standard error that is written is that of
the measurement and of the simulated mean together. Runs are kept in ./observed-runs, so that a second start is quick.
"""
import concurrent.futures
import csv
import io
import json
import math
import os
import pathlib
import random
import statistics
import subprocess
import sys
import tomllib

FOLDER = pathlib.Path(sys.argv[1])
DEMCAL = sys.argv[2] if len(sys.argv) > 2 else str(pathlib.Path(__file__).resolve().parent.parent / "demcal")


def simulate(truth, name, point, rpm, seed):
    at = ",".join(f"{key}={value}" for key, value in (point["at"] | {"rpm": rpm}).items())
    out = pathlib.Path("observed-runs") / f"{FOLDER.name}-{name}-{rpm}-{seed}"
    command = [DEMCAL, "simulate", str(FOLDER), "--at", at, "--seed", str(seed), "--json", "--quiet",
               "--out", str(out), "--material", point["material"], "--set", f"training.standard_error={truth['standard_error']}",
               "--set", f"run.longest=\"{truth['longest']}\""]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode not in (0, 2):  # 2: done, with a warning
        sys.exit(f"{' '.join(command)}\n{done.stderr}")
    result = json.loads(done.stdout)
    if result["state"] != "steady":
        sys.exit(f"{name} at {rpm} rpm, seed {seed}: {result['state']}: {result['why']} (truth.toml: longest)")
    torque = result["outputs"]["torque"]
    return torque["mean"], torque["standard_error"]


def observe(truth, name, point, rpm):
    runs = [simulate(truth, name, point, rpm, seed) for seed in truth["simulation_seeds"]]
    means = [mean for mean, _ in runs]
    of_runs = math.hypot(*(error for _, error in runs)) / len(runs)
    of_scatter = statistics.stdev(means) / math.sqrt(len(runs)) if len(runs) > 1 else 0.0
    mean, error = statistics.fmean(means), max(of_runs, of_scatter)
    print(f"{name} {rpm} rpm: {mean:.2f} +- {error:.2f}", flush=True)
    return mean, error


def main():
    truth = tomllib.loads((FOLDER / "observed" / "truth.toml").read_text())
    noise = random.Random(truth["noise_seed"])
    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        points = {name: [pool.submit(observe, truth, name, point, rpm) for rpm in truth["rpm"]]
                  for name, point in truth["series"].items()}
    for name, point in truth["series"].items():
        rows = [(rpm, *done.result(), noise.gauss(0.0, 1.0)) for rpm, done in zip(truth["rpm"], points[name])]
        for level in truth["noise"]:
            out = io.StringIO()
            values = ", ".join(f"{key} {value}" for key, value in point["at"].items())
            out.write(f"# synthetic, not a measurement: torque of demcal's own DEM on the slice rig of this study\n"
                      f"# truth: {values} ({point['source']})\n"
                      f"# mean of runs with seeds {', '.join(map(str, truth['simulation_seeds']))}, which no training run uses; "
                      f"measurement noise {level:.0%} of torque, seed {truth['noise_seed']}\n"
                      f"# made by data/make_observed.py; torque_se: noise and error of the simulated mean together\n")
            table = csv.writer(out, lineterminator="\n")
            table.writerow(["rpm", "torque", "torque_se"])
            for rpm, mean, error, draw in rows:
                table.writerow([rpm, f"{mean + level * mean * draw:.4f}", f"{math.hypot(level * mean, error):.4f}"])
            folder = FOLDER / "observed" / f"noise-{100 * level:.0f}"
            folder.mkdir(parents=True, exist_ok=True)
            (folder / f"{name}.csv").write_text(out.getvalue())


main()
