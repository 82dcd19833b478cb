#!/usr/bin/python3
"""Draws docs/trend.png: the change of the torque from slow to fast against cohesion, in another code's table and in our slice.

docs/trend.py [OUTPUT.png]. Needs gnuplot.
Left, data/drum-table, 10 to 50 rpm. A design is one set of sphere size, restitution, sliding, rolling and cohesion.
Those with sliding of at least 0.3 and rolling of at least 0.05 are drawn: below, the bed slips or flows whatever its
cohesion. Boxes: half of the designs; whiskers: 90 % of them; line: their medians.
Right, data/paper, 50 to 300 rpm, friction 0.40: one run a point, with its standard error.
"""
import csv
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[1]
DESIGN = ["psd_mm", "restitution", "sliding", "rolling", "cohesion"]
SLOW, FAST = "10", "50"  # rpm
SCRIPT = """
set terminal pngcairo size 1100,460 font "sans,11"
set output "{output}"
set multiplot layout 1,2
set yrange [-42:45]
set xzeroaxis lt 1 lc rgb "#888888"
set grid ytics lc rgb "#dddddd"
set key top right
set style fill solid 0.35
set boxwidth 4
set title "drum, LIGGGHTS runs of another group"
set xlabel "cohesion energy density (SJKR), kJ/m^3"
set ylabel "change of the torque from 10 to 50 rpm, %"
set xrange [-5:75]
plot "-" using 1:3:2:6:5 with candlesticks lc rgb "#3b6ea5" title "half and 90 % of the designs" whiskerbars 0.5, \\
     "-" using 1:2 with linespoints lw 2 pt 7 lc rgb "#b5432a" title "median"
{boxes}
e
{medians}
e
set title "auger slice, demcal, friction 0.40"
set xlabel "Bond number (pull-off force over weight)"
set ylabel "change of the torque from 50 to 300 rpm, %"
set xrange [-1:*]
plot "-" using 1:2:3 with yerrorlines lw 2 pt 7 lc rgb "#b5432a" title "one run a point"
{slice}
e
unset multiplot
"""


def changes():
    """Percent, by cohesion."""
    torque = {}
    with open(ROOT / "data" / "drum-table" / "granudrum_liggghts.csv", newline="") as file:
        for row in csv.DictReader(file):
            if float(row["sliding"]) >= 0.3 and float(row["rolling"]) >= 0.05:
                torque.setdefault(tuple(row[n] for n in DESIGN), {})[row["rpm"]] = float(row["torque_over_MgR"])
    found = {}
    for design, at in torque.items():
        found.setdefault(float(design[-1]), []).append(100.0 * (at[FAST] / at[SLOW] - 1.0))
    return found


def slice_changes():
    """(Bond number, percent, standard error), by Bond number."""
    torque = {}
    with open(ROOT / "data" / "paper" / "sweeps.csv", newline="") as file:
        for row in csv.DictReader(line for line in file if not line.startswith("#")):
            if row["sweep"] in ("friction", "hamaker") and row["friction"] == "0.4" and row["torque"]:
                torque.setdefault(float(row["hamaker"]), {})[row["rpm"]] = row
    found = []
    for at in torque.values():
        if "50" not in at or "300" not in at:
            continue
        slow, fast = (float(at[rpm]["torque"]) for rpm in ("50", "300"))
        share = ((float(at["50"]["torque_se"]) / slow) ** 2 + (float(at["300"]["torque_se"]) / fast) ** 2) ** 0.5
        found.append((float(at["300"]["bond_number"]), 100.0 * (fast / slow - 1.0), 100.0 * share * fast / slow))
    return sorted(found)


def quantile(values, share):
    ordered = sorted(values)
    place = share * (len(ordered) - 1)
    low = int(place)
    return ordered[low] + (place - low) * (ordered[min(low + 1, len(ordered) - 1)] - ordered[low])


def main():
    output = sys.argv[1] if len(sys.argv) > 1 else str(ROOT / "docs" / "trend.png")
    boxes, medians = [], []
    for cohesion, values in sorted(changes().items()):
        q05, q25, q50, q75, q95 = (quantile(values, s) for s in (0.05, 0.25, 0.5, 0.75, 0.95))
        falls = 100.0 * sum(v < 0 for v in values) / len(values)
        print(f"{cohesion:6.0f} J/m3: median {q50:+5.1f} %, half {q25:+5.1f} to {q75:+5.1f} %; falls in {falls:3.0f} % of {len(values)} designs")
        boxes.append(f"{cohesion / 1000} {q05} {q25} {q50} {q75} {q95}")
        medians.append(f"{cohesion / 1000} {q50}")
    in_slice = slice_changes()
    for bond, change, error in in_slice:
        print(f"Bond number {bond:5.1f}: {change:+5.1f} +- {error:.1f} %")
    text = SCRIPT.format(output=output, boxes="\n".join(boxes), medians="\n".join(medians),
                         slice="\n".join(f"{bond} {change} {error}" for bond, change, error in in_slice))
    subprocess.run(["gnuplot"], input=text, text=True, check=True)


if __name__ == "__main__":
    main()
