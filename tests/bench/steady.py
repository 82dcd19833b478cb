#!/usr/bin/env python3
"""Whether a run's mean is that of the steady flow and its error true: python3 tests/bench/steady.py [--demcal PROGRAM]
[--seeds N] [--jobs N] [--out FOLDER]

Six points of data/developer, each material slow and fast, N seeds each, and a reference of three other seeds with at
least 15 turns each. It prints the table of dem/STEADY.md:
  spread   standard deviation of (mean of a run - mean of all) / (error stated), over the seeds; 1 when errors are true
  bias     (mean of the runs - reference) / (error stated by one run)
  steady, drifting, short: what the runs say of themselves
and with equal spheres instead of the study's, how many runs notice that they are not steady or that the bed orders.
Every run is a folder of its own that `demcal simulate` goes on in: start it again, and it does only what is missing.
"""
import argparse
import concurrent.futures
import json
import math
import pathlib
import statistics
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
POINTS = [(material, f"friction=0.4,hamaker={hamaker} J,rpm={rpm}")
          for material, hamaker in (("zirconia-800", "0"), ("zirconia-100", "2e-18"), ("carrier", "9e-18"))
          for rpm in (60, 300)]


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--demcal", default=str(ROOT / "demcal"))
    parser.add_argument("--study", default=str(ROOT / "data" / "developer"))
    parser.add_argument("--out", default="steady-runs", type=pathlib.Path)
    parser.add_argument("--seeds", default=30, type=int)
    parser.add_argument("--jobs", default=1, type=int)
    parser.add_argument("--equal", default=3, type=int, help="seeds with equal spheres")
    parser.add_argument("--set", default=[], action="append", help="KEY=VALUE for every run, as demcal's")
    return parser.parse_args()


def simulate(options, point, seed, kind, settings):
    material, at = point
    name = f"{material}-{at}-{seed}-{kind}".replace(" J", "").replace("=", "").replace(",", "-")
    folder = options.out / name
    kept = folder / "result.json"
    if kept.exists():
        return json.loads(kept.read_text())
    command = [options.demcal, "simulate", options.study, "--material", material, "--at", at, "--seed", str(seed),
               "--out", str(folder), "--json", "--quiet"]
    for setting in [*options.set, *settings]:
        command += ["--set", setting]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode not in (0, 2):
        sys.exit(f"{' '.join(command)}\n{done.stderr}")
    kept.write_text(done.stdout)
    return json.loads(done.stdout)


def main():
    options = parse_arguments()
    options.out.mkdir(parents=True, exist_ok=True)
    reference = ["run.shortest_turns=15", "run.shortest=\"3 s\"", "run.longest=\"40 s\""]
    equal = [f"materials.{name}.sizes=[{{ diameter = \"0.8 mm\", mass_fraction = 1.0 }}]"
             for name in ("zirconia-800", "zirconia-100", "carrier")]
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        runs, long, same = ({point: [] for point in POINTS} for _ in range(3))

        def submit(into, seeds, kind, settings):
            """Seed by seed over all points, so that what is there early tells of all of them."""
            for seed in seeds:
                for point in POINTS:
                    into[point].append(pool.submit(simulate, options, point, seed, kind, settings))

        submit(runs, range(1000, 1000 + options.seeds // 3), "run", [])
        submit(long, range(5000, 5003), "reference", reference)
        submit(same, range(1000, 1000 + options.equal), "equal", equal)
        submit(runs, range(1000 + options.seeds // 3, 1000 + options.seeds), "run", [])
    print("| point | seeds | torque | error of a run | spread | bias | steady / drifting / short | equal: noticed |")
    print("|---|---|---|---|---|---|---|---|")
    together = []
    for point in POINTS:
        results = [run.result() for run in runs[point]]
        good = [r["outputs"]["torque"] for r in results if r["state"] == "steady"]
        states = [sum(r["state"] == state for r in results) for state in ("steady", "drifting", "short")]
        noticed = sum(r.result()["state"] != "steady" or bool(r.result()["ordering"]) for r in same[point])
        if len(good) < 2:
            print(f"| {point[0]}, {point[1]} | {len(results)} | too few steady runs | | | | {states} | |")
            continue
        mean = statistics.fmean(t["mean"] for t in good)
        error = statistics.fmean(t["standard_error"] for t in good)
        scaled = [(t["mean"] - mean) / t["standard_error"] for t in good]
        spread = math.sqrt(sum(z * z for z in scaled) / (len(scaled) - 1))
        together += [(z * z, len(scaled)) for z in scaled]
        truth = statistics.fmean(r.result()["outputs"]["torque"]["mean"] for r in long[point])
        print(f"| {point[0]}, {point[1]} | {len(results)} | {mean:.2f} ({truth:.2f}) | {error:.2f} | {spread:.2f} | "
              f"{(mean - truth) / error:+.2f} | {' / '.join(map(str, states))} | {noticed} of {len(same[point])} |")
    if together:
        all_spread = math.sqrt(sum(z2 * n / (n - 1) for z2, n in together) / len(together))
        print(f"\nspread over all: {all_spread:.2f}")


main()
