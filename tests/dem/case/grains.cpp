// Beds of unequal spheres: shares of mass become numbers, log-normal sizes keep their law, and all start clear of each
// other.
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dem/case/grains.hpp"
#include "dem/reading/prepare.hpp"
#include "dem/reading/target.hpp"
#include "dem/rig/slice.hpp"
#include "dem/run/run.hpp"
#include "tests/dem/scene.hpp"

namespace {

double mass_of(const dem::Grains& g, std::size_t k) {
  return g.density[k] * 4.0 / 3.0 * std::numbers::pi * std::pow(g.radius[k], 3);
}

dem::Component component(const char* name, double density, double diameter, double mass_fraction) {
  dem::Component k;
  k.material.name = name;
  k.material.density = density;
  k.material.diameter = diameter;
  k.mass_fraction = mass_fraction;
  return k;
}

dem::Case mixture() {
  dem::Case c;
  c.material.name = "mix";
  c.components = {component("sand", 2600.0, 0.6e-3, 0.7), component("steel", 7800.0, 1.0e-3, 0.3)};
  c.rig.fill = 1500.0;
  return c;
}

dem::Case log_normal(double median, double geometric_sd, double cut) {
  dem::Case c;
  c.material.diameter = median;
  c.material.log_normal = {geometric_sd, median / cut, median * cut};
  c.rig.fill = 20000.0;
  return c;
}

}  // namespace

TEST_CASE("a list of sizes gives each its share of the mass, to less than a sphere, by mass and by number alike") {
  dem::Case c;
  c.material.sizes = {{0.5e-3, 0.2}, {0.8e-3, 0.5}, {1.2e-3, 0.3}};
  const auto by_mass = GENERATE(false, true);
  if (by_mass)
    c.rig.fill_mass = 2e-3;
  else
    c.rig.fill = 1200.0;
  const dem::BedSummary bed = dem::summarise_bed(c);
  REQUIRE(bed.classes.size() == 3);
  if (by_mass)
    CHECK(bed.mass == Approx(2e-3).margin(0.5 * bed.classes[2].mean_mass));
  else
    CHECK(bed.spheres == 1200);
  for (std::size_t k = 0; k < 3; ++k) {
    const dem::GrainClass& g = bed.classes[k];
    // The number is rounded, which moves the bed's own mass too.
    CHECK(std::abs(static_cast<double>(g.count) * g.mean_mass - c.material.sizes[k].mass_fraction * bed.mass) <
          2.0 * bed.classes[2].mean_mass);
  }
  const dem::Grains grains = dem::draw_grains(c, 1);
  REQUIRE(grains.radius.size() == bed.spheres);
  double mass = 0.0;
  for (std::size_t k = 0; k < bed.spheres; ++k) mass += mass_of(grains, k);
  CHECK(mass == Approx(bed.mass).epsilon(1e-12));
  CHECK(dem::solid_volume(grains, bed.spheres) == Approx(bed.volume).epsilon(1e-12));
  CHECK(std::is_sorted(grains.radius.rbegin(), grains.radius.rend()));
}

TEST_CASE("drawn log-normal sizes have the median, the spread and the bounds asked for, by mass") {
  const double median = 0.8e-3, spread = 1.3;
  const dem::Case c = log_normal(median, spread, std::pow(spread, 4));
  const dem::Grains grains = dem::draw_grains(c, 5);
  REQUIRE(grains.radius.size() == 20000);
  double mass = 0.0, below = 0.0, mean = 0.0, square = 0.0;
  for (std::size_t k = 0; k < grains.radius.size(); ++k) {
    const double m = mass_of(grains, k), z = std::log(2.0 * grains.radius[k] / median) / std::log(spread);
    mass += m;
    below += z < 0.0 ? m : 0.0;
    mean += m * z;
    square += m * z * z;
    CHECK(std::abs(z) <= 4.0 + 1e-9);
  }
  CHECK(below / mass == Approx(0.5).margin(0.003));
  CHECK(mean / mass == Approx(0.0).margin(0.01));
  CHECK(square / mass == Approx(1.0).margin(0.02));  // of a normal cut at 4 deviations: 0.9989
  // The mean mass by which masses become numbers.
  const dem::BedSummary bed = dem::summarise_bed(c);
  CHECK(mass == Approx(bed.mass).epsilon(0.002));
  CHECK(bed.classes[0].mean_mass == Approx(mass / 20000.0).epsilon(0.002));
}

TEST_CASE("narrow log-normal sizes tend to equal spheres") {
  const dem::Case c = log_normal(0.8e-3, 1.0011, 1.01);
  CHECK(dem::mean_diameter(c.material) == Approx(0.8e-3).epsilon(1e-5));
}

TEST_CASE("drawn sizes follow from the seed alone") {
  const dem::Case c = log_normal(0.8e-3, 1.2, 1.5);
  CHECK(dem::draw_grains(c, 3).radius == dem::draw_grains(c, 3).radius);
  CHECK(dem::draw_grains(c, 3).radius != dem::draw_grains(c, 4).radius);
}

TEST_CASE("a mixture has each component's density and its share of the mass") {
  const dem::Case c = mixture();
  REQUIRE(dem::problems(c).empty());
  const dem::Grains grains = dem::draw_grains(c, 1);
  REQUIRE(grains.radius.size() == 1500);
  double mass[2] = {0.0, 0.0};
  for (std::size_t k = 0; k < grains.radius.size(); ++k) {
    const dem::Material& m = c.components[grains.material[k]].material;
    CHECK(grains.density[k] == m.density);
    CHECK(grains.radius[k] == 0.5 * m.diameter);
    mass[grains.material[k]] += mass_of(grains, k);
  }
  CHECK(mass[1] / (mass[0] + mass[1]) == Approx(0.3).margin(mass_of(grains, 0) / (mass[0] + mass[1])));
}

TEST_CASE("a mixture of one material with itself is that material: same number, mass and time step") {
  dem::Case one;
  one.rig.fill = 900.0;
  dem::Case both = one;
  both.components = {component("a", one.material.density, one.material.diameter, 0.4),
                     component("b", one.material.density, one.material.diameter, 0.6)};
  const dem::Derived d = dem::derive(one), e = dem::derive(both);
  CHECK(e.spheres == d.spheres);
  CHECK(e.mass == Approx(d.mass).epsilon(1e-14));
  CHECK(e.time_step == d.time_step);
  CHECK(e.kinds[0].pull_off == d.pull_off);
}

TEST_CASE("unequal spheres start clear of each other and of the walls, in the slice") {
  dem::Case c;
  SECTION("a mixture") { c = mixture(); }
  SECTION("fine powder that starts in parcels") {
    c = mixture();
    c.components[0].material.diameter = 0.25e-3;
    c.rig.fill = 9000.0;
  }
  SECTION("log-normal sizes") {
    c = log_normal(0.7e-3, 1.25, 1.6);
    c.rig.fill = 1500.0;
  }
  const dem::Simulation s(scene::rig(c, 3));
  CHECK(s.state().particles() == static_cast<std::size_t>(c.rig.fill));
  CHECK(s.sums().contacts == 0);
  CHECK(s.sums().wall_contacts == 0);
}

TEST_CASE("a mixture runs to its torque, and its coordination and stress are those of a bed at work") {
  dem::Case c = mixture();
  c.rig.fill = 700.0;
  c.contact.stiffness = 300.0;
  c.run.overlap_limit = 0.3;  // of grains wedged between blade and trough
  c.run.settle = 0.04;
  c.run.start_up = 0.02;
  c.run.start_up_turns = 0.25;
  c.run.shortest = c.run.longest = 0.06;
  c.run.window = 5e-3;
  const dem::RunResult result = dem::run(c, 2);
  REQUIRE(result.status == dem::RunStatus::done);
  const double coordination = dem::output(result, "coordination").mean;
  CHECK(coordination > 0.5);
  CHECK(coordination < 6.0);
  CHECK(dem::output(result, "torque").mean > 0.0);
  const double tip = dem::tool_speed(c);
  CHECK(dem::output(result, "tool_contacts").mean > 0.0);
  CHECK(dem::output(result, "tool_contacts").mean < coordination);
  CHECK(dem::output(result, "tool_slip").mean > 0.0);
  CHECK(dem::output(result, "tool_slip").mean < tip);
  // The bed turns with the mixer, and slips on the trough that holds it back.
  CHECK(dem::output(result, "wall_slip").mean > 0.0);
  CHECK(dem::output(result, "wall_slip").mean < tip);
  // Of the order of the weight of the bed on its bottom.
  const double weight = 9.81 * dem::summarise_bed(c).mass / (c.rig.pitch * 2.0 * c.rig.trough_radius);
  CHECK(dem::output(result, "normal_stress").mean > 0.1 * weight);
  CHECK(dem::output(result, "normal_stress").mean < 10.0 * weight);
}
