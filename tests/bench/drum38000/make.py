#!/usr/bin/env python3
"""Makes the rotating drum of M. Dosta et al., Comput. Phys. Commun. 296:109066 (2024), as a study and for LIGGGHTS:
make.py FOLDER [--from DOWNLOADED] writes drum.stl, packing.csv and study.toml, and of the same numbers data.drum.

Start and walls are the paper's own, PartCoordinates.txt and walls.txt of Drivers/Papers/OSBenchmark/Drum in MercuryDPM;
without --from they are the copies beside this script."""
import argparse, lzma, math, pathlib

here = pathlib.Path(__file__).resolve().parent
RPM = 60.0 / math.pi  # 2 rad/s about -y: the wall rises at +x
DENSITY = {0.001: 2500.0, 0.002: 2000.0}  # kg/m3 by radius: M1, M2


def rows(downloaded, name):
    """The numbers below the line of headings."""
    path = downloaded / name if downloaded else here / (name + ".xz")
    with (open if downloaded else lzma.open)(path, "rt") as file:
        return [list(map(float, line.split())) for line in file.readlines()[1:] if line.strip()]


def write_stl(path, triangles):
    with open(path, "w") as out:
        out.write("solid drum\n")
        for t in triangles:
            a, b, c = t[0:3], t[3:6], t[6:9]
            u, v = [b[k] - a[k] for k in range(3)], [c[k] - a[k] for k in range(3)]
            n = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]]
            size = math.sqrt(sum(q * q for q in n))
            out.write("facet normal %.9e %.9e %.9e\nouter loop\n" % tuple(q / size for q in n))
            for corner in (a, b, c):
                out.write("vertex %.9g %.9g %.9g\n" % tuple(corner))
            out.write("endloop\nendfacet\n")
        out.write("endsolid drum\n")


parser = argparse.ArgumentParser(description=__doc__.split("\n")[0])
parser.add_argument("folder", type=pathlib.Path)
parser.add_argument("--from", dest="downloaded", type=pathlib.Path, help="folder of PartCoordinates.txt and walls.txt")
options = parser.parse_args()
folder = options.folder
folder.mkdir(parents=True, exist_ok=True)
write_stl(folder / "drum.stl", rows(options.downloaded, "walls.txt"))
spheres = rows(options.downloaded, "PartCoordinates.txt")

with open(folder / "packing.csv", "w") as out:
    out.write("x,y,z,diameter\n")
    for radius, x, y, z in spheres:
        out.write(f"{x!r},{y!r},{z!r},{2 * radius!r}\n")
with open(folder / "data.drum", "w") as out:  # types: M1, M2, steel
    out.write(f"drum\n\n{len(spheres)} atoms\n3 atom types\n\n-0.105 0.105 xlo xhi\n-0.036 0.036 ylo yhi\n"
              "-0.105 0.105 zlo zhi\n\nAtoms\n\n")
    for k, (radius, x, y, z) in enumerate(spheres, 1):
        out.write(f"{k} {1 if radius == 0.001 else 2} {2 * radius!r} {DENSITY[radius]!r} {x!r} {y!r} {z!r}\n")

mass = {radius: sum(s[0] == radius for s in spheres) * density * radius**3 for radius, density in DENSITY.items()}
share = mass[0.001] / sum(mass.values())
(folder / "study.toml").write_text(f"""[study]
name = "drum38000"
seed = 1
description = "The rotating drum of a comparison of open-source DEM codes"

[rig]
kind = "stl"
rpm = "{RPM!r} rpm"
packing = "packing.csv"

[rig.box]
low = ["-105 mm", "-36 mm", "-105 mm"]
high = ["105 mm", "36 mm", "105 mm"]

[[rig.mesh]]
name = "drum"
file = "drum.stl"
unit = "m"
axis = [0, -1, 0]
speed_ratio = 1

[materials.mixture]
components = [{{ material = "M1", mass_fraction = {share!r} }}, {{ material = "M2", mass_fraction = {1 - share!r} }}]

[materials.M1]
density = "2500 kg/m3"
diameter = "2 mm"
contact = {{ young_modulus = "1 GPa" }}

[materials.M2]
density = "2000 kg/m3"
diameter = "4 mm"
contact = {{ young_modulus = "0.5 GPa" }}

[contact]
normal = "hertz"
wall_young_modulus = "210 GPa"
poisson_ratio = 0.2
restitution = 0.5        # of M1 with M1
friction = 0.3
wall_restitution = 0.4
tangential_damping = 1   # as LIGGGHTS has it
tension = "allowed"

[[contact.pair]]
between = ["M2", "M2"]
restitution = 0.4
friction = 0.4

[[contact.pair]]
between = ["M1", "M2"]
restitution = 0.45
friction = 0.2

[run]
gravity = "9.81 m/s2"
time_step = "0.8 us"
settle = "0 s"           # the packing is at rest
start_up = "0 s"
start_up_turns = 0
sample_interval = "0.5 ms"
shortest_turns = 0
longest = "5 s"

[training]
standard_error = 1e-6    # never reached: the run is as long as `longest` says

[parameters.wall_friction]   # the middle of its range, 0.2, is what `demcal simulate` takes
target = "contact.wall_friction"
low = 0.1
high = 0.3

[outputs.torque]
unit = "mN m"

[outputs.kinetic_energy]
unit = "mJ"

[outputs.coordination]

[outputs.centre_x]
unit = "mm"

[outputs.centre_z]
unit = "mm"
""")
