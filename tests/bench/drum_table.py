#!/usr/bin/python3
"""Coverage of intervals and verdicts on another code's table, and GrainLearning's filter beside it.

drum_table.py DEMCAL [--designs 200] [--others 100] [--jobs 1] [--seed 1] [--errors roughness|PERCENT] [--truths all|inner]
    [--runs-most N] [--out FOLDER] [--summary]

Each of N designs of data/drum-table in turn is the truth: its rows at the three speeds are the observations, as they
stand (their own scatter is the noise), with the standard errors of make_data.py, or with PERCENT of every output. The
runs are those of M other designs of the same sphere size, drawn at random; with --others 0 they are those of all
designs but the N truths, which the surrogates are fitted to once (they stay in FOLDER/study-J of each job). `demcal calibrate` gives draws and verdicts
of both cases. Results are appended to FOLDER/results.jsonl, so that a campaign that was cut off goes on; --summary
only prints the tables.

"holds" counts truths in the central 90 % interval (q05 to q95), over designs whose level of that parameter is not an
end of its range, since no central interval reaches an end; "narrowest" counts all designs, by the shortest interval
that has 90 % of the draws. An identified parameter is false where its truth lies more than 3 posterior sds off.

The filter is the sequential Monte Carlo weighting of GrainLearning (grainlearning/inference.py, commit fcbf493c) on a
fixed set of samples, written anew: weights of Gaussian likelihoods whose standard deviation is one share of each
observation, the same share for all, chosen so that the effective sample size is 30 % of the samples (its default).
Speeds are its steps and outputs its observables, all of equal weight. Its further iterations, which simulate resampled points,
need a code to run and are left out.
"""
import argparse
import concurrent.futures
import importlib.util
import json
import math
import pathlib
import queue
import random
import shutil
import subprocess
import sys
import tempfile
import time

import netCDF4
import numpy as np

ROOT = pathlib.Path(__file__).resolve().parents[2]
STUDY = ROOT / "data" / "drum-table"
PARAMETERS = ["sliding", "rolling", "cohesion", "restitution"]
CASES = {"torque-alone": ["torque_over_MgR"], "with-angles": ["torque_over_MgR", "angle_upper", "angle_lower"]}
EFFECTIVE_SAMPLES = 0.3  # share of the samples, GrainLearning's default


def load_maker():
    spec = importlib.util.spec_from_file_location("make_data", STUDY / "make_data.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def with_percent(maker, percent):
    """The same errors for all rows, whatever their surface."""
    maker.torque_error = lambda row: 0.01 * percent * float(row["torque_over_MgR"])
    maker.angle_error = lambda row, name: 0.01 * percent * float(row[name])


def write_study(folder, maker, rows, truth):
    """Study of one truth; False where no angle was seen."""
    maker.write_runs(folder / "runs.csv", rows, truth)
    angles = maker.write_observations(folder, [r for r in rows if maker.design_of(r) == truth], truth)
    text = (STUDY / "study.toml").read_text().replace('material = "size-1.1"', f'material = "{maker.material_of(dict(zip(maker.DESIGN, truth)))}"')
    if not angles:
        head, tail = text.split('[[observe]]\nname = "angles"')
        text = head + tail[tail.index("[[calibrate]]"):].split('[[calibrate]]\nname = "with-angles"')[0]
    (folder / "study.toml").write_text(text)
    return angles


def narrowest(draws, share=0.9):
    ordered = np.sort(draws)
    kept = int(math.ceil(share * len(ordered)))
    widths = ordered[kept - 1:] - ordered[:len(ordered) - kept + 1]
    first = int(np.argmin(widths))
    return float(ordered[first]), float(ordered[first + kept - 1])


def read_draws(path):
    with netCDF4.Dataset(path) as file:
        return {name: np.asarray(file["posterior"][name]).ravel() for name in PARAMETERS}


def ours(program, folder, rows, truth, maker, runs_most):
    write_study(folder, maker, rows, truth)
    begin = time.time()
    done = subprocess.run([program, "calibrate", str(folder), "--no-scan", "--json", "--quiet", "--out", str(folder / "out"),
                           "--set", f"surrogate.runs_most={runs_most}"], capture_output=True, text=True)
    if done.returncode not in (0, 2):
        return {"failed": done.stderr.strip()[-500:], "status": done.returncode}
    report = json.loads(done.stdout)
    found = {"seconds": time.time() - begin, "cases": {},
             "surrogates": {s["output"]: [s["verdict"], s["q2"]] for s in report["surrogates"]}}
    for case in report["cases"]:
        draws = read_draws(folder / "out" / f"posterior-{case['name']}.nc")
        one = {}
        for parameter in case["parameters"]:
            d = draws[parameter["name"]]
            one[parameter["name"]] = {
                "verdict": parameter["verdict"], "reason": parameter.get("reason"), "mean": float(d.mean()), "sd": float(d.std()),
                "q05": float(np.quantile(d, 0.05)), "q95": float(np.quantile(d, 0.95)), "narrowest": narrowest(d)}
        found["cases"][case["name"]] = {"parameters": one, "ppp": case["fit"]["ppp"]}
    return found


def weighted_quantile(values, weights, share):
    order = np.argsort(values, kind="stable")
    return float(np.asarray(values)[order][np.searchsorted(np.cumsum(weights[order]), share * (1.0 - 1e-12))])


def filter_weights(samples, observed):
    """Of samples (count, observables): one relative sd for all, to the wanted effective sample size."""
    distance = np.sum(((samples - observed) / observed) ** 2, axis=1)

    def at(sd):
        weights = np.exp(-0.5 * (distance - distance.min()) / sd ** 2)
        return weights / weights.sum()

    low, high = 1e-6, 1e3
    for _ in range(100):
        sd = math.sqrt(low * high)
        low, high = (sd, high) if 1.0 / np.sum(at(sd) ** 2) / len(samples) < EFFECTIVE_SAMPLES else (low, sd)
    return at(sd)


def filtered(rows, truth, maker):
    """Intervals of GrainLearning's weighting on the same rows."""
    of_design = {}
    for row in rows:
        of_design.setdefault(maker.design_of(row), {})[row["rpm"]] = row
    own, found = of_design.pop(truth), {}
    values = np.array([[float(v) for v in design[1:]] for design in of_design])
    for case, outputs in CASES.items():
        columns = [(rpm, name) for rpm in sorted(own) for name in outputs]
        observed = np.array([float(own[rpm][name]) for rpm, name in columns])
        samples = np.array([[float(design[rpm][name]) for rpm, name in columns] for design in of_design.values()])
        weights = filter_weights(samples, observed)
        found[case] = {name: {"q05": weighted_quantile(values[:, maker.DESIGN.index(name) - 1], weights, 0.05),
                              "q95": weighted_quantile(values[:, maker.DESIGN.index(name) - 1], weights, 0.95)}
                       for name in PARAMETERS}
    return found


def one_of_all(program, table, truths, truth, arguments, folders):
    """A truth beside all designs that are no truth of the N."""
    maker = load_maker()
    if arguments.errors != "roughness":
        with_percent(maker, float(arguments.errors))
    rows = [r for r in table if maker.design_of(r) not in truths]
    own = [r for r in table if maker.design_of(r) == truth]
    folder = folders.get()
    try:
        found = ours(program, folder, rows + own, truth, maker, arguments.runs_most)
    finally:
        folders.put(folder)
    same = [r for r in rows if r["psd_mm"] == truth[0]]
    return {"truth": dict(zip(maker.DESIGN, map(float, truth))), "others": arguments.others, "seed": arguments.seed, "errors": arguments.errors,
            "truths": arguments.truths, "runs_most": arguments.runs_most, "ours": found, "filter": filtered(same + own, truth, maker)}


def one_design(program, table, truth, arguments):
    maker = load_maker()
    if arguments.errors != "roughness":
        with_percent(maker, float(arguments.errors))
    same = sorted({maker.design_of(r) for r in table if r["psd_mm"] == truth[0]} - {truth})
    others = set(random.Random(f"{arguments.seed} {truth}").sample(same, min(arguments.others, len(same))))
    rows = [r for r in table if maker.design_of(r) == truth or maker.design_of(r) in others]
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder) / "drum-table"
        folder.mkdir()
        found = ours(program, folder, rows, truth, maker, arguments.runs_most)
        shutil.rmtree(folder)
    return {"truth": dict(zip(maker.DESIGN, map(float, truth))), "others": arguments.others, "seed": arguments.seed, "errors": arguments.errors,
            "truths": arguments.truths, "runs_most": arguments.runs_most, "ours": found, "filter": filtered(rows, truth, maker)}


def share(flags):
    if not flags:
        return "-"
    mean = sum(flags) / len(flags)
    return f"{100 * mean:.1f} +- {100 * math.sqrt(mean * (1 - mean) / len(flags)):.1f} %"


def summary(results):
    done = [r for r in results if "cases" in r["ours"]]
    if not done:
        return "no design yet"
    ends = {"sliding": (0.15, 1.0), "rolling": (0.0, 0.7), "cohesion": (0.0, 7e4), "restitution": (0.1, 0.99)}
    ranges = {p: high - low for p, (low, high) in ends.items()}
    lines = [f"{len(done)} designs, {len(results) - len(done)} failed; seconds each: median "
             f"{np.median([r['ours']['seconds'] for r in done]):.0f}",
             "", "| case | parameter | holds, inner levels | narrowest, all levels | width, share of range | identified | of them false | "
             "filter holds, inner levels | filter holds, all levels | filter's width |", "|" + "---|" * 10]
    totals = {case: [[] for _ in range(6)] for case in CASES}
    for case in CASES:
        for p in PARAMETERS:
            central, short, width, said, false, theirs, theirs_all, wide = ([] for _ in range(8))
            for r in done:
                if case not in r["ours"]["cases"]:
                    continue
                own, other, truth = r["ours"]["cases"][case]["parameters"][p], r["filter"][case][p], r["truth"][p]
                if truth not in ends[p]:
                    central.append(own["q05"] <= truth <= own["q95"])
                    theirs.append(other["q05"] <= truth <= other["q95"])
                slack = 1e-3 * ranges[p]  # draws come near an end, not onto it
                short.append(own["narrowest"][0] - slack <= truth <= own["narrowest"][1] + slack)
                theirs_all.append(other["q05"] <= truth <= other["q95"])
                width.append((own["q95"] - own["q05"]) / ranges[p])
                wide.append((other["q95"] - other["q05"]) / ranges[p])
                said.append(own["verdict"] == "identified")
                if said[-1]:
                    false.append(abs(own["mean"] - truth) > 3.0 * own["sd"])
            for total, part in zip(totals[case], (central, short, said, false, theirs, theirs_all)):
                total += part
            lines.append(f"| {case} | {p} | {share(central)} | {share(short)} | {np.mean(width):.2f} | {sum(said)} of {len(said)} | {sum(false)} | "
                         f"{share(theirs)} | {share(theirs_all)} | {np.mean(wide):.2f} |")
        central, short, said, false, theirs, theirs_all = totals[case]
        lines.append(f"| {case} | all | {share(central)} | {share(short)} | | {sum(said)} of {len(said)} | {sum(false)} | {share(theirs)} | {share(theirs_all)} | |")
    return "\n".join(lines)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("demcal")
    parser.add_argument("--designs", type=int, default=200)
    parser.add_argument("--others", type=int, default=100, help="other designs that are the runs; 0: all that are no truth")
    parser.add_argument("--errors", default="roughness")
    parser.add_argument("--runs-most", type=int, default=1000, help="runs that train a surrogate")
    parser.add_argument("--truths", choices=["all", "inner"], default="all",
                        help="inner: designs with no parameter at an end of its range")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("drum-table-coverage"))
    parser.add_argument("--summary", action="store_true")
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    kept = arguments.out / "results.jsonl"
    results = [json.loads(line) for line in kept.read_text().splitlines()] if kept.exists() else []
    kinds = ["others", "seed", "errors", "truths", "runs_most"]
    results = [r for r in results if all(r[kind] == getattr(arguments, kind) for kind in kinds)]
    if not arguments.summary:
        maker = load_maker()
        table = maker.read_table(STUDY / "granudrum_liggghts.csv")
        designs = sorted({maker.design_of(r) for r in table})
        if arguments.truths == "inner":
            ends = [{f(float(d[k]) for d in designs) for f in (min, max)} for k in range(1, len(maker.DESIGN))]
            designs = [d for d in designs if not any(float(v) in e for v, e in zip(d[1:], ends))]
        random.Random(arguments.seed).shuffle(designs)
        known = {tuple(r["truth"].values()) for r in results}
        missing = [d for d in designs[:arguments.designs] if tuple(map(float, d)) not in known]
        with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool, kept.open("a") as file:
            if arguments.others == 0:
                folders = queue.Queue()
                for job in range(arguments.jobs):
                    folders.put(arguments.out / f"study-{job}")
                    (arguments.out / f"study-{job}").mkdir(exist_ok=True)
                truths = set(designs[:arguments.designs])
                jobs = [pool.submit(one_of_all, arguments.demcal, table, truths, truth, arguments, folders) for truth in missing]
            else:
                jobs = [pool.submit(one_design, arguments.demcal, table, truth, arguments) for truth in missing]
            for job in concurrent.futures.as_completed(jobs):
                results.append(job.result())
                file.write(json.dumps(results[-1]) + "\n")
                file.flush()
                print(f"{len(results)} of {arguments.designs}", file=sys.stderr)
    print(summary(results))


if __name__ == "__main__":
    main()
