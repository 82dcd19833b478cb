#!/usr/bin/python3
"""Faults of the system, injected at every call: run.py DEMCAL INJECT DATA [--every K] [--command NAME]

Each command is run once to count its calls of write, fsync, rename, close and open; then once for each call (or each K-th),
with that call failing as on a full disk, and staying so. Whatever fails:
  - no signal ends the program, and its status is one of its own;
  - where it says that all is done, the results are those of a run without a fault;
  - else it says why, naming a path or the stream;
  - no part of a file stands there: a text that is there is the one of a run without a fault (a run table may have fewer rows);
  - the same command without a fault then gives what it gives in a new folder.
"""
import argparse
import errno
import hashlib
import os
import pathlib
import shutil
import subprocess
import sys
import tempfile

STATUSES = {0, 2, 64, 65, 66, 69, 70, 73, 75, 78}
CALLS = ("open", "write", "fsync", "close", "rename")


def commands(data):
    log = "\n".join(["time [s],torque [mN m],rpm [rpm]"] + [f"{0.1 * i:.1f},{5 + (i * 7919 % 13) / 100:.3f},{100 if i < 200 else 200}" for i in range(400)])
    study = str(data / "other-code")
    return {
        "fit": ["fit", study, "--out", "out"],
        "sample": ["sample", study, "--out", "out", "--csv"],
        "calibrate": ["calibrate", study, "--out", "out", "--no-scan"],
        "design": ["design", str(data / "quick"), "--out", "out", "--runs", "5"],
        "train": ["train", str(data / "quick"), "--out", "out", "--set", "training.runs=2", "--jobs", "1", "--set", "rig.fill=200", "--set",
                  'run.longest="0.4 s"', "--set", "run.start_up_turns=0.25", "--set", 'training.unsteady="use"'],
        "new": ["new", "mixer"],
        "observe": (["observe", "log.csv"], log),
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


def digest(folder):
    """Contents of a folder but for what tells of time."""
    found = {}
    for path in sorted(folder.rglob("*")):
        if path.is_file() and path.suffix not in {".h5", ".nc", ".html", ".json", ".svg"}:
            found[str(path.relative_to(folder))] = hashlib.sha256(timeless(path)).hexdigest()
        elif path.is_file():
            found[str(path.relative_to(folder))] = "there"
    return found


def start(program, words, folder, library=None, **fault):
    environment = dict(os.environ)
    if library:
        environment["LD_PRELOAD"] = str(library)
        environment |= {f"FAULT_{name.upper()}": str(value) for name, value in fault.items()}
    return subprocess.run([program, *words], cwd=folder, env=environment, capture_output=True, text=True, timeout=300)


def one_command(program, library, name, words, options):
    words, log = words if isinstance(words, tuple) else (words, None)
    failures, runs = [], 0

    def fresh():
        folder = pathlib.Path(tempfile.mkdtemp())
        if log:
            (folder / "log.csv").write_text(log)
        return folder

    whole = fresh()
    good = start(program, words, whole)
    if good.returncode not in (0, 2):
        return [f"{name}: without a fault: {good.returncode} {good.stderr[-300:]}"], 0
    wanted = digest(whole)
    for call in CALLS:
        folder = fresh()
        count = folder / ".count"
        start(program, words, folder, library, call=call, count=count)
        calls = int(count.read_text()) if count.exists() else 0
        shutil.rmtree(folder)
        for at in range(1, calls + 1, options.every):
            folder = fresh()
            runs += 1
            done = start(program, words, folder, library, call=call, at=at, errno=errno.ENOSPC, stays=1)
            what = f"{name}: {call} {at} of {calls}"
            if done.returncode not in STATUSES:
                failures.append(f"{what}: status {done.returncode}: {done.stderr[-200:]}")
            elif done.returncode in (0, 2) and digest(folder) != wanted:
                failures.append(f"{what}: status {done.returncode}, but files differ or lack: "
                                f"{sorted(set(wanted.items()) ^ set(digest(folder).items()))[:3]}")
            elif done.returncode == 70:
                failures.append(f"{what}: called a defect of the program: {done.stderr[-200:]}")
            elif done.returncode not in (0, 2) and not done.stderr.strip():
                failures.append(f"{what}: status {done.returncode} without a word")
            partial = [file for file, text in digest(folder).items()
                       if wanted.get(file, text) != text and not file.endswith("training.csv")]
            if partial:
                failures.append(f"{what}: status {done.returncode}, and parts of files stand there: {partial[:3]}")
            again = start(program, words if name != "new" else ["new", "mixer2"], folder)
            if again.returncode not in (0, 2):
                failures.append(f"{what}: started again: {again.returncode} {again.stderr[-300:]}")
            elif name != "new":
                after = digest(folder)
                lacking = [file for file in wanted if wanted[file] != after.get(file)]
                if lacking:
                    failures.append(f"{what}: started again, it differs: {lacking[:3]}")
            shutil.rmtree(folder)
    shutil.rmtree(whole)
    return failures, runs


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("demcal")
    parser.add_argument("inject")
    parser.add_argument("data", type=pathlib.Path)
    parser.add_argument("--every", type=int, default=1)
    parser.add_argument("--command", action="append")
    options = parser.parse_args()
    options.demcal = str(pathlib.Path(options.demcal).resolve())
    failures, runs = [], 0
    for name, words in commands(options.data.resolve()).items():
        if options.command and name not in options.command:
            continue
        found, made = one_command(options.demcal, pathlib.Path(options.inject).resolve(), name, words, options)
        print(f"{name}: {made} faults, {len(found)} not answered as they should be", flush=True)
        failures += found
        runs += made
    for line in failures:
        print("  " + line)
    print(f"{runs} faults")
    sys.exit(bool(failures))


if __name__ == "__main__":
    main()
