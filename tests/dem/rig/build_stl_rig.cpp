// Rigs of the user's own meshes: what a study says reaches the run, packings keep clear, mistakes are named.
#include <fmt/format.h>
#include <catch2/catch.hpp>
#include <tuple>

#include "data/error.hpp"
#include "dem/bed/setup.hpp"
#include "dem/case/stl_rig.hpp"
#include "dem/reading/prepare.hpp"
#include "dem/reading/read_case.hpp"
#include "dem/reading/target.hpp"
#include "dem/rig/slice.hpp"
#include "dem/run/run.hpp"
#include "dem/walls/stl.hpp"
#include "tests/dem/scene.hpp"
#include "tests/temporary.hpp"

namespace {

/// A folder with the default slice's mixer and trough as STL.
struct SliceFolder : TemporaryFolder {
  SliceFolder() {
    dem::write_stl(dem::auger_mesh({}), path("mixer.stl"));
    dem::write_stl(dem::trough_mesh({}, 0.06), path("trough.stl"));
  }
  data::StudyFile study(const std::string& text) const {
    write("study.toml", text);
    return data::StudyFile::open(path());
  }
};

const std::string rig = R"(
[rig]
kind = "stl"
rpm = "150 rpm"
fill = 400
[rig.box]
low = ["0 mm", "-7.1 mm", "-7.1 mm"]
high = ["12 mm", "7.1 mm", "60 mm"]
periodic = ["x"]
[rig.region]
low = ["0 mm", "-7.1 mm", "-7.1 mm"]
high = ["12 mm", "7.1 mm", "30 mm"]
[[rig.mesh]]
name = "mixer"
file = "mixer.stl"
unit = "m"
speed_ratio = 1
[[rig.mesh]]
name = "trough"
file = "trough.stl"
unit = "m"
)";
const std::string rest = R"(
[materials.steel]
density = "7800 kg/m3"
diameter = "1.4 mm"
[run]
settle = "20 ms"
start_up = "10 ms"
start_up_turns = 0.25
shortest = "10 ms"
longest = "30 ms"
window = "2 ms"
)";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

std::string said(const SliceFolder& folder, const std::string& text) {
  const data::StudyFile file = folder.study(text);
  dem::read_case(file, "steel");
  try {
    file.finish();
  } catch (const data::InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("a slice given as STL runs like the slice itself: same steps, same torque within its error", "[slow]") {
  const SliceFolder folder;
  const data::StudyFile file = folder.study(rig + rest);
  dem::Case c = dem::read_case(file, "steel");
  CHECK_NOTHROW(file.finish());
  c.run.overlap_limit = 0.5;  // the spheres are wider than the gap between blade and trough, and pinched there
  c.run.settle = 0.05;
  c.run.start_up = 0.05;
  c.run.start_up_turns = 0.25;
  c.run.shortest = c.run.longest = 0.25;
  const dem::RunResult stl = dem::run(c, 1);
  REQUIRE(stl.status == dem::RunStatus::done);
  dem::Case slice = c;
  slice.rig.stl.reset();
  const dem::RunResult own = dem::run(slice, 1);
  CHECK(stl.diagnostics.steps == own.diagnostics.steps);
  const auto &a = stl.summary.mean[0], &b = own.summary.mean[0];
  INFO("torque " << 1e6 * a.mean << " +- " << 1e6 * a.standard_error << " and " << 1e6 * b.mean << " +- "
                 << 1e6 * b.standard_error << " uN m");
  CHECK(a.mean > 0.0);
  CHECK(std::abs(a.mean - b.mean) < 4.0 * std::hypot(a.standard_error, b.standard_error));
  // Positive along the axis, and the helix conveys against it.
  CHECK(dem::output(stl, "axial_flow").mean < 0.0);
}

TEST_CASE(
    "spheres fill a region of meshes from the bottom, clear of them and of each other, and never inside a shaft") {
  const SliceFolder folder;
  const data::StudyFile file = folder.study(rig + rest);
  dem::Case c = dem::read_case(file, "steel");
  c.material.diameter = 0.4e-3;  // small enough to find room inside shaft and blade
  c.rig.fill = 12000.0;
  const dem::BuiltRig built = dem::build_rig(c, 3);
  REQUIRE(built.position.size() == 12000);
  const dem::Simulation s(dem::make_setup(c, dem::derive(c), built, 0, 1));
  CHECK(s.sums().contacts + s.sums().wall_contacts == 0);
  const dem::Rig slice;
  for (const dem::Vec3 p : built.position) {
    const double rho = std::hypot(p.y, p.z);
    CHECK(rho > slice.shaft_radius);
    const double off = std::remainder(p.x - std::atan2(p.z, p.y) / (2.0 * M_PI) * slice.pitch, slice.pitch);
    CHECK((rho > slice.blade_radius || std::abs(off) > 0.5 * slice.blade_thickness));
  }
  c.rig.fill = 1e6;
  CHECK_THROWS_WITH(dem::build_rig(c, 3), Catch::Contains("1000000 spheres") && Catch::Contains("has room for"));
}

TEST_CASE("spheres so small that their places fit no memory are refused before any is looked for") {
  const SliceFolder folder;
  const data::StudyFile file = folder.study(rig + replaced(rest, "1.4 mm", "1.4 um"));
  const dem::Case c = dem::read_case(file, "steel");
  CHECK_NOTHROW(file.finish());
  CHECK_THROWS_WITH(dem::build_rig(c, 1), Catch::Contains("material.diameter") &&
                                              Catch::Contains("0.0014 mm is so small") &&
                                              Catch::Contains("check the unit"));
}

TEST_CASE("spheres start where a CSV says, and one outside the box or inside a mesh is named") {
  const SliceFolder folder;
  const auto write = [&](const char* rows) { folder.write("at.csv", std::string("x,y,z\n") + rows); };
  const std::string text = replaced(rig, "fill = 400", "packing = \"at.csv\"\npacking_unit = \"mm\"") + rest;
  const auto build = [&] { return dem::build_rig(dem::read_case(folder.study(text), "steel"), 1); };
  write("6,5.5,2\n3,-5.5,3\n");
  const dem::BuiltRig built = build();
  REQUIRE(built.position.size() == 2);
  CHECK(built.position[1].y == Approx(-5.5e-3));
  CHECK(dem::derive(dem::read_case(folder.study(text), "steel")).spheres == 2);
  folder.write("at.csv", "x,y,z,vx,vy,vz,frozen\n6,5.5,2,0,0,-0.1,0\n3,-5.5,3,0,0,1,1\n");
  const dem::Case turning = dem::read_case(folder.study(text), "steel");
  dem::Simulation s(dem::make_setup(turning, dem::derive(turning), build(), 0, 1));
  while (s.time() < 5e-3) s.step();
  CHECK(scene::position_of(s, 0).z == Approx(2e-3 - 0.1 * s.time() - 0.5 * 9.81 * s.time() * s.time()).epsilon(1e-3));
  CHECK(scene::position_of(s, 1).z == Approx(3e-3 + 1.0 * s.time()).epsilon(1e-12));  // keeps its velocity
  write("6,5.5,2\n3,-9,3\n");
  CHECK_THROWS_WITH(build(), Catch::Contains("sphere 2") && Catch::Contains("outside the box"));
  write("6,5.5,2\n3,6.9,3\n");
  CHECK_THROWS_WITH(build(), Catch::Contains("sphere 2") && Catch::Contains("inside a mesh"));
  write("6,5.5\n");
  CHECK_THAT(said(folder, text), Catch::Contains("at.csv"));
}

TEST_CASE("a packing is read in the units of its headings, and in packing_unit and m/s where they have none") {
  const SliceFolder folder;
  const std::string text = replaced(rig, "fill = 400", "packing = \"at.csv\"\npacking_unit = \"mm\"") + rest;
  const auto read = [&](const std::string& heading) {
    folder.write("at.csv", heading + "\n6,5.5,2,3,4,5\n");
    return *dem::read_case(folder.study(text), "steel").rig.stl;
  };
  const dem::StlRig bare = read("x,y,z,vx,vy,vz");
  CHECK(bare.packing[0].x == Approx(6e-3));
  CHECK(bare.velocity[0].x == Approx(3.0));
  const dem::StlRig with = read("x [um],y [m],z,vx [mm/s],vy [m/s],vz [cm/s]");
  CHECK(with.packing[0].x == Approx(6e-6));
  CHECK(with.packing[0].y == Approx(5.5));
  CHECK(with.packing[0].z == Approx(2e-3));
  CHECK(with.velocity[0].x == Approx(3e-3));
  CHECK(with.velocity[0].y == Approx(4.0));
  CHECK(with.velocity[0].z == Approx(5e-2));
  folder.write("at.csv", "x,y,z,vx [mm],vy,vz\n6,5.5,2,3,4,5\n");
  CHECK_THAT(said(folder, text), Catch::Contains("at.csv:1: vx") && Catch::Contains("does not measure"));
}

TEST_CASE("a packing of several sizes says which sphere is how large, as the materials make them") {
  const SliceFolder folder;
  std::string text = replaced(rig, "fill = 400", "packing = \"at.csv\"\npacking_unit = \"mm\"") + rest;
  text = replaced(
      text, "diameter = \"1.4 mm\"",
      "sizes = [{ diameter = \"1.4 mm\", mass_fraction = 0.8 }, { diameter = \"0.7 mm\", mass_fraction = 0.2 }]");
  const auto build = [&](const std::string& rows) {
    folder.write("at.csv", rows);
    return dem::build_rig(dem::read_case(folder.study(text), "steel"), 1);
  };
  const std::string heading = "x,y,z,vx,vy,vz,diameter\n", small = "6,5.5,10,1,0,0,0.7\n", large = "6,0,20,2,0,0,1.4\n";
  const dem::BuiltRig built = build(heading + small + large + "6,-5.5,30,3,0,0,0.7\n");
  REQUIRE(built.position.size() == 3);  // 0.8 of the mass in one sphere and 0.2 in two, each an eighth of it
  for (const auto& [at, z, speed, radius] :
       {std::tuple{0, 20e-3, 2.0, 0.7e-3}, {1, 10e-3, 1.0, 0.35e-3}, {2, 30e-3, 3.0, 0.35e-3}}) {
    CHECK(built.position[at].z == Approx(z));
    CHECK(built.velocity[at].x == Approx(speed));
    CHECK(built.grains.radius[at] == Approx(radius));
  }
  using Catch::Contains;
  CHECK_THROWS_WITH(build(heading + small + large + "6,-5.5,30,3,0,0,0.8\n"),
                    Contains("of 0.0008 m in line 4") && Contains("0.0007 m"));
  CHECK_NOTHROW(build(heading + small + large + "6,1.0,20,0,0,0,0.7\n"));  // touching at 1.05 mm
  CHECK_THROWS_WITH(build(heading + small + large + "6,0.98,20,0,0,0,0.7\n"),
                    Contains("(lines 3 and 4)") && Contains("0.133 of a radius"));
  folder.write("at.csv", "x,y,z\n6,5.5,10\n6,0,20\n6,-5.5,30\n");
  const std::vector<data::Problem> found = dem::problems(dem::read_case(folder.study(text), "steel"));
  REQUIRE(found.size() == 1);
  CHECK_THAT(found[0].remedy, Contains("give it a column diameter"));
}

TEST_CASE("spheres of a packing that overlap are named with their lines, also over a periodic face") {
  const SliceFolder folder;
  const std::string text = replaced(rig, "fill = 400", "packing = \"at.csv\"\npacking_unit = \"mm\"") + rest;
  const auto build = [&](const std::string& rows) {
    folder.write("at.csv", "x,y,z,frozen\n" + rows);
    return dem::build_rig(dem::read_case(folder.study(text), "steel"), 1);
  };
  using Catch::Contains;  // spheres of 1.4 mm, of which a tenth of a radius is 0.07 mm
  CHECK_NOTHROW(build("6,0,20,0\n6,1.34,20,0\n"));
  CHECK_THROWS_WITH(build("6,0,20,0\n6,0,30,0\n6,1.32,20,0\n"),
                    Contains("spheres 1 and 3 (lines 2 and 4)") && Contains("0.114 of a radius"));
  CHECK_THROWS_WITH(build("6,0,20,0\n6,0,20,1\n"), Contains("lines 2 and 3") && Contains("2 of a radius"));
  CHECK_THROWS_WITH(build("0.1,0,20,0\n11.9,0,20,0\n"), Contains("lines 2 and 3"));
  CHECK_NOTHROW(build("6,-6,20,0\n6,6,20,0\n"));
  CHECK_NOTHROW(build("6,0,20,1\n6,1,20,1\n"));  // both are held
  std::string lattice;                           // all pairs of many cells, of which one overlaps
  for (int i = 0; i < 8; ++i)
    for (int j = 0; j < 8; ++j)
      for (int k = 0; k < 20; ++k)
        lattice += fmt::format("{},{},{},0\n", 0.75 + 1.5 * i, -5.25 + 1.5 * j, 10.0 + 1.5 * k);
  CHECK_NOTHROW(build(lattice));
  CHECK_THROWS_WITH(build(lattice + "3.75,-2.25,17,0\n"), Contains("and 1281"));
}

TEST_CASE("the rig's speed drives its meshes, its dimensions do not exist, and its settings name all that it is") {
  const SliceFolder folder;
  dem::Case c = dem::read_case(folder.study(rig + rest), "steel");
  dem::set_target(c, "rig.rpm", -3.0);
  const dem::BuiltRig built = dem::build_rig(c, 1);
  CHECK(dem::programme_speed(built.bodies[0].motion, 1.0) == -3.0);
  CHECK(dem::programme_speed(built.bodies[1].motion, 1.0) == 0.0);
  CHECK(built.sensor.driven.at(0).torque_axis.x == 1.0);
  CHECK_THROWS_WITH(dem::set_target(c, "rig.pitch", 0.01),
                    Catch::Contains("belongs to rigs of kind \"slice\" and \"machine\" only"));
  const std::string before = dem::settings_text(c);
  const std::vector<std::pair<std::string, std::string>> changes{
      {"speed_ratio = 1", "speed_ratio = 2"},
      {"\"12 mm\", \"7.1 mm\", \"60 mm\"", "\"12 mm\", \"7.1 mm\", \"61 mm\""},
      {"file = \"trough.stl\"", "file = \"mixer.stl\""},
      {"high = [\"12 mm\", \"7.1 mm\", \"30 mm\"]",
       "from = [\"0 mm\", \"0 mm\", \"0 mm\"]\nto = [\"12 mm\", \"0 mm\", \"9 mm\"]\nradius = \"7 mm\""},
      {"speed_ratio = 1",
       "speed_ratio = 1\n[[rig.mesh.oscillation]]\nalong = [0, 0, 1]\namplitude = \"1 mm\"\nfrequency "
       "= \"20 Hz\""},
      {"rpm = \"150 rpm\"", "rpm = \"150 rpm\"\ndown = [0, 1, -1]"},
      {"rpm = \"150 rpm\"", "rpm = \"150 rpm\"\ntorque_of = \"trough\""}};
  for (const auto& [from, to] : changes) {
    dem::Case other = dem::read_case(folder.study(replaced(rig, from, to) + rest), "steel");
    dem::set_target(other, "rig.rpm", -3.0);
    INFO(to);
    CHECK(dem::settings_text(other) != before);
  }
}

TEST_CASE(
    "a speed that drives no mesh has no effect, nor has a wall's coefficient where each wall has one of its own") {
  using Catch::Contains;
  const SliceFolder folder;
  const auto why = [&](const std::string& text, const char* target) {
    return dem::without_effect(dem::read_case(folder.study(text + rest), "steel"), target);
  };
  const auto pair = [](const std::string& body) {
    return "[[contact.pair]]\nbetween = [\"steel\", \"" + body + "\"]\nfriction = 0.1\n";
  };
  CHECK(why(rig, "rig.rpm") == "");
  CHECK_THAT(why(replaced(rig, "speed_ratio = 1", "rpm = \"9 rpm\""), "rpm"), Contains("none has a speed_ratio"));
  CHECK(why(rig, "contact.wall_friction") == "");
  CHECK(why(rig + pair("mixer"), "contact.wall_friction") == "");
  CHECK_THAT(why(rig + pair("mixer") + pair("trough"), "contact.wall_friction"), Contains("friction is given"));
  CHECK_THAT(why(rig + pair("wall"), "wall_friction"), Contains("contact.pair"));
  CHECK(why(rig + pair("wall"), "contact.friction") == "");
}

TEST_CASE("the torques of several meshes are summed, and two that turn side by side have channels") {
  const SliceFolder folder;
  const std::string two = replaced(rig, "speed_ratio = 1", R"(speed_ratio = 1
[[rig.mesh]]
name = "second"
file = "mixer.stl"
unit = "m"
axis = [-1, 0, 0]
point = ["0 mm", "4 mm", "0 mm"]
speed_ratio = 1
)");
  const auto read = [&](const std::string& measured) {
    const std::string text = replaced(two, "rpm = \"150 rpm\"", "rpm = \"150 rpm\"\ntorque_of = " + measured);
    return dem::read_case(folder.study(text + rest), "steel");
  };
  const dem::Case both = read("[\"mixer\", \"second\"]"), one = read("\"second\"");
  REQUIRE(both.rig.stl->measured == std::vector<std::size_t>{0, 1});
  CHECK(one.rig.stl->measured == std::vector<std::size_t>{1});
  CHECK(dem::measured_bodies(both).size() == 2);
  CHECK(dem::settings_text(both) != dem::settings_text(one));
  const dem::Channels channels = dem::channels_of(both);
  CHECK(channels.along.x == 1.0);
  CHECK(channels.across.y == Approx(1.0));
  CHECK(channels.middle == Approx(2e-3));
  CHECK(channels.to - channels.from == Approx(12e-3));
  CHECK(channels.of({0.0, 1.9e-3, 0.0}) == 0);
  CHECK(channels.of({0.0, 2.1e-3, 0.0}) == 1);
  CHECK_FALSE(dem::channels_of(one).exist());
  CHECK(dem::no_output_because(both, "second_flow").empty());
  CHECK_THAT(dem::no_output_because(both, "silhouette_x"), Catch::Contains("turn about two"));
  CHECK_THAT(dem::no_output_because(one, "second_flow"), Catch::Contains("side by side"));
  const dem::BuiltRig built = dem::build_rig(both, 1);
  REQUIRE(built.sensor.driven.size() == 2);
  CHECK(built.sensor.driven[1].torque_axis.x == 1.0);  // it turns the other way
  CHECK(dem::length(built.sensor.picture.right) == 0.0);
  CHECK_THAT(
      said(folder, replaced(two, "rpm = \"150 rpm\"", "rpm = \"150 rpm\"\ntorque_of = [\"mixer\", \"mixer\"]") + rest),
      Catch::Contains("names the mesh 'mixer' twice"));
}

TEST_CASE(
    "the torque of a mesh at rest is about the axis of what turns, and one that swings is measured about its own") {
  using Catch::Contains;
  const SliceFolder folder;
  const std::string about_z = "axis = [0, 0, 1]\npoint = [\"3 mm\", \"1 mm\", \"0 mm\"]\n";
  const auto text = [&](const std::string& measured, const std::string& mixer, const std::string& trough) {
    std::string t = replaced(rig, "periodic = [\"x\"]", "");
    t = replaced(t, "rpm = \"150 rpm\"", "rpm = \"150 rpm\"\ntorque_of = " + measured);
    return replaced(t, "speed_ratio = 1\n", mixer) + trough + rest;
  };
  const auto sensor_axis = [&](const std::string& study, std::size_t body) {
    const dem::Case c = dem::read_case(folder.study(study), "steel");
    const dem::BuiltRig built = dem::build_rig(c, 1);
    REQUIRE(built.sensor.driven.back().body == body);
    return std::pair{built.sensor.driven.back().torque_axis, built.bodies[body].motion.point};
  };
  const auto is_that_of_the_mixer = [&](const std::string& study, std::size_t body) {
    const auto [axis, point] = sensor_axis(study, body);
    CHECK(axis.z == 1.0);
    CHECK(dem::length(point - dem::Vec3{3e-3, 1e-3, 0.0}) < 1e-12);
  };
  const std::string swing =
      "[[rig.mesh.oscillation]]\nabout = [0, 0, 2]\namplitude = \"1 degree\"\nfrequency = \"5 Hz\"\n";
  is_that_of_the_mixer(text("\"trough\"", about_z + "speed_ratio = 1\n", ""), 1);
  is_that_of_the_mixer(text("[\"mixer\", \"trough\"]", about_z + "rpm = \"30 rpm\"\n", ""), 1);
  is_that_of_the_mixer(text("\"trough\"", "point = [\"3 mm\", \"1 mm\", \"0 mm\"]\n" + swing, ""), 1);
  is_that_of_the_mixer(text("\"mixer\"", "point = [\"3 mm\", \"1 mm\", \"0 mm\"]\n" + swing, ""), 0);
  const auto given = sensor_axis(text("\"trough\"", about_z + "speed_ratio = 1\n", "axis = [0, 1, 0]\n"), 1);
  CHECK(given.first.y == 1.0);
  CHECK(given.second.x == 0.0);
  const auto refused = [&](const std::string& study) { return said(folder, study); };
  CHECK_THAT(refused(text("\"trough\"", "", "")),
             Contains("rig.mesh") && Contains("axis: is missing") && Contains("'trough'") && Contains("no mesh turns"));
  CHECK_THAT(refused(text("\"mixer\"", "speed_ratio = 1\n" + swing, "")), !Contains("is missing"));
  CHECK_THAT(refused(text("\"trough\"", about_z + "speed_ratio = 1\n", R"(
[[rig.mesh]]
name = "second"
file = "mixer.stl"
unit = "m"
axis = [0, 0, 1]
rpm = "9 rpm"
)")),
             Contains("'trough'") && Contains("no axis in common") && Contains("add lines like axis"));
}

TEST_CASE("a programme and oscillations are read with their units") {
  const SliceFolder folder;
  const std::string text = replaced(rig, "speed_ratio = 1", R"(
axis = [2, 0, 0]
point = ["0 mm", "1 mm", "0 mm"]
programme = { time = ["0 s", "500 ms"], speed = ["0 rpm", "60 rpm"] }
[[rig.mesh.oscillation]]
about = [1, 0, 0]
amplitude = "90 degree"
frequency = "20 Hz"
phase = "180 degree"
)") + rest;
  const dem::Case c = dem::read_case(folder.study(text), "steel");
  REQUIRE(c.rig.stl->meshes.size() == 2);
  const dem::Motion& m = c.rig.stl->meshes[0].motion;
  CHECK(m.axis.x == 1.0);
  CHECK(m.point.y == Approx(1e-3));
  CHECK(dem::programme_speed(m, 0.25) == Approx(M_PI));
  REQUIRE(m.oscillations.size() == 1);
  CHECK(m.oscillations[0].kind == dem::OscillationKind::about);
  CHECK(m.oscillations[0].amplitude == Approx(0.5 * M_PI));
  CHECK(m.oscillations[0].frequency == Approx(20.0));
  CHECK(said(folder, text) == "");
}

TEST_CASE("what is wrong with a rig from STL is named with its place, value and remedy, all at once") {
  using Catch::Contains;
  const SliceFolder folder;
  const auto with = [&](const std::string& from, const std::string& to) {
    return said(folder, replaced(rig, from, to) + rest);
  };
  CHECK(said(folder, rig + rest) == "");
  CHECK_THAT(with("mixer.stl", "shaft.stl"), Contains("shaft.stl") && Contains("no such file"));
  CHECK_THAT(with("unit = \"m\"", "unit = \"mm\""), Contains("rig.mesh.mixer") && Contains("smaller than a sphere"));
  CHECK_THAT(with("unit = \"m\"", "unit = \"km\""), Contains("rig.mesh.mixer") && Contains("correct the mesh's unit"));
  CHECK_THAT(with("unit = \"m\"", "unit = \"kg\""), Contains("'kg' is not a length"));
  CHECK_THAT(with("unit = \"m\"", ""), Contains("unit") && Contains("missing"));
  CHECK_THAT(with("\"12 mm\", \"7.1 mm\", \"60 mm\"", "\"6.5 mm\", \"7.1 mm\", \"60 mm\""),
             Contains("rig.mesh.mixer") && Contains("along x") && Contains("beyond the box"));
  CHECK_THAT(with("speed_ratio = 1", "speed_ratio = 1\naxis = [0, 0, 1]"), Contains("periodic"));
  CHECK_THAT(with("speed_ratio = 1", "speed_ratio = 1\nrpm = \"3 rpm\""), Contains("more than one"));
  CHECK_THAT(with("speed_ratio = 1", "axis = [0, 0, 0]"), Contains("is no direction"));
  CHECK_THAT(with("rpm = \"150 rpm\"", "torque_of = \"auger\""),
             Contains("no mesh 'auger'") && Contains("mixer, trough"));
  CHECK_THAT(with("rpm = \"150 rpm\"", "rpm = \"0 rpm\""), Contains("rig.rpm"));
  CHECK_THAT(with("\"trough\"", "\"mixer\""), Contains("taken by another mesh"));
  CHECK_THAT(with("periodic = [\"x\"]", "periodic = [\"w\"]"), Contains("'w' is no axis"));
  CHECK_THAT(with("low = [\"0 mm\", \"-7.1 mm\", \"-7.1 mm\"]", "low = [\"0 mm\", \"-7.1 mm\"]"),
             Contains("has 2 numbers"));
  folder.write("mixer.stl", "solid broken\nfacet normal 0 0 1\nouter loop\nvertex 0 0 x\n");
  const std::string both = with("periodic = [\"x\"]", "periodic = [\"w\"]");
  CHECK_THAT(both, Contains("mixer.stl:4") && Contains("'w' is no axis"));
}

TEST_CASE("a value that was not read makes no second, false problem") {
  using Catch::Contains;
  const SliceFolder folder;
  const std::string point = said(folder, replaced(rig, "speed_ratio = 1", "speed_ratio = 1\npoint = [0, 0, 0]") + rest);
  CHECK_THAT(point, Contains("0 has no unit") && !Contains("numbers"));
  const std::string fill = said(folder, replaced(rig, "fill = 400", "fill = \"50 %\"") + rest);
  CHECK_THAT(fill, Contains("rig.fill") && !Contains("is zero"));
  CHECK_THAT(said(folder, replaced(rig, "fill = 400", "fill = 0") + rest), Contains("0 is not above 0"));
  const std::string none = said(folder, replaced(rig, "speed_ratio = 1", "speed_ratio = 1\npoint = []") + rest);
  CHECK_THAT(none, Contains("has 0 numbers"));
}
