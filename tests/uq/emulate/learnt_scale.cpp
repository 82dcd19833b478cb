// Emulators whose runs are learnt on stretched scales are functions of the study's unit cube.
#include <catch2/catch.hpp>
#include <cmath>

#include "data/random.hpp"
#include "surrogate/design.hpp"
#include "tests/temporary.hpp"
#include "tests/uq/formula_study.hpp"
#include "uq/emulate/surrogate_file.hpp"
#include "uq/emulate/surrogates.hpp"

using Eigen::MatrixXd;
using Eigen::VectorXd;
using namespace uq;

namespace {

const data::Study study = formula::study({0.5}, {1.0}, 0.1);

/// Runs of a torque that bends at low a, in the study's own units.
data::RunTable runs(int count) {
  data::RunTable table = data::empty_table(study);
  data::RandomStream random(3, data::Purpose::test, 4);
  const MatrixXd design = surrogate::scrambled_sobol(count, 3, 1, 0);
  for (Eigen::Index i = 0; i < design.rows(); ++i) {
    const double a = design(i, 0), b = design(i, 1), x = design(i, 2);
    const double y = (1.0 + b + x) / (0.05 + a);
    table.rows.push_back({.inputs = {a, b, x},
                          .outputs = {y * (1.0 + 0.01 * random.normal()), std::nan("")},
                          .standard_errors = {0.01 * y, std::nan("")}});
  }
  return table;
}

FittedSurrogate fitted_to(const data::RunTable& table) {
  return fit_surrogates(study, table, {.fit = {.starts = 2}, .observed_only = true}).front();
}

}  // namespace

TEST_CASE("a surrogate of a torque that bends at one end stretches that input, and says so", "[uq]") {
  const FittedSurrogate fitted = fitted_to(runs(40));
  REQUIRE(fitted.report.stretches.size() == 3);
  CHECK(fitted.report.stretches[0] > 1.0);
  CHECK(fitted.report.stretches[1] == 1.0);
  CHECK(fitted.report.stretches[2] == 1.0);
  bool said = false;
  for (const std::string& note : fitted.report.notes)
    said = said || note.find("is learnt as log(") != std::string::npos;
  CHECK(said);
}

TEST_CASE("predictions and gradients of a stretched emulator are those of the unit cube", "[uq]") {
  const FittedSurrogate fitted = fitted_to(runs(40));
  const Emulator emulator = emulator_of(fitted);
  const MatrixXd points = (MatrixXd(3, 3) << 0.1, 0.2, 0.3, 0.1, 0.2, 0.6, 0.1, 0.2, 0.9).finished();
  const surrogate::Prediction found = emulator.predict(points);
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double truth = (1.0 + points(i, 1) + points(i, 2)) / (0.05 + points(i, 0));
    CHECK(std::abs(found.mean[i] - truth) < 4.0 * std::sqrt(found.covariance(i, i)) + 1e-3 * truth);
  }
  CHECK((emulator.predict_mean(points) - found.mean).cwiseAbs().maxCoeff() < 1e-9);
  CHECK((emulator.predict_batch(points, 3).front().mean - found.mean).cwiseAbs().maxCoeff() < 1e-9);
  const std::vector<int> all{0, 1, 2};
  // Column 0 is the same in all rows, as an unknown is; then it differs from row to row.
  for (const bool same : {true, false}) {
    MatrixXd at = points;
    if (!same) at.col(0) << 0.05, 0.3, 0.8;
    const surrogate::PredictionGradient gradient = emulator.predict_with_gradient(at, all);
    for (const int k : all) {
      MatrixXd before = at, after = at;
      const double h = 1e-5;
      before.col(k).array() -= h;
      after.col(k).array() += h;
      const surrogate::Prediction low = emulator.predict(before), high = emulator.predict(after);
      const VectorXd slope = (high.mean - low.mean) / (2.0 * h);
      const MatrixXd covariance_slope = (high.covariance - low.covariance) / (2.0 * h);
      CAPTURE(same, k);
      CHECK((gradient.mean_gradient[k] - slope).norm() < 1e-3 * slope.norm());
      CHECK((gradient.covariance_gradient[k] - covariance_slope).norm() <
            1e-2 * covariance_slope.norm() + 1e-8 * found.covariance.norm());
    }
  }
}

TEST_CASE("the runs behind a stretched emulator stand at their places of the study's unit cube", "[uq]") {
  const data::RunTable table = runs(40);
  const FittedSurrogate fitted = fitted_to(table);
  const Emulator emulator = emulator_of(fitted);
  REQUIRE(emulator.runs->points.rows() == 40);
  for (Eigen::Index i = 0; i < 40; ++i)
    for (Eigen::Index k = 0; k < 3; ++k)
      CHECK(emulator.runs->points(i, k) == Approx(table.rows[i].inputs[k]).margin(1e-12));
  CHECK(learnt_points(emulator.inputs, emulator.runs->points).isApprox(fitted.rows.set.x, 1e-12));
}

TEST_CASE("a stretched surrogate that is read from its file predicts the same to the bit", "[uq]") {
  const TemporaryFolder folder;
  const std::string path = folder.path("surrogate.h5");
  const data::RunTable table = runs(40);
  const SurrogateOptions options{.fit = {.starts = 2}, .observed_only = true};
  const std::vector<FittedSurrogate> fitted = fit_surrogates(study, table, options);
  save_surrogates(path, study, table, options, fitted);
  const std::vector<FittedSurrogate> read = load_surrogates(path, study, table, options).fitted;
  REQUIRE(read.size() == 1);
  const MatrixXd points = surrogate::scrambled_sobol(20, 3, 5, 0);
  CHECK(emulator_of(read.front()).predict(points).mean == emulator_of(fitted.front()).predict(points).mean);
}

TEST_CASE("one wrong run is no bend", "[uq]") {
  data::RunTable table = data::empty_table(study);
  const MatrixXd design = surrogate::scrambled_sobol(40, 3, 1, 0);
  for (Eigen::Index i = 0; i < design.rows(); ++i) {
    const double y = 5.0 + design(i, 0) + 2.0 * design(i, 1) + design(i, 2);
    table.rows.push_back({.inputs = {design(i, 0), design(i, 1), design(i, 2)},
                          .outputs = {y * (i == 7 ? 10.0 : 1.0), std::nan("")},
                          .standard_errors = {0.01 * y, std::nan("")}});
  }
  const FittedSurrogate fitted = fitted_to(table);
  CHECK(fitted.report.stretches == std::vector<double>{1.0, 1.0, 1.0});
  CHECK(fitted.report.outlying.size() == 1);
}
