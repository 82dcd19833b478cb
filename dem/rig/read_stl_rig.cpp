#include "dem/rig/read_stl_rig.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <numeric>
#include <optional>

#include "data/csv.hpp"
#include "data/hash.hpp"
#include "dem/walls/stl.hpp"

namespace dem {
namespace {

using data::Section;

/// Three quantities; nothing when the key is missing or wrong, which is then recorded.
std::optional<Vec3> read_vector(const Section& s, std::string_view key, std::string_view unit) {
  if (!s.has(key)) return {};
  const std::vector<double> v = s.quantities(key, unit, data::any_number);
  if (v.size() == 3) return Vec3{v[0], v[1], v[2]};
  if (s.kind(key) != data::ValueKind::other) return {};  // no list: recorded as such
  s.problem(key, fmt::format("has {} numbers", v.size()), "give three: x, y, z");
  return {};
}

Vec3 demand_vector(const Section& s, std::string_view key, std::string_view unit, std::string_view example) {
  if (!s.has(key)) s.problem(key, "is missing", fmt::format("add a line like {} = {}", key, example));
  return read_vector(s, key, unit).value_or(Vec3{});
}

Vec3 read_direction(const Section& s, std::string_view key, Vec3 fallback) {
  const Vec3 v = read_vector(s, key, "1").value_or(fallback);
  if (length(v) > 0.0) return unit(v);
  s.problem(key, "is no direction", "give a vector that is not zero");
  return fallback;
}

data::Unit read_unit(const Section& s, std::string_view key, const std::optional<std::string>& fallback) {
  const std::string name = s.text(key, fallback);
  try {
    if (data::convertible(name, "m")) return data::parse_unit(name);
  } catch (const std::invalid_argument&) {
  }
  if (!name.empty()) s.problem(key, fmt::format("'{}' is not a length", name), "give a unit like \"mm\"");
  return data::parse_unit("m");
}

std::string from_folder(const std::string& folder, const std::string& file) {
  return (std::filesystem::path(folder) / file).lexically_normal().string();
}

/// Records the problems of a file as problems of the key that names it.
void record(const Section& s, std::string_view key, const data::InputError& error) {
  for (const data::Problem& p : error.problems) s.problem(key, fmt::format("{} {}", p.place, p.what), p.remedy);
}

Oscillation read_oscillation(const Section& s) {
  Oscillation o;
  o.kind = s.has("about") ? OscillationKind::about : OscillationKind::along;
  const bool about = o.kind == OscillationKind::about;
  if (about && s.has("along")) s.problem("along", "stands beside about", "keep one of them");
  o.axis = read_direction(s, about ? "about" : "along", o.axis);
  o.amplitude = s.quantity("amplitude", about ? "rad" : "m", data::non_negative);
  o.frequency = s.quantity("frequency", "Hz", data::positive);
  o.phase = s.quantity("phase", "rad", data::any_number, 0.0);
  return o;
}

std::vector<SpeedPoint> read_programme(const Section& s) {
  const std::vector<double> time = s.quantities("time", "s", data::non_negative);
  const std::vector<double> speed = s.quantities("speed", "rad/s", data::any_number);
  if (time.empty() || time.size() != speed.size()) {
    s.problem("time", fmt::format("has {} entries and speed {}", time.size(), speed.size()),
              "give as many times as speeds, at least one");
    return {};
  }
  std::vector<SpeedPoint> programme;
  for (std::size_t k = 0; k < time.size(); ++k) {
    programme.push_back({time[k], speed[k]});
    if (k > 0 && !(time[k] > time[k - 1]))
      s.problem("time", fmt::format("goes from {:g} to {:g} s", time[k - 1], time[k]), "give ascending times");
  }
  return programme;
}

void read_motion(const Section& s, RigMesh& mesh) {
  mesh.motion.axis = read_direction(s, "axis", mesh.motion.axis);
  mesh.motion.point = read_vector(s, "point", "m").value_or(Vec3{});
  const int ways = s.has("speed_ratio") + s.has("rpm") + s.has("programme");
  if (ways > 1) s.problem("", "has more than one of speed_ratio, rpm and programme", "keep one of them");
  mesh.speed_ratio = s.number("speed_ratio", data::any_number, 0.0);
  if (s.has("rpm")) mesh.motion.programme = {{0.0, s.quantity("rpm", "rad/s", data::any_number)}};
  if (s.has("programme")) mesh.motion.programme = read_programme(s.child("programme"));
  for (const Section& o : s.array("oscillation")) mesh.motion.oscillations.push_back(read_oscillation(o));
}

/// The tables of the meshes that were read, in their order.
std::vector<Section> read_meshes(const Section& rig, const std::string& folder, StlRig& r) {
  std::vector<Section> tables;
  for (const Section& s : rig.array("mesh")) {
    RigMesh mesh;
    mesh.name = s.text("name");
    for (const RigMesh& other : r.meshes) {
      if (other.name == mesh.name)
        s.problem("name", fmt::format("'{}' is taken by another mesh", mesh.name), "give each mesh a name of its own");
    }
    mesh.material = s.text("material", "wall");
    const std::string file = s.text("file");
    const double scale = read_unit(s, "unit", {}).factor;
    read_motion(s, mesh);
    if (file.empty()) continue;
    try {
      CheckedMesh checked = check_mesh(read_stl(from_folder(folder, file), scale), mesh.name, periods(r));
      mesh.mesh = std::move(checked.mesh);
      mesh.tolerance = checked.tolerance;
      r.warnings.insert(r.warnings.end(), checked.warnings.begin(), checked.warnings.end());
    } catch (const data::InputError& error) {
      record(s, "file", error);
      continue;
    }
    r.meshes.push_back(std::move(mesh));
    tables.push_back(s);
  }
  return tables;
}

void read_box(const Section& s, StlRig& r) {
  r.low = demand_vector(s, "low", "m", R"(["0 mm", "-10 mm", "-10 mm"])");
  r.high = demand_vector(s, "high", "m", R"(["20 mm", "10 mm", "10 mm"])");
  for (const std::string& axis : s.texts("periodic")) {
    if (axis == "x" || axis == "y" || axis == "z") {
      r.periodic[static_cast<std::size_t>(axis[0] - 'x')] = true;
    } else {
      s.problem("periodic", fmt::format("'{}' is no axis", axis), R"(list some of "x", "y", "z")");
    }
  }
}

void read_region(const Section& s, StlRig& r) {
  FillRegion& region = r.region;
  if (s.has("radius")) {
    region.shape = FillRegion::Shape::cylinder;
    region.from = demand_vector(s, "from", "m", R"(["0 mm", "0 mm", "0 mm"])");
    region.to = demand_vector(s, "to", "m", R"(["20 mm", "0 mm", "0 mm"])");
    region.radius = s.quantity("radius", "m", data::positive);
    region.inner_radius = s.quantity("inner_radius", "m", data::non_negative, 0.0);
    if (!(length(region.to - region.from) > 0.0)) s.problem("to", "is the same point as from", "move one of them");
  } else {
    region.low = read_vector(s, "low", "m").value_or(r.low);
    region.high = read_vector(s, "high", "m").value_or(r.high);
  }
}

/// Spheres of several sizes come largest first, as those of a bed do (dem/case/grains.hpp).
void sort_by_size(StlRig& r) {
  std::vector<std::size_t> order(r.diameter.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return r.diameter[a] > r.diameter[b]; });
  const auto sort = [&](auto& rows) {
    auto sorted = rows;
    for (std::size_t k = 0; k < rows.size(); ++k) sorted[k] = rows[order[k]];
    rows = std::move(sorted);
  };
  sort(r.packing);
  sort(r.packing_line);
  sort(r.velocity);
  sort(r.frozen);
  sort(r.diameter);
}

void read_packing(const Section& s, const std::string& folder, StlRig& r) {
  const data::Unit usual = read_unit(s, "packing_unit", "m");
  const std::string file = s.text("packing", "");
  if (file.empty()) return;
  try {
    const data::Csv csv = data::read_csv(from_folder(folder, file));
    struct Column {
      std::size_t at = 0;
      data::Unit unit;
    };
    const auto columns = [&](const std::string& prefix, const data::Unit& unit) {
      std::array<Column, 3> found;
      for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t at = csv.column(prefix + "xyz"[k]);
        found[k] = {at, csv.unit(at, unit)};
      }
      return found;
    };
    const auto vector = [&](const data::CsvRow& row, const std::array<Column, 3>& in) {
      const auto value = [&](const Column& c) { return c.unit.to_si(csv.number(row, c.at)); };
      return Vec3{value(in[0]), value(in[1]), value(in[2])};
    };
    const std::array<Column, 3> place = columns("", usual);
    const bool moving = csv.find("vx") || csv.find("vy") || csv.find("vz");
    const std::array<Column, 3> speed = moving ? columns("v", data::parse_unit("m/s")) : place;
    const std::optional<std::size_t> frozen = csv.find("frozen"), size = csv.find("diameter");
    const data::Unit size_unit = size ? csv.unit(*size, usual) : usual;
    for (const data::CsvRow& row : csv.rows) {
      r.packing.push_back(vector(row, place));
      r.packing_line.push_back(row.line);
      if (moving) r.velocity.push_back(vector(row, speed));
      if (size) r.diameter.push_back(size_unit.to_si(csv.number(row, *size)));
      if (!frozen) continue;
      const double flag = csv.number(row, *frozen);
      if (flag != 0.0 && flag != 1.0)
        s.problem("packing", fmt::format("{} is {:g}", csv.place(row, *frozen), flag), "write 1 for frozen, else 0");
      r.frozen.push_back(flag == 1.0);
    }
    if (r.packing.empty())
      s.problem("packing", fmt::format("{} has no row", file), "give positions in columns x, y, z");
    if (size) sort_by_size(r);
  } catch (const data::InputError& error) {
    record(s, "packing", error);
  }
}

void choose_measured(const Section& s, StlRig& r) {
  const auto moving = std::find_if(r.meshes.begin(), r.meshes.end(),
                                   [](const RigMesh& m) { return m.speed_ratio != 0.0 || moves(m.motion); });
  if (!r.meshes.empty())
    r.measured = {moving != r.meshes.end() ? static_cast<std::size_t>(moving - r.meshes.begin()) : 0};
  const std::vector<std::string> chosen = s.kind("torque_of") == data::ValueKind::text
                                              ? std::vector<std::string>{s.text("torque_of")}
                                              : s.texts("torque_of");
  if (chosen.empty() || chosen.front().empty()) return;
  r.measured.clear();
  std::vector<std::string> known;
  for (const RigMesh& m : r.meshes) known.push_back(m.name);
  for (const std::string& name : chosen) {
    const auto found = std::find_if(r.meshes.begin(), r.meshes.end(), [&](const RigMesh& m) { return m.name == name; });
    const auto k = static_cast<std::size_t>(found - r.meshes.begin());
    if (found == r.meshes.end())
      s.problem("torque_of", fmt::format("there is no mesh '{}'", name),
                fmt::format("choose of: {}", fmt::join(known, ", ")));
    else if (std::find(r.measured.begin(), r.measured.end(), k) != r.measured.end())
      s.problem("torque_of", fmt::format("names the mesh '{}' twice", name), "name each once");
    else
      r.measured.push_back(k);
  }
}

bool turns_by_speed(const RigMesh& m) {
  return m.speed_ratio != 0.0 || std::any_of(m.motion.programme.begin(), m.motion.programme.end(),
                                             [](const SpeedPoint& p) { return p.angular_velocity != 0.0; });
}

/// The axes about which a mesh turns, or swings where it does not turn.
std::vector<Motion> axes_of(const RigMesh& m) {
  if (turns_by_speed(m)) return {m.motion};
  std::vector<Motion> axes;
  for (const Oscillation& o : m.motion.oscillations)
    if (o.kind == OscillationKind::about) axes.push_back({.point = m.motion.point, .axis = o.axis});
  return axes;
}

/// The axis of the torque of a measured mesh that neither gives one nor turns: its own where it swings, else that about
/// which the others turn or swing, where they share one.
void choose_axis(const Section& s, RigMesh& mesh, const StlRig& r) {
  std::vector<Motion> axes = axes_of(mesh);
  if (axes.empty()) {
    for (const RigMesh& other : r.meshes)
      for (const Motion& axis : axes_of(other)) axes.push_back(axis);
  }
  const double tolerance = 1e-6 * length(r.high - r.low);
  const bool one = !axes.empty() && std::all_of(axes.begin(), axes.end(),
                                                [&](const Motion& m) { return same_line(axes.front(), m, tolerance); });
  if (one) {
    mesh.motion.axis = axes.front().axis;
    if (!s.has("point")) mesh.motion.point = axes.front().point;
    return;
  }
  s.problem("axis",
            fmt::format("is missing, but the torque of '{}' is measured, and {}", mesh.name,
                        axes.empty() ? "no mesh turns whose axis it could take" : "what turns has no axis in common"),
            R"(add lines like axis = [0, 0, 1] and point = ["0 mm", "0 mm", "0 mm"])");
}

void choose_axes(const std::vector<Section>& tables, StlRig& r) {
  for (const std::size_t k : r.measured) {
    if (k < r.meshes.size() && !tables[k].has("axis") && !turns_by_speed(r.meshes[k]))
      choose_axis(tables[k], r.meshes[k], r);
  }
}

/// Identity of what came from files, so that runs are made again when a file changes.
std::string hash_content(const StlRig& r) {
  std::string bytes;
  const auto add = [&](const auto& rows) {
    if (!rows.empty()) bytes.append(reinterpret_cast<const char*>(rows.data()), rows.size() * sizeof rows[0]);
  };
  for (const RigMesh& m : r.meshes) {
    add(m.mesh.vertices);
    add(m.mesh.triangles);
  }
  add(r.packing);
  add(r.velocity);
  add(r.frozen);
  return data::hash_text(bytes);
}

}  // namespace

std::shared_ptr<const StlRig> read_stl_rig(const Section& s, const std::string& folder) {
  StlRig r;
  read_box(s.child("box"), r);
  r.down = read_direction(s, "down", r.down);
  const std::vector<Section> tables = read_meshes(s, folder, r);
  read_region(s.child("region"), r);
  read_packing(s, folder, r);
  choose_measured(s, r);
  if (tables.size() == s.array("mesh").size()) choose_axes(tables, r);
  r.content = hash_content(r);
  return std::make_shared<const StlRig>(std::move(r));
}

}  // namespace dem
