// The problems of a case that cannot be simulated.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "data/unit.hpp"
#include "dem/bed/derived.hpp"
#include "dem/case/grains.hpp"
#include "dem/reading/prepare.hpp"
#include "dem/reading/target.hpp"

namespace dem {
namespace {

using Found = std::vector<data::Problem>;

void check_ranges(const Case& c, Found& found) {
  for (const std::string& name : quantities_of(c)) {
    const double x = get_target(c, name);
    const Target t = target(name);
    if (!(x >= t.low && x <= t.high)) {
      found.push_back(
          {t.name,
           fmt::format("is {:g}{}, but must lie in [{:g}, {:g}]", x, data::behind_number(t.unit), t.low, t.high),
           "choose a value inside it"});
    } else if (std::string why = unused_because(c, name); !why.empty()) {  // of a pair
      found.push_back({t.name, std::move(why), "remove it, or choose the law that reads it"});
    }
  }
}

/// Laws that do not go together, and coefficients that no law chosen reads.
void check_laws(const Case& c, Found& found) {
  const Contact& k = c.contact;
  const auto add = [&](const char* place, std::string what, const char* remedy) {
    found.push_back({place, std::move(what), remedy});
  };
  if (k.normal == NormalLaw::linear && k.tangential == TangentialLaw::mindlin)
    add("contact.tangential", "is mindlin, which needs the contact radius that normal = \"linear\" does not know",
        "choose tangential = \"linear\", or normal = \"hertz\"");
  if (k.normal == NormalLaw::jkr && k.tangential == TangentialLaw::linear)
    add("contact.tangential", "is linear, but normal = \"jkr\" goes with mindlin only", "leave tangential away");
  if (k.normal == NormalLaw::jkr && k.cohesion == Cohesion::dmt)
    add("contact.cohesion", "is dmt beside normal = \"jkr\", which brings its own attraction",
        "leave cohesion away, or choose normal = \"hertz\"");
  for (const Coefficient& one : coefficients()) {
    if (one.brings == Brings::no_force || !(one.given(k) > 0.0)) continue;
    if (const std::string why = unread(k, one.key); !why.empty())
      found.push_back({fmt::format("contact.{}", one.key), fmt::format("is {:g}, but {}", one.given(k), why),
                       "remove it, or choose the law that reads it"});
  }
}

/// Simulated grains are softer than the real ones, whose attraction is scaled down to theirs; never the other way.
void check_softening(const Case& c, Found& found) {
  const auto check = [&](const char* key, double used, const std::optional<double>& real, const char* unit) {
    if (real && *real < used)
      found.push_back({fmt::format("contact.true_{}", key),
                       fmt::format("is {:g} {}, below contact.{}, {:g} {}: attraction would be scaled up", *real, unit,
                                   key, used, unit),
                       fmt::format("give the real grains' own, or lower contact.{}", key)});
  };
  if (c.contact.normal == NormalLaw::linear)
    check("stiffness", c.contact.stiffness, c.contact.true_stiffness, "N/m");
  else
    check("young_modulus", c.contact.young_modulus, c.contact.true_young_modulus, "Pa");
}

void check_sizes(const Material& m, const std::string& place, Found& found) {
  if (!m.sizes.empty() && m.log_normal)
    found.push_back({place, "has both a list of sizes and a distribution", "keep one of them"});
  double sum = 0.0;
  for (const SizeShare& s : m.sizes) {
    sum += s.mass_fraction;
    if (!(s.diameter >= target("material.diameter").low && s.diameter <= target("material.diameter").high))
      found.push_back({place + ".sizes", fmt::format("has a diameter of {:g} m", s.diameter), "correct it"});
    if (!(s.mass_fraction > 0.0))
      found.push_back({place + ".sizes", fmt::format("has a mass fraction of {:g}", s.mass_fraction),
                       "give it some mass, or remove it"});
  }
  if (!m.sizes.empty() && !(std::abs(sum - 1.0) < 1e-3))
    found.push_back({place + ".sizes", fmt::format("has mass fractions that sum to {:g}, not 1", sum), "correct them"});
  if (!m.log_normal) return;
  const LogNormalSizes& l = *m.log_normal;
  if (!(l.low > 0.0 && l.low < l.high && m.diameter > 0.2 * l.low && m.diameter < 5.0 * l.high))
    found.push_back(
        {place + ".distribution",
         fmt::format("has diameters from {:g} to {:g} m about a median of {:g} m", l.low, l.high, m.diameter),
         "give low < median < high"});
}

/// Sizes and shares of what the bed is made of.
void check_bed(const Case& c, Found& found) {
  double sum = 0.0;
  for (const Component& k : components_of(c)) {
    check_sizes(k.material, "materials." + k.material.name, found);
    sum += k.mass_fraction;
    if (!(k.mass_fraction >= 0.0))
      found.push_back({fmt::format("material.{}.mass_fraction", k.material.name),
                       fmt::format("is {:g}", k.mass_fraction), "give a positive number"});
  }
  if (!(sum > 0.0))
    found.push_back({"materials." + c.material.name, "has no mass in any component", "give mass fractions"});
  if (!found.empty()) return;
  const BedSummary bed = summarise_bed(c);
  if (bed.spheres == 0) {
    found.push_back({"rig.fill", "leaves no sphere in the box", "give a larger fill"});
    return;
  }
  const std::vector<Component> parts = components_of(c);
  for (const GrainClass& g : bed.classes) {
    if (g.count == 0 && parts[g.component].mass_fraction > 0.0)
      found.push_back({"rig.fill",
                       fmt::format("of {} spheres leaves none of {}{}", bed.spheres, parts[g.component].material.name,
                                   g.diameter > 0.0 ? fmt::format(" of {:g} m", g.diameter) : ""),
                       "give a larger fill, or leave that share away"});
  }
  if (bed.largest > 20.0 * bed.smallest)
    found.push_back({"materials." + c.material.name,
                     fmt::format("has spheres from {:g} to {:g} m, a ratio of {:.3g} where at most 20 is followed",
                                 bed.smallest, bed.largest, bed.largest / bed.smallest),
                     "cut the smallest off"});
}

/// Checks that a contact is not pressed flat by the load that rests on it and the attraction.
void check_overlap(const Case& c, const Derived& d, Found& found) {
  const ContactKind* worst = nullptr;
  for (const ContactKind& kind : d.kinds)
    if (worst == nullptr || kind.rest_overlap > worst->rest_overlap) worst = &kind;
  if (!(worst->rest_overlap > c.run.overlap_limit)) return;
  const bool linear = c.contact.normal == NormalLaw::linear;
  const double times = worst->rest_overlap / c.run.overlap_limit;
  const std::string softer = linear ? fmt::format("{:.3g} N/m", worst->law.stiffness * times)
                                    : fmt::format("{:.3g} Pa", c.contact.young_modulus * std::pow(times, 1.5));
  found.push_back(
      {linear ? "contact.stiffness" : "contact.young_modulus",
       fmt::format("lets {} and {} at rest overlap by {:.2g} of a radius under the fill and the attraction, "
                   "more than run.overlap_limit",
                   worst->first, worst->second, worst->rest_overlap),
       fmt::format("raise it to {} or more", softer)});
}

/// Where no damping gives the restitution wanted at restitution_at.
void check_restitution(const Case& c, const Derived& d, Found& found) {
  if (!c.contact.restitution_at) return;
  const BedCoefficients as_given = make_bed(c, body_labels(c));
  for (const ContactKind& kind : d.kinds) {
    if (kind.found && kind.found->damping_ratio) {
      const auto bodies = as_given.wall.size() / static_cast<std::size_t>(as_given.materials);
      const PairCoefficients& given =
          kind.wall ? as_given.wall[kind.material * bodies + kind.other]
                    : as_given.grain[kind.material * static_cast<std::size_t>(as_given.materials) + kind.other];
      const double wanted = restitution_of(given.damping_ratio), got = kind.found->collision.restitution;
      if (std::abs(got - wanted) > 1e-5)
        found.push_back(
            {"contact.restitution_at",
             fmt::format("is {:g} m/s, at which no damping of {} and {} was found for a restitution of {:g}: "
                         "the nearest gives {:g}",
                         *c.contact.restitution_at, kind.first, kind.second, wanted, got),
             "change the speed or the restitution a little"});
      continue;
    }
    if (!kind.found) continue;
    const Collision& undamped = kind.found->collision;
    found.push_back(
        {"contact.restitution_at",
         undamped.end == CollisionEnd::sticks
             ? fmt::format(
                   "is {:g} m/s, at which {} and {} stick whatever the damping: the attraction alone holds them",
                   *c.contact.restitution_at, kind.first, kind.second)
             : fmt::format("is {:g} m/s, at which {} and {} without any damping keep {:.3g} of their speed: the "
                           "attraction takes the rest",
                           *c.contact.restitution_at, kind.first, kind.second, undamped.restitution),
         "raise the speed, lower the restitution, or weaken the attraction"});
  }
}

/// Sample, window and length of a run, each against the next.
void check_times(const Case& c, Found& found) {
  const RunControl& r = c.run;
  constexpr double windows = 8.0;  // for a fluctuation
  if (!(r.sample_interval <= r.window))
    found.push_back({"run.sample_interval",
                     fmt::format("is {:g} s, longer than run.window, {:g} s, of which samples are parts",
                                 r.sample_interval, r.window),
                     "shorten it, or lengthen the window"});
  if (!(r.longest > r.start_up))
    found.push_back({"run.longest", fmt::format("leaves nothing to measure after the start-up of {:g} s", r.start_up),
                     "make it longer"});
  else if (!(windows * r.window <= (r.longest - r.start_up) * (1.0 + 1e-9)))
    found.push_back({"run.window",
                     fmt::format("is {:g} s, of which fewer than {:g} are in the {:g} s from start_up to longest",
                                 r.window, windows, r.longest - r.start_up),
                     "shorten it, or lengthen run.longest"});
}

/// Problems of a case, and, where there are none that forbid it, what follows from it.
struct Examined {
  Found problems;
  std::optional<Derived> derived;
};

Examined examine(const Case& c) {
  Found found;
  check_ranges(c, found);
  check_laws(c, found);
  check_softening(c, found);
  if (!found.empty()) return {found, {}};
  check_bed(c, found);
  if (!found.empty()) return {found, {}};
  for (data::Problem& p : rig_problems(c)) found.push_back(std::move(p));
  const auto add = [&](std::string place, std::string what, std::string remedy) {
    found.push_back({std::move(place), std::move(what), std::move(remedy)});
  };
  const Derived d = derive(c);
  check_overlap(c, d, found);
  check_restitution(c, d, found);
  if (unused_because(c, "contact.cut_off").empty()) {
    if (c.contact.cut_off > 0.5 * d.smallest) add("contact.cut_off", "is longer than a sphere's radius", "shorten it");
    if (c.contact.minimum_separation > c.contact.cut_off) {
      add("contact.cut_off", "is shorter than the minimum separation",
          "make it longer, or the minimum separation shorter");
    }
  }
  check_times(c, found);
  if (c.run.time_step) {
    if (!(*c.run.time_step <= d.contact_duration / 15.0))
      add("run.time_step",
          fmt::format("is {:g} s, but at most {:g} s, a fifteenth of the shortest contact ({}), follows it",
                      *c.run.time_step, d.contact_duration / 15.0, d.duration_of),
          "shorten it, or leave it away");
  } else if (!(c.run.steps_per_contact >= 15.0)) {
    add("run.steps_per_contact",
        fmt::format("is {:g}: fewer than 15 steps do not follow a contact", c.run.steps_per_contact),
        "20 to 50 is usual");
  }
  return {std::move(found), d};
}

}  // namespace

std::vector<data::Problem> problems(const Case& c) { return examine(c).problems; }

PreparedCase prepare(Case c) {
  Examined examined = examine(c);
  if (!examined.problems.empty()) throw data::InputError(data::ExitStatus::bad_study, std::move(examined.problems));
  return {std::move(c), *std::move(examined.derived)};
}

}  // namespace dem
