// Meshes from STL, and round trips.
#include <catch2/catch.hpp>

#include <cstring>

#include "data/error.hpp"
#include "dem/rig/slice.hpp"
#include "dem/walls/mesh_check.hpp"
#include "dem/walls/stl.hpp"
#include "tests/dem/walls/cube.hpp"
#include "tests/temporary.hpp"

namespace {

std::string ascii(const dem::TriangleMesh& mesh) {
  std::string text = "solid a part of\n";
  const auto numbers = [](dem::Vec3 v) {
    return std::to_string(v.x) + " " + std::to_string(v.y) + " " + std::to_string(v.z) + "\n";
  };
  for (const auto& t : mesh.triangles) {
    text += " facet normal 0 0 nan\n  OUTER loop\n";
    for (const auto v : t) text += "   vertex " + numbers(mesh.vertices[v]);
    text += "  endloop\n endfacet\n";
  }
  return text + "endsolid a part of\n";
}

std::string binary(const dem::TriangleMesh& mesh) {
  std::string bytes = "solid, though binary";
  bytes.resize(80, ' ');
  const auto count = static_cast<std::uint32_t>(mesh.triangles.size());
  bytes.append(reinterpret_cast<const char*>(&count), 4);
  for (const auto& t : mesh.triangles) {
    float row[12] = {};
    for (int k = 0; k < 3; ++k) {
      const dem::Vec3 v = mesh.vertices[t[k]];
      row[3 + 3 * k] = static_cast<float>(v.x);
      row[4 + 3 * k] = static_cast<float>(v.y);
      row[5 + 3 * k] = static_cast<float>(v.z);
    }
    bytes.append(reinterpret_cast<const char*>(row), sizeof row);
    bytes.append(2, '\0');
  }
  return bytes;
}

std::string refusal(const std::string& bytes) {
  try {
    dem::parse_stl(bytes, "part.stl", 1.0);
  } catch (const data::InputError& error) {
    CHECK(error.status == data::ExitStatus::bad_data);
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("a mesh written as STL is read back with the same triangles, to single precision") {
  const dem::TriangleMesh mesh = dem::auger_mesh({});
  const TemporaryFolder folder;
  const std::string path = folder.path("mesh.stl");
  dem::write_stl(mesh, path);
  const dem::CheckedMesh back = dem::check_mesh(dem::read_stl(path, 1.0), "auger");
  CHECK(back.mesh.vertices.size() == mesh.vertices.size());
  REQUIRE(back.mesh.triangles.size() == mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const dem::Vec3 a = mesh.vertices[mesh.triangles[t][k]], b = back.mesh.vertices[back.mesh.triangles[t][k]];
      REQUIRE(length(a - b) < 1e-6 * 12e-3);
    }
  }
}

TEST_CASE("ASCII and binary give the same mesh, also when a binary file begins with 'solid', in the unit asked for") {
  for (const std::string& bytes : {ascii(cube(2.0)), binary(cube(2.0))}) {
    const dem::CheckedMesh checked = dem::check_mesh(dem::parse_stl(bytes, "part.stl", 1e-3), "part");
    CHECK(checked.warnings.empty());
    CHECK(checked.mesh.vertices.size() == 8);
    CHECK(volume(checked.mesh) == Approx(8e-9));
  }
}

TEST_CASE("STL as CAD programs write it: names in any encoding, any line ends, one line, bytes behind, no endsolid") {
  const auto triangles = [](const std::string& bytes) {
    return dem::parse_stl(bytes, "part.stl", 1.0).triangles.size();
  };
  const std::string text = ascii(cube()), bytes = binary(cube());
  const auto with = [](std::string changed, const std::string& from, const std::string& to) {
    for (std::size_t at = 0; (at = changed.find(from, at)) != std::string::npos; at += to.size())
      changed.replace(at, from.size(), to);
    return changed;
  };
  const std::string facets = text.substr(text.find("facet"), text.find("endsolid") - text.find("facet"));
  for (const std::string& written :
       {"solid R\xfchrwerk\n" + facets + "endsolid R\xfchrwerk\n",                    // Latin-1
        "solid \xbd\xc1\xb0\xe8\xc6\xf7\n" + facets + "endsolid \xbd\xc1\xb0\xe8\n",  // GBK
        "\xef\xbb\xbf" + text, with(text, "\n", "\r"), with(text, "\n", "\r\n"), with(text, "\n", " "),
        "solid\n" + facets, "solid a facet of the solid\n" + text.substr(text.find('\n') + 1),
        text + std::string(20, '\0'), text + "\x1a", text + "\n\n",
        bytes + "exported by a program that adds its name"}) {
    INFO(written.substr(0, 60));
    CHECK(triangles(written) == 12);
  }
  CHECK(triangles(text + text) == 24);
  CHECK(triangles(with(text + text, "\n", " ")) == 24);
  CHECK_THAT(refusal("\xff\xfes\0"), Catch::Contains("is UTF-16"));
  for (const std::string name : {"e10-latin1-name.stl", "e14-cr.stl"})
    CHECK(dem::read_stl(std::string(DEMCAL_SOURCE_DIR) + "/tests/data/files/" + name, 1e-3).triangles.size() == 12);
}

TEST_CASE("a binary mesh too far from its origin for single precision is refused, one at a usual distance is not") {
  dem::TriangleMesh far = cube();
  for (dem::Vec3& v : far.vertices) v.x += 1e5;
  CHECK_THAT(refusal(binary(far)),
             Catch::Contains("lies 1e+05 from its origin") && Catch::Contains("move the part to the origin"));
  for (dem::Vec3& v : far.vertices) v.x -= 99900.0;
  CHECK(dem::parse_stl(binary(far), "part.stl", 1.0).triangles.size() == 12);
}

TEST_CASE("a file that is cut, not finite, empty or not STL is refused by file and line or triangle") {
  using Catch::Contains;
  const std::string text = ascii(cube()), bytes = binary(cube());
  CHECK_THAT(refusal(text.substr(0, text.find("endloop"))), Contains("part.stl:7") && Contains("truncated"));
  CHECK_THAT(refusal(bytes.substr(0, 400)), Contains("400 bytes") && Contains("684"));
  std::string unsound = bytes + "more";
  for (std::size_t t = 0; t < 12; ++t) unsound.replace(84 + 50 * t, 4, "abcd");  // no normals, so no triangles
  CHECK_THAT(refusal(unsound), Contains("688 bytes"));
  CHECK_THAT(refusal(""), Contains("is empty"));
  CHECK_THAT(refusal("solid nothing\nendsolid nothing\n"), Contains("no triangle"));
  CHECK_THAT(refusal(std::string(84, '\0')), Contains("no triangle"));
  CHECK_THAT(refusal("ply\nformat ascii 1.0\n"), Contains("not STL"));
  CHECK_THAT(refusal(std::string("\x89PNG\r\n\x1a\n\0\0\0", 11)), Contains("not STL"));
  std::string broken = text;
  broken.replace(broken.find("vertex 1.000000"), 15, "vertex inf     ");
  CHECK_THAT(refusal(broken), Contains("'inf'") && Contains("not finite") && Contains("part.stl:"));
  broken = text;
  broken.replace(broken.find("vertex 1.000000"), 15, "vertex 1,000000");
  CHECK_THAT(refusal(broken), Contains("1,000000") && Contains("coordinate"));
  broken = bytes;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  std::memcpy(broken.data() + 84 + 2 * 50 + 12, &nan, sizeof nan);
  CHECK_THAT(refusal(broken), Contains("triangle 3") && Contains("not finite"));
}
