#!/usr/bin/env python3
"""How often data/developer's truths lie in their 90 % intervals over other draws of the measurement noise.

python3 tests/bench/noise_draws.py [DRAWS] [DEMCAL]: DRAWS (24) series at 3 % noise are made from the simulated means behind
the shipped ones, which the shipped series at 1 and 3 % give back as they share their normal draws (data/make_observed.py).
Each is calibrated, and what the intervals hold and the verdicts are is counted. Some two seconds a draw.
"""
import collections
import csv
import json
import math
import pathlib
import random
import shutil
import subprocess
import sys
import tempfile
import tomllib

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
DRAWS = int(sys.argv[1]) if len(sys.argv) > 1 else 24
DEMCAL = sys.argv[2] if len(sys.argv) > 2 else str(ROOT / "demcal")
NOISE = 0.03


def read(path):
    lines = [line for line in path.read_text().splitlines() if not line.startswith("#")]
    return [(float(row["rpm"]), float(row["torque"]), float(row["torque_se"])) for row in csv.DictReader(lines)]


def means_of(observed, name):
    """rpm, simulated mean and its standard error of each point."""
    points = []
    for (rpm, at_1, _), (_, at_3, error) in zip(*(read(observed / f"noise-{n}" / f"{name}.csv") for n in (1, 3))):
        mean = at_1 - (at_3 - at_1) / 2
        points.append((rpm, mean, math.sqrt(max(error**2 - (NOISE * mean) ** 2, 0.0))))
    return points


def main():
    with tempfile.TemporaryDirectory() as folder:
        study, out = pathlib.Path(folder) / "study", pathlib.Path(folder) / "out"
        shutil.copytree(ROOT / "data" / "developer", study)
        observed = study / "observed"
        series = tomllib.loads((observed / "truth.toml").read_text())["series"]
        means = {name: means_of(observed, name) for name in series}
        held, verdicts = collections.Counter(), collections.defaultdict(collections.Counter)
        for draw in range(DRAWS):
            noise = random.Random(7000 + draw)
            for name, points in means.items():
                rows = [f"{rpm:g},{mean * (1 + NOISE * noise.gauss(0, 1)):.4f},{math.hypot(NOISE * mean, error):.4f}"
                        for rpm, mean, error in points]
                (observed / "noise-3" / f"{name}.csv").write_text("\n".join(["rpm,torque,torque_se", *rows]) + "\n")
            done = subprocess.run([DEMCAL, "calibrate", str(study), "--out", str(out), "--quiet"],
                                  capture_output=True, text=True)
            if done.returncode not in (0, 2):  # 2: done, with a warning
                sys.exit(done.stderr)
            for case in json.loads((out / "report.json").read_text())["cases"]:
                for found in case["parameters"]:
                    truth = float(series[case["name"]]["at"][found["name"]].split()[0])
                    key = (case["name"], found["name"])
                    held[key] += found["q05"] <= truth <= found["q95"]
                    verdicts[key][found["verdict"]] += 1
        for key, words in verdicts.items():
            said = ", ".join(f"{word} {count}" for word, count in words.items())
            print(f"{key[0]} {key[1]}: {held[key]} of {DRAWS}; {said}")


main()
