// run.h5 and the study's DEM sections.
#include <catch2/catch.hpp>

#include "data/error.hpp"
#include "dem/read_case.hpp"
#include "dem/run_file.hpp"
#include "dem/target.hpp"
#include "tests/temporary.hpp"

namespace {

data::StudyFile study(const TemporaryFolder& folder, const std::string& text) {
  folder.write("study.toml", text);
  return data::StudyFile::open(folder.path());
}

const std::string text = R"(
[rig]
kind = "slice"
pitch = "10 mm"
fill = "3 g"
rpm = "120 rpm"
[materials.steel]
density = "7800 kg/m3"
diameter = "1 mm"
[materials.glass]
density = "2500 kg/m3"
diameter = "900 um"
fill = 900
contact = { restitution = 0.9 }
[contact]
friction = 0.3
wall_friction = 0.2
hamaker = "2e-18 J"
cap = "thornton"
tension = "clamped"
wall_attraction = "derjaguin"
minimum_separation = "1 nm"
[run]
settle = "50 ms"
skin = 0.2
[training]
standard_error = 0.05
)";

}  // namespace

TEST_CASE("a study's rig, material, contact and run keys reach the case in SI, each material with its own") {
  const TemporaryFolder folder;
  const data::StudyFile file = study(folder, text);
  const dem::Case steel = dem::read_case(file, "steel"), glass = dem::read_case(file, "glass");
  CHECK_NOTHROW(file.finish());
  CHECK(steel.rig.pitch == Approx(0.01));
  CHECK(steel.rig.fill_mass.value() == Approx(3e-3));
  CHECK(steel.rig.angular_velocity == Approx(12.566370614359172));
  CHECK(steel.material.name == "steel");
  CHECK(steel.material.density == 7800.0);
  CHECK_FALSE(glass.rig.fill_mass.has_value());
  CHECK(dem::get_target(glass, "fill") == 900.0);
  CHECK(glass.material.diameter == Approx(0.9e-3));
  CHECK(glass.contact.restitution == 0.9);
  CHECK(steel.contact.restitution == dem::Contact{}.restitution);
  CHECK(steel.contact.wall_friction.value() == 0.2);
  CHECK(steel.contact.cap == dem::FrictionCap::thornton);
  CHECK(steel.contact.tension == dem::DashpotTension::clamped);
  CHECK(steel.contact.wall_attraction == dem::WallAttraction::derjaguin);
  CHECK(steel.contact.minimum_separation == Approx(1e-9));
  CHECK(steel.run.settle == Approx(0.05));
  CHECK(steel.run.standard_error == 0.05);
}

TEST_CASE("a mistyped key, a wrong unit and a value out of range of the DEM's sections are all named at once") {
  const TemporaryFolder folder;
  const data::StudyFile file = study(
      folder,
      "[rig]\nkind = \"slice\"\n[contact]\nfrikction = 0.3\nfriction = -1\nhamaker = \"3 mm\"\n[run]\nskin = 0\n");
  dem::read_case(file, "");
  try {
    file.finish();
    FAIL("nothing was said");
  } catch (const data::InputError& error) {
    const std::string said = error.what();
    CHECK(error.status == data::ExitStatus::bad_study);
    CHECK_THAT(said, Catch::Contains("frikction") && Catch::Contains("contact.friction") &&
                         Catch::Contains("hamaker") && Catch::Contains("skin"));
  }
}

TEST_CASE("a run file gives back the run, and its checkpoint goes on with the same bits") {
  const TemporaryFolder folder;
  dem::Case c;
  c.rig.fill = 200.0;
  c.material.diameter = 1.6e-3;
  c.rig.trough_radius = 8e-3;  // a gap that they pass through
  c.contact.stiffness = 400.0;
  c.run.settle = 0.02;
  c.run.start_up = 0.01;
  c.run.shortest = 0.01;
  c.run.longest = 0.03;
  const dem::RunResult whole = dem::run(c, 9);
  std::stop_source stop;
  dem::RunOptions options;
  options.stop = stop.get_token();
  options.checkpoint_interval = 0.0;
  int calls = 0;
  options.checkpoint = [&](const dem::Checkpoint&) {
    if (++calls == 4) stop.request_stop();
  };
  const dem::RunResult part = dem::run(c, 9, options);
  REQUIRE(part.status == dem::RunStatus::interrupted);
  const std::string path = folder.path("run.h5");
  dem::write_run(path, c, part);
  const dem::SavedRun saved = dem::read_run(path);
  CHECK(saved.settings == dem::settings_text(c));
  CHECK(saved.result.seed == 9);
  CHECK(saved.result.status == dem::RunStatus::interrupted);
  CHECK(saved.result.series.torque == part.series.torque);
  dem::RunOptions resume;
  resume.resume = &saved.result.checkpoint;
  const dem::RunResult resumed = dem::run(c, 9, resume);
  CHECK(resumed.series.torque == whole.series.torque);
  CHECK(resumed.series.time == whole.series.time);
  CHECK(resumed.summary.mean[0].mean == whole.summary.mean[0].mean);
}

TEST_CASE("a run file that is cut short, or is something else, is refused by name") {
  const TemporaryFolder folder;
  const std::string path = folder.path("run.h5");
  std::ofstream(path) << "not HDF5";
  try {
    dem::read_run(path);
    FAIL("it was read");
  } catch (const data::InputError& error) {
    CHECK(error.status == data::ExitStatus::bad_data);
    CHECK_THAT(std::string(error.what()), Catch::Contains("run.h5"));
  }
  CHECK_THROWS_AS(dem::read_run(folder.path("none.h5")), data::InputError);
}
