// Outputs read at one setting share its error. Torque a + 2 x and angle a + 3 x are linear in the setting x, so that
// readings at x known to +- e are normal: their covariance is that of their own errors and e^2 k k', k = 2 of a torque
// and 3 of an angle, over all readings where the error is one of all, and over those at each setting where it is not.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "surrogate/design.hpp"
#include "tests/uq/formula_study.hpp"
#include "uq/posterior/posterior.hpp"
#include "uq/posterior/predictive.hpp"

using namespace uq;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

constexpr double own = 0.02, error = 0.1;
const std::vector<double> speeds{0.1, 0.4, 0.1};  // the first twice
const formula::Pair lines{[](double a, double, double x) { return a + 2.0 * x; },
                          [](double a, double, double x) { return a + 3.0 * x; }};

/// Torque and angle of each speed, with the settings' errors that `shared` says.
data::Study study_with(bool shared) {
  data::Study study = formula::study({}, {}, own);
  data::ObservationSet& set = study.observations[0];
  set.outputs = {0, 1};
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    const double off = 0.05 * (1.0 + static_cast<double>(i));
    set.points.push_back({.controls = {speeds[i]},
                          .values = {0.5 + 2.0 * (speeds[i] + off), 0.5 + 3.0 * (speeds[i] + off)},
                          .standard_errors = {own, own}});
  }
  set.setting_errors = {{.control = 0,
                         .spread = {.absolute = error},
                         .as = shared ? data::SettingErrorAs::shared : data::SettingErrorAs::covariance}};
  return study;
}

/// Of all torques, then all angles.
MatrixXd covariance_by_hand(bool shared) {
  const VectorXd slope = (VectorXd(6) << 2.0, 2.0, 2.0, 3.0, 3.0, 3.0).finished();
  MatrixXd covariance = error * error * slope * slope.transpose();
  for (Eigen::Index i = 0; i < 6; ++i)
    for (Eigen::Index j = 0; j < 6; ++j)
      if (!shared && speeds[i % 3] != speeds[j % 3]) covariance(i, j) = 0.0;
  covariance.diagonal().array() += own * own;
  return covariance;
}

double density_by_hand(const data::Study& study, double a, bool shared) {
  VectorXd residual(6);
  for (Eigen::Index i = 0; i < 6; ++i) {
    const data::Observation& point = study.observations[0].points[i % 3];
    residual[i] = point.values[i / 3] - (a + (i < 3 ? 2.0 : 3.0) * point.controls[0]);
  }
  const MatrixXd covariance = covariance_by_hand(shared);
  return -0.5 * residual.dot(covariance.inverse() * residual) - 0.5 * std::log(covariance.determinant()) -
         3.0 * std::log(2.0 * std::numbers::pi);
}

}  // namespace

TEST_CASE("outputs read at settings of one error have the density of their joint normal law", "[uq]") {
  for (const bool shared : {true, false}) {
    const data::Study study = study_with(shared);
    const CaseModel model = build_case(study, formula::emulators(0.0, lines), 0);
    REQUIRE(model.linked_settings.size() == 1);
    const MatrixXd points = surrogate::scrambled_sobol(5, 2, 1);
    const VectorXd batch = log_likelihoods(model, points);
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      const double exact = density_by_hand(study, points(i, 0), shared);
      CHECK(log_likelihood(model, points.row(i).transpose()) == Approx(exact).epsilon(1e-9));
      CHECK(batch[i] == Approx(exact).epsilon(1e-9));
      const Evaluation slope = log_likelihood_gradient(model, points.row(i).transpose());
      const double step = 1e-4;
      const double difference =
          (density_by_hand(study, points(i, 0) + step, shared) - density_by_hand(study, points(i, 0) - step, shared)) /
          (2.0 * step);
      CHECK(slope.gradient[0] == Approx(difference).epsilon(1e-5).margin(1e-3));
    }
  }
}

TEST_CASE("an output that a row does not measure leaves the density of the readings that are there", "[uq]") {
  // The marginal of the joint normal law: rows and columns 1 (second torque) and 3 (first angle) struck out.
  const std::vector<Eigen::Index> there{0, 2, 4, 5};
  for (const bool shared : {true, false}) {
    const data::Study whole = study_with(shared);
    data::Study study = whole;
    std::vector<data::Observation>& points = study.observations[0].points;
    points[1].values[0] = points[1].standard_errors[0] = NAN;
    points[0].values[1] = points[0].standard_errors[1] = NAN;
    const CaseModel model = build_case(study, formula::emulators(0.0, lines), 0);
    REQUIRE(model.row_count() == 4);
    const MatrixXd covariance = covariance_by_hand(shared)(there, there);
    for (const double a : {0.2, 0.5, 0.8}) {
      VectorXd residual(6);
      for (Eigen::Index i = 0; i < 6; ++i) {
        const data::Observation& point = whole.observations[0].points[i % 3];
        residual[i] = point.values[i / 3] - (a + (i < 3 ? 2.0 : 3.0) * point.controls[0]);
      }
      const VectorXd left = residual(there);
      const double exact = -0.5 * left.dot(covariance.inverse() * left) - 0.5 * std::log(covariance.determinant()) -
                           2.0 * std::log(2.0 * std::numbers::pi);
      CHECK(log_likelihood(model, Eigen::Vector2d(a, 0.5)) == Approx(exact).epsilon(1e-9));
    }
  }
}

TEST_CASE("replicate data share the error of the setting that they are read at", "[uq]") {
  for (const bool shared : {true, false}) {
    const CaseModel model = build_case(study_with(shared), formula::emulators(0.0, lines), 0);
    MatrixXd made = replicates(model, Eigen::RowVector2d(0.5, 0.5).replicate(4000, 1), 1);
    made.rowwise() -= made.colwise().mean().eval();
    const MatrixXd covariance = made.transpose() * made / 4000.0, exact = covariance_by_hand(shared);
    for (Eigen::Index i = 0; i < 6; ++i)
      for (Eigen::Index j = 0; j < 6; ++j)
        CHECK(covariance(i, j) == Approx(exact(i, j)).margin(0.07 * std::sqrt(exact(i, i) * exact(j, j))));
  }
}

TEST_CASE("outputs of two files were not read at the same settings", "[uq]") {
  data::Study study = study_with(true);
  data::ObservationSet angles = study.observations[0];
  angles.name = "angles";
  angles.outputs = {1};
  study.observations[0].outputs = {0};
  for (std::size_t i = 0; i < speeds.size(); ++i) {
    angles.points[i].values = {angles.points[i].values[1]};
    angles.points[i].standard_errors = {own};
    study.observations[0].points[i].values.pop_back();
    study.observations[0].points[i].standard_errors.pop_back();
  }
  study.observations.push_back(angles);
  study.cases[0].observe = {"bench", "angles"};
  CHECK(build_case(study, formula::emulators(0.0, lines), 0).linked_settings.empty());
}

TEST_CASE("what a control's range cuts off of an unknown setting is known", "[uq]") {
  data::Study study = formula::study({1.0}, {3.0}, own);
  study.observations[0].setting_errors = {
      {.control = 0, .spread = {.absolute = error}, .as = data::SettingErrorAs::unknown}};
  for (const auto& [speed, kept] : {std::pair{0.5, 1.0}, {0.9, 0.8413447}, {1.0, 0.5}}) {
    study.observations[0].points[0].controls = {speed};
    const CaseModel model = build_case(study, formula::emulators(0.0, lines), 0);
    REQUIRE(model.unknowns.back().nuisance == data::NuisanceKind::setting);
    CHECK(model.unknowns.back().prior.kept_mass() == Approx(kept).epsilon(1e-6));
  }
}
