// run.h5: what it gives back, and what goes on from it.
#include <catch2/catch.hpp>
#include <cmath>

#include "data/error.hpp"
#include "dem/reading/target.hpp"
#include "dem/run/run_file.hpp"
#include "tests/temporary.hpp"

namespace {

/// A slice with a gap that its 200 large spheres pass through; it is measured after a quarter of a turn.
dem::Case small_slice() {
  dem::Case c;
  c.rig.fill = 200.0;
  c.material.diameter = 1.6e-3;
  c.rig.trough_radius = 8e-3;
  c.contact.stiffness = 400.0;
  c.run.settle = 0.02;
  c.run.start_up = 0.01;
  c.run.start_up_turns = 0.25;
  c.run.window = 2e-3;
  return c;
}

/// The run from the file's checkpoint on.
dem::RunResult gone_on(const dem::Case& c, std::uint64_t seed, const dem::SavedRun& saved) {
  dem::RunOptions resume;
  resume.resume = &saved.result.checkpoint;
  return dem::run(c, seed, resume);
}

}  // namespace

TEST_CASE("a run file gives back the run, and its checkpoint goes on with the same bits") {
  const TemporaryFolder folder;
  dem::Case c = small_slice();
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
  const dem::RunResult resumed = gone_on(c, 9, saved);
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
  dem::Case longer = small_slice();
  longer.run.longest = 0.12;
  dem::Case brief = longer;
  brief.run.longest = 0.04;
  const dem::RunResult whole = dem::run(longer, 4), part = dem::run(brief, 4);
  const std::string path = folder.path("run.h5");
  dem::write_run(path, longer, whole);
  dem::write_run(folder.path("brief.h5"), brief, part);
  const dem::RunResult grown = gone_on(longer, 4, dem::read_run(folder.path("brief.h5"))),
                       cut = gone_on(brief, 4, dem::read_run(path));
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
  dem::Case fine = small_slice();
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
  dem::Case c = small_slice();
  c.run.longest = 0.03;
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

TEST_CASE("a run file that is cut short, or is something else, is refused by name") {
  const TemporaryFolder folder;
  const std::string path = folder.path("run.h5");
  std::ofstream(path) << "not HDF5";
  CHECK_THAT(failure_of(folder, [&] { dem::read_run(path); }), Catch::StartsWith("65: ") && Catch::Contains("run.h5"));
  CHECK_THROWS_AS(dem::read_run(folder.path("none.h5")), data::InputError);
}
