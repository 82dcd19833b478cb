#include "dem/rig/rig.hpp"

#include <algorithm>
#include <array>
#include <numbers>

#include "dem/rig/rig_kind.hpp"

namespace dem {

std::span<const RigKind* const> rig_kinds() {
  static constexpr std::array all{&slice_rig, &machine_rig, &drum_rig, &stl_rig};
  return all;
}

const RigKind& kind_of(const Case& c) {
  const auto all = rig_kinds();
  // The slice has no data of its own by which to know it: it is what no other kind is.
  return **std::find_if(all.rbegin(), all.rend(), [&](const RigKind* kind) { return kind->is(c); });
}

const char* rig_kind(const Case& c) { return kind_of(c).name; }
BuiltRig build_rig(const Case& c, std::uint64_t seed) { return kind_of(c).build(c, seed); }
std::size_t measured_bodies(const Case& c) { return kind_of(c).measured_bodies(c); }

Channels channels_of(const Case& c) { return kind_of(c).channels(c); }
std::vector<NamedMesh> rig_meshes(const Case& c) { return kind_of(c).meshes(c); }
std::vector<std::string> rig_warnings(const Case& c) { return kind_of(c).warnings(c); }
std::vector<data::Problem> rig_problems(const Case& c) { return kind_of(c).problems(c); }
std::string rig_settings(const Case& c) { return kind_of(c).settings(c); }
std::vector<BodyLabel> body_labels(const Case& c) { return kind_of(c).labels(c); }
double tool_speed(const Case& c) { return kind_of(c).tool_speed(c); }

Picture picture_along(Vec3 turning, Vec3 point, Vec3 down) {
  const Vec3 right = cross(turning, down);
  const double level = length(right);
  return {point, level > 1e-6 ? (1.0 / level) * right : Vec3{}, -down};
}

std::vector<std::string> body_names(const Case& c) {
  std::vector<std::string> names{"wall"};
  for (const BodyLabel& b : body_labels(c)) {
    for (const std::string& name : {b.name, b.material})
      if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  }
  return names;
}

double fill_depth(const Case& c) { return kind_of(c).fill_depth(c, summarise_bed(c).volume * 6.0 / std::numbers::pi); }

}  // namespace dem
