#!/usr/bin/python3
"""Faults of the system, injected at every call: run.py DEMCAL INJECT DATA [--most N] [--seed S] [--command NAME] [--say FILE]

Each command is run once to count its calls of each kind; then once for each call (or N of them, spread evenly), with that call
failing, and for what a full disk does, staying so. A command that others come before finds their results in its folder.
Whatever fails:
  - no signal ends the program, and its status is one of its own, and not that of a defect;
  - where it says that all is done, the results are those of a run without a fault;
  - else it says why, naming a path, the stream or the memory;
  - no part of a file stands there: one that is there is the earlier one or that of a run without a fault (a run table may have
    fewer rows than in the end, but not fewer than before), and no earlier one is gone;
  - the same command without a fault then gives what it gives without one before, and finds nothing damaged.
"""
import argparse
import errno
import hashlib
import json
import os
import pathlib
import random
import re
import shutil
import subprocess
import sys
import tempfile

import h5py
import numpy

STATUSES = {0, 2, 64, 65, 66, 69, 70, 73, 75, 78}
# kind of call: errno, and whether all after it fail, too
CALLS = {"open": (errno.ENOSPC, True), "write": (errno.ENOSPC, True), "fsync": (errno.EIO, True), "close": (errno.ENOSPC, True),
         "rename": (errno.EACCES, True), "mkdir": (errno.ENOSPC, True), "lock": (errno.ENOLCK, False), "read": (errno.EIO, False),
         "mmap": (errno.ENOMEM, False), "thread": (errno.EAGAIN, False), "spawn": (errno.EAGAIN, False),
         "malloc": (errno.ENOMEM, False), "large malloc": (errno.ENOMEM, True)}
LARGE = 1 << 16  # bytes, of a large malloc
ASKED_FOR = {"library": (errno.ENOMEM, False)}  # small allocations of C libraries: some crash (README.md)

# Runs of 0.05 s of 300 spheres: a thirtieth of a second each.
TINY = [word for key in ("rig.fill=300", 'run.settle="0.01 s"', 'run.start_up="0.01 s"', 'run.shortest="0.02 s"',
                         'run.longest="0.05 s"', 'run.window="2 ms"', 'run.sample_interval="0.5 ms"', "run.shortest_turns=0",
                         "run.start_up_turns=0", 'training.unsteady="use"', "training.runs=6") for word in ("--set", key)]
LOG = "\n".join(["time [s],torque [mN m],rpm [rpm]"]
                + [f"{0.1 * i:.1f},{5 + (i * 7919 % 13) / 100:.3f},{100 if i < 200 else 200}" for i in range(400)])


class Command:
    """Words of a call, and of those before it whose results lie in the folder."""
    def __init__(self, *words, before=(), again=None, moved=None):
        self.words, self.before, self.again = list(words), [list(b) for b in before], again or list(words)
        self.moved = moved  # a file, and its name afterwards

    def prepare(self, program, folder):
        (folder / "log.csv").write_text(LOG)
        for words in self.before:
            done = start(program, words, folder)
            assert done.returncode in (0, 2), f"{' '.join(words)}: {done.returncode} {done.stderr[-300:]}"
        if self.moved:
            (folder / self.moved[0]).rename(folder / self.moved[1])


NEXT_RUNS = ("out/design.csv", "out/next-runs.csv")  # lists of points are of one form


def commands(data):
    code, quick = str(data / "other-code"), str(data / "quick")

    def one(name, *words, study=code):
        return [name, study, "--out", "out", *words, *(TINY if study == quick else [])]

    def tiny(name, *words):
        return one(name, *words, study=quick)
    train, calibrate = tiny("train", "--jobs", "1"), one("calibrate", "--no-scan")
    simulate = tiny("simulate", "--frames", "2", "--stl", "--threads", "3", "--at", "rpm=200")
    export = ["export", quick, "case", "--to", "liggghts", "--at", "hamaker=0", *TINY]
    return {
        "help": Command("help", "training.runs"),
        "check": Command(*one("check")),
        "check of a rig": Command(*tiny("check")),
        "new": Command("new", "mixer", again=["new", "mixer2"]),
        "observe": Command("observe", "log.csv"),
        "observe again": Command("observe", "log.csv", "--dead-time", "1", before=[["observe", "log.csv"]]),
        "design": Command(*tiny("design", "--runs", "5")),
        "train": Command(*train),
        "train on": Command(*tiny("train", "--jobs", "3", "--runs", "3"), before=[train],
                            again=tiny("train", "--jobs", "1")),
        "train at the posterior": Command(*tiny("train", "--jobs", "1", "--at-posterior", "2"),
                                          before=[train, tiny("design", "--runs", "3")], moved=NEXT_RUNS, again=tiny("check")),
        "simulate": Command(*simulate),
        "simulate another": Command(*tiny("simulate", "--at", "rpm=250"), before=[simulate]),
        "fit": Command(*one("fit")),
        "sample": Command(*one("sample", "--csv")),
        "sample --sbc": Command(*one("sample", "--sbc", "20")),
        "calibrate": Command(*calibrate),
        "calibrate again": Command(*calibrate, "--seed", "8", before=[calibrate]),
        "plan": Command(*one("plan"), before=[calibrate]),
        "report": Command(*one("report"), before=[calibrate]),
        "export": Command(*export),
        "export again": Command(*export, "--seed", "8", before=[export]),
        "render": Command("render", "out/frames/0001.vtkhdf", "--width", "100", before=[simulate]),
    }


def timeless(path):
    """A file's text without what tells of time: lines of origin, and the run table's column cpu_seconds."""
    lines = [line for line in path.read_bytes().split(b"\n")
             if not any(word in line for word in (b"origin:", b"written", b"digest"))]
    head = next((line for line in lines if not line.startswith(b"#")), b"").split(b",")
    if b"cpu_seconds" not in head:
        return b"\n".join(lines)
    column = head.index(b"cpu_seconds")
    return b"\n".join(b",".join(cell for i, cell in enumerate(line.split(b",")) if i != column) for line in lines)


def of_hdf5(path):
    """All names and values of an HDF5 or netCDF file but what tells of time and of the machine."""
    found = hashlib.sha256()

    def add(name, value):
        for field in value.dtype.names or ():
            add(f"{name}.{field}", value[field])
        if value.dtype.names is None and not re.search("cpu|per_second|under_way|written|created|command|origin", name):
            found.update(name.encode() + b"=" + (value.tobytes() if value.dtype.kind != "O" else repr(value.tolist()).encode()))

    def visit(name, node):
        for key in sorted(node.attrs):
            if key not in ("REFERENCE_LIST", "DIMENSION_LIST", "_Netcdf4Coordinates"):
                add(f"{name}@{key}", numpy.asarray(node.attrs[key]))
        if isinstance(node, h5py.Dataset):
            add(name, numpy.asarray(node[()]))

    with h5py.File(path) as file:
        visit("/", file)
        file.visititems(visit)
    return found.hexdigest()


def of_json(path):
    read = json.loads(path.read_text())
    for key in ("origin", "provenance"):
        read.pop(key, None)
    return hashlib.sha256(json.dumps(read, sort_keys=True).encode()).hexdigest()


def content(path):
    """A file's content but for what tells of time; those of pages and pictures are theirs who draw them."""
    try:
        if path.suffix in {".h5", ".nc", ".vtkhdf"}:
            return of_hdf5(path)
        if path.suffix == ".json":
            return of_json(path)
        if path.suffix in {".html", ".svg", ".png"}:
            return "there"
        return hashlib.sha256(timeless(path)).hexdigest()
    except (OSError, ValueError, RuntimeError, KeyError) as error:
        return f"cannot be read: {error}"


def digest(folder):
    """The contents of a folder."""
    return {str(path.relative_to(folder)): content(path) for path in sorted(folder.rglob("*"))
            if path.is_file() and not path.name.startswith(".") and path.suffix != ".lock"}


def start(program, words, folder, library=None, **fault):
    environment = dict(os.environ)
    if library:
        environment["LD_PRELOAD"] = str(library)
        environment |= {f"FAULT_{name.upper()}": str(value) for name, value in fault.items()}
    return subprocess.run([program, *words], cwd=folder, env=environment, capture_output=True, text=True, errors="replace", timeout=100)


def spread(calls, most, chance):
    """Numbers of calls: all, or so many of them, the first and the last among them."""
    if calls <= most:
        return list(range(1, calls + 1))
    return sorted({1, calls, *(chance.randint(1 + (calls - 1) * i // most, (calls - 1) * (i + 1) // most) for i in range(most))})


def rows(path):
    return {line for line in timeless(path).split(b"\n") if not line.startswith(b"#")}


def more_of_a_table(found, before, wanted, folder, whole):
    """Whether a campaign's table alone differs, and holds all rows of before."""
    table = "out/training.csv"
    differing = {file for file in set(found) | set(wanted) if found.get(file) != wanted.get(file)}
    return (table in before and table in found and rows(whole / ".before" / table) <= rows(folder / table)
            and all(file.startswith(("out/runs/", "out/training.")) for file in differing))


def looked_at(done, before, wanted, folder, whole):
    """What is wrong with a command that met a fault, in words."""
    said = done.stderr.strip()
    if done.returncode not in STATUSES:
        yield f"status {done.returncode}: {said[-300:]}"
    elif done.returncode == 70:
        yield f"called a defect of the program: {said[-300:]}"
    found = digest(folder)
    if done.returncode in (0, 2) and more_of_a_table(found, before, wanted, folder, whole):
        return  # a run whose file could not be read was made again, and one further run less
    lacking = set(re.findall(r"a frame is lacking: \S*/(out/frames/\S+?):", said))
    if done.returncode == 2 and lacking and {file: wanted[file] for file in wanted if file not in lacking} == found:
        return  # the run is more than its frames
    if done.returncode in (0, 2) and found != wanted:
        yield f"status {done.returncode}, but files differ or lack: {sorted(set(wanted.items()) ^ set(found.items()))[:3]} {said[-200:]}"
    elif done.returncode not in (0, 2) and not re.search(r"/|\.\w+:|memory|the system|standard output|case\b", said):
        yield f"status {done.returncode} without a place: {said[-300:]}"
    for file, text in found.items():
        if file.endswith("training.csv") and text != wanted.get(file):
            if file in before and not rows(whole / ".before" / file) <= rows(folder / file):
                yield f"status {done.returncode}, and rows of {file} are gone"
            continue
        if file.endswith(".tmp"):
            if done.returncode == 65:
                continue  # out of memory ends at once; the next process removes it
            yield f"status {done.returncode}, and {file} was left"
        elif "cannot be read" in text:
            yield f"status {done.returncode}, and a part of {file} stands there: {text}"
        elif file.endswith(("training.h5", "design.csv")):
            continue  # as its CSV; what is left to do
        elif file in wanted and text not in (wanted[file], before.get(file)):
            yield f"status {done.returncode}, and {file} is neither the one before nor the one wanted"
    for file in before:
        if file not in found and file in wanted:
            yield f"status {done.returncode}, and {file} is gone"


def one_command(program, library, name, command, options, chance):
    failures, runs, said = [], 0, {}
    whole = pathlib.Path(tempfile.mkdtemp())
    command.prepare(program, whole)
    before = digest(whole)
    template = pathlib.Path(tempfile.mkdtemp()) / "t"
    shutil.copytree(whole, template)

    def fresh():
        folder = pathlib.Path(tempfile.mkdtemp())
        shutil.copytree(template, folder, dirs_exist_ok=True)
        return folder

    good = start(program, command.words, whole)
    wanted = digest(whole)
    shutil.copytree(template, whole / ".before")
    if good.returncode not in (0, 2):
        return [f"{name}: without a fault: {good.returncode} {good.stderr[-300:]}"], 0, said
    for call, (error, stays) in (CALLS | ASKED_FOR).items():
        if call not in (options.call or CALLS):
            continue
        fault = {"call": call.split()[-1], "errno": error, "least": LARGE if call.startswith("large") else 0}
        if stays:
            fault["stays"] = 1
        folder = fresh()
        count = folder / ".count"
        start(program, command.words, folder, library, **(fault | {"count": count}))
        calls = int(count.read_text()) if count.exists() else 0
        shutil.rmtree(folder)
        for at in spread(calls, options.most, chance):
            folder = fresh()
            runs += 1
            what = f"{name}: {call} {at} of {calls}"
            try:
                done = start(program, command.words, folder, library, **(fault | {"at": at}))
                failures += [f"{what}: {wrong}" for wrong in looked_at(done, before, wanted, folder, whole)]
                if done.returncode not in (0, 2):
                    text = re.sub(r"[\d.]+", "N", done.stderr.strip().split("\n")[-1].replace(str(folder), ""))
                    said.setdefault((done.returncode, text), what)
                again = start(program, command.again, folder)
                if again.returncode not in (0, 2) or "damaged" in again.stderr:
                    failures.append(f"{what}: ({done.returncode}) started again: {again.returncode} {again.stderr[-300:]}")
                elif command.again == command.words:
                    after = digest(folder)
                    if left := [file for file in after if file.endswith(".tmp")]:
                        failures.append(f"{what}: ({done.returncode}) started again, {left[0]} is still there")
                    if lacking := [file for file in wanted if wanted[file] != after.get(file)]:
                        failures.append(f"{what}: ({done.returncode}) started again, it differs: {lacking[:3]}")
            except subprocess.TimeoutExpired:
                failures.append(f"{what}: ran on")
            shutil.rmtree(folder, ignore_errors=True)
    shutil.rmtree(whole)
    shutil.rmtree(template)
    return failures, runs, said


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("demcal")
    parser.add_argument("inject")
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--most", type=int, default=10, help="faults of a kind in a command")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--command", action="append")
    parser.add_argument("--call", action="append")
    parser.add_argument("--say", type=pathlib.Path, help="a file for all that was answered")
    options = parser.parse_args()
    options.demcal = str(pathlib.Path(options.demcal).resolve())
    failures, runs, answers = [], 0, []
    for name, command in commands(options.data.resolve()).items():
        if options.command and name not in options.command:
            continue
        chance = random.Random(f"{options.seed} {name}")
        found, made, said = one_command(options.demcal, pathlib.Path(options.inject).resolve(), name, command, options, chance)
        print(f"{name}: {made} faults, {len(found)} not answered as they should be", flush=True)
        for line in found:
            print("  " + line, flush=True)
        failures += found
        runs += made
        answers += [f"{what}\t{status}\t{text}" for (status, text), what in said.items()]
    if options.say:
        options.say.write_text("\n".join(answers) + "\n")
    print(f"{runs} faults, {len(failures)} not answered as they should be")
    sys.exit(bool(failures))


if __name__ == "__main__":
    main()
