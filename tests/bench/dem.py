#!/usr/bin/env python3
"""Speed and agreement of the DEM core beside other codes: dem.py DEMCAL [options], started by dem.sh.

Each repetition runs the codes one after the other on the same case, from the same packing, for the same steps, and
sampling alike; what other programs do to the machine meanwhile hits both. One core: processor time of the whole
program; several: wall time. The ratio is that of each repetition, so that slow drifts of the machine leave it."""
import argparse, json, math, os, pathlib, shutil, statistics, subprocess, sys, tempfile, time

here = pathlib.Path(__file__).resolve().parent


def run(command, folder, cores):
    """Seconds that the command takes."""
    log = folder / "log"
    before = time.monotonic()
    with open(log, "w") as out:
        child = subprocess.Popen([str(word) for word in command], cwd=folder, stdout=out, stderr=subprocess.STDOUT)
        _, status, used = os.wait4(child.pid, 0)
    code = os.waitstatus_to_exitcode(status)
    if code not in (0, 2):  # 2: demcal's "done, with a warning"
        sys.exit(f"{' '.join(map(str, command))} ended with {code}:\n{log.read_text()[-2000:]}")
    return used.ru_utime + used.ru_stime if cores == 1 else time.monotonic() - before


def demcal(program, case, folder, seconds, cores, *more):
    """One run of `seconds` of simulated time, start-up included."""
    out = folder / "demcal"
    shutil.rmtree(out, ignore_errors=True)
    command = [program, "simulate", case, "--out", out, "--quiet", "--json", "--threads", cores, *more]
    for key, value in {"start_up": 0.25 * seconds, "shortest": seconds, "longest": seconds, "window": 0.05 * seconds}.items():
        command += ["--set", f"run.{key}={value:.9g} s"]
    return run(command, folder, cores)


def ranks(cores):
    return [] if cores == 1 else ["mpirun", "--allow-run-as-root", "--oversubscribe", "-np", cores]


def liggghts(case, folder, steps, cores):
    return run([*ranks(cores), "liggghts", "-in", here / "slice/in.slice", "-var", "dir", case, "-var", "nset", 0, "-var",
                "nrun", steps, "-var", "tag", "t", "-var", "px", cores, "-log", "none"], folder, cores)


def lammps(case, folder, steps, cores, *more):
    return run([*ranks(cores), "lmp", "-in", here / "chute/in.chute", "-var", "dir", case, "-var", "nrun", steps, *more,
                "-log", "none"], folder, cores)


def make(script, *words):
    subprocess.run([sys.executable, here / script, *map(str, words)], check=True, stdout=subprocess.DEVNULL)


def make_slice(pitches, folder):
    case = folder / f"slice-{pitches}"
    make("slice/make.py", pitches, case)
    return case


def make_chute(x, y, folder):
    """The flow is made once and kept: settled in 60,000 steps, tilted for 60,000 (minutes)."""
    start = folder / "start.dump"
    if not start.exists():
        make("chute/make.py", "lattice", folder)
        lammps(folder, folder, 0, 1, "-var", "nset", 60000, "-var", "ntilt", 60000, "-var", "keep", 1)
    case = folder / f"chute-{x}x{y}"
    make("chute/make.py", "study", case, start, x, y)
    return case


def spread(values):
    return (max(values) - min(values)) / 2 if len(values) > 1 else math.nan


def speed(program, options, folder):
    print("| case | steps | cores | demcal | peer | ratio | spread of the ratio |\n|---|---|---|---|---|---|---|")
    cases = [(f"slice {5000 * n}, LIGGGHTS", 5000 * n, 1e-5, liggghts, lambda n=n: make_slice(n, folder))
             for n in options.pitches]
    cases += [(f"chute {32000 * x * y}, LAMMPS", 32000 * x * y, 1e-4, lammps, lambda x=x, y=y: make_chute(x, y, folder))
              for x, y in (map(int, size.split("x")) for size in options.chute)]
    for name, spheres, time_step, peer, prepare in cases:
        case, steps = prepare(), max(500, options.work * 1000000 // spheres)
        for cores in options.cores:
            ours, theirs = [], []
            for _ in range(options.repeat):
                ours.append(spheres * steps / demcal(program, case, folder, steps * time_step, cores) / 1e6)
                theirs.append(spheres * steps / peer(case, folder, steps, cores) / 1e6)
            ratios = [a / b for a, b in zip(ours, theirs)]
            print(f"| {name} | {steps} | {cores} | {statistics.mean(ours):.2f} | {statistics.mean(theirs):.2f} | "
                  f"{statistics.mean(ratios):.2f} | {spread(ratios):.2f} |", flush=True)


def key_value(text):
    """The number in the first line of h5dump's answer that holds one."""
    return float(next(line.split("):")[1] for line in text.splitlines() if "(0):" in line))


def read_attribute(file, path):
    return key_value(subprocess.run(["h5dump", "-a", path, str(file)], check=True, capture_output=True, text=True).stdout)


def set_keys(keys):
    return [word for key, value in keys.items() for word in ("--set", f"{key}={value}")]


HERTZ = {"contact.normal": "hertz", "contact.young_modulus": "8 MPa"}
ROLLING = {"contact.rolling_friction": 0.1, "contact.twisting_friction": 0.1}
LAWS = {
    "linear (the default)": {},
    "linear, constant rolling resistance": {"contact.resistance": "constant", **ROLLING},
    "linear, spring rolling resistance": {"contact.resistance": "spring", **ROLLING},
    "linear, van der Waals": {"contact.hamaker": "2e-18 J", "contact.minimum_separation": "1.5 nm"},
    "linear, DMT": {"contact.cohesion": "dmt", "contact.work_of_adhesion": "20 mJ/m2"},
    "linear, spring rolling resistance, van der Waals": {"contact.resistance": "spring", **ROLLING, "contact.hamaker": "2e-18 J",
                                                         "contact.minimum_separation": "1.5 nm"},
    "Hertz, Mindlin": {**HERTZ, "contact.tangential": "mindlin"},
    "Hertz, linear tangential": {**HERTZ, "contact.tangential": "linear"},
    "Hertz, Mindlin, spring rolling resistance": {**HERTZ, "contact.tangential": "mindlin", "contact.resistance": "spring", **ROLLING},
    "JKR": {**HERTZ, "contact.normal": "jkr", "contact.work_of_adhesion": "20 mJ/m2"},
}


def laws(program, options, folder):
    """Processor time of a step of each law on the slice of one pitch, from the same packing with the same time step."""
    case, time_step, steps = make_slice(1, folder), 1e-5, 100 * options.work
    hertzian = folder / "slice-1-hertz"  # a key that no law reads is an error
    shutil.copytree(case, hertzian, dirs_exist_ok=True)
    study = (case / "study.toml").read_text()
    (hertzian / "study.toml").write_text("".join(line + "\n" for line in study.split("\n") if not line.startswith("stiffness")))
    print("| law | M particle-steps a second | time of a step, of the default law's | coordination number |\n|---|---|---|---|")
    seconds = {name: [] for name in LAWS}
    for _ in range(options.repeat):
        for name, keys in LAWS.items():
            extra = set_keys({**keys, "run.time_step": f"{time_step} s"})
            with_stiffness = keys.get("contact.normal") is None or keys.get("contact.tangential") == "linear"
            seconds[name].append(demcal(program, case if with_stiffness else hertzian, folder, steps * time_step, 1, *extra) / (5000 * steps))
            shutil.copy(folder / "demcal/run.h5", folder / f"law-{list(LAWS).index(name)}.h5")
    default = seconds[next(iter(LAWS))]
    for k, (name, each) in enumerate(seconds.items()):
        coordination = subprocess.run(["h5dump", "-y", "-d", "/summary/mean", str(folder / f"law-{k}.h5")], check=True,
                                      capture_output=True, text=True).stdout.split("DATA {")[1].split("}")[0].split(",")[3]
        ratio = statistics.mean(a / b for a, b in zip(each, default))
        print(f"| {name} | {1e-6 / statistics.mean(each):.2f} | {ratio:.2f} | {float(coordination):.2f} |", flush=True)


def answer(program, options, folder):
    """Processor time of a mean torque to 2 % on one pitch: demcal stops when it has it; LIGGGHTS is given as much simulated
    time, with the time step that its users take, a fiftieth of the contact's duration."""
    case = make_slice(1, folder)
    ours = run([program, "simulate", case, "--out", folder / "demcal", "--quiet", "--json", "--set", "training.standard_error=0.02",
                "--set", "run.longest=8 s"], folder, 1)
    result = json.loads((folder / "log").read_text())
    found, duration = result["outputs"]["torque"], min(pair["duration_s"] for pair in result["contacts"])
    simulated = read_attribute(folder / "demcal/run.h5", "/diagnostics/simulated_s")
    time_step, start_up = duration / 50, 0.2
    theirs = run(["liggghts", "-in", here / "slice/in.slice", "-var", "dir", case, "-var", "nset", round(start_up / time_step), "-var", "nrun",
                  round((simulated - start_up) / time_step), "-var", "dt", time_step, "-var", "tag", "t", "-log", "none"], folder, 1)
    rows = [float(line.split()[1]) for line in (folder / "torque_t.dat").read_text().splitlines() if not line.startswith("#")]
    print(f"mean torque of one pitch to 2 %: {simulated:.2f} s simulated\n"
          f"demcal, {ours:.0f} CPU seconds: {found['mean']:.1f} +- {found['standard_error']:.1f} uN m\n"
          f"LIGGGHTS, {theirs:.0f} CPU seconds: {-1e6 * statistics.mean(rows):.1f} +- {1e6 * block_error(rows):.1f} uN m\n"
          f"ratio {theirs / ours:.1f}")


def block_error(values, blocks=10):
    size = len(values) // blocks
    means = [statistics.mean(values[k * size:(k + 1) * size]) for k in range(blocks)]
    return statistics.stdev(means) / math.sqrt(blocks)


def torque(program, folder):
    """Mean torque on the auger of one pitch from 0.5 s to 1.5 s, in both codes."""
    case, steps = make_slice(1, folder), 150000
    run([program, "simulate", case, "--out", folder / "demcal", "--quiet", "--json"], folder, 1)
    ours = json.loads((folder / "log").read_text())["outputs"]["torque"]
    liggghts(case, folder, steps, 1)
    rows = [line.split() for line in (folder / "torque_t.dat").read_text().splitlines() if not line.startswith("#")]
    sums = [line.split() for line in (folder / "sums_t.dat").read_text().splitlines() if not line.startswith("#")]
    late = [row for row in rows if int(row[0]) > 50000]
    auger, tube = ([1e6 * float(row[k]) for row in late] for k in (1, 2))
    weight = 5000 * 6090 * math.pi / 6 * 0.8e-3**3 * 9.81
    moment = [1e6 * weight * float(row[3]) for row in sums if int(row[0]) > 50000]
    print(f"torque, uN m: demcal {ours['mean']:.1f} +- {ours['standard_error']:.1f}, "
          f"LIGGGHTS {-statistics.mean(auger):.1f} +- {block_error(auger):.1f}\n"
          f"LIGGGHTS's column balance, auger + tube + weight: {statistics.mean(auger):.1f} + {statistics.mean(tube):.1f} "
          f"+ {statistics.mean(moment):.1f} = "
          f"{statistics.mean(auger) + statistics.mean(tube) + statistics.mean(moment):.2f} uN m")


parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
parser.add_argument("demcal", type=pathlib.Path, help="the program")
parser.add_argument("--repeat", type=int, default=3, help="repetitions of each pair of runs")
parser.add_argument("--pitches", type=int, nargs="*", default=[2, 8], help="pitches of the slice, 5,000 spheres each")
parser.add_argument("--chute", nargs="*", default=["1x1"], help="repeats of the chute, 32,000 spheres each: 1x1 3x2 6x6")
parser.add_argument("--cores", type=int, nargs="+", default=[1, 2], help="threads and ranks")
parser.add_argument("--work", type=int, default=200, help="million particle-steps of each run")
parser.add_argument("--torque", action="store_true", help="compare the mean torque of one pitch instead (minutes)")
parser.add_argument("--laws", action="store_true", help="compare the contact laws with each other instead (minutes)")
parser.add_argument("--answer", action="store_true", help="compare the time to a mean torque to 2 %% instead (minutes)")
parser.add_argument("--keep", type=pathlib.Path, help="folder for cases and logs (default: a temporary one)")
options = parser.parse_args()
program = options.demcal.resolve()
processor = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")), "?")
print(f"{processor}, {os.cpu_count()} cores, load {os.getloadavg()[0]:.1f}; million particle-steps a second\n", flush=True)
with tempfile.TemporaryDirectory() as temporary:
    folder = (options.keep or pathlib.Path(temporary)).resolve()
    folder.mkdir(parents=True, exist_ok=True)
    if options.torque:
        torque(program, folder)
    elif options.laws:
        laws(program, options, folder)
    elif options.answer:
        answer(program, options, folder)
    else:
        speed(program, options, folder)
