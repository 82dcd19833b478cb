#!/usr/bin/python3
"""Runs the paper's sweeps and gathers them in sweeps.csv: sweep.py DEMCAL [--out FOLDER] [--jobs 1] [--threads 1] [--only SWEEP] [--gather] [--again]

Every point is one `demcal simulate data/paper`, kept below FOLDER, so that a second start goes on where one was cut
off. A point that sweeps.csv has is not run, but with --again; --gather only writes the table of what is there. Sweeps:
  friction     0.2, 0.4 and 0.6 without cohesion, six speeds                                (the paper's figure 3)
  hamaker      2e-18 and 9e-18 J at a friction of 0.40, six speeds; 1e-18, 4e-18 and 6e-18 J at two   (its figure 4)
  choices      what the paper does not state, each alone changed, at the slowest and the fastest speed: minimum
               separation, the load that limits friction, attraction of the walls, stiffness
  machine      the machine of two augers of the same cross-section beside the slice, at two speeds of five points of the first sweeps
  full mass    the machine of 330 mm with 300 g, the paper's developer: one point, three hours of one core and more (--threads 2)
  ridge        less friction and more cohesion: where the slice's torque is that of a friction of 0.4 with 2e-18 J, and the
               machine there
  carrier's ridge   three of the points that the report of data/developer calls equivalent for the carrier, in the slice and in the machine
  grain size   the same bed of spheres of other diameters, slowest and fastest speed: without cohesion, and with a force of
               attraction that goes with the 2nd, 3rd or 4th power of the diameter from that of 9e-18 J at 0.8 mm
The slice's points at the slowest and the fastest speed that the README's table of the mechanism shows have its outputs, too.
A point that ends with an error (spheres pressed into each other, say) has a row with its message and no numbers.
"""
import argparse
import concurrent.futures
import csv
import json
import pathlib
import re
import subprocess

HERE = pathlib.Path(__file__).resolve().parent
SPEEDS = [50, 100, 150, 200, 250, 300]
ENDS = [50, 300]
CHOICES = {
    "minimum separation 0.4 nm": {"contact.minimum_separation": "0.4 nm"},
    "minimum separation 1 nm": {"contact.minimum_separation": "1 nm"},
    "minimum separation 4 nm": {"contact.minimum_separation": "4 nm"},
    "cap on the net force": {"contact.cap": "net"},
    "cap of Thornton": {"contact.cap": "thornton"},
    "walls do not attract": {"contact.wall_hamaker": "0 J"},
    "stiffness 1200 N/m": {"contact.stiffness": "1200 N/m"},
}
DIAMETERS = {"spread-1131": 1.1314, "spread-566": 0.5657, "spread-400": 0.4}  # mm; dearest last: half an hour a run at 300 rpm, an hour and a half at 50
# The slice's cross-section as a machine of two augers, 48 mm long: 20,080 spheres, 31.5 g, fill 47 % of the room up to the blades' top, as in the slice.
# At 300 N/m spheres that a blade's leading edge pinches overlap too deep.
STIFFER = {"contact.stiffness": "600 N/m"}
MACHINE = STIFFER | {"rig.kind": "machine", "rig.machine_length": "48 mm", "rig.opening": "12 mm", "rig.fill": "20080", "run.start_up_turns": "12",
                     "run.longest": "30 s"}
# Points of the relation of friction and Hamaker constant that the report of data/developer gives for the carrier: its training.csv has the slice's torque at each.
CARRIERS = ((0.3625, "8.651e-18"), (0.52, "1.0012e-17"), (0.66875, "1.2108e-17"))
STIFFEST = {"contact.stiffness": "1200 N/m"}  # so much friction and cohesion press pinched spheres deeper still
# The whole machine, with the paper's 300 g. Its powder goes round once in a hundred turns; what can be had in hours is six turns after the first six.
WHOLE = MACHINE | {"rig.machine_length": "330 mm", "rig.fill": "300 g", "run.start_up_turns": "6", "run.longest": "2.3 s"}
# 153,600 spheres of 0.20 mm: five turns take three hours of a core. Those of 0.40 mm have their torque within 1 % from the third turn on.
FINEST = {"run.start_up_turns": "2", "run.longest": "1 s"}
BASE_DIAMETER, BASE_HAMAKER = 0.8, 9e-18  # mm, J
KEY = ["sweep", "choice", "material", "friction", "hamaker", "rpm"]
OUTPUTS = ["torque", "coordination", "axial_flow", "kinetic_energy"]
# What tells how the torque comes about. Runs of before there were these outputs are made again where they are in question.
MECHANISM = ["normal_stress", "centre_x", "centre_z", "tool_contacts", "tool_slip", "wall_slip"]
# What only some runs say: a machine how its powder goes round, any run an overlap deep enough for a warning and outputs whose errors are not known.
SOME = ["lap_turns", "lap_turns_se", "fill_least", "fill_most", "largest_overlap", "unreliable"]
LONGER = "; a longer run failed: "  # in the state of a row whose numbers are those of a shorter run


def points():
    """(sweep, choice, material, friction, hamaker in J, rpm, settings), the cheapest questions first."""
    for hamaker in ("2e-18", "9e-18"):
        for rpm in SPEEDS:
            yield "hamaker", "", "spread", 0.4, hamaker, rpm, {}
    for friction in (0.4, 0.2, 0.6):
        for rpm in SPEEDS:
            yield "friction", "", "spread", friction, "0", rpm, {}
    for hamaker in ("1e-18", "4e-18", "6e-18"):
        for rpm in ENDS:
            yield "hamaker", "", "spread", 0.4, hamaker, rpm, {}
    for choice, settings in CHOICES.items():
        for hamaker in ("2e-18", "9e-18"):
            for rpm in ENDS:
                yield "choices", choice, "spread", 0.4, hamaker, rpm, settings
    for rpm in (300, 100):
        for rig, settings in (("of two augers", MACHINE), ("the slice", STIFFER)):
            for friction, hamaker in ((0.4, "0"), (0.4, "9e-18"), (0.4, "2e-18"), (0.6, "0"), (0.2, "0")):
                yield "machine", rig, "spread", friction, hamaker, rpm, settings
    yield "full mass", "of two augers", "spread", 0.4, "0", 300, WHOLE
    for hamaker in ("4e-18", "6e-18", "4.7e-18"):  # the last one by interpolation between the other two
        yield "ridge", "the slice", "spread", 0.2, hamaker, 300, STIFFER
    yield "ridge", "of two augers", "spread", 0.2, "4.7e-18", 300, MACHINE
    for rig, settings in (("the slice", STIFFEST), ("of two augers", MACHINE | STIFFEST)):
        for friction, hamaker in CARRIERS:
            yield "carrier's ridge", rig, "carrier", friction, hamaker, 300, settings
    for material, diameter in DIAMETERS.items():
        for rpm in ENDS:
            yield "grain size", "no attraction", material, 0.4, "0", rpm, {}
        for power in (3, 2, 4):
            hamaker = BASE_HAMAKER * (diameter / BASE_DIAMETER) ** (power - 1)  # the force goes with hamaker * diameter
            for rpm in ENDS:
                yield "grain size", f"force as d^{power}", material, 0.4, f"{hamaker:.4g}", rpm, {}
    yield "grain size", "no attraction", "spread-200", 0.4, "0", 300, FINEST
    yield "grain size", "force as d^2", "spread-200", 0.4, f"{BASE_HAMAKER * 0.2 / BASE_DIAMETER:.4g}", 300, FINEST


def in_question(point):
    """Whether the README's table of the mechanism shows the point."""
    sweep, choice, _, friction, hamaker, rpm, _ = point
    if rpm not in ENDS:
        return False
    return sweep == "friction" or (sweep == "hamaker" and hamaker in ("2e-18", "9e-18")) or (choice == "cap on the net force" and hamaker == "9e-18")


def folder_of(arguments, point):
    sweep, choice, material, friction, hamaker, rpm, _ = point
    return arguments.out / f"{sweep.replace(' ', '-')}-{choice.replace(' ', '-')}-{material}-{friction}-{hamaker}-{rpm}"


def simulate(arguments, point):
    _, _, material, friction, hamaker, rpm, settings = point
    folder = folder_of(arguments, point)
    kept = folder / "result.json"
    if kept.exists():
        return
    command = [arguments.demcal, "simulate", str(HERE), "--material", material, "--at", f"friction={friction},hamaker={hamaker},rpm={rpm}",
               "--json", "--quiet", "--threads", str(arguments.threads), "--out", str(folder)]
    for key, value in settings.items():
        command += ["--set", f"{key}={value}"]
    done = subprocess.run(command, capture_output=True, text=True)
    folder.mkdir(parents=True, exist_ok=True)
    if done.returncode in (0, 2):  # 2: done, with a warning
        kept.write_text(done.stdout)
    elif done.returncode < 0 or done.returncode in (129, 130, 143) or not done.stderr.strip():
        raise SystemExit(f"ended from outside (status {done.returncode}): {' '.join(command)}")
    else:
        kept.write_text(json.dumps({"error": done.stderr.strip().splitlines()[0]}))
    print(f"{folder.name}: {done.returncode}", flush=True)


def key_of(point):
    """What tells a point's row in sweeps.csv."""
    return tuple(str(value) for value in point[:6])


def rows_there():
    """The rows of sweeps.csv, by the point's key."""
    table = HERE / "sweeps.csv"
    if not table.exists():
        return {}
    with open(table, newline="") as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    return {tuple(row[name] for name in KEY): row for row in rows}


def some_of(found, rpm):
    """The columns SOME that a run's result has values for."""
    row = {}
    if "circulation" in found:
        lap = found["circulation"]
        fill = lap["fill_along_first"] + lap["fill_along_second"]
        row = {"fill_least": f"{min(fill):.3g}", "fill_most": f"{max(fill):.3g}"}
        if lap["lap_s"] is not None:  # a flow that is told from none
            row |= {"lap_turns": f"{lap['lap_s'] * rpm / 60:.4g}", "lap_turns_se": f"{lap['lap_standard_error_s'] * rpm / 60:.2g}"}
    overlaps = re.findall(r"overlap by more than .*\(largest ([0-9.]+)\)", " ".join(found["warnings"]))
    if overlaps:
        row["largest_overlap"] = overlaps[0]
    return row | {"unreliable": " ".join(name for name in OUTPUTS + MECHANISM if not found["outputs"][name]["reliable"])}


def row_of(arguments, point):
    kept = folder_of(arguments, point) / "result.json"
    if not kept.exists():
        return None
    found = json.loads(kept.read_text())
    row = dict(zip(KEY, key_of(point)))
    if "error" in found:
        reason = found["error"].split(" (its last good state")[0]  # a path of the machine that ran it
        return row | {"state": "failed: " + reason}
    for name in OUTPUTS + MECHANISM:
        output = found["outputs"][name]
        row[name] = f"{output['mean']:.6g}"
        row[name + "_se"] = f"{output['standard_error']:.3g}"
    row |= some_of(found, point[5])
    return row | {"bond_number": f"{found['bond_number']:.4g}", "turns": f"{found['measured']['turns']:.4g}", "seed": found["seed"],
                  "settings": found["settings"], "state": found["state"]}


def gather(arguments):
    there = rows_there()

    def row(point):
        made, known = row_of(arguments, point), there.get(key_of(point))
        if not made or not known:
            return made or known
        # A run that ended before it was long enough for the mechanism's outputs leaves the torque that is known.
        if made["state"].startswith("failed") and known["torque"]:
            return known | {"state": known["state"].split(LONGER)[0] + LONGER + made["state"].removeprefix("failed: ")}
        return made

    rows = [one for one in map(row, points()) if one]
    columns = KEY + [c for o in OUTPUTS + MECHANISM for c in (o, o + "_se")] + SOME + [
        "bond_number", "turns", "seed", "settings", "state"]
    with open(HERE / "sweeps.csv", "w", newline="") as file:
        file.write("# made by sweep.py; torque in uN m, coordination in contacts a sphere, axial_flow in g/s, kinetic_energy in uJ,\n"
                   "# normal_stress in Pa, centre_x and centre_z in mm, tool_slip and wall_slip in mm/s, tool_contacts in contacts a sphere;\n"
                   "# NAME_se: standard error; bond_number: largest pull-off force over weight; turns: of the measured window;\n"
                   "# lap_turns: turns in which a machine's powder goes round once; fill_least, fill_most: along a trough, over its mean; largest_overlap: of a radius,\n"
                   "# where it is above 0.05; unreliable: outputs whose errors are not known; empty also where a run was gathered before there was such a column\n")
        writer = csv.DictWriter(file, columns, restval="", lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    print(f"{len(rows)} of {sum(1 for _ in points())} points")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("demcal")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("paper-runs"))
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--threads", type=int, default=1, help="of one run, whose numbers do not depend on it")
    parser.add_argument("--only", default="", help="the sweep to run")
    parser.add_argument("--gather", action="store_true")
    parser.add_argument("--again", action="store_true")
    arguments = parser.parse_args()
    if not arguments.gather:
        there = {} if arguments.again else rows_there()
        lacking = lambda point: key_of(point) not in there or (in_question(point) and not there[key_of(point)].get(MECHANISM[0]))
        missing = [point for point in points() if lacking(point) and arguments.only in ("", point[0])]
        with concurrent.futures.ThreadPoolExecutor(arguments.jobs) as pool:
            list(pool.map(lambda point: simulate(arguments, point), missing))
    gather(arguments)


if __name__ == "__main__":
    main()
