#!/usr/bin/python3
"""Draws docs/paper-friction.png and docs/paper-hamaker.png from sweeps.csv: torque over speed in the slice, in the form of the paper's figures 3 and 4.

figures.py [FOLDER]. Needs gnuplot. One run a point, with its standard error. Full lines: six speeds; dashed: the slowest and the fastest alone.
An empty circle: the mean is of a steady run, and that run failed when it was continued.
"""
import csv
import pathlib
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
SCRIPT = """
set terminal pngcairo size 1200,660 font "sans,15"
set output "{output}"
set rmargin at screen 0.75
set border 3 lc rgb "#555555"
set tics nomirror out
set grid ytics lt 1 lw 1 lc rgb "#dddddd"
set key at screen 0.765, screen 0.65 left Left reverse samplen 3 spacing 1.5 title "{legend}"
set xlabel "speed of the mixer, rpm"
set ylabel "torque, uN m"
set xrange [35:315]
set xtics 50
set yrange [0:{top}]
set bars 1.2
set title "{title}"
plot {curves}
{data}
"""
# Colour (told apart by the colour-blind, too) and marker of a curve, from the lowest to the highest.
STYLES = [("#1b4f8a", 7), ("#3a93c9", 9), ("#1a8a5a", 5), ("#b08000", 13), ("#c05a1a", 11), ("#8a1f3d", 15)]


def rows():
    with open(HERE / "sweeps.csv", newline="") as file:
        return [row for row in csv.DictReader(line for line in file if not line.startswith("#")) if row["torque"] and row["material"] == "spread"]


def curves(chosen, column):
    """The chosen rows by the column's value."""
    found = {}
    for row in chosen:
        found.setdefault(float(row[column]), []).append(row)
    return [(value, sorted(found[value], key=lambda row: float(row["rpm"]))) for value in sorted(found)]


def draw(output, texts, top, found, name_of):
    """texts: title and legend; found: (value, its rows by speed). The highest curve stands first in the key, as on the picture."""
    parts, data = [], []

    def plot(part, lines):
        parts.append('"-" using 1:2:3 ' + part)
        data.extend(lines + ["e"])

    for (value, at), (colour, marker) in reversed(list(zip(found, STYLES))):
        lines = {False: [], True: []}
        for row in at:
            lines["longer run failed" in row["state"]].append(f"{row['rpm']} {row['torque']} {row['torque_se']}")
        every = sorted(lines[False] + lines[True], key=lambda line: float(line.split()[0]))
        dash = "1" if len(at) > 2 else '"- -"'
        plot(f'with lines lw 2.5 dt {dash} lc rgb "{colour}" notitle', every)
        plot(f'with yerrorbars lw 2 pt {marker} ps 1.1 lc rgb "{colour}" title "{name_of(value)}"', lines[False])
        if lines[True]:
            plot('with points pt 7 ps 1.5 lc rgb "white" notitle', lines[True])
            plot(f'with yerrorbars lw 2 pt 6 ps 1.3 lc rgb "{colour}" title "{name_of(value)}, failed later"', lines[True])
    text = SCRIPT.format(output=output, title=texts[0], legend=texts[1], top=top, curves=", \\\n     ".join(parts), data="\n".join(data))
    subprocess.run(["gnuplot"], input=text, text=True, check=True)


def main():
    folder = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else HERE.parents[1] / "docs"
    table = rows()
    draw(folder / "paper-friction.png", ("Torque in the slice without cohesion", "friction coefficient"), 70,
         curves([row for row in table if row["sweep"] == "friction"], "friction"), "{:g}".format)
    attracted = [row for row in table if row["sweep"] == "hamaker" or (row["sweep"] == "friction" and row["friction"] == "0.4")]
    draw(folder / "paper-hamaker.png", ("Torque in the slice at a friction of 0.40", "Hamaker constant H*"), 120, curves(attracted, "hamaker"),
         lambda value: f"{value * 1e18:g}e-18 J" if value else "none")


if __name__ == "__main__":
    main()
