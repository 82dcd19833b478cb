#include "dem/reading/target.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <span>
#include <stdexcept>

#include "data/unit.hpp"
#include "dem/case/coefficients.hpp"
#include "dem/case/grains.hpp"
#include "dem/reading/binding.hpp"
#include "dem/rig/rig.hpp"
#include "dem/rig/rig_kind.hpp"

namespace dem {
namespace {

std::string always(const Case&) { return ""; }

Binding of_contact(const Coefficient& k) {
  return {{fmt::format("contact.{}", k.key), k.unit, k.low, k.high, k.meaning},
          [&k](const Case& c) { return k.value(c.contact); },
          [&k](Case& c, double x) { k.set(c.contact, x); },
          [&k](const Case& c) { return unread(c.contact, k.key); }};
}

/// Kinds of rig that have the quantity, for those that do not.
std::string unused_of_rig(const Case& c, std::string_view key) {
  const auto has = [&](const RigKind& kind) {
    return std::any_of(kind.quantities.begin(), kind.quantities.end(),
                       [&](const RigQuantity& q) { return q.key == key; });
  };
  if (has(kind_of(c))) return "";
  std::vector<std::string> names;
  for (const RigKind* kind : rig_kinds)
    if (has(*kind)) names.push_back(fmt::format("\"{}\"", kind->name));
  return fmt::format("belongs to rigs of kind {} only", fmt::join(names, " and "));
}

Binding of_rig(const RigQuantity& q) {
  return {{fmt::format("rig.{}", q.key), q.unit, q.low, q.high, q.meaning}, q.get, q.set, [&q](const Case& c) {
            return unused_of_rig(c, q.key);
          }};
}

std::string of_components(const Case& c, std::string_view key) {
  return c.components.empty() ? "" : fmt::format("is that of each component here: material.NAME.{}", key);
}

/// The targets of the bed, whatever the rig.
std::vector<Binding> of_bed() {
  return {
      {{"material.density", "kg/m3", 1.0, 1e5, "density of a grain"},
       [](const Case& c) { return c.material.density; },
       [](Case& c, double x) { c.material.density = x; },
       [](const Case& c) { return of_components(c, "density"); }},
      {{"material.diameter", "m", 1e-6, 1.0, "diameter of a sphere; the median by mass of log-normal sizes"},
       [](const Case& c) { return c.material.diameter; },
       [](Case& c, double x) { c.material.diameter = x; },
       [](const Case& c) {
         return c.material.sizes.empty() ? of_components(c, "diameter") : "is not read with a list of sizes";
       }},
      {{"material.coarse_graining", "1", 1.0, 1e4, "diameter here / diameter of the original grain"},
       [](const Case& c) { return c.material.coarse_graining; },
       [](Case& c, double x) { c.material.coarse_graining = x; },
       always},
      {{"rig.rpm", "rad/s", -1000.0, 1000.0, "angular velocity of the mixer or the drum"},
       [](const Case& c) { return c.rig.angular_velocity; },
       [](Case& c, double x) { c.rig.angular_velocity = x; },
       always},
      {{"rig.fill", "1", 1.0, 1e8, "number of spheres in the box"},
       [](const Case& c) { return static_cast<double>(summarise_bed(c).spheres); },
       [](Case& c, double x) {
         c.rig.fill = x;
         c.rig.fill_mass.reset();
         c.rig.level.reset();
       },
       always},
      {{"rig.fill_mass", "kg", 0.0, 1e6, "mass of powder in the box"},
       [](const Case& c) { return c.rig.fill_mass && !c.rig.level ? *c.rig.fill_mass : summarise_bed(c).mass; },
       [](Case& c, double x) {
         c.rig.fill_mass = x;
         c.rig.level.reset();
       },
       always},
  };
}

Binding of_log_normal_sizes() {
  return {{"material.geometric_sd", "1", 1.001, 3.0, "spread of log-normal sizes, exp of the deviation of ln diameter"},
          [](const Case& c) { return c.material.log_normal.value_or(LogNormalSizes{}).geometric_sd; },
          [](Case& c, double x) { c.material.log_normal->geometric_sd = x; },
          [](const Case& c) { return c.material.log_normal ? "" : "is read with a log-normal distribution only"; }};
}

/// The order is that of settings_text, by which runs are known: what came first stands first.
std::vector<Binding> make_bindings() {
  const auto contact = coefficients();
  std::vector<Binding> all;
  const auto add_contact = [&](std::span<const Coefficient> some) {
    for (const Coefficient& k : some) all.push_back(of_contact(k));
  };
  const auto add_rig = [&](const RigKind& kind) {
    for (const RigQuantity& q : kind.quantities) {
      Binding one = of_rig(q);
      const bool known =
          std::any_of(all.begin(), all.end(), [&](const Binding& b) { return b.target.name == one.target.name; });
      if (!known) all.push_back(std::move(one));
    }
  };
  add_contact(contact.first(first_coefficients));
  for (Binding& one : of_bed()) all.push_back(std::move(one));
  add_rig(slice_rig);
  add_contact(contact.subspan(first_coefficients));
  all.push_back(of_log_normal_sizes());
  add_rig(drum_rig);
  for (const RigKind* kind : rig_kinds) add_rig(*kind);
  return all;
}

const std::vector<Binding>& bindings() {
  static const std::vector<Binding> all = make_bindings();
  return all;
}

std::optional<Binding> find_binding(std::string_view name) {
  for (const Binding& b : bindings()) {
    const std::string_view full = b.target.name;
    if (full == name || full.substr(full.find('.') + 1) == name) return b;
  }
  return find_part(name);
}

Binding binding(std::string_view name) {
  if (std::optional<Binding> b = find_binding(name)) return *std::move(b);
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

std::optional<Target> find_target(std::string_view name) {
  if (const std::optional<Binding> b = find_binding(name)) return b->target;
  return {};
}

Target target(std::string_view name) { return binding(name).target; }

std::string unused_because(const Case& c, std::string_view name) { return binding(name).unused(c); }

std::string without_effect(const Case& c, std::string_view name) {
  const std::string full = target(name).name;
  if (full == "rig.rpm") return drives_a_body(c) ? "" : "drives no mesh of this rig: none has a speed_ratio";
  return walls_without_effect(c, full);
}

void set_target(Case& c, std::string_view name, double si) {
  const std::optional<Binding> b = find_binding(name);
  if (!b) {
    std::string known;
    for (const Target& t : targets()) known += (known.empty() ? "" : ", ") + t.name;
    throw data::InputError(data::ExitStatus::bad_study,
                           {std::string(name), "is not a quantity of the simulation",
                            "choose one of: " + known + ", contact.A-B.KEY, material.NAME.KEY"});
  }
  const Target& t = b->target;
  if (!(si >= t.low && si <= t.high)) {
    throw data::InputError(
        data::ExitStatus::bad_study,
        {t.name, fmt::format("is {:g}{}, but must lie in [{:g}, {:g}]", si, data::behind_number(t.unit), t.low, t.high),
         "choose a value inside it"});
  }
  if (std::string why = b->unused(c); !why.empty())
    throw data::InputError(data::ExitStatus::bad_study,
                           {t.name, std::move(why), "choose another target, or the law or rig that it belongs to"});
  b->set(c, si);
}

double get_target(const Case& c, std::string_view name) { return binding(name).get(c); }

std::vector<std::string> quantities_of(const Case& c) {
  std::vector<std::string> names;
  for (const Binding& b : bindings())
    if (b.unused(c).empty()) names.push_back(b.target.name);
  for (std::string& name : part_quantities(c)) names.push_back(std::move(name));
  return names;
}

}  // namespace dem
