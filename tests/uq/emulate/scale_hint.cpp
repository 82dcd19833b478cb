// Scales on which a surrogate learns better, of runs whose law is known.
#include "uq/emulate/scale_hint.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "data/random.hpp"
#include "surrogate/design.hpp"
#include "uq/emulate/outlying_runs.hpp"

using namespace uq;

namespace {

data::Study two_inputs() {
  data::Study study;
  for (const auto& [name, low, high] : {std::tuple{"a", 0.1, 0.8}, {"b", 0.5, 10.0}}) {
    data::Parameter parameter;
    parameter.name = name;
    parameter.low = low;
    parameter.high = high;
    study.parameters.push_back(parameter);
  }
  data::Output torque;
  torque.name = "torque";
  study.outputs.push_back(torque);
  return study;
}

/// 60 runs of f(a, b) with half a per cent of scatter.
TrainingRows runs_of(const data::Study& study, double (*f)(double a, double b), std::uint64_t seed) {
  TrainingRows rows{.material = "",
                    .output = 0,
                    .set = {surrogate::scrambled_sobol(60, 2, seed, 0), Eigen::VectorXd(60), Eigen::VectorXd(60)},
                    .low = std::nullopt,
                    .places = {},
                    .inputs = {{InputKind::parameter, 0}, {InputKind::parameter, 1}},
                    .constants = {},
                    .control_range = {}};
  data::RandomStream random(seed, data::Purpose::measurement_noise, 1);
  for (Eigen::Index i = 0; i < 60; ++i) {
    const double y = f(study.parameters[0].axis().from_unit(rows.set.x(i, 0)),
                       study.parameters[1].axis().from_unit(rows.set.x(i, 1)));
    rows.set.y[i] = y * (1.0 + 0.005 * random.normal());
    rows.set.noise_variance[i] = std::pow(0.005 * y, 2);
  }
  return rows;
}

const surrogate::FitOptions fit{.starts = 4, .seed = 1};

}  // namespace

TEST_CASE("of a quotient the divisor's logarithm is named, and good runs agree there", "[uq]") {
  const data::Study study = two_inputs();
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    const TrainingRows rows = runs_of(
        study, [](double a, double b) { return 20.0 * a / b + 2.0; }, seed);
    const surrogate::GaussianProcess process = surrogate::fit(rows.set, fit);
    const std::vector<int> accused = find_outlying(rows.set, process, fit).runs;
    const auto scale = best_log_scale(study, rows, accused, fit);
    REQUIRE(scale);
    CHECK((scale->key == "[parameters.b] scale = \"log\"" || scale->key == "[surrogate] log_outputs = [\"torque\"]"));
    CHECK(scale->error < left_out_error(process, rows.set));
  }
}

TEST_CASE("a run that is wrong on every scale is cleared by none", "[uq]") {
  const data::Study study = two_inputs();
  TrainingRows rows = runs_of(
      study, [](double a, double b) { return 5.0 + 4.0 * a + 0.3 * b; }, 5);
  rows.set.y[17] *= 3.0;
  const std::vector<int> accused = find_outlying(rows.set, surrogate::fit(rows.set, fit), fit).runs;
  REQUIRE(accused == std::vector<int>{17});
  CHECK_FALSE(best_log_scale(study, rows, accused, fit));
}
