// The ends of profile intervals where the size of the errors is unknown: against Student's exact intervals, and by how
// often they hold a truth under a discrepancy that was drawn.
#include "uq/verdict/interval_drop.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <memory>

#include "tests/uq/closed_form.hpp"
#include "tests/uq/unknown_errors.hpp"
#include "uq/infer/mixture_sampler.hpp"
#include "uq/posterior/posterior.hpp"
#include "uq/verdict/profile.hpp"

using namespace closed_form;
using namespace unknown_errors;

namespace {

uq::Profiles profiles_of(const uq::CaseModel& model, std::uint64_t seed) {
  const uq::Target target = uq::posterior_target(std::make_shared<const uq::CaseModel>(model));
  const Eigen::MatrixXd draws = uq::sample_mixture(target, {.seed = seed}).pooled();
  return uq::profile_likelihood(model, {.draws = draws, .log_likelihood = uq::log_likelihoods(model, draws)});
}

}  // namespace

TEST_CASE("with an unknown sd of the readings the interval is Student's", "[uq]") {
  // Percentage points of Student's distribution, 97.5 %: NIST/SEMATECH e-Handbook of Statistical Methods, 1.3.6.7.2.
  const auto [count, student] = GENERATE(std::pair{4, 3.182}, std::pair{6, 2.571}, std::pair{21, 2.086});
  const Formula mean = [](const Eigen::VectorXd& p, double) { return p[0]; };
  Eigen::VectorXd y(count);
  data::RandomStream random(7, data::Purpose::test, static_cast<std::uint32_t>(count));
  for (double& value : y) value = 3.0 + 0.4 * random.normal();
  uq::CaseModel model = make_case({{"level", -17.0, 23.0}}, mean, Eigen::VectorXd::LinSpaced(count, 0.0, 1.0), y,
                                  Eigen::VectorXd::Ones(count));
  free_noise(model);
  const uq::Profiles found = profiles_of(model, 3);
  const double sd = std::sqrt((y.array() - y.mean()).square().sum() / (count - 1.0));
  const double half = student * sd / std::sqrt(static_cast<double>(count));
  const uq::Profile& profile = found.profiles.at(0);
  REQUIRE(profile.closed());
  CHECK(model.unknowns[0].value(*profile.low) == Approx(y.mean() - half).margin(0.05 * half));
  CHECK(model.unknowns[0].value(*profile.high) == Approx(y.mean() + half).margin(0.05 * half));
}

TEST_CASE("with known errors the deviance at an interval's ends is chi-squared's", "[uq]") {
  const Formula mean = [](const Eigen::VectorXd& p, double) { return p[0]; };
  const uq::CaseModel model = make_case({{"level", 0.0, 5.0}}, mean, Eigen::Vector3d(0.0, 0.5, 1.0),
                                        Eigen::Vector3d(2.0, 2.1, 1.9), Eigen::Vector3d::Constant(0.1));
  const Eigen::MatrixXd draws = Eigen::MatrixXd::Constant(10, 1, 0.4);
  CHECK(uq::interval_drops(model, Eigen::VectorXd::Constant(1, 0.4), draws, 3.84)[0] == 3.84);
}

TEST_CASE("95 % profile intervals hold 95 % of truths where a discrepancy's sd and length are unknown", "[uq][slow]") {
  // A line through readings of 1 %, bent by a smooth process whose size and length are drawn from their priors.
  constexpr int sets = 200, rows = 8;
  const Formula line = [](const Eigen::VectorXd& p, double x) { return p[0] + p[1] * (x - 0.5); };
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(rows, 0.0, 1.0);
  const std::vector<FreeParameter> unknowns = {{"level", -20.0, 30.0}, {"slope", -60.0, 60.0}};
  const Eigen::Vector2d truth(5.0, 2.0);
  int held = 0, held_of_known_errors = 0;
  for (std::uint32_t set = 0; set < sets; ++set) {
    data::RandomStream random(11, data::Purpose::test, set);
    Eigen::VectorXd y(rows);
    for (Eigen::Index i = 0; i < rows; ++i) y[i] = line(truth, x[i]);
    const double magnitude = std::sqrt(y.squaredNorm() / rows);
    uq::CaseModel model = make_case(unknowns, line, x, y, Eigen::VectorXd::Constant(rows, 0.01 * magnitude));
    free_discrepancy(model, magnitude);
    const double sd = model.unknowns[2].value(model.unknowns[2].prior.draw(random));
    const double length = model.unknowns[3].value(model.unknowns[3].prior.draw(random));
    const Eigen::MatrixXd bent = std::pow(sd * magnitude, 2) * uq::discrepancy_correlation(x, x, length) +
                                 std::pow(0.01 * magnitude, 2) * Eigen::MatrixXd::Identity(rows, rows);
    Eigen::VectorXd z(rows);
    for (double& value : z) value = random.normal();
    model.groups[0].observed = y + bent.llt().matrixL() * z;
    const uq::Profile profile = profiles_of(model, set).profiles.at(1);
    const double u = model.unknowns[1].prior.parameter().axis().to_unit(truth[1]);
    if ((!profile.low || *profile.low <= u) && (!profile.high || u <= *profile.high)) ++held;
    const auto above = std::upper_bound(profile.u.begin(), profile.u.end(), u) - profile.u.begin();
    const double share = (u - profile.u[above - 1]) / (profile.u[above] - profile.u[above - 1]);
    const double there = profile.deviance[above - 1] + share * (profile.deviance[above] - profile.deviance[above - 1]);
    if (there <= uq::deviance_95) ++held_of_known_errors;
  }
  INFO(held << " of " << sets << " hold the truth; " << held_of_known_errors
            << " where the errors' size counts as known");
  // 95 % of 200 within 2.5 binomial sds.
  CHECK(held >= 182);
  CHECK(held <= 198);
}
