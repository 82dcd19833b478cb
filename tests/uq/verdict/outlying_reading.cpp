// One reading far from all others under errors of unknown size: against the externally studentised residual of a
// straight line, which is had without the program, and by how often clean data raise an alarm.
#include "uq/verdict/outlying_reading.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/uq/closed_form.hpp"
#include "tests/uq/unknown_errors.hpp"
#include "uq/posterior/posterior.hpp"
#include "uq/verdict/profile.hpp"

using namespace closed_form;

namespace {

/// A straight line with an unknown sd of its readings.
uq::CaseModel line(const Eigen::VectorXd& x, const Eigen::VectorXd& y) {
  const Formula formula = [](const Eigen::VectorXd& p, double at) { return p[0] + p[1] * at; };
  uq::CaseModel model =
      make_case({{"level", -50.0, 60.0}, {"slope", -60.0, 60.0}}, formula, x, y, Eigen::VectorXd::Ones(x.size()));
  unknown_errors::free_noise(model);
  return model;
}

std::optional<uq::OutlyingReading> found(const uq::CaseModel& model, double chance) {
  const Eigen::MatrixXd starts = Eigen::MatrixXd::Constant(1, model.dimension(), 0.5);
  uq::VerdictThresholds thresholds;
  thresholds.outlying_chance = chance;
  return uq::outlying_reading(model, uq::maximum_likelihood(model, starts).x, thresholds);
}

/// Of reading i: its residual from the line through the others over what that should scatter by.
double studentised(const Eigen::VectorXd& x, const Eigen::VectorXd& y, Eigen::Index i) {
  const Eigen::Index n = x.size() - 1;
  Eigen::MatrixXd design(n, 2);
  Eigen::VectorXd rest(n);
  for (Eigen::Index j = 0, k = 0; j <= n; ++j)
    if (j != i) {
      design.row(k) << 1.0, x[j];
      rest[k++] = y[j];
    }
  const Eigen::Matrix2d normal = design.transpose() * design;
  const Eigen::Vector2d fit = normal.inverse() * (design.transpose() * rest), at(1.0, x[i]);
  const double variance = (rest - design * fit).squaredNorm() / static_cast<double>(n - 2);
  return (y[i] - at.dot(fit)) / std::sqrt(variance * (1.0 + at.dot(normal.inverse() * at)));
}

Eigen::VectorXd readings(const Eigen::VectorXd& x, std::uint32_t index) {
  data::RandomStream random(23, data::Purpose::test, index);
  Eigen::VectorXd y(x.size());
  for (Eigen::Index i = 0; i < x.size(); ++i) y[i] = 5.0 + 2.0 * x[i] + 0.1 * random.normal();
  return y;
}

}  // namespace

TEST_CASE("a wrong reading among readings of unknown error is named, at its studentised distance", "[uq]") {
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(12, 0.0, 1.0);
  Eigen::VectorXd y = readings(x, 1);
  y[7] += 2.0;
  const auto one = found(line(x, y), 0.01);
  REQUIRE(one);
  CHECK(one->origin.point == 7);
  CHECK(one->errors == Approx(std::abs(studentised(x, y, 7))).epsilon(0.02));
  CHECK(one->widening > 3.0);
}

TEST_CASE("clean readings of unknown error raise the alarm as seldom as it says", "[uq]") {
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(8, 0.0, 1.0);
  int alarms = 0;
  for (std::uint32_t set = 0; set < 200; ++set) alarms += found(line(x, readings(x, 100 + set)), 0.1) ? 1 : 0;
  CHECK(alarms >= 8);  // 20 +- 4.2
  CHECK(alarms <= 33);
}

TEST_CASE("with errors of known size, or too few readings, nothing is said", "[uq]") {
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(4, 0.0, 1.0);
  Eigen::VectorXd y = readings(x, 2);
  y[2] += 3.0;
  CHECK_FALSE(found(line(x, y), 0.01));
  const Formula mean = [](const Eigen::VectorXd& p, double) { return p[0]; };
  CHECK_FALSE(found(make_case({{"level", 0.0, 9.0}}, mean, x, y, Eigen::VectorXd::Ones(4)), 0.01));
}
