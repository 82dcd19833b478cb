#!/usr/bin/env python3
"""Makes runs.csv, torque.csv and angles.csv of this folder from granudrum_liggghts.csv: make_data.py [--truth LINE]

LINE is a line of granudrum_liggghts.csv; the design that stands there is the truth. Its rows at all speeds go into
torque.csv and angles.csv and are left out of runs.csv.

The table does not state standard errors. They are taken from the roughness of the bed's surface in the same picture,
surface_rms (s, in drum radii): a lumpy bed differs from picture to picture, and a line through its surface means
little. Beside a Gaussian process of all other designs, the rows scatter as follows (robust sd, at 10 and 50 rpm):

    s about                          0.0025        0.006          0.02          0.05 and more
    torque_over_MgR (absolute)       0.0025 0.002  0.004  0.004   0.011 0.007   0.014  0.012 to 0.022
    angle_upper (relative)           0.03   0.02   0.05   0.05    0.18  0.15    0.3    0.3
    angle_lower (relative)           0.03   0.03   0.05   0.07    0.15  0.18    0.2    0.5

which these curves follow:

    torque_over_MgR_se = sqrt(((0.09 + 0.015 w) s^0.6)^2 + (70 w s^2)^2),   w = (50 rpm - speed) / 40 rpm
    angle_se = angle sqrt(0.02^2 + (8 s)^2)

w is for the slow drum, where a rough bed falls in avalanches: without it the torque at 10 rpm scatters by 1.6 of its
errors, and by 2.1 among the rougher half of the beds with a surface.

Above s = 0.02 there is no surface that a line could stand for (angles up to 140 degrees): the angles are left empty.
"""
import argparse
import csv
import math
import pathlib

SURFACE_ROUGHEST = 0.02  # drum radii
DESIGN = ["psd_mm", "restitution", "sliding", "rolling", "cohesion"]
OUTPUTS = ["torque_over_MgR", "angle_upper", "angle_lower"]


def torque_error(row):
    roughness, slowness = float(row["surface_rms"]), (50.0 - float(row["rpm"])) / 40.0
    return math.hypot((0.09 + 0.015 * slowness) * roughness ** 0.6, 70.0 * slowness * roughness ** 2)


def angle_error(row, name):
    return float(row[name]) * math.hypot(0.02, 8.0 * float(row["surface_rms"]))


def design_of(row):
    return tuple(row[name] for name in DESIGN)


def material_of(row):
    return "size-" + row["psd_mm"]


def with_errors(row):
    """[value, standard error] of each output, as text; empty where the picture has no surface."""
    cells = [row["torque_over_MgR"], f"{torque_error(row):.5f}"]
    smooth = float(row["surface_rms"]) <= SURFACE_ROUGHEST
    for name in OUTPUTS[1:]:
        cells += [f"{float(row[name]):.3f}", f"{angle_error(row, name):.3f}"] if smooth else ["", ""]
    return cells


def read_table(path):
    with open(path, newline="") as file:
        return list(csv.DictReader(file))


def write_csv(path, comments, header, rows):
    with open(path, "w", newline="") as file:
        file.writelines(f"# {comment}\n" for comment in comments)
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        writer.writerows(rows)


def write_runs(path, rows, truth):
    header = ["material"] + DESIGN[1:] + ["rpm"]
    for name in OUTPUTS:
        header += [name, name + "_se"]
    comments = ["Another code's runs: LIGGGHTS, see README.md. Standard errors from the surface's roughness: make_data.py."]
    write_csv(path, comments, header,
              [[material_of(r)] + [r[n] for n in DESIGN[1:]] + [r["rpm"]] + with_errors(r)
               for r in rows if design_of(r) != truth])


def write_observations(folder, rows, truth):
    """torque.csv and angles.csv; whether there is an angle at all."""
    own = [r for r in rows if design_of(r) == truth]
    text = ", ".join(f"{n} {v}" for n, v in zip(DESIGN, truth))
    comments = ["Synthetic: no powder was measured. One LIGGGHTS design of the table, left out of runs.csv.", f"truth: {text}"]
    cells = [(r["rpm"], with_errors(r)) for r in own]
    write_csv(folder / "torque.csv", comments, ["rpm", "torque_over_MgR", "torque_over_MgR_se"],
              [[rpm] + c[:2] for rpm, c in cells])
    angles = [[rpm] + c[2:] for rpm, c in cells if c[2]]
    write_csv(folder / "angles.csv", comments,
              ["rpm", "angle_upper", "angle_upper_se", "angle_lower", "angle_lower_se"], angles)
    return bool(angles)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    parser.add_argument("--truth", type=int, default=281, metavar="LINE")
    line = parser.parse_args().truth
    here = pathlib.Path(__file__).resolve().parent
    rows = read_table(here / "granudrum_liggghts.csv")
    if not 2 <= line <= len(rows) + 1:
        parser.error(f"--truth {line}: granudrum_liggghts.csv has rows in lines 2 to {len(rows) + 1}")
    truth = design_of(rows[line - 2])
    write_runs(here / "runs.csv", rows, truth)
    write_observations(here, rows, truth)


if __name__ == "__main__":
    main()
