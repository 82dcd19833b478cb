#!/usr/bin/python3
"""Damage to what demcal reads back: flips.py DEMCAL DATA [--flips N] [--cuts N] [--seed S] [--kind NAME]

For each kind of file: a folder with results, one bit of the file flipped at random (or the file cut off at random), and a command that
reads it. Then either the result is that of the sound file, or the command names the file. Neither a signal nor a defect is an answer, and a
result that differs without a word is the fault that this looks for. No damage to a table may lose a row that its copy still has.
"""
import argparse
import collections
import pathlib
import random
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

import run


class Kind:
    """A file, the commands before it (the last one interrupted where `seconds` says when), what is taken away, and what reads it."""
    def __init__(self, file, before, reads, *, without=(), named=None, seconds=None, looks=None, change=None):
        self.file, self.before, self.reads, self.without, self.seconds = file, before, reads, without, seconds
        self.named = named or pathlib.Path(file).name
        self.looks = looks  # files that show the result; standard output, too
        self.change = change  # of the folder, before the file is damaged


def put(file, text):
    def change(folder):
        path = folder / file
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
    return change


def kinds(data):
    code, quick = str(data / "other-code"), str(data / "quick")

    def one(name, *words):
        return [name, code, "--out", "out", *words]

    def tiny(name, *words):
        return [name, quick, "--out", "out", *words, *run.TINY]
    train, calibrate = tiny("train", "--jobs", "1"), one("calibrate", "--no-scan")
    simulate = tiny("simulate", "--at", "rpm=200")
    longer = ["simulate", quick, "--out", "out", "--at", "rpm=200", *run.TINY, "--set", 'run.longest="1 s"', "--set", 'run.shortest="0.8 s"']
    collected = "# LIGGGHTS\n" + "".join(f"{i} 0 0 0 0 0 0\n" for i in range(10))
    study = """[study]
name = "own"
[parameters.friction]
low = 0.1
high = 0.8
[controls.rpm]
unit = "rpm"
low = 50
high = 300
[training]
table = "%s"
[outputs.torque]
unit = "mN m"
[[observe]]
name = "bench"
file = "%s"
[[calibrate]]
name = "powder"
observe = ["bench"]
free = ["friction"]
"""
    runs = "friction,rpm,torque,torque_se\n" + "".join(
        f"{0.1 + 0.7 * (i * 7 % 20) / 19:.4f},{50 + 250 * (i * 3 % 20) / 19:.2f},{4 + 3 * (i * 7 % 20) / 19 + (i * 3 % 20) / 50:.4f},0.05\n"
        for i in range(20))

    def of_observations(folder):
        put("study/study.toml", study % ("runs.csv", "../log-observed.csv"))(folder)
        put("study/runs.csv", runs)(folder)
    table = ["out/training.csv"]
    return {
        "training.h5": Kind("out/training.h5", [train], tiny("train", "--jobs", "1"), looks=table),
        "training.h5 alone": Kind("out/training.h5", [train], tiny("train", "--jobs", "1"), looks=table, without=["out/training.csv"]),
        "training.csv beside the table": Kind("out/training.csv", [train], tiny("train", "--jobs", "1"), looks=table),
        "training.csv alone": Kind("out/training.csv", [train], tiny("train", "--jobs", "1"), looks=table, without=["out/training.h5"]),
        "a run of a campaign": Kind("out/runs/*.h5", [train], tiny("train", "--jobs", "1"), looks=table,
                                    without=["out/training.h5", "out/training.csv"], named=r"\.h5"),
        "design.csv": Kind("out/design.csv", [tiny("design", "--runs", "3")], tiny("train", "--jobs", "1", "--runs", "3"), looks=table),
        "next-runs.csv": Kind("out/next-runs.csv", [train, tiny("design", "--runs", "3")],
                              tiny("train", "--jobs", "1", "--at-posterior", "1"), looks=table,
                              change=lambda folder: (folder / run.NEXT_RUNS[0]).rename(folder / run.NEXT_RUNS[1])),
        "surrogate.h5": Kind("out/surrogate.h5", [one("fit")], one("fit", "--json")),
        "run.h5": Kind("out/run.h5", [simulate], [*simulate, "--json"], looks=[]),
        "run.h5 interrupted": Kind("out/run.h5", [longer], [*longer, "--json"], looks=[], seconds=0.3),
        "report.json": Kind("out/report.json", [calibrate], one("report", "--json")),
        "report.json under a plan": Kind("out/report.json", [calibrate], one("plan", "--json")),
        "plan.json": Kind("out/plan.json", [calibrate, one("plan")], one("report", "--json")),
        "posterior.nc": Kind("out/posterior-powder.nc", [calibrate], one("report", "--json")),
        "a frame": Kind("out/frames/0001.vtkhdf", [tiny("simulate", "--frames", "2", "--at", "rpm=200")],
                        ["render", "out/frames/0001.vtkhdf", "--width", "100"], looks=["out/frames/0001.png"]),
        "observations": Kind("log-observed.csv", [["observe", "log.csv"]], ["check", "study"], change=of_observations),
        "an exported point": Kind("case/point.json", [["export", quick, "case", "--to", "liggghts", "--at", "hamaker=0", *run.TINY]],
                                  ["export", quick, "case", "--collect", "--out", "out", *run.TINY], change=put("case/torque.dat", collected)),
        "Slurm's record": Kind("out/slurm/campaign.json", [train], tiny("train", "--jobs", "1", "--runs", "1"), looks=table,
                               change=put("out/slurm/campaign.json", '{"format": 1, "prefix": "demcal-x", "next": 2, "jobs": {}, "runs": {}}')),
    }


def start(demcal, words, folder, seconds=None):
    process = subprocess.Popen([demcal, *words], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, errors="replace")
    if seconds:
        time.sleep(seconds)
        process.send_signal(signal.SIGINT)
    try:
        out, err = process.communicate(timeout=60)
    except subprocess.TimeoutExpired:
        process.kill()
        out, err = process.communicate()
        return 124, out, err
    return process.returncode, out, err


def result(folder, out, kind):
    """Standard output without what tells of time, and the files that show the result."""
    text = re.sub(r'"(cpu_seconds|seconds|origin|written|steps_per_second|started)[^"]*": ?[^,}\]]*', "", out).replace(str(folder), "")
    text = re.sub(r'"provenance":\{[^}]*\}', "", text)
    return text, tuple(run.content(folder / file) if (folder / file).exists() else "gone" for file in kind.looks or ())


def damaged(content, cut, chance):
    if cut:
        at = chance.randrange(len(content))
        return content[:at], f"cut at {at} of {len(content)}"
    at, bit = chance.randrange(len(content)), chance.randrange(8)
    return content[:at] + bytes([content[at] ^ (1 << bit)]) + content[at + 1:], f"bit {bit} of byte {at} of {len(content)}"


def template_of(demcal, kind, folder):
    (folder / "log.csv").write_text(run.LOG)
    for number, words in enumerate(kind.before):
        last = number + 1 == len(kind.before)
        status, _, err = start(demcal, words, folder, kind.seconds if last else None)
        assert status in (0, 2, 75), f"{' '.join(words)}: {status} {err}"
    if kind.change:
        kind.change(folder)
    for file in kind.without:
        (folder / file).unlink()
    return sorted(folder.glob(kind.file))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("demcal")
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--flips", type=int, default=90, help="over all kinds")
    parser.add_argument("--cuts", type=int, default=36)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--kind", action="append")
    options = parser.parse_args()
    demcal = str(pathlib.Path(options.demcal).resolve())
    chosen = {name: kind for name, kind in kinds(options.data.resolve()).items() if not options.kind or name in options.kind}
    failures, counts = [], collections.Counter()
    for order, (name, kind) in enumerate(chosen.items()):
        chance = random.Random(f"{options.seed} {name}")
        base = pathlib.Path(tempfile.mkdtemp())
        template = base / "template"
        template.mkdir()
        files = template_of(demcal, kind, template)
        assert files, f"{name}: there is no {kind.file}"

        def look(number, content, file):
            folder = base / "here"
            shutil.copytree(template, folder)
            if content is not None:
                (folder / file.relative_to(template)).write_bytes(content)
            status, out, err = start(demcal, kind.reads, folder)
            found = result(folder, out, kind)
            shutil.rmtree(folder)
            return status, found, err

        sound, wanted, said = look(0, None, None)
        here = collections.Counter()
        share = [n // len(chosen) + (order < n % len(chosen)) for n in (options.flips, options.cuts)]
        for number in range(sum(share)):
            file = chance.choice(files)
            content, what = damaged(file.read_bytes(), number >= share[0], chance)
            status, found, err = look(number, content, file)
            named = re.search(kind.named, err) and err != said
            if status < 0 or status in (70, 124, 134, 139):
                failures.append(f"{name}: {what}: status {status} {err[-300:]}")
                here["wrong"] += 1
            elif (status, found) == (sound, wanted):
                here["equal, and said" if named else "equal"] += 1
            elif named:
                here["refused or said"] += 1
            else:
                failures.append(f"{name}: {what}: status {status} instead of {sound}, another result, and no word of {kind.named}: {err[-300:]}")
                here["wrong"] += 1
        print(f"{name} (status {sound}): " + ", ".join(f"{count} {word}" for word, count in sorted(here.items())), flush=True)
        counts += here
        shutil.rmtree(base)
    for line in failures:
        print("  " + line)
    print(f"{sum(counts.values())} damaged files: " + ", ".join(f"{count} {word}" for word, count in sorted(counts.items())))
    sys.exit(bool(failures))


if __name__ == "__main__":
    main()
