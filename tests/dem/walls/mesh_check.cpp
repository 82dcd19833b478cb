// The repair of broken meshes.
#include <catch2/catch.hpp>

#include "data/error.hpp"
#include "dem/walls/mesh_check.hpp"
#include "tests/dem/walls/cube.hpp"

TEST_CASE("triangles without area and triangles given twice are left out with their count") {
  dem::TriangleMesh mesh = cube();
  mesh.triangles.push_back({0, 1, 1});
  mesh.vertices.push_back({0.5, 0.0, 0.0});
  mesh.triangles.push_back({0, 8, 1});  // on a line
  mesh.triangles.push_back({5, 7, 4});  // given before, in another order
  const dem::CheckedMesh checked = dem::check_mesh(mesh, "part");
  CHECK(checked.mesh.triangles.size() == 12);
  REQUIRE(checked.warnings.size() == 2);
  CHECK_THAT(checked.warnings[0], Catch::Contains("part: 2 triangles without area"));
  CHECK_THAT(checked.warnings[1], Catch::Contains("part: 1 triangles given twice"));
  mesh.triangles.erase(mesh.triangles.begin(), mesh.triangles.begin() + 12);
  mesh.triangles.pop_back();
  CHECK_THROWS_AS(dem::check_mesh(mesh, "part"), data::InputError);
}

TEST_CASE("inverted surfaces and single triangles are turned outwards, and a cavity stays a cavity") {
  const auto inverted = [](dem::TriangleMesh mesh, std::size_t count) {
    for (std::size_t t = 0; t < count; ++t) std::swap(mesh.triangles[t][1], mesh.triangles[t][2]);
    return mesh;
  };
  const dem::CheckedMesh whole = dem::check_mesh(inverted(cube(), 12), "part");
  CHECK(volume(whole.mesh) == Approx(1.0));
  REQUIRE(whole.warnings.size() == 1);
  CHECK_THAT(whole.warnings[0], Catch::Contains("12 triangles of closed surfaces"));
  for (const std::size_t few : {1, 5, 7, 11}) {
    const dem::CheckedMesh some = dem::check_mesh(inverted(cube(), few), "part");
    CHECK(volume(some.mesh) == Approx(1.0));
    CHECK_THAT(some.warnings.at(0), Catch::Contains(std::to_string(std::min(few, 12 - few)) + " triangles oriented"));
  }
  dem::TriangleMesh hollow = cube(3.0);
  dem::append(hollow, inverted(cube(1.0, {1.0, 1.0, 1.0}), 12));
  const dem::CheckedMesh kept = dem::check_mesh(hollow, "part");
  CHECK(kept.warnings.empty());
  CHECK(volume(kept.mesh) == Approx(26.0));
}

TEST_CASE("open edges are counted except where a periodic copy goes on, and so are edges of three triangles") {
  dem::TriangleMesh mesh = cube();
  mesh.triangles.erase(mesh.triangles.begin() + 8, mesh.triangles.end());  // no walls across x: a tube along x
  const dem::CheckedMesh tube = dem::check_mesh(mesh, "tube");
  REQUIRE(tube.warnings.size() == 1);
  CHECK_THAT(tube.warnings[0], Catch::Contains("8 open edges"));
  CHECK(dem::check_mesh(mesh, "tube", {{1.0, 0.0, 0.0}}).warnings.empty());
  CHECK_THAT(dem::check_mesh(mesh, "tube", {{0.0, 1.0, 0.0}}).warnings.at(0), Catch::Contains("open edges"));
  mesh = cube();
  mesh.vertices.push_back({2.0, 2.0, 2.0});
  mesh.triangles.push_back({6, 7, 8});
  CHECK_THAT(dem::check_mesh(mesh, "fin").warnings.back(), Catch::Contains("1 edges where more than two"));
}
