#!/usr/bin/env python3
"""Makes runs.csv and bench.csv of this study from a closed formula; the same bytes every time.

No DEM is behind these numbers: they stand for the runs of another code, so that the calibration can be tried, and tested,
where the truth is known.

    torque = 8 mN m * (1 + cohesion / 6)^0.5 * (friction / 0.4)^0.5 * (1 + 0.12 s - 0.04 s cohesion / 6)
    s = (speed - 175 rpm) / 125 rpm, cohesion in mJ/m2

Friction and cohesion both raise torque by the same factor at any speed; only the small last term, by which cohesion flattens
the rise with speed (0.12 to 0.053 over the range of cohesion), tells them apart. So torque gives their product well and
each of them poorly.

runs.csv: 80 points of a Latin hypercube, normal noise of standard deviation 1 % of torque, which is torque_se.
bench.csv: six speeds at friction 0.40 and cohesion 4 mJ/m2, noise and torque_se 3 %.
"""
import os
import random

FRICTION, COHESION, SPEED = (0.1, 0.8), (0.0, 10.0), (50.0, 300.0)
TRUE_FRICTION, TRUE_COHESION = 0.40, 4.0
RUNS, SEED = 80, 20110726
RUN_NOISE, BENCH_NOISE = 0.01, 0.03

FORMULA = "torque = 8 mN m * (1 + cohesion/6)^0.5 * (friction/0.4)^0.5 * (1 + 0.12 s - 0.04 s cohesion/6), s = (speed - 175)/125"


def torque(friction, cohesion, speed):
    """mN m, from friction, cohesion in mJ/m2 and speed in rpm."""
    s = (speed - 175.0) / 125.0
    common = 8.0 * (1.0 + cohesion / 6.0) ** 0.5 * (friction / 0.4) ** 0.5
    return common * (1.0 + 0.12 * s - 0.04 * s * cohesion / 6.0)


def latin_hypercube(rng, count):
    """Points in the unit cube, one in each of `count` slices of every axis."""
    axes = []
    for _ in range(3):
        slices = list(range(count))
        rng.shuffle(slices)
        axes.append([(k + rng.random()) / count for k in slices])
    return zip(*axes)


def scale(u, bounds):
    return bounds[0] + u * (bounds[1] - bounds[0])


def main():
    folder = os.path.dirname(os.path.abspath(__file__))
    rng = random.Random(SEED)
    head = ["# Synthetic: made by make_data.py from a formula, not by a DEM code and not measured.", "# " + FORMULA]

    lines = head + [
        f"# {RUNS} points of a Latin hypercube, normal noise of 1 % of torque (torque_se), seed {SEED}",
        "friction,cohesion,speed,torque,torque_se",
    ]
    for u in latin_hypercube(rng, RUNS):
        x = float(f"{scale(u[0], FRICTION):.4f}"), float(f"{scale(u[1], COHESION):.3f}"), float(f"{scale(u[2], SPEED):.2f}")
        exact = torque(*x)
        lines.append(f"{x[0]:.4f},{x[1]:.3f},{x[2]:.2f},{exact + RUN_NOISE * exact * rng.gauss(0, 1):.4f},{RUN_NOISE * exact:.4f}")
    with open(os.path.join(folder, "runs.csv"), "w", newline="\n") as file:
        file.write("\n".join(lines) + "\n")

    lines = head + [
        f"# truth: friction {TRUE_FRICTION}, cohesion {TRUE_COHESION} mJ/m2; normal noise of 3 % of torque (torque_se), seed {SEED}",
        "speed,torque,torque_se",
    ]
    for speed in (50, 100, 150, 200, 250, 300):
        exact = torque(TRUE_FRICTION, TRUE_COHESION, speed)
        lines.append(f"{speed},{exact + BENCH_NOISE * exact * rng.gauss(0, 1):.4f},{BENCH_NOISE * exact:.4f}")
    with open(os.path.join(folder, "bench.csv"), "w", newline="\n") as file:
        file.write("\n".join(lines) + "\n")


if __name__ == "__main__":
    main()
