// demcal new: a commented study for the user's own rig and powder.
#include <fmt/core.h>

#include <algorithm>
#include <filesystem>

#include "campaign/placeholder.hpp"
#include "cli/command.hpp"
#include "data/atomic_file.hpp"
#include "data/file_name.hpp"
#include "data/terminal.hpp"

namespace cli {
namespace fs = std::filesystem;
namespace {

constexpr const char* study_template =
    R"(# A study for demcal. Values carry units as text; a bare number is dimensionless or in the section's unit.
# demcal check {0}       reads it and names every mistake
# demcal simulate {0}    one run, to see that the rig does what you expect
# demcal train {0}       makes the training runs
# demcal calibrate {0}   gives the report

[study]
name = "{1}"
seed = 1
description = "Which of friction and Hamaker constant does the measured torque determine?"
notes = []                     # choices your source does not give; the report shows them beside the verdicts

[rig]                          # one pitch of an auger in an open trough, periodic along its axis
kind = "slice"
shaft_radius = "2.5 mm"
blade_radius = "6 mm"
blade_thickness = "1 mm"
trough_radius = "8.4 mm"        # grains pass between blade and trough uncrushed: three diameters clear
pitch = "12 mm"
fill = 2400                    # spheres in the box, or their mass: "4 g"

# The machine that circulates the powder: kind = "machine", two such augers in a double trough; machine_length, opening, sill.
# A rotating drum: kind = "drum", drum_radius, drum_length, end_plates, and level (the bed's share of its volume) or fill.
# Your own machine: kind = "stl", [rig.box] low, high, periodic = ["x"], and for each STL file from CAD a table
# [[rig.mesh]]: name, file, unit = "mm", and for what the study's rpm turns axis = [1, 0, 0], point, speed_ratio = 1.

[materials.powder]
density = "6090 kg/m3"
# Of the simulated spheres. No powder has equal grains, and a bed of equal spheres orders while it turns: its torque
# falls for seconds. A spread of a tenth keeps it from that.
sizes = [{{ diameter = "0.72 mm", mass_fraction = 0.3333 }}, {{ diameter = "0.80 mm", mass_fraction = 0.3334 }}, {{ diameter = "0.88 mm", mass_fraction = 0.3333 }}]
coarse_graining = 1            # their diameter over that of the real grains
# Instead: diameter = "0.8 mm" for all, or distribution = {{ kind = "log_normal", median = "0.8 mm", geometric_sd = 1.2, low = "0.5 mm", high = "1.2 mm" }}.
# A bed of several: [materials.mix] components = [{{ material = "sand", mass_fraction = 0.7 }}, ...], and a table for each.

[contact]                      # of all contacts; wall_KEY of those with bodies, which follows KEY unless given
normal = "linear"              # or hertz, jkr: then young_modulus, poisson_ratio instead of stiffness
stiffness = "300 N/m"
restitution = 0.7              # without attraction; with restitution_at = "0.1 m/s" at that speed, attraction included
resistance = "none"            # constant, spring: rolling_friction, twisting_friction stand in for the grains' shape
cohesion = "van_der_waals"     # or dmt: then work_of_adhesion (J/m2) instead of hamaker
minimum_separation = "1.5 nm"  # only hamaker / minimum_separation^2 matters
# wall_friction = 0.3
# [[contact.pair]]             # what two materials, or one and a mesh, its material or "wall", have of their own
# between = ["powder", "wall"]
# restitution = 0.5

[run]                          # each run ends when its mean torque is known well enough and is that of the steady flow
shortest = "1 s"               # measured at least, after the start-up, and
shortest_turns = 2             # turns at least
longest = "6 s"                # of turning; a run that is not steady by then says so and trains nothing

[parameters.friction]          # what is to be calibrated
target = "contact.friction"
low = 0.1
high = 0.8
prior = {{ kind = "uniform" }}   # also log_uniform, normal, truncated_normal, log_normal, beta

[parameters.hamaker]
target = "contact.hamaker"
unit = "J"
low = 0
high = 1.5e-17

[controls.rpm]                 # what the experiment sets
target = "rig.rpm"
unit = "rpm"
low = 50
high = 300

[outputs.torque]
unit = "uN m"

[training]
runs = 48
standard_error = 0.03          # wanted of each run's mean torque, relative
unsteady = "leave_out"         # or use: the runs that are not of the steady flow

[[observe]]                    # your measurement: a CSV with the columns rpm, torque, torque_se, or torque [mN m]
name = "bench"
material = "powder"
file = "bench.csv"

[[calibrate]]
name = "powder"
observe = ["bench"]
free = ["friction", "hamaker"]

# [plan]                     # what could be measured next (demcal plan); without it, every speed and every output
# [[plan.candidates]]
# settings = {{ rpm = ["250 rpm", "300 rpm"] }}
# outputs = ["torque"]
# error = "2 %"              # of one reading
# cost = 1                   # of one reading, in any unit
)";

}  // namespace

Action add_new(CLI::App& program) {
  const auto folder = std::make_shared<std::string>();
  CLI::App* command = program.add_subcommand("new", "a commented study for your own rig and powder");
  command->add_option("FOLDER", *folder, "made by this command")->required();
  command->footer("Example: demcal new my-mixer");
  return [folder] {
    if (folder->find_first_not_of(" \t") == std::string::npos)
      throw data::InputError(data::ExitStatus::usage, {"FOLDER", "is empty", "give the new folder a name"});
    const fs::path path = fs::absolute(*folder).lexically_normal();
    const fs::path study = path / "study.toml";
    std::error_code unseen;
    if (fs::exists(path, unseen) && !fs::is_directory(path, unseen))
      throw data::InputError(data::ExitStatus::cannot_write,
                             {path.string(), "is there already, and no folder", "give the new folder another name"});
    for (const fs::path& file : {study, path / "bench.csv"}) {
      std::error_code failure;
      const fs::file_type there = fs::symlink_status(file, failure).type();
      if (there != fs::file_type::not_found)
        throw data::InputError(
            data::ExitStatus::cannot_write,
            {file.string(), failure ? "cannot be looked for: " + failure.message() : "is there already",
             "choose another folder, or move it away first"});
    }
    const std::string name = data::file_name((path.has_filename() ? path : path.parent_path()).filename().string());
    std::string hint = data::shell_word(*folder);
    std::replace(hint.begin(), hint.end(), '\n', ' ');  // it stands in a comment
    data::write_atomically((path / "bench.csv").string(), placeholder_torque());
    data::write_atomically(study.string(),
                           std::string_view(fmt::format(fmt::runtime(study_template), data::printable(hint), name)));
    data::print_answer(
        fmt::format("{}: edit it, put your torque into bench.csv, then: demcal check {}", study.string(), hint));
    return data::ExitStatus::done;
  };
}

}  // namespace cli
