#!/usr/bin/python3
"""Campaigns on a real Slurm of two nodes, made for this test: campaign.py DEMCAL STUDY FOLDER

Each campaign must give the table that the same runs give on this machine, bit for bit but for the processor time and the
origin. Exit status 77, and a line that says so, where there is no Slurm to try it on."""
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import time

here = pathlib.Path(__file__).resolve().parent
program, study, folder = sys.argv[1], sys.argv[2], pathlib.Path(sys.argv[3]).resolve()
cluster = folder / "cluster"


def skip(why):
    print(f"SKIPPED, nothing was tested: {why}")
    sys.exit(77)


missing = [name for name in ("slurmctld", "slurmd", "sbatch", "squeue", "munged") if not shutil.which(name)]
if missing:
    skip(f"no {', '.join(missing)} here (apt-get install --no-install-recommends slurmctld slurmd slurm-client munge)")
if os.geteuid() != 0:
    skip("only root can start a Slurm of its own")
try:
    import h5py
except ImportError:
    skip("python3-h5py is not here")

failures = []
DONE = (0, 2)  # with a warning: in so short runs some spheres overlap deeply


def check(true, what):
    print(("ok      " if true else "FAILED  ") + what, flush=True)
    if not true:
        failures.append(what)


def settings(longest):
    return ["--set", "rig.fill=200", "--set", f'run.longest="{longest} s"', "--set", "run.start_up_turns=0.25", "--set", 'training.unsteady="use"']


def train(out, runs, longest, *more):
    return [program, "train", study, "--out", str(folder / out), "--runs", str(runs), *settings(longest), *more]


def run(words, env=None):
    done = subprocess.run(words, capture_output=True, text=True, env=env, timeout=600)
    return done.returncode, done.stdout + done.stderr


class Following:
    """demcal train --slurm, beside this program."""

    def __init__(self, words):
        self.file = open(folder / "said.txt", "w+")
        self.child = subprocess.Popen(words, stdout=self.file, stderr=subprocess.STDOUT)

    def said(self):
        return (folder / "said.txt").read_text()

    def end(self):
        status = self.child.wait(timeout=400)
        return status, self.said()


def wait_for(what, true, seconds=90):
    until = time.monotonic() + seconds
    while not true():
        if time.monotonic() > until:
            check(False, f"{what} within {seconds} s")
            return
        time.sleep(0.2)


def queue(*options):
    return subprocess.run(["squeue", "-h", "-r", *options], capture_output=True, text=True).stdout.split("\n")[:-1]


def rows(out):
    """Every dataset of the table but the processor time and the origin, as bytes."""
    found = {}
    with h5py.File(folder / out / "training.h5") as file:
        def keep(name, item):
            if isinstance(item, h5py.Dataset) and not any(word in name for word in ("cpu_seconds", "origin")):
                value = item[()]
                found[name] = [str(x) for x in value] if value.dtype == object else value.tobytes()
        file.visititems(keep)
    return found


def same(out, reference, what):
    mine, others = rows(out), rows(reference)
    different = [name for name in others if mine.get(name) != others[name]]
    check(len(others) > 4 and mine.keys() == others.keys() and not different, f"{what}: the table is the local one {different}")


def a_campaign_completes():
    status, said = run(train("completes", 8, 2, "--slurm", "--runs-per-task", "2", "--mem", "100M", "--time", "10"))
    check(status in DONE, f"a campaign completes ({status})\n{'' if status in DONE else said}")
    check("submitted job" in said and "8 runs in 4 tasks" in said, "it says which job it submitted")
    same("completes", "local", "a campaign completes")


def a_node_dies():
    follow = Following(train("node", 8, 2, "--slurm", "--runs-per-task", "2"))
    wait_for("a task on node2", lambda: queue("-t", "R", "-w", "node2"))
    time.sleep(2)
    print(subprocess.run([here / "crash", cluster, "node2"], capture_output=True, text=True).stdout, end="")
    status, said = follow.end()
    check(status in DONE, f"a node dies in mid-run and the campaign completes ({status})\n{'' if status in DONE else said}")
    same("node", "local", "a node died")
    subprocess.run([here / "crash", cluster, "node2", "revive"])
    wait_for("node2 comes back", lambda: "idle" in subprocess.run(
        ["sinfo", "-h", "-n", "node2", "-o", "%t"], capture_output=True, text=True).stdout)


def the_controller_stops():
    # More tasks than the nodes have processors: some wait for the controller, so the program must hear it again. Where all
    # are running, they end without it and their files are the whole answer.
    follow = Following(train("controller", 8, 2, "--slurm", "--runs-per-task", "1"))
    wait_for("a running task", lambda: queue("-t", "R"))
    pid = int((cluster / "run/slurmctld.pid").read_text())
    os.kill(pid, signal.SIGTERM)
    wait_for("the silence is told", lambda: "does not answer" in follow.said(), 120)
    check(follow.child.poll() is None, "the program waits while the controller is stopped")
    subprocess.run(["slurmctld", "-f", os.environ["SLURM_CONF"]])
    status, said = follow.end()
    check(status in DONE, f"the controller stops and comes back, and the campaign completes ({status})\n{'' if status in DONE else said}")
    submitted = said.count("submitted job")
    check(submitted == 1, f"nothing was submitted twice ({submitted})\n{'' if submitted == 1 else said}")
    check("answers again" in said, f"that it answers again is told\n{'' if 'answers again' in said else said}")
    same("controller", "local", "the controller was stopped")


def detached_and_picked_up():
    words = train("detached", 8, 2, "--slurm", "--runs-per-task", "2")
    status, said = run(words + ["--detach"])
    check(status == 0 and "are with Slurm" in said, f"--detach comes back when all is submitted ({status})")
    follow = Following(words)
    wait_for("a running task", lambda: queue("-t", "R"))
    time.sleep(1)
    follow.child.send_signal(signal.SIGINT)
    status, said = follow.end()
    check(status == 75 and "scancel" in said, f"interruption leaves the jobs, and says so ({status})")
    check(len(queue()) > 0, "they are still in the queue")
    status, said = run(words)
    check(status in DONE and "submitted job" not in said, f"the next call follows the same job ({status})")
    same("detached", "local", "left and picked up")


def cancelled():
    words = train("cancelled", 8, 2, "--slurm", "--runs-per-task", "2")
    follow = Following(words)
    wait_for("a running task", lambda: queue("-t", "R"))
    subprocess.run(["scancel", *{line.split("_")[0] for line in queue("-o", "%i")}])
    status, said = follow.end()
    check(status == 75 and "cancelled" in said and said.count("submitted job") == 1,
          f"what scancel ends is not submitted again by itself ({status})\n{'' if status == 75 else said}")
    status, said = run(words)
    check(status in DONE, f"the next call makes it ({status})")
    same("cancelled", "local", "cancelled and made again")


def refused():
    status, said = run(train("refused", 2, 2, "--slurm", "--partition", "nowhere"))
    check(status == 64 and "nvalid partition" in said and "--partition" in said, f"a wrong partition is told ({status})")
    status, said = run(train("refused", 2, 2, "--slurm"), dict(os.environ, PATH="/nonexistent"))
    check(status == 69 and "slurm-client" in said, f"a missing sbatch is told ({status})")


shutil.rmtree(folder, ignore_errors=True)
folder.mkdir(parents=True)
up = subprocess.run([here / "up", cluster], capture_output=True, text=True)
if up.returncode == 3:
    skip("no Slurm could be started: " + up.stderr.strip())
try:
    os.environ["SLURM_CONF"] = str(cluster / "slurm.conf")
    check(up.returncode == 0, "a Slurm of two nodes starts\n" + up.stderr)
    status, said = run(train("local", 8, 2))
    check(status in DONE, f"the same runs on this machine ({status})")
    for scenario in (refused, a_campaign_completes, detached_and_picked_up, cancelled, the_controller_stops, a_node_dies):
        if not failures:
            start = time.monotonic()
            scenario()
            print(f"        {scenario.__name__}: {time.monotonic() - start:.0f} s", flush=True)
finally:
    subprocess.run([here / "down", cluster])
sys.exit(1 if failures else 0)
