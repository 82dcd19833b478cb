#include "dem/target.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "dem/derived.hpp"
#include "dem/rig.hpp"

namespace dem {
namespace {

struct Binding {
  Target target;
  double (*get)(const Case&);
  void (*set)(Case&, double);
};

const std::vector<Binding>& bindings() {
  static const std::vector<Binding> all{
      {{"contact.friction", "1", 0.0, 10.0, "Coulomb friction between grains"},
       [](const Case& c) { return c.contact.friction; },
       [](Case& c, double x) { c.contact.friction = x; }},
      {{"contact.wall_friction", "1", 0.0, 10.0, "Coulomb friction at walls; follows friction when not set"},
       [](const Case& c) { return c.contact.wall_friction.value_or(c.contact.friction); },
       [](Case& c, double x) { c.contact.wall_friction = x; }},
      {{"contact.hamaker", "J", 0.0, 1e-12, "Hamaker constant of eq. (1)"},
       [](const Case& c) { return c.contact.hamaker; },
       [](Case& c, double x) { c.contact.hamaker = x; }},
      {{"contact.wall_hamaker", "J", 0.0, 1e-12, "Hamaker constant at walls; follows hamaker when not set"},
       [](const Case& c) { return c.contact.wall_hamaker.value_or(c.contact.hamaker); },
       [](Case& c, double x) { c.contact.wall_hamaker = x; }},
      {{"contact.minimum_separation", "m", 1e-11, 1e-6, "minimum separation h_min of eq. (1)"},
       [](const Case& c) { return c.contact.minimum_separation; },
       [](Case& c, double x) { c.contact.minimum_separation = x; }},
      {{"contact.cut_off", "m", 0.0, 1e-4, "separation beyond which there is no attraction"},
       [](const Case& c) { return c.contact.cut_off; },
       [](Case& c, double x) { c.contact.cut_off = x; }},
      {{"contact.restitution", "1", 0.01, 1.0, "restitution of a head-on collision without attraction"},
       [](const Case& c) { return c.contact.restitution; },
       [](Case& c, double x) { c.contact.restitution = x; }},
      {{"contact.stiffness", "N/m", 1e-3, 1e9, "normal spring between grains"},
       [](const Case& c) { return c.contact.stiffness; },
       [](Case& c, double x) { c.contact.stiffness = x; }},
      {{"contact.wall_stiffness", "N/m", 1e-3, 1e9, "normal spring at walls; follows stiffness when not set"},
       [](const Case& c) { return c.contact.wall_stiffness.value_or(c.contact.stiffness); },
       [](Case& c, double x) { c.contact.wall_stiffness = x; }},
      {{"contact.tangential_ratio", "1", 0.0, 2.0, "tangential / normal stiffness"},
       [](const Case& c) { return c.contact.tangential_ratio; },
       [](Case& c, double x) { c.contact.tangential_ratio = x; }},
      {{"contact.tangential_damping", "1", 0.0, 2.0, "tangential / normal dashpot"},
       [](const Case& c) { return c.contact.tangential_damping; },
       [](Case& c, double x) { c.contact.tangential_damping = x; }},
      {{"material.density", "kg/m3", 1.0, 1e5, "density of a grain"},
       [](const Case& c) { return c.material.density; },
       [](Case& c, double x) { c.material.density = x; }},
      {{"material.diameter", "m", 1e-6, 1.0, "diameter of a sphere"},
       [](const Case& c) { return c.material.diameter; },
       [](Case& c, double x) { c.material.diameter = x; }},
      {{"material.coarse_graining", "1", 1.0, 1e4, "diameter here / diameter of the original grain"},
       [](const Case& c) { return c.material.coarse_graining; },
       [](Case& c, double x) { c.material.coarse_graining = x; }},
      {{"rig.rpm", "rad/s", -1000.0, 1000.0, "angular velocity of the mixer"},
       [](const Case& c) { return c.rig.angular_velocity; },
       [](Case& c, double x) { c.rig.angular_velocity = x; }},
      {{"rig.fill", "1", 1.0, 1e8, "number of spheres in the box"},
       [](const Case& c) { return static_cast<double>(derive(c).spheres); },
       [](Case& c, double x) {
         c.rig.fill = x;
         c.rig.fill_mass.reset();
       }},
      {{"rig.fill_mass", "kg", 0.0, 1e6, "mass of powder in the box"},
       [](const Case& c) {
         const Derived d = derive(c);
         return c.rig.fill_mass.value_or(static_cast<double>(d.spheres) * d.mass);
       },
       [](Case& c, double x) { c.rig.fill_mass = x; }},
      {{"rig.shaft_radius", "m", 1e-6, 10.0, "radius of the shaft"},
       [](const Case& c) { return c.rig.shaft_radius; },
       [](Case& c, double x) { c.rig.shaft_radius = x; }},
      {{"rig.blade_radius", "m", 1e-6, 10.0, "outer radius of the blade"},
       [](const Case& c) { return c.rig.blade_radius; },
       [](Case& c, double x) { c.rig.blade_radius = x; }},
      {{"rig.blade_thickness", "m", 1e-7, 10.0, "thickness of the blade along the axis"},
       [](const Case& c) { return c.rig.blade_thickness; },
       [](Case& c, double x) { c.rig.blade_thickness = x; }},
      {{"rig.pitch", "m", 1e-6, 100.0, "pitch of the helix"},
       [](const Case& c) { return c.rig.pitch; },
       [](Case& c, double x) { c.rig.pitch = x; }},
      {{"rig.trough_radius", "m", 1e-6, 10.0, "radius of the trough"},
       [](const Case& c) { return c.rig.trough_radius; },
       [](Case& c, double x) { c.rig.trough_radius = x; }},
  };
  return all;
}

const Binding* find_binding(std::string_view name) {
  for (const Binding& b : bindings()) {
    const std::string_view full = b.target.name;
    if (full == name || full.substr(full.find('.') + 1) == name) return &b;
  }
  return nullptr;
}

const Binding& binding(std::string_view name) {
  if (const Binding* b = find_binding(name)) return *b;
  throw std::out_of_range(fmt::format("no target named {}", name));
}

}  // namespace

const std::vector<Target>& targets() {
  static const std::vector<Target> all = [] {
    std::vector<Target> list;
    for (const Binding& b : bindings()) list.push_back(b.target);
    return list;
  }();
  return all;
}

const Target* find_target(std::string_view name) {
  const Binding* b = find_binding(name);
  return b == nullptr ? nullptr : &b->target;
}

const Target& target(std::string_view name) { return binding(name).target; }

void set_target(Case& c, std::string_view name, double si) {
  const Binding* b = find_binding(name);
  if (b == nullptr) {
    std::string known;
    for (const Target& t : targets()) known += (known.empty() ? "" : ", ") + t.name;
    throw data::InputError(data::ExitStatus::bad_study,
                           {std::string(name), "is not a quantity of the simulation", "choose one of: " + known});
  }
  const Target& t = b->target;
  if (!(si >= t.low && si <= t.high)) {
    throw data::InputError(data::ExitStatus::bad_study,
                           {t.name, fmt::format("is {:g} {}, but must lie in [{:g}, {:g}]", si, t.unit, t.low, t.high),
                            "choose a value inside it"});
  }
  if (!rig_has(c, t.name)) {
    throw data::InputError(data::ExitStatus::bad_study, {t.name, "is a dimension of the slice, and this rig has none",
                                                         "choose another target, or kind = \"slice\""});
  }
  b->set(c, si);
}

double get_target(const Case& c, std::string_view name) { return binding(name).get(c); }

std::vector<data::Problem> problems(const Case& c) {
  std::vector<data::Problem> found;
  for (const Binding& b : bindings()) {
    if (!rig_has(c, b.target.name)) continue;
    const double x = b.get(c);
    const Target& t = b.target;
    if (!(x >= t.low && x <= t.high)) {
      found.push_back({t.name, fmt::format("is {:g} {}, but must lie in [{:g}, {:g}]", x, t.unit, t.low, t.high),
                       "choose a value inside it"});
    }
  }
  if (!found.empty()) return found;
  const Derived d = derive(c);
  const double size = c.material.diameter;
  const auto add = [&](std::string place, std::string what, std::string remedy) {
    found.push_back({std::move(place), std::move(what), std::move(remedy)});
  };
  if (d.spheres == 0) add("rig.fill", "leaves no sphere in the box", "give a larger fill");
  for (data::Problem& p : rig_problems(c)) found.push_back(std::move(p));
  // What rests on one sphere at the bottom of the fill must not press it flat.
  const double rest = d.weight * fill_depth(c) / size / c.contact.stiffness;
  const double pulled = (d.pull_off + rest * c.contact.stiffness) / c.contact.stiffness;
  if (pulled > 0.05 * size) {
    add("contact.stiffness",
        fmt::format("lets spheres at rest overlap by {:.2g} of a radius under the fill and the attraction",
                    pulled / (0.5 * size)),
        fmt::format("raise it to {:.3g} N/m or more", 20.0 * c.contact.stiffness * pulled / size));
  }
  if (c.contact.cut_off > 0.5 * size) add("contact.cut_off", "is longer than a sphere's radius", "shorten it");
  if (c.contact.minimum_separation > c.contact.cut_off) {
    add("contact.cut_off", "is shorter than the minimum separation",
        "make it longer, or the minimum separation shorter");
  }
  if (!(c.run.longest > c.run.start_up))
    add("run.longest", "leaves nothing to measure after the start-up", "make it longer");
  if (!(c.run.steps_per_contact >= 15.0)) {
    add("run.steps_per_contact",
        fmt::format("is {:g}: fewer than 15 steps do not follow a contact", c.run.steps_per_contact),
        "20 to 50 is usual");
  }
  return found;
}

std::string settings_text(const Case& c) {
  std::string text = fmt::format("rig.kind = {}\n", c.rig.stl ? "stl" : "slice");
  const auto line = [&](std::string_view name, double value, std::string_view unit) {
    text += fmt::format("{} = {:.17g}{}{}\n", name, value, unit == "1" ? "" : " ", unit == "1" ? "" : unit);
  };
  for (const Binding& b : bindings())
    if (rig_has(c, b.target.name)) line(b.target.name, b.get(c), b.target.unit);
  const Contact& k = c.contact;
  const RunControl& r = c.run;
  text += rig_settings(c);
  text += fmt::format("contact.tension = {}\n", k.tension == DashpotTension::allowed ? "allowed" : "clamped");
  text += fmt::format("contact.cap = {}\n", k.cap == FrictionCap::net         ? "net"
                                            : k.cap == FrictionCap::repulsion ? "repulsion"
                                                                              : "thornton");
  text += fmt::format("contact.hamaker_of = {}\n", k.hamaker_of == HamakerOf::simulation ? "simulation" : "original");
  text += fmt::format("contact.length_scale = {}\n", k.length_scale == LengthScale::diameter ? "diameter" : "radius");
  text += fmt::format("contact.wall_attraction = {}\n",
                      k.wall_attraction == WallAttraction::as_grains ? "as_grains" : "derjaguin");
  line("run.gravity", r.gravity, "m/s2");
  line("run.steps_per_contact", r.steps_per_contact, "1");
  line("run.skin", r.skin, "1");
  line("run.settle", r.settle, "s");
  line("run.start_up", r.start_up, "s");
  line("run.sample_interval", r.sample_interval, "s");
  line("run.window", r.window, "s");
  line("run.standard_error", r.standard_error, "1");
  line("run.shortest", r.shortest, "s");
  line("run.shortest_turns", r.shortest_turns, "1");
  line("run.longest", r.longest, "s");
  return text;
}

}  // namespace dem
