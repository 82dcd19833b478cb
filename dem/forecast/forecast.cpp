#include "dem/forecast/forecast.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dem/bed/derived.hpp"
#include "dem/case/grains.hpp"
#include "dem/forecast/forecast_meshes.hpp"
#include "dem/forecast/forecast_words.hpp"
#include "dem/rig/rig_kind.hpp"
#include "dem/rig/rig_words.hpp"

namespace dem {

void say_gap(Forecast& f, const std::string& between, double width) {
  const double in_spheres = width / f.largest;
  if (in_spheres < 4.0) f.gaps.push_back({between, width, in_spheres});
  if (width > 0.0 && in_spheres < 1.0 - 1e-6)
    f.warnings.push_back(
        fmt::format("the gap between {} is {} mm, {:.2g} of the largest sphere ({} mm): spheres are pinched there "
                    "(three are safe; make the gap wider or the spheres smaller)",
                    between, mm(width), in_spheres, mm(f.largest)));
}

void say_immersion(Forecast& f, const std::string& tool, double lowest) {
  constexpr double enough = 1.8;  // of the largest sphere
  const double depth = *f.surface - lowest;
  if (depth >= enough * f.largest) return;
  if (depth < 0.0) {
    f.warnings.push_back(fmt::format(
        "{} ends {} mm above the bed: it may never touch the powder, and the torque be 0 (raise the fill until it dips {} mm)",
        tool, mm(-depth), mm(enough * f.largest)));
    return;
  }
  f.warnings.push_back(fmt::format(
      "{} dips only {} mm into the bed, {:.2g} of the largest sphere: the bed settles below it, and the torque falls "
      "for long (raise the fill until it dips {} mm)",
      tool, mm(depth), depth / f.largest, mm(enough * f.largest)));
}

namespace {

void say_density(const Case& c, Forecast& f) {
  for (const Component& k : components_of(c)) {
    const double density = k.material.density;
    if (density >= 30.0 && density <= 23000.0) continue;
    f.warnings.push_back(fmt::format("material {} has a density of {:g} kg/m3, {} than any solid (was {} meant?)",
                                     k.material.name, density, density < 30.0 ? "less" : "more",
                                     density < 30.0 ? fmt::format("{:g} g/cm3", density) : "another unit"));
  }
}

/// A centrifuge may have any other multiple of the Earth's gravity.
void say_gravity(const Case& c, Forecast& f) {
  if (std::abs(c.run.gravity / 981.0 - 1.0) < 0.01)
    f.warnings.push_back(fmt::format("run.gravity is {:g} m/s2, a hundred times the Earth's (was {:g} cm/s2 meant?)",
                                     c.run.gravity, c.run.gravity));
}

/// How deep spheres press in where the tool hits them, of contact.stiffness.
void say_impacts(const Case& c, const Derived& d, Forecast& f) {
  if (c.contact.normal != NormalLaw::linear) return;
  const double speed = tool_speed(c);
  for (const ContactKind& kind : d.kinds) {
    const double overlap = speed * std::sqrt(kind.mass / kind.law.stiffness) / kind.radius;
    if (!kind.wall || !(overlap > c.run.overlap_limit)) continue;
    f.warnings.push_back(
        fmt::format("at {:.3g} m/s the tool presses a sphere of {} into {} by {:.2g} of a radius, more than "
                    "run.overlap_limit: the run is likely to end there (raise contact.stiffness)",
                    speed, kind.first, kind.second, overlap));
    return;
  }
}

void say_samples(const Case& c, const Derived& d, Forecast& f) {
  if (c.run.sample_interval >= d.time_step * (1.0 - 1e-9)) return;
  f.warnings.push_back(fmt::format(
      "run.sample_interval, {:g} s, is shorter than a time step, {:.3g} s, and each step makes a sample (lengthen it)",
      c.run.sample_interval, d.time_step));
}

Forecast with_outlook(Forecast f, RigOutlook seen) {
  f.fill = seen.fill;
  f.surface = seen.surface;
  f.up = std::move(seen.up);
  f.full_at = std::move(seen.full_at);
  f.bodies = std::move(seen.bodies);
  for (const RigOutlook::Passage& one : seen.passages) say_gap(f, one.between, one.width);
  for (const RigOutlook::Tool& one : seen.tools) say_immersion(f, one.name, one.lowest);
  f.warnings.insert(f.warnings.end(), seen.warnings.begin(), seen.warnings.end());
  f.problems.insert(f.problems.end(), seen.problems.begin(), seen.problems.end());
  return f;
}

}  // namespace

Forecast forecast(const PreparedCase& prepared, std::uint64_t seed) {
  const Case& c = prepared.given();
  const BedSummary bed = summarise_bed(c);
  Forecast f{.spheres = bed.spheres, .mass = bed.mass, .largest = bed.largest};
  say_density(c, f);
  say_gravity(c, f);
  say_impacts(c, prepared.derived(), f);
  say_samples(c, prepared.derived(), f);
  const RigKind& kind = kind_of(c);
  f = kind.outlook != nullptr ? with_outlook(std::move(f), kind.outlook(c)) : forecast_of_meshes(c, seed, std::move(f));
  std::sort(f.gaps.begin(), f.gaps.end(), [](const NamedGap& a, const NamedGap& b) { return a.width < b.width; });
  return f;
}

std::vector<std::string> describe(const Forecast& f) {
  std::vector<std::string> lines = f.bodies;
  if (f.fill && f.surface) {
    const std::string above = "above ";  // the axis, or the axes
    const std::string surface = f.up.starts_with(above)
                                    ? fmt::format("{} mm {} {}", mm(std::abs(*f.surface)),
                                                  *f.surface < 0.0 ? "below" : "above", f.up.substr(above.size()))
                                    : fmt::format("at {} mm ({})", mm(*f.surface), f.up);
    lines.push_back(fmt::format("fill: {:.2g} % of the room up to {}; the bed's surface will lie {}", 100.0 * *f.fill,
                                f.full_at, surface));
  }
  for (const NamedGap& gap : f.gaps)
    lines.push_back(
        fmt::format("gap between {}: {} mm, {:.2g} of the largest sphere", gap.between, mm(gap.width), gap.in_spheres));
  return lines;
}

}  // namespace dem
