// A narrow column of grains: H. Janssen's silo, Z. Ver. Dtsch. Ing. 39:1045 (1895).
#include "data/random.hpp"
#include "tests/dem/shot.hpp"

namespace {

/// A cylinder about z from `low` to `high`, open at both ends.
dem::TriangleMesh ring(double radius, double low, double high) {
  constexpr std::uint32_t facets = 48;
  dem::TriangleMesh mesh;
  for (std::uint32_t k = 0; k < facets; ++k) {
    const double angle = 2.0 * std::numbers::pi * k / facets;
    for (const double z : {low, high}) mesh.vertices.push_back({radius * std::cos(angle), radius * std::sin(angle), z});
    const std::uint32_t a = 2 * k, b = 2 * ((k + 1) % facets);
    mesh.triangles.push_back({a, b, b + 1});
    mesh.triangles.push_back({a, b + 1, a + 1});
  }
  return mesh;
}

/// A narrow cylinder of spheres between floor and rim.
struct Column {
  std::vector<double> depth, force;               ///< m, N through the cross-section there
  double per_height = 0.0;                        ///< N/m, weight
  double weight = 0.0, floor = 0.0, borne = 0.0;  ///< N, of the spheres; on the floor; on floor and walls
};

Column fill_column(const dem::Case& c, std::uint64_t seed) {
  const double d = c.material.diameter, radius = 4.0 * d;
  dem::Setup s = scene::box(c, {}, {});
  s.low = {-5.0 * d, -5.0 * d, -2.0 * d};
  s.high = {5.0 * d, 5.0 * d, 90.0 * d};
  s.gravity = {0.0, 0.0, -9.81};
  data::RandomStream random(seed, data::Purpose::test);
  for (int layer = 0; s.spheres.position.size() < 2000; ++layer) {
    for (int k = 0; k < 49; ++k) {
      const dem::Vec3 at{(k % 7 - 3.0) * 1.08 * d, (k / 7 - 3.0) * 1.08 * d, (layer + 0.6) * 1.05 * d};
      if (std::hypot(at.x, at.y) > radius - 0.56 * d) continue;
      s.spheres.position.push_back(at);
      s.spheres.velocity.push_back({0.05 * random.normal(), 0.05 * random.normal(), 0.0});
    }
  }
  // The wall in rings, whose friction is known each by itself; the floor sinks slowly, so that friction is all called
  // upon.
  constexpr int rings = 7;
  const double ring_height = 6.0 * d;
  for (int k = 0; k < rings; ++k)
    s.bodies.push_back({"ring", ring(radius, k * ring_height, k + 1 < rings ? (k + 1) * ring_height : 90.0 * d), {}});
  s.bodies[0].mesh = ring(radius, -2.0 * d, ring_height);
  s.bodies.push_back(scene::floor(6.0 * d));
  s.bodies.back().motion.oscillations = {{dem::OscillationKind::along, {0.0, 0.0, -1.0}, d, 1.0, 0.0}};
  s.rest_steps = static_cast<std::uint64_t>(std::llround(0.15 / s.time_step));
  dem::Simulation sim(std::move(s));
  while (sim.time() < 0.25) sim.step();
  double up[rings] = {}, floor = 0.0, below[rings + 1] = {}, samples = 0.0, top = 0.0;
  const double momentum = sim.momentum().z;
  while (sim.time() < 0.30) {
    sim.step();
    ++samples;
    for (int k = 0; k < rings; ++k) up[k] -= sim.sums().body[static_cast<std::size_t>(k)].force.z;
    floor -= sim.sums().body[rings].force.z;
  }
  const double weight = 9.81 * dem::derive(c).mass, count = static_cast<double>(sim.state().particles());
  for (std::size_t i = 0; i < sim.state().particles(); ++i) {
    const double z = sim.state().position[i].at.z;
    top = std::max(top, z);
    for (int k = 0; k <= rings; ++k) below[k] += z < k * ring_height ? 1.0 : 0.0;
  }
  // Force through the cross-section at each ring's foot: the weight above less what the rings above carry.
  Column column;
  double carried = 0.0;
  for (int k = rings - 1; k >= 0; --k) {
    carried += up[k] / samples;
    if (top - k * ring_height < 2.0 * d) continue;
    column.depth.push_back(top - k * ring_height);
    column.force.push_back((count - below[k]) * weight - carried);
  }
  column.per_height = (count - below[1]) * weight / (top - ring_height);
  column.weight = count * weight;
  column.floor = floor / samples;
  const double gained = (sim.momentum().z - momentum) / (samples * sim.setup().time_step);
  column.borne = column.floor + carried - gained;
  return column;
}

}  // namespace

TEST_CASE("the pressure in a narrow column follows Janssen's law", "[slow][table]") {
  dem::Case c;
  c.contact.restitution = 0.5;
  c.contact.friction = 0.4;
  const double d = c.material.diameter, diameter = 8.0 * d;
  constexpr int columns = 4;  // what one packing's force chains do to a profile is several percent
  Column mean;
  for (std::uint64_t seed = 1; seed <= columns; ++seed) {
    const Column one = fill_column(c, seed);
    scene::row(fmt::format("Janssen, column {}: floor and walls carry the weight [mN]", seed), 1e3 * one.weight,
               1e3 * one.borne, {1e-3});
    CHECK(one.floor < 0.7 * one.weight);
    mean.depth.resize(one.depth.size());
    mean.force.resize(one.depth.size());
    for (std::size_t k = 0; k < one.depth.size(); ++k) {
      mean.depth[k] += one.depth[k] / columns;
      mean.force[k] += one.force[k] / columns;
    }
    mean.per_height += one.per_height / columns;
    mean.weight += one.weight / columns;
  }
  // Fit of lambda = D / (4 mu_w K) to sigma(z) / (rho g): f = w lambda (1 - exp(-z / lambda)), w the weight per height.
  const auto miss = [&](double lambda) {
    double sum = 0.0;
    for (std::size_t k = 0; k < mean.depth.size(); ++k) {
      const double law = mean.per_height * lambda * (1.0 - std::exp(-mean.depth[k] / lambda));
      sum += std::pow(mean.force[k] / law - 1.0, 2);
    }
    return std::sqrt(sum / static_cast<double>(mean.depth.size()));
  };
  double best = diameter;
  for (double lambda = 0.3 * diameter; lambda < 6.0 * diameter; lambda *= 1.01) {
    if (miss(lambda) < miss(best)) best = lambda;
  }
  const double k = diameter / (4.0 * 0.4 * best);
  std::string profile;
  for (std::size_t j = 0; j < mean.depth.size(); ++j)
    profile += fmt::format(" {:.1f}d: {:.3f}", mean.depth[j] / d, mean.force[j] / mean.weight);
  INFO("lambda " << best / diameter << " D, K " << k << ", miss " << miss(best) << "; force / weight at depth"
                 << profile);
  scene::row(fmt::format("Janssen: rms misfit of the profile, mean of {} columns", columns), 0.0, miss(best),
             {0.0, 0.06});
  // Between active stress of a friction 0.38 and passive.
  CHECK(k > 0.4);
  CHECK(k < 1.3);
}
