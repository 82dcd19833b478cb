#include "dem/exchange/liggghts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>

#include "data/atomic_file.hpp"
#include "data/file_name.hpp"
#include "data/origin.hpp"
#include "dem/bed/derived.hpp"
#include "dem/case/grains.hpp"
#include "dem/rig/drive.hpp"
#include "dem/rig/rig.hpp"
#include "dem/run/run.hpp"
#include "dem/walls/stl.hpp"

namespace dem {
namespace {

constexpr double steps_per_contact = 50.0;

/// The steps by which `script` writes and `read_liggghts` counts.
struct Clock {
  double step = 0.0;    ///< s
  double sample = 1.0;  ///< steps

  explicit Clock(const Case& c, const Derived& d)
      : step(d.contact_duration / steps_per_contact), sample(steps(c.run.sample_interval)) {}
  double steps(double time) const { return std::max(1.0, std::round(time / step)); }
};
constexpr std::size_t most_types = 40;  // of spheres: tables of properties have their square

/// A kind of sphere or a body.
struct Type {
  std::size_t material = 0;  ///< material of the bed, or the body's index
  double mass = 0.0;         ///< kg, 0 of a body
};

struct Types {
  std::vector<Type> of;           ///< spheres, then bodies
  std::size_t spheres = 0;        ///< types of spheres
  std::vector<std::size_t> each;  ///< per sphere, its type
};

Types types_of(const BuiltRig& rig) {
  Types types;
  std::map<std::pair<std::uint32_t, double>, std::size_t> known;
  const Grains& g = rig.grains;
  for (std::size_t i = 0; i < rig.position.size(); ++i) {
    const std::uint32_t material = g.material.empty() ? 0 : g.material[i];
    const double radius = g.radius.size() == 1 ? g.radius[0] : g.radius[i];
    const double density = g.density.size() == 1 ? g.density[0] : g.density[i];
    const auto [at, added] = known.try_emplace({material, radius}, types.of.size());
    if (added) types.of.push_back({material, 4.0 / 3.0 * std::numbers::pi * density * radius * radius * radius});
    types.each.push_back(at->second);
    if (types.of.size() > most_types)
      throw data::InputError(
          data::ExitStatus::bad_study,
          {"[materials]", "the spheres' sizes are drawn, and LIGGGHTS needs an atom type for each that is damped alike",
           "list sizes = [{ diameter, mass_fraction }, ...] instead of a distribution"});
  }
  types.spheres = types.of.size();
  for (std::size_t body = 0; body < rig.bodies.size(); ++body) types.of.push_back({body, 0.0});
  return types;
}

/// Values of all pairs of types, of those between bodies the first pair's: nothing reads them.
template <class Value>
std::string table(const Types& types, const BedCoefficients& bed, const Value& value) {
  std::string text;
  const std::size_t n = types.of.size(), bodies = n - types.spheres,
                    materials = static_cast<std::size_t>(bed.materials);
  for (std::size_t a = 0; a < n; ++a) {
    for (std::size_t b = 0; b < n; ++b) {
      const bool wall_a = a >= types.spheres, wall_b = b >= types.spheres;
      const Type &first = types.of[wall_a ? b : a], &second = types.of[wall_a ? a : b];
      if (wall_a && wall_b)
        text += fmt::format(" {:.12g}", value(bed.wall[0], types.of[0].mass));
      else if (wall_a || wall_b)
        text += fmt::format(" {:.12g}", value(bed.wall[first.material * bodies + second.material], first.mass));
      else
        text += fmt::format(" {:.12g}", value(bed.grain[first.material * materials + second.material],
                                              first.mass * second.mass / (first.mass + second.mass)));
    }
  }
  return text;
}

std::string properties(const Case& c, const Types& types, const BedCoefficients& bed) {
  std::string text;
  const std::size_t n = types.of.size();
  int number = 0;
  const auto pairs = [&](const char* name, const auto& value) {
    text += fmt::format("fix p{} all property/global {} peratomtypepair {}{}\n", ++number, name, n,
                        table(types, bed, value));
  };
  const auto each = [&](const char* name, const auto& value) {
    text += fmt::format("fix p{} all property/global {} peratomtype", ++number, name);
    for (std::size_t t = 0; t < n; ++t) text += fmt::format(" {:.12g}", value(t));
    text += "\n";
  };
  pairs("coefficientFriction", [](const PairCoefficients& p, double) { return p.friction; });
  if (c.contact.resistance == ResistanceLaw::constant)
    pairs("coefficientRollingFriction", [](const PairCoefficients& p, double) { return p.rolling_friction; });
  if (c.contact.normal == NormalLaw::linear) {
    const auto rate = [](const PairCoefficients& p, double mass) {
      return 2.0 * p.damping_ratio * std::sqrt(p.stiffness / mass);
    };
    pairs("kn", [](const PairCoefficients& p, double) { return p.stiffness; });
    pairs("kt", [](const PairCoefficients& p, double) { return p.tangential_stiffness; });
    pairs("gamman", rate);
    pairs("gammat", [&](const PairCoefficients& p, double mass) { return p.tangential_damping * rate(p, mass); });
    // LIGGGHTS asks for these two values, though the law does not use them.
    each("youngsModulus", [](std::size_t) { return 5e6; });
    each("poissonsRatio", [](std::size_t) { return 0.3; });
  } else {
    pairs("coefficientRestitution", [](const PairCoefficients& p, double) {
      const double z = p.damping_ratio;
      return std::exp(-std::numbers::pi * z / std::sqrt(std::max(1e-12, 1.0 - z * z)));
    });
    // LIGGGHTS combines the moduli of two types as dem/bed/bed.cpp does those of two materials.
    const std::vector<Component> parts = components_of(c);
    const std::vector<BodyLabel> bodies = body_labels(c);
    const auto of_type = [&](std::size_t t) {
      const std::size_t index = types.of[t].material;
      return t < types.spheres ? elastic(c, parts[index].material) : elastic(c, parts[0].material, bodies[index]);
    };
    each("youngsModulus", [&](std::size_t t) { return of_type(t).young_modulus; });
    each("poissonsRatio", [&](std::size_t t) { return of_type(t).poisson_ratio; });
  }
  return text;
}

/// The contact models as LIGGGHTS names them, for spheres and walls. Their settings follow; in a wall's command other
/// words stand in between.
std::string models(const Case& c) {
  std::string law = c.contact.normal == NormalLaw::linear ? "model hooke/stiffness" : "model hertz";
  law += " tangential history";
  if (c.contact.resistance == ResistanceLaw::constant) law += " rolling_friction cdt";
  return law;
}

std::string model_settings(const Case& c) {
  std::string settings;
  if (c.contact.normal == NormalLaw::linear) settings += " tangential_damping on";
  if (c.contact.tension == DashpotTension::clamped) settings += " limitForce on";
  return settings;
}

std::string data_file(const BuiltRig& rig, const Types& types) {
  // Meshes must lie inside a box that does not repeat.
  Vec3 low = rig.low, high = rig.high;
  const double margin = 0.01 * length(rig.high - rig.low);
  for (const auto& [axis, at] : {std::pair{0, &Vec3::x}, {1, &Vec3::y}, {2, &Vec3::z}}) {
    if (rig.periodic[axis]) continue;
    low.*at -= margin;
    high.*at += margin;
  }
  std::string text = fmt::format(
      "# {}\n\n{} atoms\n{} atom types\n\n{:.12g} {:.12g} xlo xhi\n{:.12g} {:.12g} ylo yhi\n{:.12g} "
      "{:.12g} zlo zhi\n\nAtoms\n\n",
      data::blank_mark(), rig.position.size(), types.of.size(), low.x, high.x, low.y, high.y, low.z, high.z);
  const Grains& g = rig.grains;
  for (std::size_t i = 0; i < rig.position.size(); ++i) {
    const Vec3& at = rig.position[i];
    text += fmt::format("{} {} {:.12g} {:.12g} {:.12g} {:.12g} {:.12g}\n", i + 1, types.each[i] + 1,
                        2.0 * (g.radius.size() == 1 ? g.radius[0] : g.radius[i]),
                        g.density.size() == 1 ? g.density[0] : g.density[i], at.x, at.y, at.z);
  }
  if (!rig.velocity.empty()) {
    text += "\nVelocities\n\n";
    for (std::size_t i = 0; i < rig.velocity.size(); ++i)
      text += fmt::format("{} {:.12g} {:.12g} {:.12g} 0 0 0\n", i + 1, rig.velocity[i].x, rig.velocity[i].y,
                          rig.velocity[i].z);
  }
  return text;
}

/// Every triangle shifted by box lengths to where its centre lies in the box: LIGGGHTS loses those that do not.
TriangleMesh in_box(const TriangleMesh& mesh, const BuiltRig& rig) {
  TriangleMesh moved;
  for (const auto& corners : mesh.triangles) {
    Vec3 centre;
    for (const auto corner : corners) centre += 1.0 / 3.0 * mesh.vertices[corner];
    Vec3 shift;
    for (const auto& [axis, at] : {std::pair{0, &Vec3::x}, {1, &Vec3::y}, {2, &Vec3::z}}) {
      const double period = rig.high.*at - rig.low.*at;
      if (rig.periodic[axis]) shift.*at = -period * std::floor((centre.*at - rig.low.*at) / period);
    }
    const auto first = static_cast<std::uint32_t>(moved.vertices.size());
    for (const auto corner : corners) moved.vertices.push_back(mesh.vertices[corner] + shift);
    moved.triangles.push_back({first, first + 1, first + 2});
  }
  return moved;
}

/// "m0", "m1": a name that LIGGGHTS takes, whatever the mesh is called.
std::string mesh_id(std::size_t body) { return fmt::format("m{}", body); }

std::string torque_of(const Sensor& sensor) {
  std::string text;
  for (const Driven& driven : sensor.driven) {
    const double axis[]{driven.torque_axis.x, driven.torque_axis.y, driven.torque_axis.z};
    for (int k = 0; k < 3; ++k)
      if (axis[k] != 0.0)
        text += fmt::format("{}{:.12g}*f_{}[{}]", text.empty() ? "" : "+", axis[k], mesh_id(driven.body), 4 + k);
  }
  return text;
}

std::string script(const Case& c, const Derived& d, const BuiltRig& rig, const Types& types,
                   const std::vector<std::string>& meshes) {
  const Clock clock(c, d);
  std::string text = fmt::format(
      "# {}\n# For LIGGGHTS 3.8: liggghts -in in.liggghts, or mpirun -np 2 liggghts -in in.liggghts\n"
      "# -var px N cuts the box into N parts along x; -var nset N and -var nrun N change the lengths.\n"
      "variable dt   index {:.12g}\nvariable nset index {:.0f}\nvariable nrun index {:.0f}\nvariable px   index *\n\n"
      "atom_style granular\natom_modify map array\nboundary {} {} {}\nnewton off\n"
      "communicate single vel yes\nunits si\nsoft_particles yes\nprocessors ${{px}} * *\nread_data bed.data\nneighbor {:.6g} "
      "bin\nneigh_modify delay 0\n\n",
      data::blank_mark(), clock.step, clock.steps(c.run.settle), clock.steps(c.run.longest),
      rig.periodic[0] ? "p" : "f", rig.periodic[1] ? "p" : "f", rig.periodic[2] ? "p" : "f", 0.25 * d.largest);
  text += properties(c, types, d.bed);
  text += fmt::format("\npair_style gran {}{}\npair_coeff * *\ntimestep ${{dt}}\n", models(c), model_settings(c));
  std::string all;
  for (std::size_t body = 0; body < meshes.size(); ++body) {
    const Vec3 p = rig.bodies[body].motion.point;
    text += fmt::format("fix {} all mesh/surface/stress file {} type {} reference_point {:.12g} {:.12g} {:.12g}\n",
                        mesh_id(body), meshes[body], types.spheres + body + 1, p.x, p.y, p.z);
    all += " " + mesh_id(body);
  }
  text += fmt::format("fix walls all wall/gran {} mesh n_meshes {} meshes{}{}\n", models(c), meshes.size(), all,
                      model_settings(c));
  const Vec3 down = rig.down;
  text += fmt::format("fix gravity all gravity {:.12g} vector {:.12g} {:.12g} {:.12g}\nfix move all nve/sphere\n",
                      c.run.gravity, down.x, down.y, down.z);
  text += fmt::format(
      "\ncompute ke all ke\ncompute rotation all erotate/sphere\ncompute contacts all contact/atom\n"
      "compute coordination all reduce ave c_contacts\nvariable torque equal {}\nvariable energy equal "
      "c_ke+c_rotation\n"
      "thermo_style custom step atoms c_ke v_torque cpu\nthermo 10000\nthermo_modify lost error norm no\n\n"
      "# The bed comes to rest; then the tool turns.\nrun ${{nset}}\nreset_timestep 0\n",
      torque_of(rig.sensor));
  for (std::size_t body = 0; body < meshes.size(); ++body) {
    const Motion& m = rig.bodies[body].motion;
    const double speed = m.programme.empty() ? 0.0 : m.programme.front().angular_velocity;
    if (speed == 0.0) continue;
    const double sign = speed > 0.0 ? 1.0 : -1.0;
    text += fmt::format(
        "fix turn{} all move/mesh mesh {} rotate origin {:.12g} {:.12g} {:.12g} axis {:.12g} {:.12g} {:.12g} period "
        "{:.12g}\n",
        body, mesh_id(body), m.point.x, m.point.y, m.point.z, sign * m.axis.x, sign * m.axis.y, sign * m.axis.z,
        2.0 * std::numbers::pi / std::abs(speed));
  }
  // LIGGGHTS averages every step; what is per sphere is taken once a sample.
  text += fmt::format(
      "fix torque all ave/time 1 {0:.0f} {0:.0f} v_torque file torque.dat\n"
      "fix state all ave/time {0:.0f} 1 {0:.0f} c_coordination v_energy file state.dat\nrun ${{nrun}}\n",
      clock.sample);
  return text;
}

/// Columns of a file of `fix ave/time` after the step, without what some of them write at step 0. The steps follow each
/// other evenly, or samples are lacking.
std::vector<std::vector<double>> averages(const std::string& path, std::size_t columns) {
  const std::string text = data::read_file(path);
  std::vector<std::vector<double>> found(columns);
  std::size_t line_number = 0;
  double last = 0.0, every = 0.0;  // steps
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find('\n', at), text.size());
    std::string line = text.substr(at, end - at);
    const bool whole = end < text.size();  // LIGGGHTS may be writing the last one
    at = end + 1;
    ++line_number;
    if (line.empty() || line[0] == '#' || !whole) continue;
    const char* place = line.c_str();
    char* next = nullptr;
    const double step = std::strtod(place, &next);
    if (next == place)
      throw data::InputError(data::ExitStatus::bad_data,
                             {fmt::format("{}:{}", path, line_number), fmt::format("'{}' begins with no step", line),
                              "let LIGGGHTS run the in.liggghts that lies beside it"});
    if (step == 0.0) continue;
    if (last > 0.0 && step - last != every && every > 0.0)
      throw data::InputError(
          data::ExitStatus::bad_data,
          {fmt::format("{}:{}", path, line_number),
           fmt::format("step {:.0f} comes after {:.0f}, but a sample every {:.0f} steps before: samples are lacking",
                       step, last, every),
           "let LIGGGHTS run without a break, and collect the folder again"});
    if (last > 0.0) every = step - last;
    last = step;
    for (std::size_t k = 0; k < columns; ++k) {
      place = next;
      const double value = std::strtod(place, &next);
      if (next == place || !std::isfinite(value))
        throw data::InputError(data::ExitStatus::bad_data,
                               {fmt::format("{}:{}", path, line_number), fmt::format("has no {} numbers", columns + 1),
                                "let LIGGGHTS run the in.liggghts that lies beside it"});
      found[k].push_back(value);
    }
  }
  return found;
}

}  // namespace

std::vector<std::string> write_liggghts(const Case& c, std::uint64_t seed, const std::string& folder) {
  if (std::vector<data::Problem> found = not_in_liggghts(c); !found.empty())
    throw data::InputError(data::ExitStatus::bad_study, std::move(found));
  const BuiltRig rig = build_rig(c, seed);
  if (std::any_of(rig.frozen.begin(), rig.frozen.end(), [](std::uint8_t held) { return held != 0; }))
    throw data::InputError(
        data::ExitStatus::bad_study,
        {"rig.packing", "holds spheres that do not move, which this export does not know", "make them a mesh"});
  const Types types = types_of(rig);
  const std::filesystem::path into(folder);
  std::vector<std::string> meshes;
  for (const NamedMesh& mesh : rig_meshes(c)) {
    meshes.push_back(data::file_name(mesh.name) + ".stl");
    write_stl(in_box(mesh.mesh, rig), (into / meshes.back()).string());
  }
  data::write_atomically((into / "bed.data").string(), data_file(rig, types));
  data::write_atomically((into / "in.liggghts").string(), script(c, derive(c), rig, types, meshes));
  std::vector<std::string> files{"in.liggghts", "bed.data"};
  files.insert(files.end(), meshes.begin(), meshes.end());
  return files;
}

Measured read_liggghts(const Case& c, const std::string& folder) {
  const std::filesystem::path from(folder);
  for (const char* file : {"torque.dat", "state.dat"})
    if (!std::filesystem::exists(from / file))
      throw data::InputError(data::ExitStatus::missing_input,
                             {(from / file).string(), "is not there: LIGGGHTS has not run in this folder",
                              "run it there first: liggghts -in in.liggghts"});
  Series series;
  auto torque = averages((from / "torque.dat").string(), 1);
  auto state = averages((from / "state.dat").string(), 2);
  const std::size_t samples = std::min(torque[0].size(), state[0].size());
  if (samples == 0)
    throw data::InputError(data::ExitStatus::bad_data, {(from / "torque.dat").string(), "holds no sample yet",
                                                        "let LIGGGHTS run until the tool has turned"});
  const auto first = [&](const std::vector<double>& all) {
    return std::vector<double>(all.begin(), all.begin() + static_cast<std::ptrdiff_t>(samples));
  };
  series.torque = first(torque[0]);
  series.coordination = first(state[0]);
  series.kinetic_energy = first(state[1]);
  const Clock clock(c, derive(c));
  const double sample = clock.sample * clock.step;
  for (std::size_t k = 1; k <= samples; ++k) series.time.push_back(static_cast<double>(k) * sample);
  return measure(look_rule(c.run, sample, turn_of(c)), series, samples);
}

}  // namespace dem
