#include "dem/rig/rig.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dem/rig/rig_kind.hpp"

namespace dem {

const RigKind& kind_of(const Case& c) {
  // The slice has no data of its own by which to know it: it is what no other kind is.
  return **std::find_if(rig_kinds.rbegin(), rig_kinds.rend(), [&](const RigKind* kind) { return kind->is(c); });
}

const char* rig_kind(const Case& c) { return kind_of(c).name; }
BuiltRig build_rig(const Case& c, std::uint64_t seed) { return kind_of(c).build(c, seed); }
std::vector<RigBody> rig_bodies(const Case& c) { return kind_of(c).bodies(c); }
std::vector<std::size_t> measured_bodies(const Case& c) { return kind_of(c).measured(c); }
bool has_picture(const Case& c) { return kind_of(c).has_picture(c); }
Channels channels_of(const Case& c) { return kind_of(c).channels(c); }
std::vector<NamedMesh> rig_meshes(const Case& c) { return kind_of(c).meshes(c); }
std::vector<std::string> rig_warnings(const Case& c) { return kind_of(c).warnings(c); }
std::vector<data::Problem> rig_problems(const Case& c) { return kind_of(c).problems(c); }
std::string rig_settings(const Case& c) { return kind_of(c).settings(c); }
double tool_speed(const Case& c) { return kind_of(c).tool_speed(c); }

Picture picture_along(Vec3 turning, Vec3 point, Vec3 down) {
  const Vec3 right = cross(turning, down);
  const double level = length(right);
  return {point, level > 1e-6 ? (1.0 / level) * right : Vec3{}, -down};
}

bool shows_bed(const Picture& picture, const std::array<bool, 3>& periodic) {
  if (dot(picture.right, picture.right) == 0.0) return false;
  const auto lies = [&](Vec3 axis) {
    return std::abs(dot(axis, picture.right)) > 1e-6 || std::abs(dot(axis, picture.up)) > 1e-6;
  };
  return !((periodic[0] && lies({1.0, 0.0, 0.0})) || (periodic[1] && lies({0.0, 1.0, 0.0})) ||
           (periodic[2] && lies({0.0, 0.0, 1.0})));
}

bool drives_a_body(const Case& c) {
  const std::vector<RigBody> bodies = rig_bodies(c);
  return std::any_of(bodies.begin(), bodies.end(), [](const RigBody& body) { return body.driven; });
}

std::vector<BodyLabel> body_labels(const Case& c) {
  std::vector<BodyLabel> labels;
  for (RigBody& body : rig_bodies(c)) labels.push_back(std::move(body.label));
  return labels;
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
