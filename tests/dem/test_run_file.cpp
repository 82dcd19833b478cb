// run.h5 and the study's DEM sections.
#include <catch2/catch.hpp>
#include <cmath>

#include "data/error.hpp"
#include "dem/reading/prepare.hpp"
#include "dem/reading/read_case.hpp"
#include "dem/reading/target.hpp"
#include "dem/run/run_file.hpp"
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
  c.run.start_up_turns = 0.25;
  c.run.shortest = 0.01;
  c.run.longest = 0.03;
  c.run.window = 2e-3;
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
  CHECK(resumed.series.axial_flow == whole.series.axial_flow);
  CHECK(resumed.series.kinetic_energy == whole.series.kinetic_energy);
  REQUIRE(whole.series.window_time.size() > 5);
  CHECK(resumed.series.window_time == whole.series.window_time);
  CHECK(resumed.series.silhouette_x == whole.series.silhouette_x);  // a window was under way when it stopped
  CHECK(resumed.series.silhouette_z == whole.series.silhouette_z);
}

TEST_CASE("a finished run goes on to more turns, or is cut to fewer, with the bits of a run of that length") {
  const TemporaryFolder folder;
  dem::Case longer;
  longer.rig.fill = 200.0;
  longer.material.diameter = 1.6e-3;
  longer.rig.trough_radius = 8e-3;
  longer.contact.stiffness = 400.0;
  longer.run.settle = 0.02;
  longer.run.start_up = 0.01;
  longer.run.start_up_turns = 0.25;
  longer.run.longest = 0.12;
  longer.run.window = 2e-3;
  dem::Case brief = longer;
  brief.run.longest = 0.04;
  const dem::RunResult whole = dem::run(longer, 4), part = dem::run(brief, 4);
  const std::string path = folder.path("run.h5");
  dem::write_run(path, longer, whole);
  dem::write_run(folder.path("brief.h5"), brief, part);
  const auto continued = [](const dem::Case& c, const std::string& from) {
    const dem::SavedRun saved = dem::read_run(from);
    dem::RunOptions resume;
    resume.resume = &saved.result.checkpoint;
    return dem::run(c, 4, resume);
  };
  const dem::RunResult grown = continued(longer, folder.path("brief.h5")), cut = continued(brief, path);
  CHECK(grown.series.torque == whole.series.torque);
  CHECK(grown.series.bond_order == whole.series.bond_order);
  CHECK(cut.series.torque == part.series.torque);
  CHECK(cut.series.look_time == part.series.look_time);
  for (std::size_t k = 0; k < dem::outputs().size(); ++k) {
    INFO(dem::outputs()[k].name);
    const auto same = [](double a, double b) { return a == b || (std::isnan(a) && std::isnan(b)); };
    CHECK(same(grown.summary.mean[k].mean, whole.summary.mean[k].mean));
    CHECK(same(grown.summary.mean[k].standard_error, whole.summary.mean[k].standard_error));
    CHECK(same(cut.summary.mean[k].mean, part.summary.mean[k].mean));
    CHECK(same(cut.summary.mean[k].standard_error, part.summary.mean[k].standard_error));
  }
  CHECK(cut.checkpoint.state.position.empty());  // what is left of it is no state of that time
}

TEST_CASE("every output's sample is the mean over its interval: ten short ones make a long one") {
  dem::Case fine;
  fine.rig.fill = 200.0;
  fine.material.diameter = 1.6e-3;
  fine.rig.trough_radius = 8e-3;
  fine.contact.stiffness = 400.0;
  fine.run.settle = 0.02;
  fine.run.start_up = 0.01;
  fine.run.start_up_turns = 0.25;
  fine.run.longest = 0.05;
  fine.run.window = 4e-3;
  fine.run.time_step = 1e-5;
  fine.run.sample_interval = 2e-4;
  dem::Case coarse = fine;
  coarse.run.sample_interval = 2e-3;
  const dem::Series a = dem::run(fine, 5).series, b = dem::run(coarse, 5).series;
  REQUIRE(b.time.size() >= 20);
  REQUIRE(a.time.size() >= 200);
  for (const auto values : {&dem::Series::torque, &dem::Series::axial_flow, &dem::Series::coordination,
                            &dem::Series::kinetic_energy, &dem::Series::normal_stress}) {
    for (std::size_t k = 0; k < a.time.size() / 10; ++k) {
      double mean = 0.0;
      for (std::size_t j = 0; j < 10; ++j) mean += 0.1 * (a.*values)[10 * k + j];
      CHECK((b.*values)[k] == Approx(mean).epsilon(1e-9).margin(1e-18));
    }
  }
}

TEST_CASE("a run too short to be steady, or to know its error, says so in its result, its warnings and its file") {
  const TemporaryFolder folder;
  dem::Case c;
  c.rig.fill = 200.0;
  c.material.diameter = 1.6e-3;
  c.rig.trough_radius = 8e-3;
  c.contact.stiffness = 400.0;
  c.run.settle = 0.02;
  c.run.start_up = 0.01;
  c.run.start_up_turns = 0.25;
  c.run.longest = 0.03;
  c.run.window = 2e-3;
  const dem::RunResult run = dem::run(c, 6);
  CHECK(run.status == dem::RunStatus::done);
  CHECK(run.summary.state == data::FlowState::too_short);
  REQUIRE(!run.warnings.empty());
  CHECK_THAT(run.warnings[0], Catch::Contains("fewer than run.shortest_turns") && Catch::Contains("run.longest"));
  const std::string path = folder.path("run.h5");
  dem::write_run(path, c, run);
  const dem::Summary back = dem::read_run(path).result.summary;
  CHECK(back.state == run.summary.state);
  CHECK(back.why == run.summary.why);
  CHECK(back.drift_p == run.summary.drift_p);
  CHECK(back.measured_from == run.summary.measured_from);
  CHECK(back.turns == run.summary.turns);
}

TEST_CASE("sample, window and length of a run that do not fit into each other are refused, each by name") {
  const auto said = [](double sample, double window, double longest) {
    dem::Case c;
    c.run.sample_interval = sample;
    c.run.window = window;
    c.run.longest = longest;
    std::string all;
    for (const data::Problem& p : dem::problems(c)) all += p.place + " " + p.what + "; ";
    return all;
  };
  CHECK_THAT(said(10.0, 0.02, 0.3), Catch::Contains("run.sample_interval is 10 s, longer than run.window"));
  CHECK_THAT(said(1e-3, 0.5, 1.0), Catch::Contains("run.window is 0.5 s, of which fewer than 8"));
  CHECK_THAT(said(1e-3, 0.02, 0.1), Catch::Contains("run.longest leaves nothing to measure"));
  CHECK_THAT(said(1e-3, 0.02, 1.0), !Catch::Contains("run.sample") && !Catch::Contains("run.window"));
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
