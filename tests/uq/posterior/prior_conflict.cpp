// Prior and data that contradict each other. A reading y of a, with an error of sd t and a prior N(m, s) of a, comes
// from N(m, sqrt(s^2 + t^2)), so that z = (y - m) / sqrt(s^2 + t^2), whatever the posterior is worked out by.
#include "uq/posterior/prior_conflict.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "data/random.hpp"
#include "tests/uq/closed_form.hpp"

namespace {

using namespace closed_form;

uq::CaseModel one_reading(const data::Prior& prior, double error = 0.1, double reading = 5.0) {
  return make_case(
      {{"a", 0.0, 10.0, prior}}, [](const Eigen::VectorXd& p, double) { return p[0]; },
      Eigen::VectorXd::Constant(1, 0.5), Eigen::VectorXd::Constant(1, reading), Eigen::VectorXd::Constant(1, error));
}

/// Draws of a posterior that is normal in `score`, with a its value there.
template <class Value>
Eigen::MatrixXd draws_of(double mean, double sd, const Value& value) {
  data::RandomStream random(1, data::Purpose::posterior_predictive);
  Eigen::MatrixXd draws(20000, 1);
  for (double& u : draws.reshaped()) u = value(mean + sd * random.normal()) / 10.0;
  return draws;
}

double z_of(const data::Prior& prior, const Eigen::MatrixXd& draws, double error = 0.1, double reading = 5.0) {
  const auto found = uq::prior_conflicts(one_reading(prior, error, reading), draws, 0.0);
  REQUIRE(found.size() == 1);
  return found[0].z;
}

}  // namespace

TEST_CASE("prior and data differ by as many standard deviations as the reading lies off the prior predictive", "[uq]") {
  // Prior 5 +- 0.5, reading y +- t: posterior variance v = 1 / (4 + 1 / t^2), mean 5 + (y - 5) v / t^2.
  const data::Prior prior{.kind = data::PriorKind::normal, .low = 0.0, .high = 10.0, .mean = 5.0, .sd = 0.5};
  for (const double t : {0.1, 0.5, 1.0})
    for (const double y : {5.0, 6.0, 3.5}) {
      const double variance = 1.0 / (4.0 + 1.0 / (t * t)), mean = 5.0 + (y - 5.0) * variance / (t * t);
      const Eigen::MatrixXd draws = draws_of(mean, std::sqrt(variance), [](double a) { return a; });
      CHECK(z_of(prior, draws) == Approx((y - 5.0) / std::hypot(0.5, t)).margin(0.1));
    }
}

TEST_CASE("a prior that is far narrower than the data's error is judged as any other", "[uq]") {
  // The data move the posterior by a few of its errors only: 1.3 of the prior's sd where the two differ by nine.
  for (const double sd : {0.2, 0.1, 0.05, 0.03}) {
    const data::Prior prior{.kind = data::PriorKind::normal, .low = 0.0, .high = 10.0, .mean = 7.0, .sd = sd};
    const double t = 0.37, y = 3.6, told = sd * sd / (sd * sd + t * t);
    const Eigen::MatrixXd draws =
        draws_of(7.0 + (y - 7.0) * told, sd * std::sqrt(1.0 - told), [](double a) { return a; });
    CAPTURE(sd, told);
    CHECK(z_of(prior, draws, t, y) == Approx((y - 7.0) / std::hypot(sd, t)).epsilon(0.05));
  }
}

TEST_CASE("on a thin curved ridge, beside which the posterior's mean lies, nothing contradicts a prior that agrees",
          "[uq]") {
  // b = a^2 to 0.001 and no more is known: a keeps its prior.
  const data::Prior prior{.kind = data::PriorKind::normal, .low = -4.0, .high = 4.0, .mean = 0.0, .sd = 1.0};
  const uq::CaseModel model = make_case(
      {{"a", -4.0, 4.0, prior}, {"b", -1.0, 16.0}}, [](const Eigen::VectorXd& p, double) { return p[1] - p[0] * p[0]; },
      Eigen::VectorXd::Constant(1, 0.5), Eigen::VectorXd::Constant(1, 0.0), Eigen::VectorXd::Constant(1, 0.001));
  data::RandomStream random(2, data::Purpose::posterior_predictive);
  Eigen::MatrixXd draws(4000, 2);
  for (Eigen::Index i = 0; i < draws.rows(); ++i) {
    const double a = std::clamp(random.normal(), -3.9, 3.9);
    draws.row(i) << (a + 4.0) / 8.0, (a * a + 1.0) / 17.0;
  }
  CHECK(uq::prior_conflicts(model, draws, 1.0).empty());
}

TEST_CASE("a skew prior is judged by its own tails", "[uq]") {
  // ln a ~ N(ln 2, 0.3), and ln a read as ln 4 +- 0.2.
  const data::Prior prior{.kind = data::PriorKind::log_normal, .low = 0.0, .high = 10.0, .mean = 2.0, .sd = 0.3};
  const double variance = 1.0 / (1.0 / 0.09 + 25.0), mean = std::log(2.0) + std::log(2.0) * variance * 25.0;
  const Eigen::MatrixXd draws = draws_of(mean, std::sqrt(variance), [](double ln_a) { return std::exp(ln_a); });
  CHECK(z_of(prior, draws) == Approx(std::log(2.0) / std::hypot(0.3, 0.2)).epsilon(0.03));
}

TEST_CASE("a range alone, and a posterior that is the prior, contradict nothing", "[uq]") {
  const data::Prior range{.kind = data::PriorKind::uniform, .low = 0.0, .high = 10.0};
  const Eigen::MatrixXd draws = draws_of(9.9, 0.01, [](double a) { return a; });
  CHECK(uq::prior_conflicts(one_reading(range), draws, 0.0).empty());
  const data::Prior prior{.kind = data::PriorKind::normal, .low = 0.0, .high = 10.0, .mean = 5.0, .sd = 0.5};
  CHECK(uq::prior_conflicts(one_reading(prior), draws_of(5.0, 0.5, [](double a) { return a; }), 0.1).empty());
}
