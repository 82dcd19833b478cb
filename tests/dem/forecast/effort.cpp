// What a run costs, measured on a small bed.
#include <catch2/catch.hpp>

#include "dem/bed/derived.hpp"
#include "dem/forecast/effort.hpp"

TEST_CASE("fine meshes are in the forecast of time and memory, and coarse ones need not be") {
  const auto effort = [](int cells) {
    dem::StlRig rig;
    dem::RigMesh plate{.name = "plate", .mesh = {}, .tolerance = 1e-9};
    constexpr double side = 0.04;
    for (int x = 0; x <= cells; ++x)
      for (int y = 0; y <= cells; ++y)  // wavy, so that edges and corners are features as well
        plate.mesh.vertices.push_back({side * x / cells, side * y / cells, 1e-5 * ((x + y) % 3)});
    const auto at = [&](int x, int y) { return static_cast<std::uint32_t>(x * (cells + 1) + y); };
    for (int x = 0; x < cells; ++x)
      for (int y = 0; y < cells; ++y) {
        plate.mesh.triangles.push_back({at(x, y), at(x + 1, y), at(x, y + 1)});
        plate.mesh.triangles.push_back({at(x + 1, y), at(x + 1, y + 1), at(x, y + 1)});
      }
    rig.meshes = {plate};
    dem::Case c;
    c.rig.stl = std::make_shared<dem::StlRig>(rig);
    return dem::measure_effort(c, dem::derive(c));
  };
  CHECK(effort(4).bytes_of_meshes == 0.0);
  const dem::Effort some = effort(100), more = effort(200);
  CHECK(some.bytes_of_meshes > 2.0 * 100 * 100 * 500.0);
  // Four times the triangles; the grid of the finer mesh is coarser (dem/walls/surface.cpp).
  CHECK(more.bytes_of_meshes > 1.5 * some.bytes_of_meshes);
  CHECK(more.bytes_of_meshes < 8.0 * some.bytes_of_meshes);
  CHECK(more.seconds_at_walls > some.seconds_at_walls);
}

TEST_CASE("a run's cost is that of spheres which touch, whether anything attracts them or not") {
  dem::Case c;
  c.contact.stiffness = 300.0;
  const double without = dem::measure_effort(c, dem::derive(c)).rate;
  c.contact.hamaker = 9e-18;
  const double with = dem::measure_effort(c, dem::derive(c)).rate;
  // In an open box spheres without attraction flew apart, and three times as many steps seemed to be made.
  CHECK(without < 2.0 * with);
}
