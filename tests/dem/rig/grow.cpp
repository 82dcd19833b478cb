// Spheres grown in place: what the lattice of the largest has no room for, in vessels whose volume is known.
#include "dem/rig/grow.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/dem/scene.hpp"

namespace {

/// A box of 20 x 20 x 40 mm with a plate across it at half height that leaves 6 mm open along x.
dem::TriangleMesh vessel() {
  dem::TriangleMesh mesh;
  const auto quad = [&](dem::Vec3 a, dem::Vec3 b, dem::Vec3 c, dem::Vec3 d) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (const dem::Vec3 v : {a, b, c, d}) mesh.vertices.push_back(v);
    mesh.triangles.push_back({first, first + 1, first + 2});
    mesh.triangles.push_back({first, first + 2, first + 3});
  };
  const double w = 0.02, h = 0.04;
  quad({0, 0, 0}, {w, 0, 0}, {w, w, 0}, {0, w, 0});
  quad({0, 0, 0}, {w, 0, 0}, {w, 0, h}, {0, 0, h});
  quad({0, w, 0}, {w, w, 0}, {w, w, h}, {0, w, h});
  quad({0, 0, 0}, {0, w, 0}, {0, w, h}, {0, 0, h});
  quad({w, 0, 0}, {w, w, 0}, {w, w, h}, {w, 0, h});
  quad({0, 0, 0.02}, {w - 0.006, 0, 0.02}, {w - 0.006, w, 0.02}, {0, w, 0.02});
  return dem::weld(mesh, 1e-9);
}

dem::Packable where() {
  static const dem::FillRegion inside{.low = {}, .high = {0.02, 0.02, 0.04}};
  return {inside, {}, {0.02, 0.02, 0.04}, {false, false, false}, {0.0, 0.0, -1.0}};
}

/// Radii that fall evenly by this factor, largest first, of the solid volume [m3].
dem::Grains graded(double largest, double factor, double volume) {
  dem::Grains g;
  const auto ball = [](double r) { return 4.0 / 3.0 * std::numbers::pi * r * r * r; };
  double mean = 0.0;
  for (int k = 0; k < 100; ++k) mean += ball(largest * std::pow(factor, -k / 99.0)) / 100.0;
  const auto count = static_cast<std::size_t>(volume / mean);
  for (std::size_t k = 0; k < count; ++k) {
    g.radius.push_back(largest * std::pow(factor, -static_cast<double>(k) / static_cast<double>(count - 1)));
    g.density.push_back(2500.0);
    g.material.push_back(0);
  }
  return g;
}

/// Least distance between two surfaces, of the sum of radii.
double least_gap(const dem::Grains& g, const std::vector<dem::Vec3>& at) {
  double least = 1.0;
  for (std::size_t i = 0; i < at.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j)
      least = std::min(least, dem::length(at[i] - at[j]) / (g.radius[i] + g.radius[j]) - 1.0);
  }
  return least;
}

}  // namespace

TEST_CASE("spheres of one size and of sizes eightfold apart grow without touching each other or a wall") {
  const std::vector<dem::Body> bodies{{"vessel", vessel(), {}}};
  std::vector<dem::Surface> surfaces{dem::make_surface(bodies[0].mesh, 2e-3)};
  for (const double factor : {1.0, 3.0, 8.0}) {
    const dem::Grains g = graded(1e-3, factor, 0.5 * 1.6e-5);  // half of the vessel is solid
    const std::vector<dem::Vec3> at = dem::grow(where(), bodies, g, {g.radius.size(), 1});
    INFO("sizes " << factor << " apart, " << g.radius.size() << " spheres");
    REQUIRE(at.size() == g.radius.size());
    CHECK(least_gap(g, at) > 0.0);
    double deepest = -1.0;
    for (std::size_t i = 0; i < at.size(); ++i) {
      deepest = std::max(deepest, dem::depth_in_bodies(bodies, surfaces, at[i], g.radius[i]));
      REQUIRE(at[i].x > 0.0);
      REQUIRE(at[i].x < 0.02);
      REQUIRE(at[i].z > 0.0);
      REQUIRE(at[i].z <= 0.04);  // open above: where the region ends
    }
    CHECK(deepest < 0.0);
  }
}

TEST_CASE("a bed grows up to its level from the bottom, of a solid fraction near 0.5") {
  const std::vector<dem::Body> bodies{{"vessel", vessel(), {}}};
  const dem::Grains g = graded(0.7e-3, 2.0, 0.5 * 4e-6);  // 10 mm of 40
  const std::vector<dem::Vec3> at = dem::grow(where(), bodies, g, {g.radius.size(), 1});
  REQUIRE(at.size() == g.radius.size());
  double sum = 0.0;
  for (const dem::Vec3 p : at) sum += p.z / static_cast<double>(at.size());
  CHECK(sum == Approx(5e-3).epsilon(0.12));
}

TEST_CASE("more powder than a vessel can take finds no room") {
  const std::vector<dem::Body> bodies{{"vessel", vessel(), {}}};
  const dem::Grains g = graded(1e-3, 1.0, 0.8 * 1.6e-5);
  CHECK(dem::grow(where(), bodies, g, {g.radius.size(), 1}).empty());
}
