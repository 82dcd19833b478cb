// What a camera measures along the axis, of clouds whose outline is known: circular segments and a bed with a kink. The
// closed forms are those of plane geometry, and hold to the size of a cell. Then of a drum at work.
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <memory>

#include "dem/reading/target.hpp"
#include "dem/run/outputs.hpp"
#include "dem/run/run.hpp"
#include "dem/run/silhouette.hpp"
#include "tests/dem/small_rigs.hpp"

using Catch::Contains;

namespace {

constexpr double radius = 42e-3, sphere = 0.25e-3, degree = M_PI / 180.0;

const dem::Box drum_box{{-radius, 0.0, -radius}, {radius, 20e-3, radius}, {false, true, false}};

/// Along y, as the drum's, of a drum whose right or whose left side rises.
dem::PicturePlane plane_of(double turns = 1.0) {
  return dem::picture_plane(dem::picture_along({0.0, -turns, 0.0}, {}, {0.0, 0.0, -1.0}), drum_box, sphere);
}

/// Spheres on a lattice denser than they are wide, wherever `inside(x, z)` says so, their discs within the circle.
std::vector<dem::PositionRow> cloud(const std::function<bool(double x, double z)>& inside) {
  std::vector<dem::PositionRow> spheres;
  const double apart = 0.8 * sphere, wide = radius - sphere;
  const int most = static_cast<int>(wide / apart);
  for (int i = -most; i <= most; ++i) {
    for (int j = -most; j <= most; ++j) {
      const double x = i * apart, z = j * apart;
      if (std::hypot(x, z) <= wide && inside(x, z)) spheres.push_back({{x, 1e-3, z}, sphere});
    }
  }
  return spheres;
}

dem::Silhouette seen(const dem::PicturePlane& plane, const std::vector<dem::PositionRow>& spheres) {
  dem::Exposure exposure;
  dem::expose(plane, spheres, exposure);
  return dem::silhouette_of(plane, exposure);
}

/// Below a straight surface at this angle, whose distance from the axis is `depth`. The centres stop a radius short.
std::vector<dem::PositionRow> segment(double angle, double depth = 0.0) {
  return cloud([=](double x, double z) { return z * std::cos(angle) - x * std::sin(angle) <= -depth - sphere; });
}

/// Two straight surfaces that meet on the line through axis and centre, at equal angles from `mean` to either side.
std::vector<dem::PositionRow> kinked(double mean, double half) {
  return cloud([=](double x, double z) {
    const double s = x * std::cos(mean) + z * std::sin(mean), h = z * std::cos(mean) - x * std::sin(mean);
    return h + sphere / std::cos(half) <= std::tan(half) * std::abs(s) - 0.1 * radius;
  });
}

/// Open at its ends, with spheres that are lighter.
dem::Case open_drum() {
  dem::Case c = scene::small_drum(dem::EndPlates::none);
  c.rig.level = 0.45;
  c.material.density = 1500.0;
  c.material.sizes = scene::thirds(1.08e-3, 1.2e-3, 1.32e-3);
  return c;
}

}  // namespace

TEST_CASE("a circular segment under an inclined surface has the centre, area and angles of plane geometry") {
  const double angle = 25.0 * degree, depth = GENERATE(0.0, 0.15, -0.1) * radius;
  const dem::PicturePlane plane = plane_of();
  const dem::Silhouette found = seen(plane, segment(angle, depth));
  // Of the part of a disc beyond a chord at distance d from its middle.
  const double half = std::acos(depth / radius), area = radius * radius * (half - std::sin(half) * std::cos(half)),
               distance = 2.0 / 3.0 * std::pow(radius * std::sin(half), 3.0) / area,
               outline = 2.0 * radius * (half + std::sin(half));
  CHECK(std::abs(found.area - area) < 0.5 * plane.cell * outline);
  CHECK(std::abs(found.x - distance * std::sin(angle)) < plane.cell);
  CHECK(std::abs(found.z + distance * std::cos(angle)) < plane.cell);
  CHECK(std::abs(found.upper_angle - angle) < 0.3 * degree);
  CHECK(std::abs(found.lower_angle - angle) < 0.3 * degree);
}

TEST_CASE("a surface with a kink has the angle of each of its two parts") {
  const double mean = 40.0 * degree, half = 6.0 * degree;
  const dem::Silhouette found = seen(plane_of(), kinked(mean, half));
  CHECK(std::abs(found.upper_angle - (mean + half)) < 0.5 * degree);
  CHECK(std::abs(found.lower_angle - (mean - half)) < 0.5 * degree);
}

TEST_CASE("the bed mirrored in a drum that turns the other way is measured alike, in the same drum it leans away") {
  const double angle = 25.0 * degree;
  const dem::Silhouette one = seen(plane_of(), segment(angle)), other = seen(plane_of(-1.0), segment(-angle)),
                        away = seen(plane_of(), segment(-angle));
  CHECK(other.x == Approx(one.x).epsilon(0.002));
  CHECK(other.area == Approx(one.area).epsilon(0.002));
  CHECK(std::abs(other.upper_angle - one.upper_angle) < 0.3 * degree);
  CHECK(away.x == Approx(-one.x).epsilon(0.002));
  CHECK(std::abs(away.upper_angle + one.upper_angle) < 0.3 * degree);
}

TEST_CASE("the silhouette is what is covered more often than not: grains in flight do not move it") {
  const dem::PicturePlane plane = plane_of();
  const std::vector<dem::PositionRow> bed = segment(30.0 * degree);
  std::vector<dem::PositionRow> with_flight = bed;
  with_flight.push_back({{0.2 * radius, 0.0, 0.7 * radius}, 4.0 * sphere});
  dem::Exposure exposure;
  for (int k = 0; k < 5; ++k) dem::expose(plane, k < 2 ? with_flight : bed, exposure);
  const dem::Silhouette alone = seen(plane, bed), averaged = dem::silhouette_of(plane, exposure);
  CHECK(averaged.x == alone.x);
  CHECK(averaged.area == alone.area);
  CHECK(averaged.upper_angle == alone.upper_angle);
}

TEST_CASE("where the surface is not that of a bed no angle is a number, and centre and area still are") {
  const dem::PicturePlane plane = plane_of();
  const auto without_angles = [](const dem::Silhouette& s) {
    return std::isfinite(s.x) && s.area > 0.0 && std::isnan(s.upper_angle) && std::isnan(s.lower_angle);
  };
  CHECK(without_angles(seen(plane, segment(20.0 * degree, 0.9 * radius))));  // its chord ends before 0.6 R
  CHECK(without_angles(seen(plane, cloud([](double x, double z) { return std::hypot(x, z) > 0.8 * radius; }))));
  const dem::Silhouette nothing = seen(plane, {});
  CHECK(nothing.area == 0.0);
  CHECK(std::isnan(nothing.x));
}

TEST_CASE("there is no picture along a vertical axis, nor across a periodic one") {
  const dem::Vec3 down{0.0, 0.0, -1.0};
  const dem::Box box{{-1.0, -1.0, -1.0}, {1.0, 1.0, 1.0}, {false, false, false}};
  dem::Box repeats = box;
  repeats.periodic[0] = true;
  CHECK(dem::picture_plane(dem::picture_along({0.0, 0.0, 1.0}, {}, down), box, 0.01).columns == 0);
  CHECK(dem::picture_plane(dem::picture_along({0.0, 1.0, 0.0}, {}, down), repeats, 0.01).columns == 0);
  CHECK(dem::picture_plane(dem::picture_along({1.0, 0.0, 0.0}, {}, down), repeats, 0.01).columns > 0);
  const auto stirred_about = [](dem::Vec3 axis) {
    dem::StlRig rig{.low = {-1.0, -1.0, -1.0}, .high = {1.0, 1.0, 1.0}};
    rig.meshes.push_back({.name = "stirrer", .motion = {.axis = axis}});
    dem::Case c;
    c.rig.stl = std::make_shared<const dem::StlRig>(rig);
    return c;
  };
  CHECK_FALSE(dem::no_output_because(stirred_about({0.0, 0.0, 1.0}), "silhouette_x").empty());
  CHECK(dem::no_output_because(stirred_about({0.0, 0.0, 1.0}), "centre_z").empty());
  CHECK(dem::no_output_because(stirred_about({1.0, 0.0, 0.0}), "silhouette_x").empty());
  CHECK(dem::no_output_because(open_drum(), "silhouette_x").empty());
  CHECK(dem::no_output_because(dem::Case{}, "upper_angle").empty());
  CHECK_FALSE(dem::has_output("silhouette_y"));
}

TEST_CASE("there are 256 cells along the longer side at most, and a sphere smaller than a cell still covers one") {
  const dem::PicturePlane plane =
      dem::picture_plane(dem::picture_along({0.0, -1.0, 0.0}, {}, {0.0, 0.0, -1.0}), drum_box, 1e-6);
  CHECK(plane.columns == 256);
  const dem::Silhouette one = seen(plane, {{{1e-3, 0.0, -2e-3}, 1e-6}});
  CHECK(one.area == Approx(plane.cell * plane.cell));
  CHECK(std::abs(one.x - 1e-3) < plane.cell);
  CHECK(std::abs(one.z + 2e-3) < plane.cell);
}

TEST_CASE("a drum at work: its silhouette leans as its mass does, and the surface of the picture rises", "[slow]") {
  dem::Case c = scene::steady(open_drum(), 2.0);
  c.rig.angular_velocity *= GENERATE(1.0, -1.0);
  const dem::RunResult result = dem::run(c, 1);
  REQUIRE(result.status == dem::RunStatus::done);
  const auto of = [&](const char* name) { return dem::output(result, name); };
  const double share = of("silhouette_area").mean / (M_PI * 1e-4);  // of a level of 0.45, and what flow loosens
  CHECK(share > 0.45);
  CHECK(share < 0.6);
  // The surface stands half a sphere above the highest centres, so the silhouette's centre is nearer to the axis.
  const double x = of("silhouette_x").mean, mass_x = of("centre_x").mean;
  CHECK(x > 0.75 * mass_x);
  CHECK(x < mass_x);
  CHECK(of("silhouette_z").mean < 0.0);
  CHECK(of("silhouette_z").mean > of("centre_z").mean);
  for (const char* name : {"upper_angle", "lower_angle"}) {
    CHECK(of(name).mean > 20.0 * degree);
    CHECK(of(name).mean < 50.0 * degree);
    CHECK(of(name).standard_error < 4.0 * degree);
  }
  CHECK(of("silhouette_x").standard_error > 0.0);  // whether it is known so soon is another question (dem/STEADY.md)
  CHECK(of("silhouette_x").standard_error < 0.1 * std::abs(x));
  CHECK(result.series.window_time.size() ==
        result.series.time.size() / dem::samples_in_window(c.run, result.series.time.front()));
}
