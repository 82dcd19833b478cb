#!/usr/bin/env python3
"""Whether a run's mean is that of the steady flow and its error true: python3 tests/bench/steady.py [--demcal PROGRAM]
[--seeds N] [--jobs N] [--only TEXT] [--out FOLDER]

Six points of data/developer, each material slow and fast, N seeds each, and a reference of three other seeds with at
least 15 turns each. It prints the table of dem/STEADY.md:
  spread   standard deviation of (mean of a run - mean of all) / (error stated), over the seeds; 1 when errors are true
  bias     (mean of the runs - reference) / (error stated by one run)
  steady, drifting, short: what the runs say of themselves
and with equal spheres instead of the study's, how many runs notice that they are not steady or that the bed orders.
What each run gave is a row of steady.csv beside this file, so that nobody has to run it again. A run that was
interrupted goes on in its folder below --out. `--seeds 0` runs nothing and prints the table.
"""
import argparse
import concurrent.futures
import csv
import json
import math
import pathlib
import statistics
import subprocess
import sys
import threading

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
POINTS = [(material, f"friction=0.4,hamaker={hamaker} J,rpm={rpm}")
          for material, hamaker in (("zirconia-800", "0"), ("zirconia-100", "2e-18"), ("carrier", "9e-18"))
          for rpm in (60, 300)]


REFERENCE = ["run.shortest_turns=15", "run.shortest=\"3 s\"", "run.longest=\"40 s\""]
EQUAL = [f"materials.{name}.sizes=[{{ diameter = \"0.8 mm\", mass_fraction = 1.0 }}]"
         for name in ("zirconia-800", "zirconia-100", "carrier")]
COLUMNS = ["material", "at", "seed", "kind", "settings", "state", "ordering", "turns", "torque_uN_m",
           "standard_error_uN_m"]


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--demcal", default=str(ROOT / "demcal"))
    parser.add_argument("--study", default=str(ROOT / "data" / "developer"))
    parser.add_argument("--out", default="steady-runs", type=pathlib.Path, help="where unfinished runs are kept")
    parser.add_argument("--table", default=pathlib.Path(__file__).with_suffix(".csv"), type=pathlib.Path)
    parser.add_argument("--seeds", default=30, type=int)
    parser.add_argument("--references", default=3, type=int, help="seeds of at least 15 turns")
    parser.add_argument("--equal", default=3, type=int, help="seeds with equal spheres")
    parser.add_argument("--jobs", default=1, type=int)
    parser.add_argument("--only", default="", help="points whose name has this text, as zirconia-100-...-rpm=60")
    parser.add_argument("--set", default=[], action="append", help="KEY=VALUE for every run, as demcal's")
    return parser.parse_args()


class Table:
    """Rows of finished runs, by point, seed and kind; written whole after each run."""

    def __init__(self, path):
        self.path, self.lock = path, threading.Lock()
        self.rows = {}
        if path.exists():
            with path.open() as lines:
                for row in csv.DictReader(line for line in lines if not line.startswith("#")):
                    self.rows[self.key((row["material"], row["at"]), row["seed"], row["kind"])] = row

    @staticmethod
    def key(point, seed, kind):
        return (*point, str(seed), kind)

    def add(self, row):
        with self.lock:
            self.rows[self.key((row["material"], row["at"]), row["seed"], row["kind"])] = row
            new = self.path.with_suffix(".new")
            with new.open("w") as out:
                out.write("# Runs of steady.py on data/developer: means of torque and their stated errors.\n")
                writer = csv.DictWriter(out, COLUMNS, lineterminator="\n")
                writer.writeheader()
                writer.writerows(row for _, row in sorted(self.rows.items()))
            new.replace(self.path)

    def of(self, point, kind):
        rows = [row for key, row in sorted(self.rows.items()) if key[:2] == point and key[3] == kind]
        settings = {row["settings"] for row in rows}
        if len(settings) > 1:
            sys.exit(f"{self.path}: rows of {point[0]}, {point[1]}, {kind} have several settings "
                     f"({', '.join(settings)}): remove those of other settings than the study's")
        return rows


def simulate(options, table, point, seed, kind, settings):
    if Table.key(point, seed, kind) in table.rows:
        return
    material, at = point
    name = f"{material}-{at}-{seed}-{kind}".replace(" J", "").replace("=", "").replace(",", "-")
    command = [options.demcal, "simulate", options.study, "--material", material, "--at", at, "--seed", str(seed),
               "--out", str(options.out / name), "--json", "--quiet"]
    for setting in [*options.set, *settings]:
        command += ["--set", setting]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode not in (0, 2):
        raise RuntimeError(f"{' '.join(command)}\n{done.stderr}")
    found = json.loads(done.stdout)
    torque = found["outputs"]["torque"]
    table.add(dict(zip(COLUMNS, [material, at, str(seed), kind, found["settings"], found["state"],
                                 "yes" if found["ordering"] else "no", f"{found['measured']['turns']:.3f}",
                                 f"{torque['mean']:.6g}", f"{torque['standard_error']:.4g}"], strict=True)))


def run_missing(options, table):
    """Seed by seed over all points, a third of the runs first: what is there early tells of all points."""
    points = [point for point in POINTS if options.only in f"{point[0]}-{point[1]}"]
    first = range(1000, 1000 + options.seeds // 3)
    others = range(first.stop, 1000 + options.seeds)
    references = range(5000, 5000 + (options.references if options.seeds else 0))
    equal = range(1000, 1000 + (options.equal if options.seeds else 0))
    parts = [(first, "run", []), (references, "reference", REFERENCE), (equal, "equal", EQUAL), (others, "run", [])]
    tasks = [(point, seed, kind, settings) for seeds, kind, settings in parts for seed in seeds for point in points]
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        for done in concurrent.futures.as_completed(pool.submit(simulate, options, table, *task) for task in tasks):
            done.result()


def number(row, column):
    return float(row[column])


def print_summary(table):
    print("| point | seeds | torque (reference), uN m | error of a run | spread | bias | "
          "steady / drifting / short | equal: noticed |")
    print("|---|---|---|---|---|---|---|---|")
    together = []
    for point in POINTS:
        runs, long, equal = (table.of(point, kind) for kind in ("run", "reference", "equal"))
        good = [row for row in runs if row["state"] == "steady"]
        states = " / ".join(str(sum(row["state"] == s for row in runs)) for s in ("steady", "drifting", "short"))
        noticed = sum(row["state"] != "steady" or row["ordering"] == "yes" for row in equal)
        if len(good) < 2:
            print(f"| {point[0]}, {point[1]} | {len(runs)} | too few steady runs | | | | {states} | |")
            continue
        mean = statistics.fmean(number(row, "torque_uN_m") for row in good)
        error = statistics.fmean(number(row, "standard_error_uN_m") for row in good)
        scaled = [(number(row, "torque_uN_m") - mean) / number(row, "standard_error_uN_m") for row in good]
        spread = math.sqrt(sum(z * z for z in scaled) / (len(scaled) - 1))
        together += [(z * z, len(scaled)) for z in scaled]
        reference, bias = "none", ""
        if long:
            truth = statistics.fmean(number(row, "torque_uN_m") for row in long)
            its_error = math.hypot(*(number(row, "standard_error_uN_m") for row in long)) / len(long)
            reference = f"{truth:.2f} +- {its_error:.2f}"
            bias = f"{(mean - truth) / error:+.2f} +- {math.hypot(error / math.sqrt(len(good)), its_error) / error:.2f}"
        print(f"| {point[0]}, {point[1]} | {len(runs)} | {mean:.2f} ({reference}) | {error:.2f} | {spread:.2f} | "
              f"{bias} | {states} | {noticed} of {len(equal)} |")
    if together:
        print(f"\nspread over all: {math.sqrt(sum(z2 * n / (n - 1) for z2, n in together) / len(together)):.2f}")


def main():
    options = parse_arguments()
    table = Table(options.table)
    try:
        run_missing(options, table)
    finally:
        print_summary(table)


main()
