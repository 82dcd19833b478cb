#include "dem/read_case.hpp"

#include <cmath>

#include "dem/read_stl_rig.hpp"
#include "dem/target.hpp"

namespace dem {
namespace {

using data::Range;
using data::Section;

Range range_of(std::string_view name) {
  const Target& t = target(name);
  return {.low = t.low, .high = t.high};
}

/// A key whose name, unit and range are those of the target "SECTION.KEY".
void read(const Section& s, std::string_view section, std::string_view key, Case& c) {
  if (!s.has(key)) return;
  const Target& t = target(std::string(section) + "." + std::string(key));
  const double value = s.quantity(key, t.unit, range_of(t.name), get_target(c, t.name));
  if (value >= t.low && value <= t.high) set_target(c, t.name, value);
}

template <class Choice>
void choose(const Section& s, std::string_view key, const std::vector<std::string>& names, Choice& field) {
  const std::string text = s.choice(key, names, names[static_cast<std::size_t>(field)]);
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (names[k] == text) field = static_cast<Choice>(k);
  }
}

/// A bare number counts spheres, a quantity is a mass. The reader tells them apart by a unit that only a bare number
/// gets, and that turns it negative.
void read_fill(const Section& s, Case& c) {
  const data::Unit count{.symbol = "spheres", .factor = -1.0, .offset = 0.0};
  const double fill =
      s.quantity("fill", "kg", {.low = -target("fill").high, .high = target("fill_mass").high}, 0.0, &count);
  if (fill < 0.0) {
    c.rig.fill = -fill;
    c.rig.fill_mass.reset();
  } else if (fill > 0.0) {
    c.rig.fill_mass = fill;
  } else if (s.has("fill")) {
    s.problem("fill", "is zero", "give a number of spheres, or a mass with its unit");
  }
}

void read_rig(const Section& s, const std::string& folder, Case& c) {
  if (s.choice("kind", {"slice", "stl"}, "slice") == "stl") {
    c.rig.stl = read_stl_rig(s, folder);
    if (!c.rig.stl->packing.empty()) c.rig.fill = static_cast<double>(c.rig.stl->packing.size());
    read(s, "rig", "rpm", c);
  } else {
    for (const char* key : {"shaft_radius", "blade_radius", "blade_thickness", "pitch", "trough_radius", "rpm"})
      read(s, "rig", key, c);
    c.rig.pitches = static_cast<int>(s.integer("pitches", {.low = 1, .high = 1000}, c.rig.pitches));
  }
  read_fill(s, c);
}

void read_contact(const Section& s, Case& c) {
  for (const char* key : {"stiffness", "wall_stiffness", "restitution", "tangential_ratio", "tangential_damping",
                          "friction", "wall_friction", "hamaker", "wall_hamaker", "minimum_separation", "cut_off"}) {
    read(s, "contact", key, c);
  }
  choose(s, "tension", {"allowed", "clamped"}, c.contact.tension);
  choose(s, "cap", {"net", "repulsion", "thornton"}, c.contact.cap);
  choose(s, "hamaker_of", {"simulation", "original"}, c.contact.hamaker_of);
  choose(s, "length_scale", {"diameter", "radius"}, c.contact.length_scale);
  choose(s, "wall_attraction", {"as_grains", "derjaguin"}, c.contact.wall_attraction);
}

void read_run(const Section& s, RunControl& r) {
  r.gravity = s.quantity("gravity", "m/s2", {.low = 0.0, .high = 1000.0, .open_low = true}, r.gravity);
  r.steps_per_contact = s.number("steps_per_contact", {.low = 15.0, .high = 10000.0}, r.steps_per_contact);
  r.skin = s.number("skin", {.low = 0.01, .high = 1.0}, r.skin);
  r.settle = s.quantity("settle", "s", data::non_negative, r.settle);
  r.start_up = s.quantity("start_up", "s", data::non_negative, r.start_up);
  r.sample_interval = s.quantity("sample_interval", "s", data::positive, r.sample_interval);
  r.window = s.quantity("window", "s", data::positive, r.window);
  r.shortest = s.quantity("shortest", "s", data::positive, r.shortest);
  r.shortest_turns = s.number("shortest_turns", data::non_negative, r.shortest_turns);
  r.longest = s.quantity("longest", "s", data::positive, r.longest);
}

void read_material(const Section& s, Case& c) {
  for (const char* key : {"density", "diameter", "coarse_graining"}) read(s, "material", key, c);
  read_fill(s, c);
  read_contact(s.child("contact"), c);
}

}  // namespace

Case read_case(const data::StudyFile& study, std::string_view material) {
  const Section root = study.root();
  Case c;
  read_rig(root.child("rig"), study.folder(), c);
  read_contact(root.child("contact"), c);
  read_run(root.child("run"), c.run);
  c.run.standard_error =
      root.child("training")
          .number("standard_error", {.low = 0.0, .high = 1.0, .open_low = true}, c.run.standard_error);
  // Every material's keys are known, whichever is read.
  for (const auto& [name, section] : root.child("materials").children()) {
    Case other = c;
    read_material(section, other);
    if (name == material) {
      c = other;
      c.material.name = name;
    }
  }
  // An InputError for what no single key is to blame for; single keys were checked as they were read.
  for (const data::Problem& p : problems(c)) root.child("rig").problem("", p.place + " " + p.what, p.remedy);
  return c;
}

}  // namespace dem
