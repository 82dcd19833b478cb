#!/usr/bin/env python3
"""Training around the posterior on the default carrier, beside a space-filling design:
python3 tests/bench/sequential_carrier.py DEMCAL [--seeds N] [--out FOLDER]

In the place of the DEM stands a process of scikit-learn's, fitted to the carrier's runs in data/developer, with 2 % of noise a
run; it is no surrogate of demcal's. The measurement is of 3 % at six speeds. Both designs begin with the same ten points of a
scrambled Sobol sequence, two of them at the slowest and the fastest speed; then
  sequential   the points that `demcal train --until posterior` lists for another code, a batch at a time
  filling      the next points of the sequence
Error: total variation distance of the posterior from the one that the process itself gives on a grid, mean over friction and
Hamaker constant in 40 classes each. Needs numpy, scipy, scikit-learn, netCDF4 (Debian's python3-sklearn, python3-netcdf4).
"""
import argparse
import csv
import pathlib
import shutil
import subprocess

import netCDF4
import numpy
from scipy.stats import qmc
from sklearn.gaussian_process import GaussianProcessRegressor
from sklearn.gaussian_process.kernels import ConstantKernel, Matern, WhiteKernel

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
LOW, HIGH = numpy.array([0.1, 0.0, 50.0]), numpy.array([0.8, 2e-17, 300.0])  # friction, Hamaker constant [J], rpm
TRUTH, SPEEDS = (0.4, 9e-18), numpy.arange(50.0, 301.0, 50.0)
CLASSES = [numpy.linspace(LOW[k], HIGH[k], 41) for k in (0, 1)]
SEQUENTIAL, FILLING = (10, 15, 20, 25, 30, 35, 40, 50, 60), (10, 15, 20, 25, 30, 35, 40, 50, 60, 80, 100)

STUDY = """[study]
name = "carrier"
seed = 1
[parameters]
friction = { low = 0.1, high = 0.8 }
hamaker = { unit = "J", low = 0, high = 2e-17 }
[controls]
rpm = { unit = "rpm", low = 50, high = 300 }
[outputs.torque]
unit = "uN m"
[training]
table = "runs.csv"
[[observe]]
name = "bench"
file = "bench.csv"
[[calibrate]]
name = "carrier"
observe = ["bench"]
free = ["friction", "hamaker"]
"""


def rows_of(path):
    with open(path) as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))


def write(path, header, rows):
    path.write_text(header + "\n" + "".join(",".join(f"{x:.8g}" for x in row) + "\n" for row in rows))


def torque_in_place_of_the_dem():
    rows = [row for row in rows_of(ROOT / "data/developer/training.csv") if row["material"] == "carrier"]
    x = numpy.array([[float(row[k]) for k in ("friction", "hamaker", "rpm")] for row in rows]) / HIGH
    y = numpy.array([float(row["torque"]) for row in rows])
    kernel = ConstantKernel(100.0) * Matern([1.0, 1.0, 1.0], nu=2.5) + WhiteKernel(0.01)
    process = GaussianProcessRegressor(kernel, normalize_y=True, n_restarts_optimizer=3, random_state=0).fit(x, y)
    return lambda points: process.predict(points / HIGH)


def exact_posterior(torque, measured, errors):
    axes = [numpy.linspace(LOW[k], HIGH[k], 161) for k in (0, 1)]
    friction, hamaker = (a.ravel() for a in numpy.meshgrid(*axes, indexing="ij"))
    log = sum(-0.5 * ((y - torque(numpy.c_[friction, hamaker, numpy.full(friction.size, rpm)])) / e) ** 2
              for rpm, y, e in zip(SPEEDS, measured, errors))
    weight = numpy.exp(log - log.max())
    return [numpy.histogram(x, c, weights=weight / weight.sum())[0] for x, c in zip((friction, hamaker), CLASSES)]


def distance(demcal, folder, exact):
    out = folder / "out"
    shutil.rmtree(out, ignore_errors=True)
    subprocess.run([demcal, "sample", folder, "--out", out, "--quiet"], capture_output=True)
    group = netCDF4.Dataset(out / "posterior-carrier.nc")["posterior"]
    found = [numpy.asarray(group[name][:]).ravel() for name in ("friction", "hamaker")]
    return numpy.mean([0.5 * abs(numpy.histogram(x, c)[0] / x.size - e).sum() for x, c, e in zip(found, CLASSES, exact)])


def next_points(demcal, folder, runs):
    out = folder / "out"
    shutil.rmtree(out, ignore_errors=True)
    subprocess.run([demcal, "train", folder, "--out", out, "--until", "posterior", "--share", "0.001", "--runs", str(runs),
                    "--quiet"], capture_output=True)
    return numpy.array([[float(row[k]) for k in ("friction", "hamaker", "rpm")] for row in rows_of(out / "next-runs.csv")])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("demcal", type=lambda text: pathlib.Path(text).resolve())
    parser.add_argument("--seeds", type=int, default=10)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("sequential-carrier"))
    options = parser.parse_args()
    torque = torque_in_place_of_the_dem()
    errors = {}
    for seed in range(options.seeds):
        noise = numpy.random.default_rng(900 + seed)
        true = torque(numpy.c_[numpy.full(6, TRUTH[0]), numpy.full(6, TRUTH[1]), SPEEDS])
        measured = true * (1.0 + 0.03 * noise.standard_normal(6))
        exact = exact_posterior(torque, measured, 0.03 * true)
        sequence = LOW + qmc.Sobol(3, seed=seed).random(128) * (HIGH - LOW)
        sequence[:2, 2] = LOW[2], HIGH[2]
        for design, counts in (("sequential", SEQUENTIAL), ("filling", FILLING)):
            folder = options.out / f"{design}-{seed}"
            folder.mkdir(parents=True, exist_ok=True)
            (folder / "study.toml").write_text(STUDY)
            write(folder / "bench.csv", "rpm,torque,torque_se", zip(SPEEDS, measured, 0.03 * true))
            scatter = numpy.random.default_rng(70 + seed)
            runs = numpy.empty((0, 5))
            for count in counts:
                while len(runs) < count:
                    listed = design == "sequential" and len(runs) >= 10
                    points = next_points(options.demcal, folder, count) if listed else sequence[len(runs):]
                    points = points[:count - len(runs)]
                    value = torque(points)
                    made = value + 0.02 * value * scatter.standard_normal(len(value))
                    runs = numpy.vstack([runs, numpy.c_[points, made, 0.02 * value]])
                    write(folder / "runs.csv", "friction,hamaker,rpm,torque,torque_se", runs)
                error = distance(options.demcal, folder, exact)
                errors.setdefault((design, count), []).append(error)
                print(f"seed {seed}, {design}, {count} runs: {error:.3f}", flush=True)
    print("| design | runs | median | quartiles |\n|---|---|---|---|")
    for (design, count), values in errors.items():
        low, middle, high = numpy.quantile(values, [0.25, 0.5, 0.75])
        print(f"| {design} | {count} | {middle:.3f} | {low:.3f}, {high:.3f} |")


if __name__ == "__main__":
    main()
