// What many grains do together: the friction law mu(I) of P. Jop, Y. Forterre, O. Pouliquen, Nature 441:727 (2006), and
// the slice's independence of the time step.
#include <numeric>

#include "data/random.hpp"
#include "dem/rig/rig.hpp"
#include "dem/rig/slice.hpp"
#include "tests/dem/shot.hpp"

namespace {

/// mu(I) of glass beads.
double published(double inertial) { return 0.3819 + (0.6435 - 0.3819) / (0.279 / inertial + 1.0); }

struct Flow {
  double inertial = 0.0, friction = 0.0, spread = 0.0;  ///< spread of the friction over quarters of the window
  double volume_fraction = 0.0;
};

constexpr int quarters = 4;

/// Friction and its spread from the sums of shear and normal force in each quarter of the window.
void read_friction(const double (&shear)[quarters], const double (&normal)[quarters], Flow& f) {
  double x = 0.0, z = 0.0;
  for (int q = 0; q < quarters; ++q) {
    x += shear[q];
    z += normal[q];
  }
  f.friction = x / z;
  for (int q = 0; q < quarters; ++q) f.spread = std::max(f.spread, std::abs(shear[q] / normal[q] - f.friction));
}

/// A layer of spheres of 0.8 to 1.2 diameters (equal ones would order) on a bottom of frozen ones at random, periodic
/// along x and y, gravity tilted by `angle` [rad]; it starts with the profile of Bagnold for the inertial number that
/// the law has there. Friction = shear / normal force on the bottom; inertial number I = shear rate d / sqrt(P / rho)
/// from the profile between 0.2 and 0.8 of the height.
Flow incline(const dem::Case& c, double angle, double inertial, double start_up, double window) {
  const double d = c.material.diameter, g = 9.81;
  constexpr int nx = 10, ny = 6, layers = 12;
  const double spacing = 1.16 * d;
  dem::Setup s = scene::box(c, {}, {});
  s.low = {0.0, 0.0, -d};
  s.high = {nx * spacing, ny * spacing, 40.0 * d};
  s.periodic = {true, true, false};
  s.gravity = {g * std::sin(angle), 0.0, -g * std::cos(angle)};
  dem::BedCoefficients bed = dem::make_bed(c, 1);
  bed.equal_mass = bed.equal_radius = 0.0;
  s.laws = dem::make_force_pass(bed);
  s.bodies = {scene::floor(40.0 * d)};
  s.spheres.radius.clear();
  data::RandomStream random(1, data::Purpose::test);
  const double height = 0.8 * layers * d;
  const auto bagnold = [&](double z) {
    const double depth = std::max(height - z, 0.0);
    return 2.0 / 3.0 * inertial * std::sqrt(0.58 * g * std::cos(angle)) *
           (std::pow(height, 1.5) - std::pow(depth, 1.5)) / d;
  };
  for (int layer = 0; layer <= layers; ++layer) {
    for (int k = 0; k < nx * ny; ++k) {
      // A plane closes the bottom's gaps. Forces among spheres of the bottom and the plane cancel in its sum.
      const bool bottom = layer == 0;
      const double shake = (bottom ? 0.6 : 0.04) * d, z = (layer + 0.4) * spacing;
      s.spheres.radius.push_back((0.4 + 0.2 * random.uniform()) * d);
      s.spheres.position.push_back({(k % nx + 0.5) * spacing + shake * (random.uniform() - 0.5),
                                    (k / nx + 0.5) * spacing + shake * (random.uniform() - 0.5),
                                    z + shake * (random.uniform() - 0.5)});
      s.spheres.velocity.push_back({bottom ? 0.0 : bagnold(z), 0.0, 0.0});
      s.spheres.frozen.push_back(bottom ? 1 : 0);
    }
  }
  dem::Simulation sim(std::move(s));
  while (sim.time() < start_up) sim.step();
  constexpr int bins = 12;
  double sum_x[quarters] = {}, sum_z[quarters] = {}, count[bins] = {}, heavy[bins] = {}, speed[bins] = {};
  double samples = 0.0;
  for (std::uint64_t k = 0; sim.time() < start_up + window; ++k) {
    sim.step();
    if (k % 20 != 0) continue;
    const int part = std::min(quarters - 1, static_cast<int>(quarters * (sim.time() - start_up) / window));
    ++samples;
    sum_x[part] += sim.sums().body[0].force.x;
    sum_z[part] -= sim.sums().body[0].force.z;
    for (std::size_t i = 0; i < sim.state().particles(); ++i) {
      if (sim.state().load[i].inverse_mass == 0.0) {
        sum_x[part] += sim.state().load[i].force.x;
        sum_z[part] -= sim.state().load[i].force.z;
        continue;
      }
      const int bin = static_cast<int>(sim.state().position[i].at.z / height * bins);
      if (bin < 0 || bin >= bins) continue;
      ++count[bin];
      heavy[bin] += sim.state().motion[i].mass;
      speed[bin] += sim.state().motion[i].velocity.x;
    }
  }
  Flow f;
  read_friction(sum_x, sum_z, f);
  // Pressure above a bin: the weight of what lies higher.
  const double area = nx * ny * spacing * spacing, thick = height / bins;
  double used = 0.0;
  for (int b = 2; b <= 9; ++b) {
    double above = 0.5 * heavy[b];
    for (int k = b + 1; k < bins; ++k) above += heavy[k];
    const double pressure = above / samples * g * std::cos(angle) / area;
    const double rate = (speed[b + 1] / count[b + 1] - speed[b - 1] / count[b - 1]) / (2.0 * thick);
    f.inertial += rate * d / std::sqrt(pressure / c.material.density);
    f.volume_fraction += heavy[b] / samples / c.material.density / (area * thick);
    ++used;
  }
  f.inertial /= used;
  f.volume_fraction /= used;
  return f;
}

/// Plane shear without gravity between two layers of frozen spheres, periodic along x and y: the upper one moves along
/// x at `rate` [1/s] times the height, and comes down until the pressure reaches `pressure` [Pa]; from then on the
/// volume is kept, and the pressure found decides the inertial number. Friction = shear / normal force on the upper
/// layer.
Flow shear(const dem::Case& c, double rate, double pressure, double strain) {
  const double d = c.material.diameter;
  constexpr int nx = 10, ny = 6, layers = 12;
  const double spacing = 1.12 * d, area = nx * ny * spacing * spacing;
  dem::Setup s = scene::box(c, {}, {});
  s.low = {0.0, 0.0, -2.0 * d};
  s.high = {nx * spacing, ny * spacing, 1.5 * layers * d};
  s.periodic = {true, true, false};
  s.gravity = {};
  dem::BedCoefficients bed = dem::make_bed(c, 1);
  bed.equal_mass = bed.equal_radius = 0.0;
  s.laws = dem::make_force_pass(bed);
  s.spheres.radius.clear();
  data::RandomStream random(3, data::Purpose::test);
  for (int layer = 0; layer < layers; ++layer) {
    const bool frozen = layer == 0 || layer == layers - 1;
    for (int k = 0; k < nx * ny; ++k) {
      const double z = layer * spacing + (frozen ? 0.5 : 0.02) * d * (random.uniform() - 0.5);
      s.spheres.radius.push_back((0.4 + 0.2 * random.uniform()) * d);
      s.spheres.position.push_back({(k % nx + 0.5) * spacing, (k / nx + 0.5) * spacing, z});
      s.spheres.velocity.push_back(
          {rate * (frozen ? layer * spacing : z), 0.0, layer == layers - 1 ? -2.0 * rate * d : 0.0});
      s.spheres.frozen.push_back(frozen ? 1 : 0);
    }
  }
  const auto load = [](const dem::Simulation& sim) {  // on the upper layer
    dem::Vec3 sum;
    for (std::size_t i = 0; i < sim.state().particles(); ++i) {
      if (sim.state().load[i].inverse_mass == 0.0 && sim.state().motion[i].velocity.x > 0.0)
        sum += sim.state().load[i].force;
    }
    return sum;
  };
  dem::Setup kept = s;
  kept.spheres.spin.resize(s.spheres.position.size());
  {
    dem::Simulation sim(std::move(s));
    for (double mean = 0.0; mean < pressure * area && sim.time() < 3.0 / rate;) {
      sim.step();
      mean += 0.002 * (load(sim).z - mean);
    }
    for (std::size_t i = 0; i < sim.state().particles(); ++i) {
      const dem::MotionRow m = sim.motion(i);
      const std::uint32_t id = sim.state().id[i];
      kept.spheres.position[id] = sim.state().position[i].at;
      kept.spheres.velocity[id] = {m.velocity.x, m.velocity.y, kept.spheres.frozen[id] ? 0.0 : m.velocity.z};
      kept.spheres.spin[id] = m.spin;
    }
  }
  dem::Simulation sim(std::move(kept));
  while (sim.time() < 0.5 * strain / rate) sim.step();
  const double height = sim.setup().spheres.position.back().z, thick = height / 8.0;
  double shear_force[quarters] = {}, normal[quarters] = {}, samples = 0.0, count[8] = {}, speed[8] = {}, volume = 0.0;
  const double from = sim.time(), window = strain / rate;
  for (std::uint64_t k = 0; sim.time() < from + window; ++k) {
    sim.step();
    if (k % 20 != 0) continue;
    const int q = std::min(quarters - 1, static_cast<int>(quarters * (sim.time() - from) / window));
    const dem::Vec3 force = load(sim);
    shear_force[q] -= force.x;
    normal[q] += force.z;
    ++samples;
    for (std::size_t i = 0; i < sim.state().particles(); ++i) {
      const int bin = static_cast<int>(sim.state().position[i].at.z / thick);
      if (bin < 1 || bin > 6) continue;
      ++count[bin];
      speed[bin] += sim.state().motion[i].velocity.x;
      volume += sim.state().motion[i].mass / c.material.density;
    }
  }
  Flow f;
  read_friction(shear_force, normal, f);
  const double found = (speed[6] / count[6] - speed[1] / count[1]) / (5.0 * thick);
  const double mean_pressure = std::accumulate(std::begin(normal), std::end(normal), 0.0) / samples / area;
  f.inertial = found * d / std::sqrt(mean_pressure / c.material.density);
  f.volume_fraction = volume / samples / (6.0 * thick * area);
  return f;
}

dem::Case glass() {
  dem::Case c;
  c.material.density = 2500.0;
  c.material.diameter = 1e-3;
  c.contact.stiffness = 200.0;
  c.contact.restitution = 0.7;
  c.contact.friction = 0.5;
  return c;
}

}  // namespace

TEST_CASE("a layer flowing down an incline has the friction of the published mu(I) law, and cohesion raises it",
          "[slow][table]") {
  const dem::Case c = glass();
  dem::Case sticky = c;
  sticky.contact.hamaker = 1e-18;
  sticky.contact.hamaker *= 8.0 / dem::derive(sticky).bond;
  struct Point {
    double degrees, inertial;
  };
  for (const auto& [degrees, inertial] : {Point{23.2, 0.06}, Point{24.4, 0.12}, Point{27.8, 0.30}}) {
    const double angle = degrees * std::numbers::pi / 180.0;
    const Flow f = incline(c, angle, inertial, 0.6, 0.3);
    INFO("at " << degrees << " deg: I " << f.inertial << ", mu " << f.friction << " +- " << f.spread
               << ", volume fraction " << f.volume_fraction);
    scene::row(fmt::format("mu at I = {:.3f} (+- {:.3f}), {} deg", f.inertial, f.spread, degrees),
               published(f.inertial), f.friction, {0.0, 0.04});
    CHECK(f.inertial > 0.01);
    if (degrees != 27.8) continue;
    // Cohesion of Bond number 8: more friction at the same inertial number, hence slower at the same angle.
    const Flow cohesive = incline(sticky, angle, inertial, 0.6, 0.3);
    INFO("cohesive: I " << cohesive.inertial << ", mu " << cohesive.friction << " +- " << cohesive.spread);
    CHECK(cohesive.inertial > 0.01);
    CHECK(cohesive.friction - published(cohesive.inertial) > f.friction - published(f.inertial) + 0.01);
    CHECK(cohesive.inertial < 0.9 * f.inertial);
  }
}

TEST_CASE("slow plane shear has the friction of the published mu(I) law", "[slow][table]") {
  struct Point {
    double rate, pressure;  // 1/s, Pa
  };
  for (const auto& [rate, pressure] : {Point{3.0, 700.0}, Point{8.0, 400.0}, Point{20.0, 130.0}}) {
    const Flow f = shear(glass(), rate, pressure, 3.0);
    INFO("at " << rate << " 1/s: I " << f.inertial << ", mu " << f.friction << " +- " << f.spread
               << ", volume fraction " << f.volume_fraction);
    scene::row(fmt::format("mu at I = {:.3f} (+- {:.3f}), plane shear, volume fraction {:.3f}", f.inertial, f.spread,
                           f.volume_fraction),
               published(f.inertial), f.friction, {0.0, 0.04});
  }
}

TEST_CASE("torque and kinetic energy of the slice are the same under half the time step", "[slow][table]") {
  // Means over 0.3 s after 0.15 s of turning; errors from means over 30 ms.
  double mean[2][2] = {}, error[2][2] = {};
  for (int fine = 0; fine < 2; ++fine) {
    dem::Case c;
    c.run.overlap_limit = 1.0;  // the default rig pinches grains
    c.run.steps_per_contact = fine ? 60.0 : 30.0;
    dem::Simulation s(scene::rig(c, 2, static_cast<std::uint64_t>(std::llround(0.06 / dem::derive(c).time_step))));
    while (s.time() < 0.21) s.step();
    std::vector<double> block[2];
    for (int b = 0; b < 10; ++b) {
      double sum[2] = {}, count = 0.0;
      while (s.time() < 0.21 + 0.03 * (b + 1)) {
        s.step();
        sum[0] -= s.sums().body[dem::mixer].torque.x;
        if (s.state().step % 50 == 0) {
          sum[1] += s.kinetic_energy();
          ++count;
        }
      }
      block[0].push_back(sum[0] * s.setup().time_step / 0.03);
      block[1].push_back(sum[1] / count);
    }
    for (int q = 0; q < 2; ++q) {
      double square = 0.0;
      for (const double x : block[q]) mean[fine][q] += x / 10.0;
      for (const double x : block[q]) square += std::pow(x - mean[fine][q], 2);
      error[fine][q] = std::sqrt(square / 90.0);
    }
  }
  for (int q = 0; q < 2; ++q) {
    const double together = std::hypot(error[0][q], error[1][q]);
    INFO(mean[0][q] << " +- " << error[0][q] << " and " << mean[1][q] << " +- " << error[1][q]);
    scene::row(q == 0 ? fmt::format("slice torque at dt/2 [uN m], +- {:.2g}", 1e6 * together)
                      : fmt::format("slice kinetic energy at dt/2 [uJ], +- {:.2g}", 1e6 * together),
               1e6 * mean[0][q], 1e6 * mean[1][q], {0.0, 3e6 * together});
    CHECK(together < 0.05 * mean[0][q]);
  }
}
