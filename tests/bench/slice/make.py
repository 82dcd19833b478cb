#!/usr/bin/env python3
"""Makes the benchmark slice as a study: make.py PITCHES FOLDER writes auger.stl, tube.stl and data.init (slice_mesh.py;
5,000 spheres a pitch) and, of the same numbers, positions.csv and study.toml."""
import math, pathlib, subprocess, sys

pitches, folder = int(sys.argv[1]), pathlib.Path(sys.argv[2])
here = pathlib.Path(__file__).resolve().parent
subprocess.run([sys.executable, here / "slice_mesh.py", str(pitches), str(5000 * pitches), folder], check=True)

atoms = (folder / "data.init").read_text().split("Atoms")[1].split("\n")
rows = [line.split()[4:7] for line in atoms if line.strip()]
(folder / "positions.csv").write_text("x,y,z\n" + "".join(",".join(row) + "\n" for row in rows))

# The law of in.slice: 200 N/m, damping 1050 m/2 per second between spheres. Its restitution, and the steps in a contact
# that make the time step 1e-5 s, follow from demcal's own formulas (dem/bed/derived.cpp).
stiffness, mass, gamma, step = 200.0, 6090.0 * math.pi / 6.0 * 0.8e-3**3, 1050.0, 1e-5
frequency = math.sqrt(2.0 * stiffness / mass)
zeta = 0.5 * gamma / frequency
restitution = math.exp(-math.pi * zeta / math.sqrt(1.0 - zeta**2))
steps = math.pi / (frequency * math.sqrt(1.0 - zeta**2)) / step

(folder / "study.toml").write_text(f"""[study]
name = "slice-{pitches}"
seed = 1
description = "The auger slice that LIGGGHTS runs too"

[rig]
kind = "stl"
rpm = "150 rpm"
packing = "positions.csv"

[rig.box]
low = ["0 mm", "-10.5 mm", "-10.5 mm"]
high = ["{20 * pitches} mm", "10.5 mm", "10.5 mm"]
periodic = ["x"]

[[rig.mesh]]
name = "auger"
file = "auger.stl"
unit = "m"
axis = [1, 0, 0]
speed_ratio = 1

[[rig.mesh]]
name = "tube"
file = "tube.stl"
unit = "m"

[materials.grain]
density = "6090 kg/m3"
diameter = "0.8 mm"

[contact]
stiffness = "{stiffness} N/m"
restitution = {restitution!r}
tension = "allowed"

[run]
steps_per_contact = {steps!r}
skin = 0.25
overlap_limit = 0.5      # 200 N/m is soft for this rig; LIGGGHTS lets spheres pass as deep
settle = "0 s"
start_up = "0.5 s"
sample_interval = "2 ms"
shortest = "1 s"
longest = "1.5 s"

[training]
standard_error = 1e-6    # never reached: the run is as long as `longest` says

[parameters.friction]    # the middle of its range, 0.4, is what `demcal simulate` takes
target = "contact.friction"
low = 0.3
high = 0.5

[controls.rpm]           # 150 alike
target = "rig.rpm"
unit = "rpm"
low = 100
high = 200

[outputs.torque]
unit = "uN m"

[outputs.axial_flow]
unit = "g/s"
""")
