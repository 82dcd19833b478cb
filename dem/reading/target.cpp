#include "dem/reading/target.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <span>
#include <stdexcept>

#include "data/unit.hpp"
#include "dem/case/coefficients.hpp"
#include "dem/case/grains.hpp"
#include "dem/rig/rig.hpp"
#include "dem/rig/rig_kind.hpp"

namespace dem {
namespace {

struct Binding {
  Target target;
  std::function<double(const Case&)> get;
  std::function<void(Case&, double)> set;
  std::function<std::string(const Case&)> unused;  ///< why the case has no use for it
};

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
  // A value that the pair does not state follows the contact law's, at a wall the wall's, as the coefficients do
  // (bed.cpp).
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

std::string without_effect(const Case& c, std::string_view name) {
  const std::string full = target(name).name;
  if (full == "rig.rpm") return drives_a_body(c) ? "" : "drives no mesh of this rig: none has a speed_ratio";
  constexpr std::string_view of_walls = "contact.wall_";
  if (!full.starts_with(of_walls)) return "";
  const auto key = std::find_if(std::begin(pair_keys), std::end(pair_keys),
                                [&](const PairKey& k) { return k.key == full.substr(of_walls.size()); });
  if (key == std::end(pair_keys)) return "";
  for (const std::string& grain : grain_names(c)) {
    for (const BodyLabel& body : body_labels(c)) {
      const bool own = std::any_of(c.pairs.begin(), c.pairs.end(), [&](const PairContact& p) {
        return p.*key->field && holds_for(c, p, {grain, body.name});
      });
      if (!own) return "";
    }
  }
  return fmt::format("has no effect: every wall's {} is given by contact.pair", key->key);
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
