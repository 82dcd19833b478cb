// Bond order against crystals, where neighbours' bonds point alike.
#include <catch2/catch.hpp>
#include <cmath>

#include "data/random.hpp"
#include "dem/engine/order.hpp"

namespace {

/// Spheres of 1 mm on a face-centred cubic lattice of 4 x 4 x 4 cells, periodic all round, each moved by up to `shift`.
struct Crystal {
  dem::State state;
  dem::Box box;
};

Crystal face_centred(double shift) {
  const double edge = std::sqrt(2.0) * 1e-3;
  const int cells = 4;
  Crystal c;
  c.box = {{0.0, 0.0, 0.0}, {cells * edge, cells * edge, cells * edge}, {true, true, true}};
  data::RandomStream random(5, data::Purpose::test);
  const dem::Vec3 basis[]{{0.0, 0.0, 0.0}, {0.5, 0.5, 0.0}, {0.5, 0.0, 0.5}, {0.0, 0.5, 0.5}};
  for (int x = 0; x < cells; ++x)
    for (int y = 0; y < cells; ++y)
      for (int z = 0; z < cells; ++z)
        for (const dem::Vec3 b : basis) {
          const dem::Vec3 moved{random.uniform(-shift, shift), random.uniform(-shift, shift),
                                random.uniform(-shift, shift)};
          c.state.position.push_back({edge * (dem::Vec3{1.0 * x, 1.0 * y, 1.0 * z} + b) + moved, 0.5e-3});
          c.state.half.push_back({});
        }
  return c;
}

}  // namespace

TEST_CASE("the bond order of a crystal is 1, across periodic faces too") {
  Crystal c = face_centred(0.0);
  CHECK(dem::bond_order(c.state, c.box) == Approx(1.0).epsilon(1e-9));
  // Where the lattice lies in the box, and on which side of a face a sphere stands, changes nothing.
  for (std::size_t i = 0; i < c.state.particles(); ++i) {
    c.state.position[i].at += dem::Vec3{0.3e-3, -0.2e-3, 0.11e-3};
    if (i % 3 == 0) c.state.position[i].at.x += c.box.high.x;
  }
  CHECK(dem::bond_order(c.state, c.box) == Approx(1.0).epsilon(1e-9));
}

TEST_CASE("bond order falls as a crystal is shaken, and is small where spheres lie anyhow") {
  double before = 1.0 + 1e-9;
  for (const double shift : {0.05e-3, 0.1e-3, 0.2e-3}) {
    const Crystal c = face_centred(shift);
    const double now = dem::bond_order(c.state, c.box);
    CHECK(now < before);
    before = now;
  }
  const Crystal anyhow = face_centred(4e-3);
  CHECK(std::abs(dem::bond_order(anyhow.state, anyhow.box)) < 0.25);
  CHECK(dem::bond_order({}, anyhow.box) == 0.0);
}
