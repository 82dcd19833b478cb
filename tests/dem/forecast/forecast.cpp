// What is said of a rig before it runs: how full it is, which gaps pinch, and what makes its run nonsense. The rigs are
// boxes, whose volumes and gaps are known by arithmetic.
#include "dem/forecast/forecast.hpp"
#include "dem/forecast/effort.hpp"

#include <algorithm>
#include <catch2/catch.hpp>

#include "dem/bed/derived.hpp"
#include "dem/reading/prepare.hpp"
#include "dem/reading/target.hpp"
#include "dem/rig/slice.hpp"

using Catch::Contains;

namespace {

/// Of a closed box, or without its top.
dem::TriangleMesh box(dem::Vec3 low, dem::Vec3 high, bool open = false) {
  dem::TriangleMesh mesh;
  for (int k = 0; k < 8; ++k)
    mesh.vertices.push_back({k & 1 ? high.x : low.x, k & 2 ? high.y : low.y, k & 4 ? high.z : low.z});
  const std::vector<std::array<std::uint32_t, 4>> sides{{0, 2, 3, 1}, {0, 1, 5, 4}, {2, 6, 7, 3},
                                                        {0, 4, 6, 2}, {1, 3, 7, 5}, {4, 5, 7, 6}};
  for (std::size_t k = 0; k < sides.size() - (open ? 1 : 0); ++k) {
    const auto& s = sides[k];
    mesh.triangles.push_back({s[0], s[1], s[2]});
    mesh.triangles.push_back({s[0], s[2], s[3]});
  }
  return mesh;
}

dem::RigMesh part(const char* name, dem::TriangleMesh mesh) {
  return {.name = name, .mesh = std::move(mesh), .tolerance = 1e-8};
}

/// A vessel of 20 x 20 x 40 mm, open above, and a bar of 12 x 2 x 4 mm that turns about z 1 mm over its floor.
struct Mixer {
  dem::Case c;
  dem::StlRig rig;
  Mixer() {
    c.material.density = 2500.0;
    c.material.diameter = 1e-3;
    c.rig.fill = 3000.0;
    rig.low = {-0.012, -0.012, -0.002};
    rig.high = {0.012, 0.012, 0.05};
    rig.region.low = {-0.01, -0.01, 0.006};
    rig.region.high = {0.01, 0.01, 0.039};
    dem::RigMesh vessel = part("vessel", box({-0.01, -0.01, 0.0}, {0.01, 0.01, 0.04}, true));
    dem::RigMesh bar = part("bar", box({-0.006, -0.001, 0.001}, {0.006, 0.001, 0.005}));
    bar.motion.axis = {0.0, 0.0, 1.0};
    bar.speed_ratio = 1.0;
    rig.meshes = {vessel, bar};
    rig.measured = {1};
  }
  dem::RigMesh& bar() { return rig.meshes[1]; }
  dem::RigMesh& vessel() { return rig.meshes[0]; }
  dem::Case built() {
    c.rig.stl = std::make_shared<dem::StlRig>(rig);
    return c;
  }
  dem::Forecast told() { return dem::forecast(dem::prepare(built()), 1); }
  std::string said() { return data::describe(told().problems); }
};

std::string listed(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

}  // namespace

TEST_CASE("the bed's surface and the fill of a box are those of arithmetic") {
  Mixer m;
  const dem::Forecast f = m.told();
  CHECK(data::describe(f.problems) == "");
  CHECK(listed(f.warnings) == "");
  // 3000 spheres of 1 mm at a solid fraction of 0.6, and the bar, in a square of 20 mm.
  const double bed = 3000.0 * M_PI / 6.0 * 1e-9 / 0.6, bar = 12e-3 * 2e-3 * 4e-3;
  REQUIRE(f.surface);
  CHECK(*f.surface == Approx((bed + bar) / 4e-4).margin(5e-4));
  REQUIRE(f.fill);
  CHECK(*f.fill == Approx(bed / (4e-4 * 0.04 - bar)).epsilon(0.07));  // two cells of 0.6 mm in 20
  CHECK(f.mass == Approx(3000.0 * M_PI / 6.0 * 1e-9 * 2500.0));
  // The bar's ends keep 4 mm from the walls less what turning brings them nearer; its floor gap is one sphere.
  REQUIRE(f.gaps.size() == 1);
  CHECK(f.gaps[0].width == Approx(1e-3).epsilon(0.01));
}

TEST_CASE("a gap narrower than a sphere is said, also where only turning makes it") {
  Mixer m;
  m.bar().mesh = box({-0.0092, -0.001, 0.002}, {0.0092, 0.001, 0.006});  // a half-diagonal of 9.25 mm
  const dem::Forecast f = m.told();
  CHECK(data::describe(f.problems) == "");
  CHECK_THAT(listed(f.warnings), Contains("the gap between vessel and bar is 0.7") && Contains("pinched"));
  m.bar().mesh = box({-0.006, -0.001, 0.0003}, {0.006, 0.001, 0.004});
  CHECK_THAT(listed(m.told().warnings), Contains("the gap between vessel and bar is 0.3 mm"));
}

TEST_CASE("a tool above the bed is said, with both heights, and one in another chamber too") {
  Mixer m;
  m.bar().mesh = box({-0.006, -0.001, 0.02}, {0.006, 0.001, 0.024});
  CHECK_THAT(m.said(), Contains("rig.mesh.bar") && Contains("never touches the powder") && Contains("20 mm"));
  Mixer other;
  other.c.rig.fill = 300.0;
  // A floor in the middle: the powder lies on it, the bar below.
  other.vessel().mesh = box({-0.01, -0.01, 0.0}, {0.01, 0.01, 0.02});
  other.rig.meshes.push_back(part("upper", box({-0.01, -0.01, 0.022}, {0.01, 0.01, 0.04}, true)));
  other.rig.region.low.z = 0.022;
  CHECK_THAT(other.said(), Contains("rig.mesh.bar") && Contains("never touches the powder"));
}

TEST_CASE("what the bed lies on is reached by it, however thin the bed, and is no tool that dips into it") {
  Mixer m;
  m.rig.meshes.pop_back();
  m.rig.measured = {0};
  m.rig.region.low.z = 0.0;
  m.c.rig.fill = 300.0;  // a bed of 0.65 mm
  CHECK(m.said() == "");
  CHECK_THAT(listed(m.told().warnings), !Contains("vessel dips"));
  // One sphere on the floor of a vessel of two metres.
  Mixer wide;
  wide.c.material.diameter = 0.01;
  wide.c.rig.fill = 1.0;
  wide.rig.low = {-1.02, -1.02, -0.02};
  wide.rig.high = {1.02, 1.02, 0.1};
  wide.rig.region.low = {0.1, 0.1, 0.01};
  wide.rig.region.high = {0.14, 0.14, 0.05};
  wide.rig.meshes = {part("vessel", box({-1.0, -1.0, 0.0}, {1.0, 1.0, 0.08}, true))};
  wide.rig.measured = {0};
  CHECK(wide.said() == "");
}

TEST_CASE("a sweep that cuts the vessel, another tool, or leaves the box is said, and tools that mesh are not") {
  Mixer m;
  SECTION("a bar that fits only as it starts") {
    m.bar().mesh = box({-0.0097, -0.006, 0.001}, {0.0097, 0.006, 0.005});  // half-diagonal 11.4 mm
    CHECK_THAT(m.said(), Contains("rig.mesh.bar: cuts vessel by"));
  }
  SECTION("an axis left where the mesh is not") {
    for (dem::RigMesh* mesh : {&m.bar(), &m.vessel()})
      for (dem::Vec3& v : mesh->mesh.vertices) v += dem::Vec3{0.04, 0.025, 0.0};
    for (dem::Vec3* v : {&m.rig.low, &m.rig.high, &m.rig.region.low, &m.rig.region.high})
      *v += dem::Vec3{0.04, 0.025, 0.0};
    CHECK_THAT(m.said(), Contains("leaves the box as it turns") && Contains("give rig.mesh.bar.point"));
    m.bar().motion.point = {0.04, 0.025, 0.0};
    CHECK(m.said() == "");
    m.bar().motion.point = {0.045, 0.025, 0.0};  // 5 mm off: 11 mm from the axis to the far end, 5 mm to the wall
    CHECK_THAT(m.said(), Contains("cuts vessel"));
  }
  SECTION("two bars in step, and one that stands in the other's way") {
    m.bar().mesh = box({-0.0077, -0.0005, 0.001}, {0.0007, 0.0005, 0.005});
    m.bar().motion.point = {-0.0035, 0.0, 0.0};
    dem::RigMesh second = m.bar();
    second.name = "second";
    second.mesh = box({0.003, -0.0042, 0.001}, {0.004, 0.0042, 0.005});
    second.motion.point = {0.0035, 0.0, 0.0};
    m.rig.meshes.push_back(second);
    CHECK(m.said() == "");  // at right angles all the time, 7 mm apart
    m.rig.meshes[2].speed_ratio = 0.5;
    CHECK_THAT(m.said(), Contains("cuts second"));
  }
  SECTION("a shaft through the wall, turning in its hole") {
    m.rig.meshes.push_back(part("shaft", box({-0.003, -0.003, 0.005}, {0.003, 0.003, 0.06})));
    m.rig.meshes[2].motion.axis = {0.0, 0.0, 1.0};
    m.rig.meshes[2].speed_ratio = 1.0;
    m.rig.meshes.push_back(part("lid", box({-0.01, -0.01, 0.045}, {0.01, 0.01, 0.046})));
    const dem::Forecast f = m.told();
    CHECK(data::describe(f.problems) == "");
    CHECK_THAT(listed(f.warnings), Contains("cuts lid") && Contains("the two meet as they start"));
  }
}

/// A tube along x with this many sides, from the axis y = z = 0; its ends open.
dem::TriangleMesh tube(double radius, double from, double to, std::uint32_t sides) {
  dem::TriangleMesh mesh;
  for (std::uint32_t k = 0; k < sides; ++k) {
    const double angle = 2.0 * 3.14159265358979 * k / sides;
    for (const double x : {from, to}) mesh.vertices.push_back({x, radius * std::cos(angle), radius * std::sin(angle)});
    const std::uint32_t next = (k + 1) % sides;
    mesh.triangles.push_back({2 * k, 2 * k + 1, 2 * next});
    mesh.triangles.push_back({2 * next, 2 * k + 1, 2 * next + 1});
  }
  return mesh;
}

TEST_CASE("a blade that sticks out through the wall all round is said, and what a shaft has outside makes no gap") {
  Mixer m;
  m.rig.low = {-0.012, -0.014, -0.014};
  m.rig.high = {0.012, 0.014, 0.014};
  m.rig.region.low = {-0.009, -0.005, -0.009};
  m.rig.region.high = {0.009, 0.005, -0.004};
  m.c.rig.fill = 400.0;
  m.bar().motion.axis = {1.0, 0.0, 0.0};
  m.vessel().mesh = tube(0.01, -0.01, 0.01, 64);
  dem::TriangleMesh ends = box({-0.0105, -0.0102, -0.0102}, {-0.01, 0.0102, 0.0102});
  m.rig.meshes.push_back(part("end", ends));
  m.rig.meshes.push_back(part("other end", box({0.01, -0.0102, -0.0102}, {0.0105, 0.0102, 0.0102})));
  SECTION("it fits") {
    m.bar().mesh = box({-0.006, -0.006, -0.0005}, {0.006, 0.006, 0.0005});
    CHECK_THAT(listed(m.told().warnings), !Contains("sticks out"));
  }
  SECTION("its diameter was taken for its radius") {
    m.bar().mesh = box({-0.006, -0.012, -0.0005}, {0.006, 0.012, 0.0005});
    CHECK_THAT(listed(m.told().warnings), Contains("bar sticks out by 2") && Contains("through vessel"));
    CHECK(m.told().gaps.empty());
  }
  SECTION("a shaft that ends just outside the end wall") {
    m.bar().mesh = box({-0.0115, -0.002, -0.0021}, {0.006, 0.002, 0.0021});
    INFO(m.said());
    const dem::Forecast f = m.told();
    CHECK_THAT(listed(f.warnings), !Contains("sticks out"));
    for (const dem::NamedGap& gap : f.gaps) CHECK(gap.between.find("end") == std::string::npos);
  }
}

TEST_CASE("powder that nothing holds is said: outside the vessel, through an open end, upwards, over the rim") {
  Mixer m;
  SECTION("the region is the box") {
    m.rig.region.low = m.rig.low;
    m.rig.region.high = m.rig.high;
    m.rig.low = {-0.03, -0.03, -0.02};
    m.rig.high = {0.03, 0.03, 0.06};
    m.rig.region.low = m.rig.low;
    m.rig.region.high = m.rig.high;
    CHECK_THAT(m.said(), Contains("rig.region") && Contains("no wall is under them"));
  }
  SECTION("no wall on one side") {
    m.vessel().mesh.triangles.erase(m.vessel().mesh.triangles.begin() + 8, m.vessel().mesh.triangles.begin() + 10);
    CHECK_THAT(m.said(), Contains("rig.region") && Contains("runs out of the box at"));
  }
  SECTION("gravity the other way") {
    m.rig.down = {0.0, 0.0, 1.0};
    CHECK_THAT(m.said(), Contains("rig.region") && Contains("no wall is under them"));
  }
  SECTION("more than it holds") {
    m.vessel().mesh = box({-0.01, -0.01, 0.0}, {0.01, 0.01, 0.012}, true);
    m.c.rig.fill = 6500.0;
    CHECK_THAT(m.said(), Contains("rig.fill") && Contains("times what the vessel holds"));
  }
  SECTION("a gap narrower than a sphere keeps the powder in") {
    m.vessel().mesh = box({-0.01, -0.01, 0.0}, {0.01, 0.01, 0.04}, true);
    for (dem::Vec3& v : m.vessel().mesh.vertices)
      if (v.z == 0.0) v.z = 0.0005;
    m.vessel().mesh.triangles.erase(m.vessel().mesh.triangles.begin(), m.vessel().mesh.triangles.begin() + 2);
    m.rig.meshes.push_back(part("floor", box({-0.011, -0.011, -0.001}, {0.011, 0.011, 0.0})));
    CHECK(m.said() == "");
  }
}

TEST_CASE("spheres inside a tool that is inside the vessel are said") {
  Mixer m;
  m.c.rig.fill = 100.0;
  m.bar().mesh = box({-0.006, -0.006, 0.001}, {0.006, 0.006, 0.013});
  m.rig.region.low = {-0.005, -0.005, 0.002};
  m.rig.region.high = {0.005, 0.005, 0.012};
  // All of them: right if the bar is a drum in its casing.
  CHECK(m.said() == "");
  CHECK_THAT(listed(m.told().warnings), Contains("all spheres start inside the mesh bar"));
  // A packing that was made without the bar.
  for (int x = -8; x <= 8; x += 2)
    for (int y = -8; y <= 8; y += 2)
      for (int z = 2; z <= 12; z += 2) m.rig.packing.push_back({1e-3 * x, 1e-3 * y, 1e-3 * z});
  std::erase_if(m.rig.packing, [](dem::Vec3 p) {
    return std::max(std::abs(p.x), std::abs(p.y)) > 0.0055 && std::max(std::abs(p.x), std::abs(p.y)) < 0.0065;
  });
  m.rig.packing_line.assign(m.rig.packing.size(), 1);
  m.c.rig.fill = static_cast<double>(m.rig.packing.size());
  CHECK_THAT(m.said(), Contains("rig.region") && Contains("inside the mesh bar"));
}

TEST_CASE("a vessel may stand in a casing, in a frame, or have lifters that go through its wall") {
  Mixer m;
  const dem::Forecast alone = m.told();
  SECTION("a casing") {
    m.rig.meshes.push_back(part("jacket", box({-0.0115, -0.0115, -0.001}, {0.0115, 0.0115, 0.041})));
  }
  SECTION("a frame") {
    m.rig.meshes.push_back(part("left", box({-0.0115, -0.0115, -0.001}, {-0.0105, 0.0115, 0.045})));
    m.rig.meshes.push_back(part("right", box({0.0105, -0.0115, -0.001}, {0.0115, 0.0115, 0.045})));
  }
  SECTION("powder that starts above the rim") {
    m.rig.meshes.push_back(part("jacket", box({-0.0115, -0.0115, -0.001}, {0.0115, 0.0115, 0.0495})));
    m.rig.region.high = {0.01, 0.01, 0.048};
  }
  INFO(listed(m.told().warnings));
  CHECK(m.said() == "");
  CHECK(*m.told().surface == Approx(*alone.surface).margin(1e-4));
}

TEST_CASE("the bed's surface is that of arithmetic wherever the box begins, and however thin the bed") {
  // A floor just below the centre of a cell leaves two narrow cells under the wide ones.
  for (const double size : {1e-3, 1.3e-3}) {
    for (int shift = 0; shift < 12; ++shift) {
      Mixer m;
      m.c.material.diameter = size;
      m.c.rig.fill = 1500.0;
      m.rig.low.z = -0.5e-3 - 0.05e-3 * shift;
      m.rig.low.x = -0.0112 - 0.05e-3 * shift;
      const double bar = 0.012 * 0.002 * 0.004;
      const double bed = 1500.0 * 3.14159265358979 / 6.0 * size * size * size / 0.6;
      const double depth = (bed + bar) / (0.02 * 0.02);
      INFO(size << ", " << shift << ": " << m.said());
      CHECK(*m.told().surface == Approx(depth).margin(0.4 * size));
    }
  }
}

TEST_CASE("normals turned inwards change nothing that is said") {
  Mixer m;
  const dem::Forecast before = m.told();
  for (dem::RigMesh& mesh : m.rig.meshes)
    for (auto& t : mesh.mesh.triangles) std::swap(t[0], t[1]);
  const dem::Forecast after = m.told();
  CHECK(data::describe(after.problems) == "");
  CHECK(*after.surface == Approx(*before.surface));
  CHECK(after.gaps[0].width == Approx(before.gaps[0].width));
}

TEST_CASE("a slice's surface is that of its cross-section, and a fill that buries the mixer is refused") {
  dem::Case c;
  // Half of the room below the axis, without a mixer.
  c.rig.shaft_radius = 1e-6;
  c.rig.blade_radius = 2e-6;
  c.rig.blade_thickness = 1e-7;
  const double half = 0.5 * M_PI * c.rig.trough_radius * c.rig.trough_radius * c.rig.pitch;
  c.rig.fill = std::round(half * 0.6 / (M_PI / 6.0 * std::pow(c.material.diameter, 3)));
  CHECK(dem::fill_of_slice(c).surface == Approx(0.0).margin(1e-5));
  c = {};
  CHECK(dem::problems(c).empty());
  const dem::Forecast f = dem::forecast(dem::prepare(c), 1);
  CHECK(*f.fill > 0.4);
  CHECK(*f.fill < 0.9);
  c.material.density = 2.5;
  c.rig.fill_mass = 3.87e-3;  // of 6090 kg/m3: 2400 spheres
  const std::vector<data::Problem> found = dem::problems(c);
  REQUIRE(found.size() == 1);
  CHECK(found[0].place == "rig.fill_mass");
  CHECK_THAT(found[0].what, Contains("times the room below the blade's top"));
  CHECK_THAT(found[0].remedy, Contains("density"));
}

TEST_CASE("a gravity of 981 m/s2 is asked about, and a centrifuge's is not") {
  dem::Case c;
  c.contact.stiffness = 1e4;
  const auto warned = [&](double gravity) {
    c.run.gravity = gravity;
    const std::vector<std::string> warnings = dem::forecast(dem::prepare(c), 1).warnings;
    return std::any_of(warnings.begin(), warnings.end(),
                       [](const std::string& one) { return one.find("cm/s2") != std::string::npos; });
  };
  CHECK(warned(981.0));
  CHECK_FALSE(warned(9.81));
  CHECK_FALSE(warned(500.0));
}

TEST_CASE("a slice whose spheres do not pass between trough and shaft is refused, and its packing ends everywhere") {
  dem::Case c;
  c.rig.trough_radius = 0.3e-3;
  c.rig.blade_radius = 0.2e-3;
  c.rig.shaft_radius = 0.1e-3;
  CHECK_THAT(data::describe(dem::problems(c)), Contains("rig.trough_radius"));
  CHECK_THROWS_WITH(dem::pack(c, 1), Contains("rig.trough_radius") && Contains("leaves no place for a sphere"));
}
