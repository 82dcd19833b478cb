#!/usr/bin/env python3
"""Whether a plan's forecast comes true where the truth is a DEM run: python3 tests/bench/plan_truths.py OUT [--demcal PROGRAM]
[--truths N] [--runs-only] [--draws N] [--seed N]

Each of N truths of data/developer's carrier (friction and Hamaker constant, evenly over the inner four fifths of their
ranges) is simulated at three speeds with a seed that no training run has: their torques with 3 % noise are the
measurement. It is calibrated, and `plan --about friction` chooses what to measure next. That reading, simulated at the truth and with the
noise that the plan assumed, is added, and all is calibrated again: once the plan's first choice, and once the reading of any
output that would teach most about friction, as if it meant the same in the real powder as with enlarged grains. Printed
are, for each truth, friction's sd before, as forecast and as found, the words, and whether the 90 % interval holds the
truth; failures stay in the table. --draws: so many draws of all noise for each truth. The DEM runs are kept below OUT, so that a second start goes on.
"""
import argparse
import collections
import json
import math
import pathlib
import random
import shutil
import statistics
import subprocess

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
MATERIAL, ABOUT, NOISE = "carrier", "friction", 0.03
SPEEDS = (50, 150, 300)
RANGES = {"friction": (0.1, 0.8), "hamaker": (0.0, 1.5e-17)}


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("out", type=pathlib.Path)
    parser.add_argument("--demcal", default=str(ROOT / "demcal"))
    parser.add_argument("--truths", default=20, type=int)
    parser.add_argument("--draws", default=1, type=int)
    parser.add_argument("--seed", default=1, type=int, help="of the noise")
    parser.add_argument("--runs-only", action="store_true")
    return parser.parse_args()


def radical_inverse(number, base):
    """Halton's sequence: the digits of `number` behind the point, in reverse."""
    value, scale = 0.0, 1.0 / base
    while number:
        value, number, scale = value + scale * (number % base), number // base, scale / base
    return value


def truth(number):
    places = (radical_inverse(number + 1, 2), radical_inverse(number + 1, 3))
    return {name: low + (0.1 + 0.8 * place) * (high - low) for (name, (low, high)), place in zip(RANGES.items(), places)}


def run(command):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True)
    if done.returncode not in (0, 2):  # 2: done, with a warning
        raise RuntimeError(f"{' '.join(map(str, command))}\n{done.stderr}")
    return done.stdout


def simulate(options, number, rpm):
    """The outputs of the run at a truth: {name: (mean, standard error)}; kept as OUT/runs/NUMBER-RPM.json."""
    kept = options.out / "runs" / f"{number}-{rpm:g}.json"
    if not kept.exists():
        at = ",".join([*(f"{name}={value!r}" for name, value in truth(number).items()), f"rpm={rpm!r}"])
        text = run([options.demcal, "simulate", ROOT / "data" / "developer", "--material", MATERIAL, "--at", at, "--seed",
                    8800 + number, "--json", "--quiet", "--out", options.out / "runs" / f"{number}-{rpm:g}"])
        kept.write_text(text)
        shutil.rmtree(options.out / "runs" / f"{number}-{rpm:g}")
    found = json.loads(kept.read_text())
    return {name: (of["mean"], of["standard_error"]) for name, of in found["outputs"].items()}


def reading(noise, mean, error, spread):
    """A measured value and its standard error, the simulated mean's error in it."""
    value = mean + spread * noise.gauss(0, 1)
    return value, math.hypot(spread, error)


def write_study(folder, truth_number, torques):
    if folder.exists():
        shutil.rmtree(folder)
    shutil.copytree(ROOT / "data" / "developer", folder)
    text = (folder / "study.toml").read_text()
    start = text.index("[[observe]]")
    (folder / "torque.csv").write_text("rpm,torque,torque_se\n" + "".join(f"{r:g},{v!r},{e!r}\n" for r, v, e in torques))
    at = ", ".join(f"{name} {value:.4g}" for name, value in truth(truth_number).items())
    case = f'[[calibrate]]\nname = "{MATERIAL}"\nobserve = ["torque"]\nfree = ["friction", "hamaker"]\n'
    measured = f'[[observe]]\nname = "torque"\nmaterial = "{MATERIAL}"\nfile = "torque.csv"   # truth: {at}\n'
    (folder / "study.toml").write_text(text[:start] + measured + case)


def add_reading(folder, output, rpm, value, error):
    (folder / "next.csv").write_text(f"rpm,{output},{output}_se\n{rpm:g},{value!r},{error!r}\n")
    path = folder / "study.toml"
    text = path.read_text().replace('observe = ["torque"]', 'observe = ["torque", "next"]')
    more = f'[[observe]]\nname = "next"\nmaterial = "{MATERIAL}"\nfile = "next.csv"\n'
    path.write_text(text.replace("[[calibrate]]", more + "[[calibrate]]"))


def calibrated(options, folder, seed):
    run([options.demcal, "calibrate", folder, "--out", folder / "results", "--quiet", "--seed", seed])
    case = json.loads((folder / "results" / "report.json").read_text())["cases"][0]
    return next(p for p in case["parameters"] if p["name"] == ABOUT), case["fit"]["fits"]


def of_friction(candidate):
    return next(p for p in candidate["parameters"] if p["name"] == ABOUT)


def spread_of(candidate, mean):
    """The standard error that the plan assumed, "3.2 %" or in the output's unit."""
    number, *unit = candidate["error"].split()
    return float(number) / 100 * abs(mean) if unit == ["%"] else float(number)


def loop(options, number, draw):
    """One truth, measured, planned, measured again by the plan's first choice and by the output that would teach most."""
    noise = random.Random(1000 * options.seed + 100 * draw + number)
    folder = options.out / "loops" / f"{number}-{options.seed}-{draw}"
    torques = []
    for rpm in SPEEDS:
        mean, error = simulate(options, number, rpm)["torque"]
        torques.append((rpm, *reading(noise, mean, error, NOISE * mean)))
    write_study(folder, number, torques)
    before, fits = calibrated(options, folder, 1)
    row = {"number": number, "draw": draw, "before": before, "fits": fits, "arms": {}}
    if not fits:
        return row
    run([options.demcal, "plan", folder, "--about", ABOUT, "--out", folder / "results", "--quiet"])
    candidates = json.loads((folder / "results" / "plan.json").read_text())["plans"][0]["candidates"]
    chosen = {"torque": candidates[0], "any output": max(candidates, key=lambda c: of_friction(c)["information"])}
    for arm, candidate in chosen.items():
        [output], [setting] = candidate["outputs"], candidate["settings"]
        mean, error = simulate(options, number, setting["rpm"])[output]
        spread = spread_of(candidate, mean)
        again = folder.with_name(folder.name + "-" + arm.replace(" ", "-"))
        write_study(again, number, torques)
        add_reading(again, output, setting["rpm"], *reading(noise, mean, error, spread))
        after, fits = calibrated(options, again, 2)
        row["arms"][arm] = {"choice": candidate["name"], "forecast": of_friction(candidate), "after": after, "fits": fits}
    return row


def holds(found, number):
    return found["q05"] <= truth(number)[ABOUT] <= found["q95"]


def print_tables(rows):
    print("| truth | friction | before | choice | forecast | found | word | forecast of that word | holds |")
    print("|---|---|---|---|---|---|---|---|---|")
    for row in rows:
        start = f"| {row['number']} | {truth(row['number'])[ABOUT]:.3f} | {row['before']['sd']:.3f} {row['before']['verdict']} |"
        if not row["fits"]:
            print(start, "does not fit: not planned | | | | | |")
        for arm, found in row["arms"].items():
            after, said = found["after"], {w["verdict"]: w["probability"] for w in found["forecast"]["words"]}
            print(start, f"{found['choice']} | {found['forecast']['sd_after']:.3f} | {after['sd']:.3f} | {after['verdict']} | "
                         f"{said.get(after['verdict'], 0.0):.2f} | {'yes' if holds(after, row['number']) else 'no'} |")
    planned = [row for row in rows if row["arms"]]
    print(f"\n{len(rows)} loops, {len(rows) - len(planned)} did not fit the torque and were not planned")
    print(f"before: 90 % intervals hold the truth {sum(holds(r['before'], r['number']) for r in rows)} of {len(rows)}")
    for arm in ("torque", "any output"):
        found = [(row["number"], row["before"], row["arms"][arm]) for row in planned]
        sds = [(one["after"]["sd"], one["forecast"]["sd_after"], before["sd"]) for _, before, one in found if one["fits"]]
        changed = sum(one["after"]["verdict"] != before["verdict"] for _, before, one in found)
        word = collections.Counter(one["after"]["verdict"] for _, _, one in found)
        told = collections.Counter()
        for _, _, one in found:
            for w in one["forecast"]["words"]:
                told[w["verdict"]] += w["probability"]
        print(f"{arm}: sd found over forecast {statistics.fmean(a / f for a, f, _ in sds):.3f}, over that before "
              f"{statistics.fmean(a / b for a, _, b in sds):.3f}; the word changes in {changed}; "
              f"holds {sum(holds(one['after'], number) for number, _, one in found)} of {len(found)}; "
              f"does not fit {len(found) - len(sds)}")
        for verdict in sorted(set(word) | set(told)):
            print(f"  {verdict}: came {word[verdict]}, forecast {told[verdict]:.1f}")


def main():
    options = parse_arguments()
    (options.out / "runs").mkdir(parents=True, exist_ok=True)
    ended = []
    for number in range(options.truths):
        try:
            for rpm in SPEEDS:
                simulate(options, number, rpm)
            ended.append(number)
        except RuntimeError as error:  # a run that ends at run.overlap_limit, say: the truth counts as failed
            print(f"truth {number} cannot be simulated: {error}", flush=True)
    if options.runs_only:
        return
    print(f"{options.truths - len(ended)} of {options.truths} truths cannot be simulated")
    rows = []
    for draw in range(options.draws):
        for number in ended:
            rows.append(loop(options, number, draw))
            row = rows[-1]
            print(f"truth {number}, draw {draw}:", row["before"]["verdict"],
                  *(f"-> {one['after']['verdict']} ({one['choice']})" for one in row["arms"].values()), flush=True)
    print_tables(rows)


main()
