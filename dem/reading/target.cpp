#include "dem/reading/target.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <stdexcept>

#include "dem/case/cross_section.hpp"
#include "dem/case/grains.hpp"
#include "dem/rig/rig.hpp"

namespace dem {
namespace {

struct Binding {
  Target target;
  std::function<double(const Case&)> get;
  std::function<void(Case&, double)> set;
  std::function<std::string(const Case&)> unused;  ///< why the case has no use for it
};

std::string of_slice_only(const Case& c) {
  return c.rig.stl || c.rig.drum ? "is a dimension of the slice, and this rig has none" : "";
}
std::string of_machine_only(const Case& c) { return c.rig.machine ? "" : "is of the rig kind = \"machine\" only"; }
std::string of_level_only(const Case& c) {
  return c.rig.drum || c.rig.machine ? "" : "is of the rigs kind = \"drum\" and \"machine\" only";
}
std::string of_drum_only(const Case& c) { return c.rig.drum ? "" : "is of the rig kind = \"drum\" only"; }
std::string always(const Case&) { return ""; }

/// Which laws read which coefficient.
std::string unread(const Contact& k, std::string_view key) {
  const auto is = [&](std::initializer_list<std::string_view> keys) {
    return std::find(keys.begin(), keys.end(), key) != keys.end();
  };
  const bool hertzian = k.normal != NormalLaw::linear;
  const bool mindlin = k.tangential_law() == TangentialLaw::mindlin;
  if (is({"stiffness", "wall_stiffness"}) && hertzian && mindlin)
    return "is read by normal = \"linear\" or tangential = \"linear\" only";
  if (key == "true_stiffness" && hertzian) return "is read by normal = \"linear\" only";
  if (key == "tangential_ratio" && mindlin) return "is read by tangential = \"linear\" only";
  if (is({"young_modulus", "wall_young_modulus", "true_young_modulus", "poisson_ratio"}) && !hertzian)
    return "is read by normal = \"hertz\" or \"jkr\" only";
  if (is({"rolling_friction", "wall_rolling_friction", "twisting_friction"}) && k.resistance == ResistanceLaw::none)
    return "is not read with resistance = \"none\"";
  if (is({"rolling_stiffness_ratio", "rolling_damping"}) && k.resistance != ResistanceLaw::spring)
    return "is read by resistance = \"spring\" only";
  if (is({"hamaker", "wall_hamaker", "minimum_separation", "cut_off"})) {
    if (k.normal == NormalLaw::jkr) return "is not read with normal = \"jkr\", which brings its own attraction";
    if (k.cohesion == Cohesion::dmt) return "is read by cohesion = \"van_der_waals\" only";
  }
  if (is({"work_of_adhesion", "wall_work_of_adhesion"}) && k.normal != NormalLaw::jkr && k.cohesion != Cohesion::dmt)
    return "is read by normal = \"jkr\" or cohesion = \"dmt\" only";
  return "";
}

std::string_view last_part(std::string_view name) { return name.substr(name.rfind('.') + 1); }

Binding of_contact(Target t, double Contact::*field) {
  const std::string key(last_part(t.name));
  return {std::move(t), [=](const Case& c) { return c.contact.*field; },
          [=](Case& c, double x) { c.contact.*field = x; }, [=](const Case& c) { return unread(c.contact, key); }};
}
/// A field that follows another while it is not set.
Binding of_contact(Target t, std::optional<double> Contact::*field, double Contact::*otherwise) {
  const std::string key(last_part(t.name));
  return {std::move(t), [=](const Case& c) { return (c.contact.*field).value_or(c.contact.*otherwise); },
          [=](Case& c, double x) { c.contact.*field = x; }, [=](const Case& c) { return unread(c.contact, key); }};
}
Binding of_slice(Target t, double Rig::*field) {
  return {std::move(t), [=](const Case& c) { return c.rig.*field; }, [=](Case& c, double x) { c.rig.*field = x; },
          of_slice_only};
}

Binding of_drum(Target t, double Drum::*field) {
  return {std::move(t), [=](const Case& c) { return c.rig.drum.value_or(Drum{}).*field; },
          [=](Case& c, double x) { c.rig.drum.value().*field = x; }, of_drum_only};
}

Binding of_machine(Target t, double Machine::*field) {
  return {std::move(t), [=](const Case& c) { return c.rig.machine.value_or(Machine{}).*field; },
          [=](Case& c, double x) { c.rig.machine.value().*field = x; }, of_machine_only};
}

/// The level that is set, or what the fill comes to, of a rig too full 1.
double level_of(const Case& c) {
  const double room = level_volume(c.rig);
  if (c.rig.level || room <= 0.0) return c.rig.level.value_or(0.0);
  return std::min(1.0, summarise_bed(c).volume / packing_fraction / room);
}

std::string of_components(const Case& c, std::string_view key) {
  return c.components.empty() ? "" : fmt::format("is that of each component here: material.NAME.{}", key);
}

const std::vector<Binding>& bindings() {
  using C = Contact;
  static const std::vector<Binding> all{
      of_contact({"contact.friction", "1", 0.0, 10.0, "Coulomb friction between grains"}, &C::friction),
      of_contact({"contact.wall_friction", "1", 0.0, 10.0, "Coulomb friction at walls; follows friction when not set"},
                 &C::wall_friction, &C::friction),
      of_contact({"contact.hamaker", "J", 0.0, 1e-12, "Hamaker constant of eq. (1)"}, &C::hamaker),
      of_contact({"contact.wall_hamaker", "J", 0.0, 1e-12, "Hamaker constant at walls; follows hamaker when not set"},
                 &C::wall_hamaker, &C::hamaker),
      of_contact({"contact.minimum_separation", "m", 1e-11, 1e-6, "minimum separation h_min of eq. (1)"},
                 &C::minimum_separation),
      of_contact({"contact.cut_off", "m", 0.0, 1e-4, "separation beyond which there is no attraction"}, &C::cut_off),
      of_contact({"contact.restitution", "1", 0.01, 1.0, "restitution of a head-on collision without attraction"},
                 &C::restitution),
      of_contact({"contact.stiffness", "N/m", 1e-3, 1e9, "normal spring between grains"}, &C::stiffness),
      of_contact({"contact.wall_stiffness", "N/m", 1e-3, 1e9, "normal spring at walls; follows stiffness when not set"},
                 &C::wall_stiffness, &C::stiffness),
      of_contact({"contact.tangential_ratio", "1", 0.0, 2.0, "tangential / normal stiffness"}, &C::tangential_ratio),
      of_contact({"contact.tangential_damping", "1", 0.0, 2.0, "tangential / normal dashpot"}, &C::tangential_damping),
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
      of_slice({"rig.shaft_radius", "m", 1e-6, 10.0, "radius of the shaft"}, &Rig::shaft_radius),
      of_slice({"rig.blade_radius", "m", 1e-6, 10.0, "outer radius of the blade"}, &Rig::blade_radius),
      of_slice({"rig.blade_thickness", "m", 1e-7, 10.0, "thickness of the blade along the axis"},
               &Rig::blade_thickness),
      of_slice({"rig.pitch", "m", 1e-6, 100.0, "pitch of the helix"}, &Rig::pitch),
      of_slice({"rig.trough_radius", "m", 1e-6, 10.0, "radius of the trough"}, &Rig::trough_radius),
      of_contact({"contact.wall_restitution", "1", 0.01, 1.0, "restitution at walls; follows restitution when not set"},
                 &C::wall_restitution, &C::restitution),
      of_contact({"contact.young_modulus", "Pa", 1e3, 1e13, "Young's modulus of a grain"}, &C::young_modulus),
      of_contact({"contact.wall_young_modulus", "Pa", 1e3, 1e15, "Young's modulus of walls; follows young_modulus"},
                 &C::wall_young_modulus, &C::young_modulus),
      of_contact({"contact.poisson_ratio", "1", 0.0, 0.5, "Poisson's ratio of grains and walls"}, &C::poisson_ratio),
      of_contact({"contact.rolling_friction", "1", 0.0, 10.0, "rolling torque / (reduced radius * load), at most"},
                 &C::rolling_friction),
      of_contact(
          {"contact.wall_rolling_friction", "1", 0.0, 10.0, "rolling friction at walls; follows rolling_friction"},
          &C::wall_rolling_friction, &C::rolling_friction),
      of_contact({"contact.twisting_friction", "1", 0.0, 10.0, "torque about the normal / (reduced radius * load)"},
                 &C::twisting_friction),
      of_contact({"contact.rolling_stiffness_ratio", "1", 1e-6, 10.0, "rolling / normal stiffness"},
                 &C::rolling_stiffness_ratio),
      of_contact({"contact.rolling_damping", "1", 0.0, 2.0, "rolling dashpot, of critical"}, &C::rolling_damping),
      of_contact({"contact.work_of_adhesion", "J/m2", 0.0, 100.0, "work of adhesion between grains, jkr and dmt"},
                 &C::work_of_adhesion),
      of_contact({"contact.wall_work_of_adhesion", "J/m2", 0.0, 100.0,
                  "work of adhesion at walls; follows work_of_adhesion when not set"},
                 &C::wall_work_of_adhesion, &C::work_of_adhesion),
      of_contact({"contact.true_stiffness", "N/m", 1e-3, 1e12,
                  "stiffness of the real grain: attraction scaled by the root of stiffness / it"},
                 &C::true_stiffness, &C::stiffness),
      of_contact({"contact.true_young_modulus", "Pa", 1e3, 1e13,
                  "Young's modulus of the real grain: attraction scaled by (young_modulus / it)^0.4"},
                 &C::true_young_modulus, &C::young_modulus),
      {{"material.geometric_sd", "1", 1.001, 3.0, "spread of log-normal sizes, exp of the deviation of ln diameter"},
       [](const Case& c) { return c.material.log_normal.value_or(LogNormalSizes{}).geometric_sd; },
       [](Case& c, double x) { c.material.log_normal->geometric_sd = x; },
       [](const Case& c) { return c.material.log_normal ? "" : "is read with a log-normal distribution only"; }},
      of_drum({"rig.drum_radius", "m", 1e-6, 10.0, "radius of the drum, inside"}, &Drum::radius),
      of_drum({"rig.drum_length", "m", 1e-6, 10.0, "length of the drum between its end plates"}, &Drum::length),
      {{"rig.level", "1", 1e-6, 1.0,
        "bed / drum, or bed / room of the machine below its blades' top, of volume, the bed at rest with a solid "
        "fraction of 0.6"},
       level_of,
       [](Case& c, double x) { c.rig.level = x; },
       of_level_only},
      of_machine({"rig.machine_length", "m", 1e-6, 100.0, "length of the machine between its end walls"},
                 &Machine::length),
      of_machine({"rig.opening", "m", 1e-6, 100.0, "length of the opening at each end of the partition"},
                 &Machine::opening),
      of_machine({"rig.partition", "m", 1e-6, 10.0, "thickness of the partition"}, &Machine::partition),
      of_machine({"rig.partition_height", "m", 1e-6, 10.0, "height of the partition above the axes"},
                 &Machine::partition_height),
      of_machine({"rig.sill", "m", -10.0, 10.0, "height of the openings' lower edge above the axes"}, &Machine::sill),
  };
  return all;
}

using Names = std::pair<std::string, std::string>;

/// The two names of "A-B", which may have dashes of their own.
std::optional<Names> split(const Case& c, std::string_view between) {
  const std::vector<std::string> grains = grain_names(c), bodies = body_names(c);
  const auto in = [](const std::vector<std::string>& names, std::string_view name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  for (std::size_t dash = between.find('-'); dash != std::string_view::npos; dash = between.find('-', dash + 1)) {
    const std::string_view a = between.substr(0, dash), b = between.substr(dash + 1);
    if ((in(grains, a) && (in(grains, b) || in(bodies, b))) || (in(bodies, a) && in(grains, b)))
      return Names{std::string(a), std::string(b)};
  }
  return {};
}

/// Whether what is said of p's two names holds for every contact that `names` stands for. "wall" stands for all
/// bodies, a body's material for those made of it.
bool holds_for(const Case& c, const PairContact& p, const Names& names) {
  const std::vector<BodyLabel> bodies = body_labels(c);
  const auto covers = [&](const std::string& said, const std::string& asked) {
    return said == asked || std::any_of(bodies.begin(), bodies.end(), [&](const BodyLabel& b) {
             return (b.name == asked && (said == b.material || said == "wall")) ||
                    (b.material == asked && said == "wall");
           });
  };
  return (covers(p.first, names.first) && covers(p.second, names.second)) ||
         (covers(p.first, names.second) && covers(p.second, names.first));
}

bool same(const PairContact& p, const Names& names) {
  return (p.first == names.first && p.second == names.second) || (p.first == names.second && p.second == names.first);
}

Binding of_pair(const Target& usual, std::string_view between, const PairKey& key) {
  const std::string pair(between), follows = usual.name;
  const auto field = key.field;
  Target t = usual;
  t.name = fmt::format("contact.{}.{}", pair, key.key);
  t.meaning += fmt::format(", between {}", pair);
  // What is not said of the pair follows the contact law's, at a wall the wall's, as the coefficients do (bed.cpp).
  const auto get = [=, wall_key = fmt::format("contact.wall_{}", key.key)](const Case& c) {
    const std::optional<Names> names = split(c, pair);
    if (!names) return get_target(c, follows);
    std::optional<double> value;
    for (const PairContact& p : c.pairs)
      if (holds_for(c, p, *names) && p.*field) value = *(p.*field);
    if (value) return *value;
    const std::vector<std::string> grains = grain_names(c);
    const auto grain = [&](const std::string& name) {
      return std::find(grains.begin(), grains.end(), name) != grains.end();
    };
    const bool wall = !grain(names->first) || !grain(names->second);
    return get_target(c, wall && find_target(wall_key) ? wall_key : follows);
  };
  const auto set = [=](Case& c, double x) {
    const Names names = split(c, pair).value();
    // The last word wins.
    if (c.pairs.empty() || !same(c.pairs.back(), names)) {
      c.pairs.push_back({});
      std::tie(c.pairs.back().first, c.pairs.back().second) = names;
    }
    c.pairs.back().*field = x;
  };
  const auto unused = [=, name = std::string(key.key)](const Case& c) -> std::string {
    if (split(c, pair)) return unread(c.contact, name);
    return fmt::format("is between no two of its materials ({}) and bodies ({})", fmt::join(grain_names(c), ", "),
                       fmt::join(body_names(c), ", "));
  };
  return {std::move(t), get, set, unused};
}

struct ComponentKey {
  std::string_view key;
  Target target;
  std::function<double(const Case&, const Component&)> get;
  std::function<void(Component&, double)> set;
};
const std::vector<ComponentKey>& component_keys() {
  const auto like = [](std::string_view name) { return *find_target(name); };
  static const std::vector<ComponentKey> all{
      {"density", like("material.density"), [](const Case&, const Component& k) { return k.material.density; },
       [](Component& k, double x) { k.material.density = x; }},
      {"diameter", like("material.diameter"), [](const Case&, const Component& k) { return k.material.diameter; },
       [](Component& k, double x) { k.material.diameter = x; }},
      {"mass_fraction",
       {"", "1", 0.0, 1.0, "share of the bed's mass, relative to the sum of all"},
       [](const Case&, const Component& k) { return k.mass_fraction; },
       [](Component& k, double x) { k.mass_fraction = x; }},
      {"young_modulus", like("contact.young_modulus"),
       [](const Case& c, const Component& k) { return k.material.young_modulus.value_or(c.contact.young_modulus); },
       [](Component& k, double x) { k.material.young_modulus = x; }},
      {"poisson_ratio", like("contact.poisson_ratio"),
       [](const Case& c, const Component& k) { return k.material.poisson_ratio.value_or(c.contact.poisson_ratio); },
       [](Component& k, double x) { k.material.poisson_ratio = x; }}};
  return all;
}

Binding of_component(std::string_view component, const ComponentKey& key) {
  const std::string name(component);
  Target t = key.target;
  t.name = fmt::format("material.{}.{}", name, key.key);
  t.meaning += fmt::format(", of {}", name);
  const auto find = [name](auto& components) {
    return std::find_if(components.begin(), components.end(), [&](const auto& k) { return k.material.name == name; });
  };
  const auto unused = [=, which = std::string(key.key)](const Case& c) -> std::string {
    const auto it = find(c.components);
    if (it == c.components.end())
      return fmt::format("is of no component of this bed ({})", fmt::join(grain_names(c), ", "));
    if (which == "diameter" && !it->material.sizes.empty()) return "is not read with a list of sizes";
    return which == "young_modulus" || which == "poisson_ratio" ? unread(c.contact, which) : "";
  };
  return {std::move(t),
          [=, &key](const Case& c) {
            const auto it = find(c.components);
            return it == c.components.end() ? 0.0 : key.get(c, *it);
          },
          [=, &key](Case& c, double x) { key.set(*find(c.components), x); }, unused};
}

std::optional<Binding> find_binding(std::string_view name) {
  for (const Binding& b : bindings()) {
    const std::string_view full = b.target.name;
    if (full == name || full.substr(full.find('.') + 1) == name) return b;
  }
  const std::size_t first = name.find('.'), last = name.rfind('.');
  if (first == last) return {};
  const std::string_view section = name.substr(0, first), middle = name.substr(first + 1, last - first - 1),
                         key = name.substr(last + 1);
  if (section == "contact") {
    for (const PairKey& k : pair_keys)
      if (k.key == key) return of_pair(*find_target("contact." + std::string(key)), middle, k);
  } else if (section == "material") {
    for (const ComponentKey& k : component_keys())
      if (k.key == key) return of_component(middle, k);
  }
  return {};
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
    throw data::InputError(data::ExitStatus::bad_study,
                           {t.name, fmt::format("is {:g} {}, but must lie in [{:g}, {:g}]", si, t.unit, t.low, t.high),
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
  const auto add = [&](std::string name) {
    if (unused_because(c, name).empty()) names.push_back(std::move(name));
  };
  for (const Binding& b : bindings()) add(b.target.name);
  for (const Component& k : c.components) {
    for (const ComponentKey& key : component_keys()) add(fmt::format("material.{}.{}", k.material.name, key.key));
  }
  for (const PairContact& p : c.pairs) {
    for (const PairKey& key : pair_keys) {
      const std::string name = fmt::format("contact.{}-{}.{}", p.first, p.second, key.key);
      if (p.*key.field && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
  }
  return names;
}

}  // namespace dem
