#!/usr/bin/env python3
"""The rotating drum of a published comparison of DEM codes: run.py DEMCAL [options].

Both codes run the first part of the case (make.py) from the same packing with the same law, time step and skin, one after
the other, on one core. Speed is counted in processor time of the whole program. Of the second half of the run both say the means
of coordination number, kinetic energy, centre of mass and torque. --reach 0.2 runs demcal alone for so many seconds, in steps
of --step, and puts beside it what two other codes gave at these times (others.csv, whose lines of comment say whose)."""
import argparse, csv, os, pathlib, shutil, subprocess, sys, tempfile

import h5py, numpy

here = pathlib.Path(__file__).resolve().parent
TIME_STEP, SPHERES = 8e-7, 38000
NAMES = ["coordination", "kinetic_energy", "centre_x", "centre_z", "torque"]


def run(command, folder):
    """Processor seconds of the command."""
    log = folder / "log"
    with open(log, "w") as out:
        child = subprocess.Popen([str(word) for word in command], cwd=folder, stdout=out, stderr=subprocess.STDOUT)
        _, status, used = os.wait4(child.pid, 0)
    if os.waitstatus_to_exitcode(status) not in (0, 2):  # 2: demcal's "done, with a warning"
        sys.exit(f"{' '.join(map(str, command))} failed:\n{log.read_text()[-2000:]}")
    return used.ru_utime + used.ru_stime


def demcal(program, case, folder, seconds, *more):
    command = [program, "simulate", case, "--out", folder / "demcal", "--quiet", "--json", "--threads", 1, *more]
    for key, value in {"shortest": seconds, "longest": seconds, "window": 0.1 * seconds}.items():
        command += ["--set", f"run.{key}={value:.9g} s"]
    return run(command, folder)


def late_mean(samples):
    return numpy.mean(samples[len(samples) // 2:], axis=0)


def answer_of_demcal(folder):
    with h5py.File(folder / "demcal/run.h5") as file:
        return file["diagnostics"].attrs["skin_m"], [late_mean(file[f"series/{name}"][:]) for name in NAMES]


def liggghts(case, folder, seconds, skin):
    return run(["liggghts", "-in", here / "in.drum", "-var", "dir", case, "-var", "nrun", round(seconds / TIME_STEP), "-var", "skin",
                skin, "-log", "none"], folder)


def answer_of_liggghts(folder):
    """Its sums are taken at both ends of a sample; demcal's are means over it."""
    sums, torque = (numpy.loadtxt(folder / name)[:, 1:] for name in ("sums.dat", "torque.dat"))
    return [*late_mean(0.5 * (sums[1:] + sums[:-1])), *late_mean(torque)]


def zones(frame):
    """What the paper measures: spheres of M1 and M2 in zone 1 (x, z > 0) and in zone 2 (x, z < 0), and their centres."""
    with h5py.File(frame) as file:
        time, points = file.attrs["time_s"], file["VTKHDF"]
        at, radius = points["Points"][:SPHERES].astype(float), points["PointData/radius"][:SPHERES]
    small = radius < 0.0015
    one, two = (at[:, 0] > 0) & (at[:, 2] > 0), (at[:, 0] < 0) & (at[:, 2] < 0)
    return time, [*(int((zone & kind).sum()) for zone in (one, two) for kind in (small, ~small)),
                  *(1e3 * at[kind, k].mean() for kind in (small, ~small) for k in (0, 2))]


def speed(program, case, folder, options):
    print("| seconds | demcal | LIGGGHTS | ratio |\n|---|---|---|---|")
    work = SPHERES * options.seconds / TIME_STEP / 1e6
    for _ in range(options.repeat):
        shutil.rmtree(folder / "demcal", ignore_errors=True)
        ours = work / demcal(program, case, folder, options.seconds)
        skin, mine = answer_of_demcal(folder)
        theirs = work / liggghts(case, folder, options.seconds, options.skin or skin)
        print(f"| {options.seconds:g} | {ours:.2f} | {theirs:.2f} | {ours / theirs:.2f} |", flush=True)
    print(f"\nthe 5 s of the paper, {SPHERES * 5 / TIME_STEP:.3g} particle-steps: {SPHERES * 5 / TIME_STEP / ours / 3.6e9:.1f} h of "
          f"one core with demcal, {SPHERES * 5 / TIME_STEP / theirs / 3.6e9:.1f} h with LIGGGHTS\n")
    print("| mean of the second half, SI | demcal | LIGGGHTS |\n|---|---|---|")
    for name, a, b in zip(NAMES, mine, answer_of_liggghts(folder)):
        print(f"| {name} | {a:.6g} | {b:.6g} |")


def reach(program, case, folder, options):
    seconds = demcal(program, case, folder, options.reach, "--frames", round(options.reach / options.step) + 1)
    print(f"{options.reach:g} s took {seconds:.0f} processor seconds\n")
    compare(folder / "demcal/frames")


def compare(frames):
    with open(here / "others.csv") as file:
        others = list(csv.reader(line for line in file if not line.startswith("#")))
    print(f"| time, s | code | {' | '.join(others[0][2:])} |\n|" + "---|" * len(others[0]))
    for frame in sorted(frames.glob("*.vtkhdf")):
        time, mine = zones(frame)
        line = lambda code, values: print(f"| {time:.2f} | {code} | {' | '.join(values)} |")
        line("demcal", [f"{value:.2f}" if isinstance(value, float) else str(value) for value in mine])
        for row in others[1:]:
            if abs(float(row[0]) - time) < 1e-3:
                line(row[1], row[2:])


parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
parser.add_argument("demcal", type=pathlib.Path, help="the program")
parser.add_argument("--seconds", type=float, default=0.05, help="simulated time of each run, 0.005 or more")
parser.add_argument("--repeat", type=int, default=1, help="repetitions of the pair of runs")
parser.add_argument("--skin", type=float, help="LIGGGHTS's skin in m, instead of demcal's")
parser.add_argument("--reach", type=float, help="seconds of demcal alone, beside the other codes' curves")
parser.add_argument("--step", type=float, default=0.1, help="time between the lines of --reach")
parser.add_argument("--compare", type=pathlib.Path, help="a folder of frames to compare, instead of a run")
parser.add_argument("--from", dest="downloaded", type=pathlib.Path, help="folder of PartCoordinates.txt and walls.txt")
parser.add_argument("--keep", type=pathlib.Path, help="folder for case and runs (default: a temporary one)")
options = parser.parse_args()
if options.compare:
    compare(options.compare)
    sys.exit()
processor = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")), "?")
print(f"{processor}, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}; million particle-steps a second\n", flush=True)
with tempfile.TemporaryDirectory() as temporary:
    folder = (options.keep or pathlib.Path(temporary)).resolve()
    case = folder / "case"
    more = ["--from", options.downloaded] if options.downloaded else []
    subprocess.run([sys.executable, here / "make.py", case, *more], check=True)
    (reach if options.reach else speed)(options.demcal.resolve(), case, folder, options)
