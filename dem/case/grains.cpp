#include "dem/case/grains.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "data/random.hpp"
#include "dem/case/cross_section.hpp"

namespace dem {
namespace {

double sphere_mass(double density, double diameter) {
  return density * std::numbers::pi / 6.0 * diameter * diameter * diameter;
}
double ball(double diameter) { return sphere_mass(1.0, diameter); }

/// Phi(b) - Phi(a), in the tail where neither cancels.
double normal_between(double a, double b) {
  const auto tail = [](double z) { return 0.5 * std::erfc(z * std::numbers::sqrt2 / 2.0); };  // 1 - Phi(z)
  return a > 0.0 ? tail(a) - tail(b) : tail(-b) - tail(-a);
}

/// The numbers of spheres below a diameter: normal in ln d, cut off.
struct NumberLaw {
  double center, spread;  ///< mean and standard deviation of ln(d / 1 m)
  double low, high;       ///< standardised
};
NumberLaw number_law(const Material& m) {
  const double s = std::log(m.log_normal->geometric_sd), center = std::log(m.diameter) - 3.0 * s * s;
  return {center, s, (std::log(m.log_normal->low) - center) / s, (std::log(m.log_normal->high) - center) / s};
}

double mean_cube(const Material& m) {
  const NumberLaw law = number_law(m);
  const double shift = 3.0 * law.spread;
  return std::exp(3.0 * law.center + 0.5 * shift * shift) * normal_between(law.low - shift, law.high - shift) /
         normal_between(law.low, law.high);
}

/// The diameter below which a share of the numbers lies, by bisection to rounding.
double quantile(const NumberLaw& law, double share) {
  double low = law.low, high = law.high;
  const double all = normal_between(law.low, law.high);
  for (int k = 0; k < 60; ++k) {
    const double middle = 0.5 * (low + high);
    (normal_between(law.low, middle) < share * all ? low : high) = middle;
  }
  return std::exp(law.center + law.spread * 0.5 * (low + high));
}

/// Whole numbers of the same sum, by largest remainders.
std::vector<std::size_t> whole(const std::vector<double>& numbers, std::size_t total) {
  std::vector<std::size_t> count(numbers.size()), order(numbers.size());
  std::size_t given = 0;
  for (std::size_t k = 0; k < numbers.size(); ++k) given += count[k] = static_cast<std::size_t>(numbers[k]);
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto rest = [&](std::size_t k) { return numbers[k] - std::floor(numbers[k]); };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return rest(a) > rest(b); });
  for (std::size_t k = 0; given < total; k = (k + 1) % order.size(), ++given) ++count[order[k]];
  return count;
}

}  // namespace

std::vector<Component> components_of(const Case& c) {
  return c.components.empty() ? std::vector<Component>{{c.material, 1.0}} : c.components;
}

std::vector<std::string> grain_names(const Case& c) {
  std::vector<std::string> names;
  for (const Component& k : components_of(c)) names.push_back(k.material.name);
  return names;
}

double smallest_diameter(const Material& m) {
  if (m.log_normal) return m.log_normal->low;
  double smallest = m.sizes.empty() ? m.diameter : m.sizes[0].diameter;
  for (const SizeShare& s : m.sizes) smallest = std::min(smallest, s.diameter);
  return smallest;
}

double mean_diameter(const Material& m) {
  if (m.log_normal) return std::cbrt(mean_cube(m));
  if (m.sizes.empty()) return m.diameter;
  double mass = 0.0, number = 0.0;  // per density
  for (const SizeShare& s : m.sizes) {
    mass += s.mass_fraction;
    number += s.mass_fraction / ball(s.diameter);
  }
  return std::cbrt(mass / number / (std::numbers::pi / 6.0));
}

BedSummary summarise_bed(const Case& c) {
  const std::vector<Component> components = components_of(c);
  BedSummary bed;
  std::vector<double> share;  // of the mass, to a common factor
  const auto add = [&](std::size_t component, double diameter, double mean_mass, double fraction) {
    bed.classes.push_back({component, diameter, mean_mass, 0});
    share.push_back(fraction);
  };
  for (std::size_t k = 0; k < components.size(); ++k) {
    const Material& m = components[k].material;
    const double fraction = components[k].mass_fraction;
    double largest = m.diameter;
    if (m.log_normal) {
      add(k, 0.0, sphere_mass(m.density, std::cbrt(mean_cube(m))), fraction);
      largest = m.log_normal->high;
    } else if (m.sizes.empty()) {
      add(k, m.diameter, sphere_mass(m.density, m.diameter), fraction);
    } else {
      double sum = 0.0;
      for (const SizeShare& s : m.sizes) sum += s.mass_fraction;
      largest = 0.0;
      for (const SizeShare& s : m.sizes) {
        add(k, s.diameter, sphere_mass(m.density, s.diameter), fraction * s.mass_fraction / sum);
        largest = std::max(largest, s.diameter);
      }
    }
    bed.smallest = k == 0 ? smallest_diameter(m) : std::min(bed.smallest, smallest_diameter(m));
    bed.largest = std::max(bed.largest, largest);
  }
  bed.equal = bed.classes.size() == 1 && bed.classes[0].diameter > 0.0;

  double all = 0.0, numbers_per_mass = 0.0, volume_per_mass = 0.0;
  for (const double f : share) all += f;
  for (std::size_t k = 0; k < share.size(); ++k) {
    numbers_per_mass += share[k] / all / bed.classes[k].mean_mass;
    volume_per_mass += share[k] / all / components[bed.classes[k].component].material.density;
  }
  double spheres = c.rig.fill;
  if (c.rig.fill_mass) spheres = *c.rig.fill_mass * numbers_per_mass;
  if (const double room = level_volume(c.rig); c.rig.level && room > 0.0)
    spheres = *c.rig.level * packing_fraction * room / volume_per_mass * numbers_per_mass;
  bed.spheres = spheres > 0.0 ? static_cast<std::size_t>(std::llround(spheres)) : 0;
  std::vector<double> numbers;
  for (std::size_t k = 0; k < share.size(); ++k)
    numbers.push_back(static_cast<double>(bed.spheres) * (share[k] / all / bed.classes[k].mean_mass) /
                      numbers_per_mass);
  const std::vector<std::size_t> counts =
      bed.equal ? std::vector<std::size_t>{bed.spheres} : whole(numbers, bed.spheres);
  for (std::size_t k = 0; k < counts.size(); ++k) {
    GrainClass& g = bed.classes[k];
    g.count = counts[k];
    bed.mass += static_cast<double>(g.count) * g.mean_mass;
    bed.volume += static_cast<double>(g.count) * g.mean_mass / components[g.component].material.density;
  }
  return bed;
}

Grains draw_grains(const Case& c, std::uint64_t seed) {
  const std::vector<Component> components = components_of(c);
  const BedSummary bed = summarise_bed(c);
  if (bed.equal) return {{0.5 * bed.classes[0].diameter}, {components[0].material.density}, {}};
  data::RandomStream random(seed, data::Purpose::packing, 2);
  struct One {
    double radius;
    std::uint32_t component;
  };
  std::vector<One> all;
  for (const GrainClass& g : bed.classes) {
    const auto component = static_cast<std::uint32_t>(g.component);
    const Material& m = components[g.component].material;
    for (std::size_t k = 0; k < g.count; ++k) {
      const double share = (static_cast<double>(k) + random.uniform()) / static_cast<double>(g.count);
      all.push_back({0.5 * (g.diameter > 0.0 ? g.diameter : quantile(number_law(m), share)), component});
    }
  }
  std::stable_sort(all.begin(), all.end(), [](const One& a, const One& b) { return a.radius > b.radius; });
  Grains grains;
  for (const One& one : all) {
    grains.radius.push_back(one.radius);
    grains.density.push_back(components[one.component].material.density);
    grains.material.push_back(one.component);
  }
  return grains;
}

double solid_volume(const Grains& grains, std::size_t count) {
  if (grains.radius.size() == 1)
    return static_cast<double>(count) * sphere_mass(grains.density[0], 2.0 * grains.radius[0]) / grains.density[0];
  double sum = 0.0;
  for (const double r : grains.radius) sum += ball(2.0 * r);
  return sum;
}

double solid_mass(const Grains& grains, std::size_t count) {
  if (grains.radius.size() == 1)
    return static_cast<double>(count) * sphere_mass(grains.density[0], 2.0 * grains.radius[0]);
  double sum = 0.0;
  for (std::size_t k = 0; k < grains.radius.size(); ++k) sum += sphere_mass(grains.density[k], 2.0 * grains.radius[k]);
  return sum;
}

}  // namespace dem
