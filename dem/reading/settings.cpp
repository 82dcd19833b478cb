// A case as text, complete: what decides a run is in it.
#include <fmt/format.h>

#include "dem/case/grains.hpp"
#include "dem/reading/target.hpp"
#include "dem/rig/drive.hpp"
#include "dem/rig/rig.hpp"

namespace dem {
namespace {

/// Version of the DEM's equations. It is raised where the same settings come to give other torques, so that runs are
/// not mixed.
constexpr int model = 2;

/// Corrections that change the torques of few cases; theirs alone are run anew.
std::vector<std::string> corrections(const Case& c) {
  const Contact& k = c.contact;
  std::vector<std::string> names;
  if (k.restitution_at) names.push_back("restitution_at");  // damping by Brent's method
  if (k.true_young_modulus && k.normal != NormalLaw::linear && c.components.size() > 1)
    names.push_back("true_young_modulus");                      // of unlike materials the same in either order
  if (k.normal == NormalLaw::jkr) names.push_back("jkr_root");  // exact near break-off
  if (drive_sign_corrected(c)) names.push_back("torque_sign");
  return names;
}

struct Text {
  std::string lines;
  void number(std::string_view name, double value, std::string_view unit) {
    lines += fmt::format("{} = {:.17g}{}{}\n", name, value, unit == "1" ? "" : " ", unit == "1" ? "" : unit);
  }
  template <data::HasTexts Choice>
  void choice(std::string_view name, Choice value) {
    lines += fmt::format("{} = {}\n", name, data::to_text(value));
  }
};

void add_sizes(const Material& m, Text& text) {
  for (const SizeShare& s : m.sizes) {
    text.number(fmt::format("material.{}.sizes.diameter", m.name), s.diameter, "m");
    text.number(fmt::format("material.{}.sizes.mass_fraction", m.name), s.mass_fraction, "1");
  }
  if (!m.log_normal) return;
  text.number(fmt::format("material.{}.distribution.low", m.name), m.log_normal->low, "m");
  text.number(fmt::format("material.{}.distribution.high", m.name), m.log_normal->high, "m");
  text.number(fmt::format("material.{}.distribution.geometric_sd", m.name), m.log_normal->geometric_sd, "1");
}

}  // namespace

std::string settings_text(const Case& c) {
  Text text{fmt::format("model = {}\nrig.kind = {}\n", model, rig_kind(c))};
  for (const std::string& name : quantities_of(c)) text.number(name, get_target(c, name), target(name).unit);
  for (const std::string& name : corrections(c)) text.lines += fmt::format("model.{} = corrected\n", name);
  const Contact& k = c.contact;
  const RunControl& r = c.run;
  text.lines += rig_settings(c);
  text.choice("contact.tension", k.tension);
  text.choice("contact.cap", k.cap);
  text.choice("contact.hamaker_of", k.hamaker_of);
  if (k.hamaker_of == HamakerOf::original && k.hamaker_power != Contact{}.hamaker_power)
    text.number("contact.hamaker_power", k.hamaker_power, "1");
  text.choice("contact.length_scale", k.length_scale);
  text.choice("contact.wall_attraction", k.wall_attraction);
  text.choice("contact.normal", k.normal);
  if (k.normal == NormalLaw::hertz) text.choice("contact.tangential", k.tangential_law());
  text.choice("contact.resistance", k.resistance);
  text.choice("contact.cohesion", k.cohesion);
  if (k.restitution_at) text.number("contact.restitution_at", *k.restitution_at, "m/s");
  text.number("run.gravity", r.gravity, "m/s2");
  text.number("run.steps_per_contact", r.steps_per_contact, "1");
  if (r.time_step) text.number("run.time_step", *r.time_step, "s");
  text.number("run.overlap_limit", r.overlap_limit, "1");
  text.number("run.skin", r.skin, "1");
  text.number("run.settle", r.settle, "s");
  text.number("run.start_up", r.start_up, "s");
  text.number("run.start_up_turns", r.start_up_turns, "1");
  text.number("run.sample_interval", r.sample_interval, "s");
  text.number("run.window", r.window, "s");
  text.number("run.standard_error", r.standard_error, "1");
  text.number("run.shortest", r.shortest, "s");
  text.number("run.shortest_turns", r.shortest_turns, "1");
  text.number("run.longest", r.longest, "s");
  if (!r.known.empty()) text.lines += fmt::format("run.known = {}\n", fmt::join(r.known, " "));
  for (const Component& part : components_of(c)) add_sizes(part.material, text);
  return text.lines;
}

}  // namespace dem
