#include "asked.hpp"

#include <regex>

#include "data/error.hpp"
#include "data/plan.hpp"
#include "data/study.hpp"
#include "dem/reading/read_case.hpp"
#include "dem/rig/slice.hpp"
#include "dem/walls/stl.hpp"
#include "tests/temporary.hpp"
#include "uq/emulate/surrogate_settings.hpp"

namespace keys {
namespace {

const char* const common = R"(
[study]
name = "all"
seed = 1
description = "every key"
notes = ["one"]
[parameters.NAME]
target = "contact.friction"
unit = "1"
low = 0.1
high = 0.8
scale = "linear"
prior = { kind = "uniform", low = 0.1, high = 0.8 }
[parameters.NAME2]
target = "contact.restitution"
low = 0.1
high = 0.8
prior = { kind = "truncated_normal", mean = 0.4, sd = 0.1 }
[parameters.NAME3]
target = "contact.tangential_ratio"
low = 0.1
high = 0.8
prior = { kind = "beta", alpha = 2, beta = 2 }
[parameters.NAME4]
target = "contact.tangential_damping"
low = 0.1
high = 0.8
prior = { kind = "log_normal", median = 0.4, sd = 0.1 }
[parameters.NAME5]
target = "contact.tangential_damping"
low = 0.1
high = 0.8
prior = { kind = "log_normal", mean = 0.4, sd = 0.1 }
[controls.NAME6]
target = "rig.rpm"
unit = "rpm"
low = 50
high = 300
uncertainty = { sd = "1 rpm", as = "covariance" }
[controls.NAME8]
target = "rig.fill"
low = 100
high = 300
[outputs.NAME7]
unit = "uN m"
[training]
runs = 48
standard_error = 0.03
table = "runs.csv"
low = "low.csv"
leave_out = [3]
engine = "demcal"
[surrogate]
kernel = "matern 5/2"
mean = "constant"
estimate = "maximum a posteriori"
hyper_parameters = "plugged in"
between_runs = "doubted"
nugget = true
stretch = true
starts = 4
runs_most = 1000
log_outputs = []
[[observe]]
name = "bench"
material = "NAME"
file = "bench.csv"
rig = "machine"
settings = { NAME8 = 200 }
common_error = { NAME7 = "2 %" }
meter = "cell"
uncertainty = { NAME6 = { sd = "1 rpm", as = "covariance" } }
[[observe]]
name = "bench2"
material = "NAME"
file = "bench.csv"
settings = { NAME8 = 200 }
common_error = 0.02
uncertainty = { NAME6 = "1 rpm" }
correlation = [{ between = ["NAME7", "NAME7"], with = "bench", value = 0.5 }]
[[calibrate]]
name = "one"
observe = ["bench"]
free = ["NAME", "NAME2"]
fixed = { NAME3 = 0.4 }
compare = { NAME2 = 0.5 }
priors = { NAME = { posterior = "two", cut = true } }
offset = { output = "NAME7", mean = "0 uN m", sd = "1 uN m", low = "-5 uN m", high = "5 uN m" }
gain = { output = "NAME7", kind = "log_normal", median = 1, sd = 0.02 }
noise = { absolute = true, output = "NAME7", kind = "uniform", low = "1 uN m", high = "2 uN m" }
discrepancy = { sd = 0.1, length = 0.5, output = "NAME7" }
sampler = "nuts"
[[calibrate]]
name = "two"
observe = ["bench2"]
free = ["NAME"]
noise = "unknown"
discrepancy = true
[[calibrate]]
name = "three"
material = "NAME"
free = ["NAME"]
[[predict]]
name = "one"
case = "one"
observe = ["bench2"]
[plan]
about = "NAME"
cost_unit = "h"
[[plan.candidates]]
name = "one"
material = "NAME"
outputs = ["NAME7"]
settings = { NAME6 = 200, NAME8 = [200] }
together = true
readings = 2
error = "3 %"
common_error = "1 %"
cost = 2
[[plan.candidates]]
name = "two"
settings = { NAME6 = [100, 200] }
meter = "cell"
[contact]
normal = "linear"
tangential = "linear"
resistance = "spring"
cohesion = "van_der_waals"
tension = "allowed"
cap = "net"
hamaker_of = "simulation"
hamaker_power = 3
length_scale = "diameter"
wall_attraction = "as_grains"
restitution_at = "0.1 m/s"
stiffness = "300 N/m"
wall_stiffness = "300 N/m"
young_modulus = "1 MPa"
wall_young_modulus = "1 MPa"
poisson_ratio = 0.3
restitution = 0.7
wall_restitution = 0.7
tangential_ratio = 0.3
tangential_damping = 0.3
friction = 0.4
wall_friction = 0.4
rolling_friction = 0.1
wall_rolling_friction = 0.1
twisting_friction = 0.1
rolling_stiffness_ratio = 0.1
rolling_damping = 0.1
hamaker = "1e-18 J"
wall_hamaker = "1e-18 J"
minimum_separation = "1.5 nm"
cut_off = "100 nm"
work_of_adhesion = "0.1 J/m2"
wall_work_of_adhesion = "0.1 J/m2"
true_stiffness = "1e6 N/m"
true_young_modulus = "1 GPa"
[[contact.pair]]
between = ["NAME", "wall"]
stiffness = "300 N/m"
restitution = 0.7
friction = 0.4
rolling_friction = 0.1
twisting_friction = 0.1
hamaker = "1e-18 J"
work_of_adhesion = "0.1 J/m2"
[run]
gravity = "9.81 m/s2"
steps_per_contact = 30
time_step = "5 us"
overlap_limit = 0.1
skin = 0.12
settle = "0.08 s"
start_up = "0.2 s"
start_up_turns = 0.25
sample_interval = "0.2 ms"
window = "20 ms"
shortest = "0.3 s"
shortest_turns = 2
longest = "6 s"
[materials.NAME]
density = "6090 kg/m3"
sizes = [{ diameter = "0.8 mm", mass_fraction = 1 }]
coarse_graining = 1
powder = "grain"
fill = 100
runs = 10
fixed = { NAME5 = 0.4 }
[materials.NAME.contact]
friction = 0.4
)";

const char* const slice = R"(
[rig]
kind = "slice"
shaft_radius = "2.5 mm"
blade_radius = "6 mm"
blade_thickness = "1 mm"
trough_radius = "8.4 mm"
pitch = "12 mm"
pitches = 1
rpm = "150 rpm"
fill = 2400
scale = 5
)";

const char* const drum = R"(
[rig]
kind = "drum"
drum_radius = "42 mm"
drum_length = "20 mm"
end_plates = "turning"
level = 0.5
rpm = "15 rpm"
)";

const char* const machine = R"(
[rig]
kind = "machine"
fill = "4 g"
machine_length = "66 mm"
opening = "12 mm"
partition = "1 mm"
partition_height = "12 mm"
sill = "-3.5 mm"
)";

const char* const meshes = R"(
[materials.NAME2]
components = [{ material = "NAME3", mass_fraction = 1 }]
[materials.NAME3]
density = "2500 kg/m3"
diameter = "1 mm"
[materials.NAME4]
fill = "4 g"
density = "2500 kg/m3"
distribution = { kind = "log_normal", median = "0.8 mm", geometric_sd = 1.2, low = "0.5 mm", high = "1.2 mm" }
[rig]
kind = "stl"
rpm = "150 rpm"
fill = 400
scale = { mean = 5, sd = 0.5 }
down = [0, 0, -1]
packing = "packing.csv"
packing_unit = "mm"
torque_of = "mixer"
[rig.box]
low = ["0 mm", "-7.1 mm", "-7.1 mm"]
high = ["12 mm", "7.1 mm", "60 mm"]
periodic = ["x"]
[rig.region]
from = ["0 mm", "0 mm", "0 mm"]
to = ["12 mm", "0 mm", "0 mm"]
radius = "7 mm"
inner_radius = "1 mm"
low = ["0 mm", "-7.1 mm", "-7.1 mm"]
high = ["12 mm", "7.1 mm", "30 mm"]
[[rig.mesh]]
name = "mixer"
material = "steel"
file = "mixer.stl"
unit = "m"
axis = [1, 0, 0]
point = ["0 mm", "0 mm", "0 mm"]
speed_ratio = 1
rpm = "100 rpm"
programme = { time = ["0 s"], speed = ["100 rpm"] }
[[rig.mesh.oscillation]]
about = [1, 0, 0]
amplitude = "10 degree"
frequency = "5 Hz"
phase = "0 degree"
[[rig.mesh.oscillation]]
along = [1, 0, 0]
amplitude = "1 mm"
frequency = "5 Hz"
)";

void collect(const std::string& text, Asked& all) {
  const TemporaryFolder folder;
  dem::write_stl(dem::auger_mesh({}), folder.path("mixer.stl"));
  folder.write("packing.csv", "x,y,z\n1,1,-3\n");
  folder.write("bench.csv", "NAME6,NAME7,NAME7_se\n150,1,0.1\n200,1,0.1\n");
  folder.write("study.toml", text);
  const data::StudyFile file = data::StudyFile::open(folder.path());
  const data::Study study = data::read_study(file);
  uq::read_surrogate_options(file, study);
  data::read_plan(file, study);
  for (const data::Material& material : study.materials) dem::read_case(file, material.name);
  for (const auto& [name, how] : file.asked()) {
    const auto [known, is_new] = all.asked.emplace(reference_name(name), how);
    std::string& type = known->second.type;
    if (is_new || type.find(how.type) != std::string::npos || how.type == "text") continue;
    if (type == "text")
      known->second = how;
    else
      type += " or " + how.type;
    if (known->second.unit.empty()) known->second.unit = how.unit;
  }
  for (const std::string& name : file.looked_for()) all.looked_for.insert(reference_name(name));
}

}  // namespace

std::string reference_name(const std::string& dotted) {
  std::string name = std::regex_replace(dotted, std::regex("NAME[0-9]+"), "NAME");
  name = std::regex_replace(name, std::regex("\\.[0-9]+(?=\\.|$)"), "");
  name = std::regex_replace(
      name,
      std::regex("^(observe|calibrate|rig\\.mesh|plan\\.candidates|predict)\\.(bench2|bench|one|two|three|mixer)"),
      "$1");
  name = std::regex_replace(name, std::regex("^materials\\.NAME\\.contact\\."), "contact.");
  // Priors have the same keys wherever they stand.
  name = std::regex_replace(name,
                            std::regex("^(calibrate\\.priors\\.NAME|calibrate\\.(offset|gain|noise)|rig\\.scale)\\."
                                       "(kind|mean|median|sd|low|high|alpha|beta)$"),
                            "parameters.NAME.prior.$3");
  name = std::regex_replace(name, std::regex("^(calibrate\\.(offset|gain|noise)|rig\\.scale)\\.(posterior|cut)$"),
                            "calibrate.priors.NAME.$3");
  return name;
}

Asked asked_by_the_readers() {
  Asked all;
  collect(std::string(common) + slice, all);
  collect(std::string(common) + drum, all);
  collect(std::string(common) + machine, all);
  const std::string cylinder = std::string(common) + meshes;
  collect(cylinder, all);
  const std::string one = "torque_of = \"mixer\"";
  collect(std::string(cylinder).replace(cylinder.find(one), one.size(), "torque_of = [\"mixer\"]"), all);
  const std::string radius = "\nradius = \"7 mm\"";
  collect(std::string(cylinder).erase(cylinder.find(radius), radius.size()), all);
  return all;
}

}  // namespace keys
