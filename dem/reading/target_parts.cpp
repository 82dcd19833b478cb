// Targets of parts of a case: of a pair of materials, and of a component.
#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <tuple>
#include <utility>
#include <vector>

#include "dem/case/coefficients.hpp"
#include "dem/case/grains.hpp"
#include "dem/reading/binding.hpp"
#include "dem/rig/rig.hpp"

namespace dem {
namespace {

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
    if (c.components.empty())
      return fmt::format("is that of a component, and this bed has none: write {}.{}",
                         which == "young_modulus" || which == "poisson_ratio" ? "contact" : "material", which);
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

}  // namespace

std::optional<Binding> find_part(std::string_view name) {
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

std::vector<std::string> part_quantities(const Case& c) {
  std::vector<std::string> names;
  for (const Component& k : c.components) {
    for (const ComponentKey& key : component_keys()) {
      const std::string name = fmt::format("material.{}.{}", k.material.name, key.key);
      if (unused_because(c, name).empty()) names.push_back(name);
    }
  }
  for (const PairContact& p : c.pairs) {
    for (const PairKey& key : pair_keys) {
      const std::string name = fmt::format("contact.{}-{}.{}", p.first, p.second, key.key);
      if (p.*key.field && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
    }
  }
  return names;
}

std::string walls_without_effect(const Case& c, const std::string& name) {
  constexpr std::string_view of_walls = "contact.wall_";
  if (!name.starts_with(of_walls)) return "";
  const auto key = std::find_if(std::begin(pair_keys), std::end(pair_keys),
                                [&](const PairKey& k) { return k.key == name.substr(of_walls.size()); });
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

}  // namespace dem
