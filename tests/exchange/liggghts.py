#!/usr/bin/python3
"""A point's case in LIGGGHTS on two ranks, and its torque back in a table: liggghts.py DEMCAL STUDY FOLDER

The torque must be that of `demcal simulate` at the same point, within the errors that the two state. Exit status 77, and a
line that says so, where there is no LIGGGHTS to try it on."""
import csv
import json
import math
import pathlib
import shutil
import subprocess
import sys

program, study, folder = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3]).resolve()
missing = [name for name in ("liggghts", "mpirun") if not shutil.which(name)]
if missing:
    print(f"SKIPPED, nothing was tested: no {', '.join(missing)} here (apt-get install --no-install-recommends liggghts openmpi-bin)")
    sys.exit(77)

shutil.rmtree(folder, ignore_errors=True)
folder.mkdir(parents=True)
# A shorter measurement than the default's second: it is LIGGGHTS's time that counts here.
short = ["--set", 'run.shortest="0.3 s"']
point = ["--at", "friction=0.4,hamaker=0,rpm=300", *short]


def run(words, status=0, where=folder):
    done = subprocess.run(words, cwd=where, capture_output=True, text=True)
    assert done.returncode in (status if isinstance(status, tuple) else (status,)), (words, done.returncode, done.stderr, done.stdout[-2000:])
    return done


run([program, "export", study, "case", "--to", "liggghts", "--quiet", *point])
# Two ranks, the box cut along its axis: meshes and spheres pass from one to the other, and through the periodic end.
run(["mpirun", "--allow-run-as-root", "--oversubscribe", "-np", "2", "liggghts", "-in", "in.liggghts", "-var", "px", "2",
     "-var", "nrun", "360000"], where=folder / "case")
theirs = json.loads(run([program, "export", study, "case", "--collect", "--json", "--quiet", "--out", "back", *short]).stdout)
ours = json.loads(run([program, "simulate", study, "--out", "ours", "--json", "--quiet", *point], status=(0, 2)).stdout)
mean, error = theirs["torque"]["mean"], theirs["torque"]["standard_error"]
torque = ours["outputs"]["torque"]
z = (mean - torque["mean"]) / math.hypot(error, torque["standard_error"])
print(f"LIGGGHTS {mean:.3f} +- {error:.3f} ({theirs['state']}), demcal {torque['mean']:.3f} +- {torque['standard_error']:.3f} uN m: z {z:.2f}")
assert theirs["state"] == "steady" and abs(z) < 3.0

# The row is another engine's: it has no settings of ours, so that a study takes it as its table.
lines = [line for line in (folder / "back" / "liggghts.csv").read_text().splitlines() if not line.startswith("#")]
rows = list(csv.DictReader(lines))
assert len(rows) == 1 and rows[0]["origin"] == "LIGGGHTS" and rows[0]["settings"] == ""
assert abs(float(rows[0]["torque"]) - mean) < 1e-6 * mean and float(rows[0]["rpm"]) == 300.0
# Collected twice, it stays one row.
run([program, "export", study, "case", "--collect", "--quiet", "--out", "back", *short])
assert len([line for line in (folder / "back" / "liggghts.csv").read_text().splitlines() if not line.startswith("#")]) == 2
