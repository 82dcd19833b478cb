// Whether the runs speak where a posterior lies. The posterior is made by hand, the runs lie where the test says.
#include "uq/posterior/support.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <map>
#include <set>

#include "data/random.hpp"
#include "surrogate/design.hpp"

using namespace uq;
using Catch::Contains;

namespace {

/// Two parameters of [0, 1] and a speed; the case measures at six speeds.
struct Scene {
  data::Study study;
  CaseModel model;
};

Scene scene_of(const Eigen::MatrixXd& runs, double variance = 1e-4) {
  Scene scene;
  for (const char* name : {"a", "b"}) {
    data::Parameter parameter{.name = name, .target = name, .low = 0.0, .high = 1.0};
    scene.study.parameters.push_back(parameter);
  }
  scene.study.controls.push_back({.name = "speed", .target = "speed", .low = 0.0, .high = 1.0});
  scene.study.outputs.push_back({.name = "torque"});
  data::ObservationSet set;
  set.outputs = {0};
  for (int i = 0; i < 6; ++i) set.points.push_back({{0.1 + 0.16 * i}, {1.0}, {0.1}, i + 2});
  scene.study.observations.push_back(set);

  Emulator emulator{.material = "",
                    .output = 0,
                    .inputs = {{InputKind::parameter, 0}, {InputKind::parameter, 1}, {InputKind::control, 0}},
                    .constants = {},
                    .control_range = {},
                    .predict = {}};
  emulator.predict = [variance](const Eigen::MatrixXd& points) -> surrogate::Prediction {
    return {Eigen::VectorXd::Ones(points.rows()), variance * Eigen::MatrixXd::Identity(points.rows(), points.rows())};
  };
  auto cloud = std::make_shared<RunCloud>();
  cloud->points = runs;
  cloud->length_scales = Eigen::Vector3d(0.5, 0.5, 2.0);
  cloud->prior_variance = 1.0;
  emulator.runs = cloud;
  RowGroup group{.emulator = emulator,
                 .base = Eigen::MatrixXd::Zero(6, 3),
                 .unknown = Eigen::MatrixXi::Constant(6, 3, -1),
                 .observed = Eigen::VectorXd::Ones(6),
                 .variance = Eigen::VectorXd::Constant(6, 0.01),
                 .origin = {},
                 .coordinate = {}};
  for (int i = 0; i < 6; ++i) {
    group.base(i, 2) = 0.1 + 0.16 * i;
    group.unknown(i, 0) = 0;
    group.unknown(i, 1) = 1;
    group.origin.push_back({.set = 0, .point = static_cast<std::size_t>(i), .output = 0});
  }
  scene.model.name = "case";
  for (const data::Parameter& parameter : scene.study.parameters)
    scene.model.unknowns.push_back({.label = parameter.name, .prior = ScaledPrior(parameter, {}), .cut = {}});
  scene.model.groups.push_back(group);
  return scene;
}

/// Draws about a centre, sd 0.02.
Eigen::MatrixXd draws_about(double a, double b) {
  data::RandomStream random(1, data::Purpose::measurement_noise, 2);
  Eigen::MatrixXd draws(400, 2);
  for (Eigen::Index i = 0; i < draws.rows(); ++i)
    draws.row(i) << a + 0.02 * random.normal(), b + 0.02 * random.normal();
  return draws;
}

SupportReport support_of(const Scene& scene, double a, double b) {
  return find_support(scene.study, scene.model, draws_about(a, b));
}

Eigen::MatrixXd kept(const Eigen::MatrixXd& runs, bool (*keep)(double a, double b)) {
  std::vector<Eigen::Index> rows;
  for (Eigen::Index i = 0; i < runs.rows(); ++i)
    if (keep(runs(i, 0), runs(i, 1))) rows.push_back(i);
  return runs(rows, Eigen::all);
}

}  // namespace

TEST_CASE("a posterior amid a space-filling design is supported, and so is one near its edges", "[uq]") {
  for (const int count : {30, 60, 120}) {
    const Scene scene = scene_of(surrogate::scrambled_sobol(count, 3, 5, 0));
    for (const auto& [a, b] : {std::pair{0.4, 0.5}, {0.9, 0.5}, {0.1, 0.8}, {0.5, 0.05}}) {
      const SupportReport found = support_of(scene, a, b);
      CAPTURE(count, a, b, found.unsupported, found.outside, found.gap, found.empty);
      CHECK(found.known);
      CHECK(found.supported);
      CHECK(found.sentence.empty());
      CHECK(unsupported_parameters(scene.model, found).empty());
      CHECK(found.next_runs.size() == 12);
      CHECK(found.next_runs[0].point.size() == 3);
    }
  }
}

TEST_CASE("the runs proposed of a case of several outputs are as many, and no two alike", "[uq]") {
  Scene scene = scene_of(surrogate::scrambled_sobol(30, 3, 5, 0));
  for (const char* name : {"flow", "angle"}) {
    scene.study.outputs.push_back({.name = name});
    scene.model.groups.push_back(scene.model.groups.front());
    scene.model.groups.back().emulator.output = scene.study.outputs.size() - 1;
  }
  const SupportReport found = support_of(scene, 0.4, 0.5);
  std::set<std::map<std::string, double>> distinct;
  for (const NextRun& run : found.next_runs) distinct.insert(run.point);
  CHECK(found.next_runs.size() == 12);
  CHECK(distinct.size() == 12);
}

TEST_CASE("a posterior beyond what the runs cover of an input is not, and the input and its end are named", "[uq]") {
  Eigen::MatrixXd runs = surrogate::scrambled_sobol(60, 3, 5, 0);
  runs.col(0) *= 0.5;
  const Scene scene = scene_of(runs);
  CHECK(support_of(scene, 0.3, 0.5).supported);
  const SupportReport beyond = support_of(scene, 0.6, 0.5);
  CHECK_FALSE(beyond.supported);
  CHECK(beyond.inputs[0].outside > 0.9);
  CHECK(beyond.inputs[1].outside == 0.0);
  CHECK_THAT(beyond.sentence, Contains("beyond the runs' a, 0.0"));
  // Another output of the same runs says it no second time.
  Scene twice = scene_of(runs);
  twice.study.outputs.push_back({.name = "angle"});
  twice.model.groups.push_back(twice.model.groups.front());
  twice.model.groups.back().emulator.output = 1;
  const std::string sentence = support_of(twice, 0.6, 0.5).sentence;
  CHECK(sentence.find("beyond the runs' a") == sentence.rfind("beyond the runs' a"));
  CHECK(unsupported_parameters(scene.model, beyond).size() == 2);
  // The points to run next lie where the posterior does.
  for (const NextRun& run : beyond.next_runs) CHECK(run.point.at("a") == Approx(0.6).margin(0.1));
}

TEST_CASE("runs reach the end of a range within a slack, or end short of it", "[uq]") {
  Eigen::MatrixXd runs = surrogate::scrambled_sobol(60, 3, 5, 0);
  runs.col(0) = 0.2 + 0.4 * runs.col(0).array();
  const Scene scene = scene_of(runs);
  const RunsReach short_of = runs_reach(scene.model, 0), whole = runs_reach(scene.model, 1);
  CHECK(short_of.low == Approx(0.2).margin(0.02));
  CHECK(short_of.high == Approx(0.6).margin(0.02));
  CHECK(whole.low == 0.0);
  CHECK(whole.high == 1.0);
}

TEST_CASE("a posterior in a hole of the runs is not supported, between the levels of a factorial design it is",
          "[uq]") {
  const Eigen::MatrixXd sobol = surrogate::scrambled_sobol(90, 3, 5, 0);
  const Scene hole = scene_of(kept(sobol, [](double a, double) { return a < 0.1 || a > 0.7; }));
  const SupportReport found = support_of(hole, 0.4, 0.5);
  CHECK_FALSE(found.supported);
  CHECK(found.inputs[0].gap > 0.9);
  CHECK(found.inputs[0].gap_low < 0.1);
  CHECK(found.inputs[0].gap_high > 0.7);
  CHECK(support_of(hole, 0.8, 0.5).supported);

  Eigen::MatrixXd levels(64, 3);
  for (int i = 0; i < 64; ++i) levels.row(i) << (i % 4) / 3.0, (i / 4 % 4) / 3.0, (i / 16) / 3.0;
  CHECK(support_of(scene_of(levels), 0.5, 0.5).supported);

  // Measured between three speeds that many runs had: no hole, though the next run is far in that plane.
  Eigen::MatrixXd speeds(90, 3);
  for (int i = 0; i < 90; ++i) speeds.row(i) << sobol(i / 3, 0), sobol(i / 3, 1), 0.2 + 0.3 * (i % 3);
  CHECK(support_of(scene_of(speeds), 0.5, 0.5).supported);
}

TEST_CASE("a posterior in a corner that the runs leave empty is not supported", "[uq]") {
  const Eigen::MatrixXd sobol = surrogate::scrambled_sobol(80, 3, 5, 0);
  const Scene scene = scene_of(kept(sobol, [](double a, double b) { return a < 0.5 || b < 0.5; }));
  CHECK_FALSE(support_of(scene, 0.85, 0.85).supported);
  CHECK(support_of(scene, 0.3, 0.3).supported);
  // Runs along a diagonal know nothing beside it.
  Eigen::MatrixXd line = sobol;
  line.col(1) = line.col(0);
  CHECK(support_of(scene_of(line), 0.5, 0.5).supported);
  CHECK_FALSE(support_of(scene_of(line), 0.3, 0.7).supported);
}

TEST_CASE("readings at pairs of controls that no run has are not supported, amid those of the runs they are", "[uq]") {
  // The second parameter becomes a control, the fill, which every run raises with its speed.
  Eigen::MatrixXd linked = surrogate::scrambled_sobol(80, 3, 5, 0);
  linked.col(1) = linked.col(2);
  const auto measured_at = [](const Eigen::MatrixXd& runs, const std::function<double(double)>& fill_at) {
    Scene scene = scene_of(runs);
    scene.study.controls.push_back({.name = "fill", .target = "fill", .low = 0.0, .high = 1.0});
    RowGroup& group = scene.model.groups[0];
    group.emulator.inputs[1] = {InputKind::control, 1};
    for (Eigen::Index row = 0; row < group.base.rows(); ++row) {
      group.unknown(row, 1) = -1;
      group.base(row, 1) = fill_at(group.base(row, 2));
    }
    return support_of(scene, 0.5, 0.5);
  };
  CHECK(measured_at(linked, [](double speed) { return speed; }).supported);
  const SupportReport beside = measured_at(linked, [](double speed) { return speed < 0.5 ? 0.9 : 0.1; });
  CHECK_FALSE(beside.supported);
  CHECK_THAT(beside.sentence, Contains("fill and speed"));
  // Three speeds at three fills, measured between them.
  Eigen::MatrixXd grid = surrogate::scrambled_sobol(90, 3, 5, 0);
  for (Eigen::Index i = 0; i < grid.rows(); ++i)
    grid.row(i).tail(2) << 0.1 + 0.4 * static_cast<double>(i % 3), 0.1 + 0.4 * static_cast<double>(i / 3 % 3);
  CHECK(measured_at(grid, [](double) { return 0.3; }).supported);
}

TEST_CASE("where readings lie beyond the runs for different reasons, each reason is named", "[uq]") {
  Eigen::MatrixXd runs = surrogate::scrambled_sobol(80, 3, 5, 0);
  runs.col(1) = 0.17 + 0.83 * runs.col(1).array();
  runs.col(2) *= 0.67;
  Scene scene = scene_of(runs);
  scene.study.controls.push_back({.name = "fill", .target = "fill", .low = 0.0, .high = 1.0});
  RowGroup& group = scene.model.groups[0];
  group.emulator.inputs[1] = {InputKind::control, 1};
  for (Eigen::Index row = 0; row < group.base.rows(); ++row) {
    group.unknown(row, 1) = -1;
    group.base(row, 1) = row < 2 ? 0.1 : 0.6;  // two of six below the runs' fill, others above their speed
  }
  const SupportReport found = support_of(scene, 0.5, 0.5);
  CHECK_FALSE(found.supported);
  CHECK_THAT(found.sentence, Contains("where no run speaks: 100 %"));
  CHECK(found.inputs[0].outside == 0.0);
  CHECK(found.inputs[1].outside == Approx(1.0));
  CHECK(found.inputs[2].outside == Approx(1.0));
}

TEST_CASE("each further reading is asked for its own runs", "[uq]") {
  Eigen::MatrixXd runs = surrogate::scrambled_sobol(80, 3, 5, 0);
  runs.col(2) *= 0.5;  // no run is faster
  const Scene scene = scene_of(runs);
  const Eigen::VectorXd found = unsupported_at(scene.model, {5, 0, 4, 2}, draws_about(0.5, 0.5));
  CHECK(found[0] == Approx(1.0));  // speeds of 0.9, 0.1, 0.74 and 0.42
  CHECK(found[1] == 0.0);
  CHECK(found[2] == Approx(1.0));
  CHECK(found[3] == 0.0);
}

TEST_CASE("a surrogate that knows no more than without runs supports nothing", "[uq]") {
  const Eigen::MatrixXd runs = surrogate::scrambled_sobol(60, 3, 5, 0);
  CHECK(support_of(scene_of(runs, 0.05), 0.5, 0.5).supported);
  const SupportReport found = support_of(scene_of(runs, 0.6), 0.5, 0.5);
  CHECK_FALSE(found.supported);
  CHECK(found.uncertain == Approx(1.0));
  CHECK(found.variance_ratio == Approx(0.6));
}

TEST_CASE("an emulator that no runs stand behind has no support to ask for, and one in doubt carries no verdict",
          "[uq]") {
  Scene scene = scene_of(surrogate::scrambled_sobol(60, 3, 5, 0));
  scene.model.groups[0].emulator.runs = nullptr;
  const SupportReport found = support_of(scene, 0.5, 0.5);
  CHECK_FALSE(found.known);
  CHECK(unsupported_parameters(scene.model, found).empty());
  scene.model.groups[0].emulator.doubt = "the surrogate of torque is unusable";
  const auto doubts = unsupported_parameters(scene.model, found);
  CHECK(doubts == std::vector<std::string>(2, "the surrogate of torque is unusable"));
}
