#!/usr/bin/env python3
"""Makes the chute of LAMMPS's bench suite as a study of our own: make.py lattice FOLDER writes data.chute, a lattice above
a frozen, rough layer, for in.chute to drop, settle and tilt; make.py study FOLDER START X Y repeats the flow that
in.chute left in START (a text dump) X by Y times and writes data.chute, positions.csv and study.toml.

Reduced units (diameter, density and gravity are 1) are taken as metres, kg/m3 and m/s2."""
import math, pathlib, random, sys

LENGTH, WIDTH, HEIGHT = 40, 20, 60


def write_data(path, rows, x, y):
    """LAMMPS data file of (id, type, place, velocity); type 2 is frozen."""
    with open(path, "w") as out:
        out.write(f"chute\n\n{len(rows)} atoms\n2 atom types\n\n0 {LENGTH * x} xlo xhi\n0 {WIDTH * y} ylo yhi\n"
                  f"-1 {HEIGHT} zlo zhi\n\nAtoms # sphere\n\n")
        for k, (kind, place, _) in enumerate(rows, 1):
            out.write(f"{k} {kind} 1 1 {place[0]!r} {place[1]!r} {place[2]!r}\n")
        out.write("\nVelocities\n\n")
        for k, (_, _, v) in enumerate(rows, 1):
            out.write(f"{k} {v[0]!r} {v[1]!r} {v[2]!r} 0 0 0\n")


def lattice(folder):
    random.seed(12345)
    rest = (0.0, 0.0, 0.0)
    rows = [(2, (i + 0.5, j + 0.5, 0.4 * random.random()), rest) for i in range(LENGTH) for j in range(WIDTH)]
    nx, ny, step = 39, 19, 1.02
    for k in range(32000 - len(rows)):
        i, j, layer = k % nx, k // nx % ny, k // (nx * ny)
        place = ((i + 0.5) * LENGTH / nx, (j + 0.5) * WIDTH / ny, 1.5 + layer * step)
        rows.append((1, tuple(c + 0.005 * random.uniform(-1, 1) for c in place), rest))
    write_data(folder / "data.chute", rows, 1, 1)


def read_dump(path):
    """Rows of a dump of id type x y z vx vy vz, by id."""
    lines = path.read_text().splitlines()
    start = next(k for k, line in enumerate(lines) if line.startswith("ITEM: ATOMS")) + 1
    words = sorted((line.split() for line in lines[start:]), key=lambda word: int(word[0]))
    return [(int(w[1]), tuple(map(float, w[2:5])), tuple(map(float, w[5:8]))) for w in words]


def study(folder, start, x, y):
    one = read_dump(start)
    rows = [(kind, ((p[0] % LENGTH) + LENGTH * i, (p[1] % WIDTH) + WIDTH * j, p[2]), v)
            for i in range(x) for j in range(y) for kind, p, v in one]
    write_data(folder / "data.chute", rows, x, y)
    with open(folder / "positions.csv", "w") as out:
        out.write("x,y,z,vx,vy,vz,frozen\n")
        for kind, p, v in rows:
            out.write(",".join(repr(c) for c in (*p, *v)) + f",{kind - 1}\n")
    # Damping 50 per effective mass m/2, and the steps in a contact that make the time step 1e-4 (dem/bed/derived.cpp).
    frequency = math.sqrt(2.0 * 200000.0 / (math.pi / 6.0))
    zeta = 0.5 * 50.0 / frequency
    damped = math.sqrt(1.0 - zeta**2)
    angle = math.radians(26.0)
    (folder / "study.toml").write_text(f"""[study]
name = "chute-{len(rows)}"
seed = 1
description = "The chute of LAMMPS's bench suite"

[rig]
kind = "stl"             # without meshes: the frozen layer is the floor
packing = "positions.csv"
down = [{math.sin(angle)!r}, 0, {-math.cos(angle)!r}]

[rig.box]
low = ["0 m", "0 m", "-1 m"]
high = ["{LENGTH * x} m", "{WIDTH * y} m", "{HEIGHT} m"]
periodic = ["x", "y"]

[materials.grain]
density = "1 kg/m3"
diameter = "1 m"

[contact]
stiffness = "200000 N/m"
restitution = {math.exp(-math.pi * zeta / damped)!r}
tangential_damping = 0
tension = "allowed"

[run]
gravity = "1 m/s2"
steps_per_contact = {math.pi / (frequency * damped) / 1e-4!r}
skin = 0.1
settle = "0 s"
start_up = "0.1 s"
sample_interval = "20 ms"

[training]
standard_error = 1e-6    # never reached: the run is as long as `longest` says

[parameters.friction]    # the middle of its range, 0.5, is what `demcal simulate` takes
target = "contact.friction"
low = 0.4
high = 0.6

[outputs.torque]
unit = "N m"

[outputs.kinetic_energy]
unit = "J"
""")


folder = pathlib.Path(sys.argv[2])
folder.mkdir(parents=True, exist_ok=True)
if sys.argv[1] == "lattice":
    lattice(folder)
else:
    study(folder, pathlib.Path(sys.argv[3]), int(sys.argv[4]), int(sys.argv[5]))
