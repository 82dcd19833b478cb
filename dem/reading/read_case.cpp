#include "dem/reading/read_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "dem/case/grains.hpp"
#include "dem/reading/prepare.hpp"
#include "dem/reading/target.hpp"
#include "dem/rig/rig.hpp"
#include "dem/rig/rig_kind.hpp"

namespace dem {
namespace {

using data::Range;
using data::Section;

/// What a key means that this case's laws do not read: a problem, or one for other materials, whose laws may read it.
enum class Unread { is_a_problem, is_for_others };

/// A key whose name, unit and range are those of the target "SECTION.KEY".
void read(const Section& s, std::string_view section, std::string_view key, Case& c,
          Unread unread = Unread::is_a_problem) {
  if (!s.has(key)) return;
  const Target t = target(std::string(section) + "." + std::string(key));
  const double value = s.quantity(key, t.unit, {.low = t.low, .high = t.high}, get_target(c, t.name));
  if (!(value >= t.low && value <= t.high)) return;
  const std::string why = unused_because(c, t.name);
  if (why.empty())
    set_target(c, t.name, value);
  else if (unread == Unread::is_a_problem)
    s.problem(key, why, "remove it, or choose what reads it");
}

/// A bare number counts spheres, a quantity is a mass.
void read_fill(const Section& s, Case& c) {
  if (!s.has("fill")) return;
  const data::Range range{.low = 0.0, .high = target("fill").high, .open_low = true};
  constexpr double unread = std::numeric_limits<double>::quiet_NaN();  // what is wrong with it is recorded already
  const bool counted = s.kind("fill") == data::ValueKind::number;
  const double fill = counted ? s.number("fill", range, unread) : s.quantity("fill", "kg", range, unread);
  if (std::isnan(fill)) return;
  if (counted && std::round(fill) != fill) {
    s.problem("fill", fmt::format("is {:g}, and a number of spheres is whole", fill),
              "give a whole number, or a mass with its unit");
    return;
  }
  c.rig.fill_mass.reset();
  c.rig.level.reset();
  if (counted)
    c.rig.fill = fill;
  else
    c.rig.fill_mass = fill;
}

void read_rig(const Section& s, const std::string& folder, Case& c) {
  std::vector<std::string> names;
  for (const RigKind* one : rig_kinds) names.emplace_back(one->name);
  const std::string name = s.choice("kind", names, names.front());
  const auto found =
      std::find_if(rig_kinds.begin(), rig_kinds.end(), [&](const RigKind* one) { return one->name == name; });
  const RigKind& kind = found == rig_kinds.end() ? *rig_kinds.front() : **found;
  kind.read(s, folder, c);
  for (const RigQuantity& one : kind.quantities) read(s, "rig", one.key, c);
  read(s, "rig", "rpm", c);
  if (kind.fill_by == FillBy::fill_or_level && s.has("fill") && s.has("level"))
    s.problem("level", "stands beside fill, which says how much powder there is, too", "keep one of them");
  read_fill(s, c);
}

std::optional<double> read_coefficient(const Section& s, std::string_view key) {
  if (!s.has(key)) return {};
  const Target t = target("contact." + std::string(key));
  return s.quantity(key, t.unit, {.low = t.low, .high = t.high});
}

void read_pair(const Section& s, Case& c) {
  PairContact pair;
  const std::vector<std::string> between = s.texts("between", true);
  if (between.size() == 2) {
    pair.first = between[0];
    pair.second = between[1];
  } else {
    s.problem("between", fmt::format("has {} names", between.size()), R"(give two, like ["sand", "wall"])");
  }
  for (const PairKey& k : pair_keys) pair.*k.field = read_coefficient(s, k.key);
  c.pairs.push_back(std::move(pair));
}

/// The choices of laws come first: which coefficients are read depends on them.
void read_laws(const Section& s, Contact& k) {
  k.normal = s.choice("normal", k.normal);
  if (s.has("tangential")) k.tangential = s.choice("tangential", TangentialLaw::linear);
  k.resistance = s.choice("resistance", k.resistance);
  k.cohesion = s.choice("cohesion", k.cohesion);
  k.tension = s.choice("tension", k.tension);
  k.cap = s.choice("cap", k.cap);
  k.hamaker_of = s.choice("hamaker_of", k.hamaker_of);
  if (s.has("hamaker_power")) k.hamaker_power = s.number("hamaker_power", {.low = 0.0, .high = 4.0});
  k.length_scale = s.choice("length_scale", k.length_scale);
  k.wall_attraction = s.choice("wall_attraction", k.wall_attraction);
  if (s.has("restitution_at")) {
    const double speed = s.quantity("restitution_at", "m/s", {.low = 0.0, .high = 1000.0, .open_low = true});
    if (speed > 0.0) k.restitution_at = speed;  // else a problem is noted, and no collision is tried
  }
}

constexpr const char* laws[]{"normal", "tangential", "resistance", "cohesion"};
bool chooses_laws(const Section& s) {
  return std::any_of(std::begin(laws), std::end(laws), [&](const char* key) { return s.has(key); });
}

/// The study's [contact], then the material's own.
void read_contact(const Section& common, const Section& own, Unread unread, Case& c) {
  read_laws(common, c.contact);
  read_laws(own, c.contact);
  for (const Coefficient& k : coefficients()) read(common, "contact", k.key, c, unread);
  for (const Coefficient& k : coefficients()) read(own, "contact", k.key, c);
  for (const Section& pair : common.array("pair")) read_pair(pair, c);
  for (const Section& pair : own.array("pair")) read_pair(pair, c);
}

void read_run(const Section& s, RunControl& r) {
  r.gravity = s.quantity("gravity", "m/s2", {.low = 0.0, .high = 1000.0, .open_low = true}, r.gravity);
  r.steps_per_contact = s.number("steps_per_contact", {.low = 15.0, .high = 10000.0}, r.steps_per_contact);
  if (s.has("time_step")) r.time_step = s.quantity("time_step", "s", data::positive);
  r.overlap_limit = s.number("overlap_limit", {.low = 0.0, .high = 1.0, .open_low = true}, r.overlap_limit);
  r.skin = s.number("skin", {.low = 0.01, .high = 1.0}, r.skin);
  r.settle = s.quantity("settle", "s", data::non_negative, r.settle);
  r.start_up = s.quantity("start_up", "s", data::non_negative, r.start_up);
  r.start_up_turns = s.number("start_up_turns", data::non_negative, r.start_up_turns);
  r.sample_interval = s.quantity("sample_interval", "s", data::positive, r.sample_interval);
  r.window = s.quantity("window", "s", data::positive, r.window);
  r.shortest = s.quantity("shortest", "s", data::positive, r.shortest);
  r.shortest_turns = s.number("shortest_turns", data::non_negative, r.shortest_turns);
  r.longest = s.quantity("longest", "s", data::positive, r.longest);
}

LogNormalSizes read_distribution(const Section& s, Material& m) {
  const Target diameter = target("material.diameter");
  const Range lengths{.low = diameter.low, .high = diameter.high};
  const Target spread = target("material.geometric_sd");
  s.choice("kind", {"log_normal"});
  m.diameter = s.quantity("median", "m", lengths);
  LogNormalSizes l;
  l.geometric_sd = s.number("geometric_sd", {.low = spread.low, .high = spread.high});
  const double two = l.geometric_sd * l.geometric_sd;
  l.low = s.quantity("low", "m", lengths, m.diameter / two);
  l.high = s.quantity("high", "m", lengths, m.diameter * two);
  return l;
}

/// Reads the properties of a grain by itself.
void read_grain(const Section& s, Material& m) {
  const auto number = [&](const char* key, double& field) {
    if (!s.has(key)) return;
    const Target t = target(std::string("material.") + key);
    field = s.quantity(key, t.unit, {.low = t.low, .high = t.high});
  };
  number("density", m.density);
  number("diameter", m.diameter);
  number("coarse_graining", m.coarse_graining);
  const Target diameter = target("material.diameter");
  for (const Section& size : s.array("sizes"))
    m.sizes.push_back({size.quantity("diameter", "m", {.low = diameter.low, .high = diameter.high}),
                       size.number("mass_fraction", {.low = 0.0, .high = 1.0, .open_low = true})});
  if (s.has("distribution")) m.log_normal = read_distribution(s.child("distribution"), m);
  if (s.has("diameter") && (!m.sizes.empty() || m.log_normal))
    s.problem("diameter", "stands beside sizes or a distribution", "keep one of them");
}

/// Reads a component's own [contact]. It holds between the component's grains, and at walls except where those have a
/// value of their own: the component's wall_KEY, else that of the mixture or of the study.
void read_component_contact(const Section& s, const std::vector<Section>& of_all, const std::string& name, Case& c,
                            Material& m) {
  PairContact grains, walls;
  grains.first = grains.second = walls.first = name;
  walls.second = "wall";
  if (chooses_laws(s)) s.problem("", "chooses laws for a component", "the laws are those of the mixture");
  bool some = false, some_wall = false;
  for (const PairKey& k : pair_keys) {
    grains.*k.field = walls.*k.field = read_coefficient(s, k.key);
    const std::string wall_key = fmt::format("wall_{}", k.key);
    if (find_target("contact." + wall_key)) {
      const bool of_all_walls =
          std::any_of(of_all.begin(), of_all.end(), [&](const Section& one) { return one.has(wall_key); });
      if (const std::optional<double> of_wall = read_coefficient(s, wall_key))
        walls.*k.field = of_wall;
      else if (of_all_walls)
        walls.*k.field = {};
    }
    some = some || grains.*k.field;
    some_wall = some_wall || walls.*k.field;
  }
  m.young_modulus = read_coefficient(s, "young_modulus");
  m.poisson_ratio = read_coefficient(s, "poisson_ratio");
  if (some) c.pairs.push_back(grains);
  if (some_wall) c.pairs.push_back(walls);
}

void read_components(const Section& mixture, const Section& root, Case& c) {
  const Section materials = root.child("materials");
  const std::vector<Section> of_all{root.child("contact"), mixture.child("contact")};
  double sum = 0.0;
  for (const Section& s : mixture.array("components")) {
    const std::string name = s.text("material");
    Component part;
    part.material.name = name;
    part.mass_fraction = s.number("mass_fraction", {.low = 0.0, .high = 1.0});
    sum += part.mass_fraction;
    if (!materials.has(name) || name == c.material.name) {
      s.problem("material", fmt::format("there is no other material '{}'", name), "name a table of [materials]");
      continue;
    }
    const Section own = materials.child(name);
    for (const char* key : {"coarse_graining", "fill"})
      if (own.has(key)) own.problem(key, "is that of the mixture, not of a component", "move it to " + c.material.name);
    read_grain(own, part.material);
    read_component_contact(own.child("contact"), of_all, name, c, part.material);
    c.components.push_back(std::move(part));
  }
  if (!(std::abs(sum - 1.0) < 1e-3))
    mixture.problem("components", fmt::format("have mass fractions that sum to {:g}, not 1", sum), "correct them");
}

void read_material(const Section& s, const Section& root, Case& c) {
  const Section materials = root.child("materials");
  read_fill(s, c);
  if (s.has("components")) {
    for (const char* key : {"density", "diameter", "sizes", "distribution"})
      if (s.has(key)) s.problem(key, "is that of each component, not of the mixture", "move it to the components");
    read(s, "material", "coarse_graining", c);
    read_components(s, root, c);
  } else {
    read_grain(s, c.material);
  }
  bool various = false;
  for (const auto& [name, other] : materials.children()) various = various || chooses_laws(other.child("contact"));
  read_contact(root.child("contact"), s.child("contact"), various ? Unread::is_for_others : Unread::is_a_problem, c);
}

/// Pairs must name materials of the study or bodies; those of other materials than this bed's are left out.
void sort_out_pairs(const Section& root, Case& c) {
  const std::vector<std::string> grains = grain_names(c), bodies = body_names(c);
  const auto in = [](const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  std::erase_if(c.pairs, [&](const PairContact& p) {
    for (const std::string& name : {p.first, p.second}) {
      if (!name.empty() && !in(grains, name) && !in(bodies, name) && !root.child("materials").has(name))
        root.child("contact").problem(
            "pair", fmt::format("names '{}', which is no material, mesh or mesh's material", name),
            fmt::format("choose two of: {}, {}", fmt::join(grains, ", "), fmt::join(bodies, ", ")));
    }
    const auto is_grain = [&](const std::string& name) {
      return in(grains, name) || root.child("materials").has(name);
    };
    if (in(bodies, p.first) && in(bodies, p.second) && !is_grain(p.first) && !is_grain(p.second))
      root.child("contact").problem(
          "pair", fmt::format("is between '{}' and '{}', and meshes never touch each other", p.first, p.second),
          fmt::format("choose a material of the bed for one of them: {}", fmt::join(grains, ", ")));
    return !((in(grains, p.first) && (in(grains, p.second) || in(bodies, p.second))) ||
             (in(bodies, p.first) && in(grains, p.second)));
  });
}

/// Where the study says what a problem of the case is about: a section, and a key of it that may be missing.
struct Blamed {
  Section section;
  std::string key;
};

/// The key to blame for a problem at "rig.mesh.NAME", "rig.KEY", "contact.KEY", "contact.A-B.KEY", "run.KEY",
/// "material.KEY", "material(s).NAME.KEY".
Blamed blamed_for(const Section& root, const std::string& material, const std::string& place) {
  const std::size_t dot = std::min(place.find('.'), place.size()), last = place.rfind('.');
  const std::string first = place.substr(0, dot), rest = dot < place.size() ? place.substr(dot + 1) : "";
  const Section materials = root.child("materials"), rig = root.child("rig");
  const Section own = materials.child(material);
  if (first == "material" || first == "materials") {
    const std::string name = rest.substr(0, rest.find('.'));
    if (!materials.has(name)) return {own, rest};
    return {materials.child(name), name.size() < rest.size() ? rest.substr(name.size() + 1) : ""};
  }
  if (first == "contact") {
    const Section its = own.child("contact"), common = root.child("contact");
    const std::string key = last > dot ? "pair" : rest;
    return its.has(key) || (!common.has(key) && its.exists()) ? Blamed{its, key} : Blamed{common, key};
  }
  if (first == "run") return {root.child("run"), rest};
  if (rest == "fill" || rest == "fill_mass") return {own.has("fill") ? own : rig, "fill"};
  if (rest.starts_with("mesh.")) {
    for (const Section& mesh : rig.array("mesh"))
      if (mesh.name() == place) return {mesh, ""};
  }
  return {rig, rest};
}

/// Whether a problem was recorded in one of the sections: what follows from a value that was not read is no news.
bool spoiled(const data::StudyFile& study, std::initializer_list<std::string_view> sections) {
  const std::vector<data::Problem> recorded = study.recorded();
  return std::any_of(recorded.begin(), recorded.end(), [&](const data::Problem& p) {
    const std::size_t colon = p.place.rfind(": ");
    const std::string key = colon == std::string::npos ? p.place : p.place.substr(colon + 2);
    return std::any_of(sections.begin(), sections.end(), [&](std::string_view section) {
      return key.starts_with(section) && (key.size() == section.size() || key[section.size()] == '.');
    });
  });
}

/// Problems that no single key is to blame for; single keys were checked as they were read. Each stands at the line of
/// the key that it is about.
void record_problems(const data::StudyFile& study, const Case& c) {
  if (spoiled(study, {"rig", "materials"})) return;
  const bool laws_read = !spoiled(study, {"contact", "run"});
  const Section root = study.root();
  for (const data::Problem& p : problems(c)) {
    if (!laws_read && (p.place.starts_with("contact.") || p.place.starts_with("run."))) continue;
    const Blamed blamed = blamed_for(root, c.material.name, p.place);
    blamed.section.problem(blamed.key, p.what, p.remedy);
  }
}

}  // namespace

Case read_case(const data::StudyFile& study, std::string_view material, const std::vector<SetValue>& set) {
  const Section root = study.root();
  Case c;
  read_rig(root.child("rig"), study.folder(), c);
  read_run(root.child("run"), c.run);
  c.run.standard_error =
      root.child("training")
          .number("standard_error", {.low = 0.0, .high = 1.0, .open_low = true}, c.run.standard_error);
  const auto materials = root.child("materials").children();
  if (materials.empty()) read_contact(root.child("contact"), root.child("none"), Unread::is_a_problem, c);
  // Every material's keys are known, whichever is read.
  const Case common = c;
  for (const auto& [name, section] : materials) {
    Case other = common;
    other.material.name = name;
    read_material(section, root, other);
    if (name == material) c = other;
  }
  sort_out_pairs(root, c);
  Case judged = c;
  for (const SetValue& value : set) {
    try {
      set_target(judged, value.target, value.si);
    } catch (const data::InputError&) {  // the case does not use it: said where the target is checked
    }
  }
  record_problems(study, judged);
  return c;
}

}  // namespace dem
