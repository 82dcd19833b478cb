// The gradient-free sampler against quadrature and closed forms.
#include "uq/infer/mixture_sampler.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/uq/infer/adversaries.hpp"
#include "tests/uq/infer/densities.hpp"
#include "uq/infer/diagnostics.hpp"
#include "uq/infer/quadrature.hpp"

using namespace uq;

namespace {

/// Largest difference of mean and sd from quadrature, in sd, allowed at an effective sample size: four standard errors.
void agrees_with_quadrature(const Target& target, std::uint64_t seed) {
  const Draws draws = sample_mixture(target, {.seed = seed});
  INFO(draws.reason << " efficiency " << draws.proposal_efficiency << " draws " << draws.chains.front().x.rows());
  REQUIRE(draws.converged);
  const Quadrature exact = integrate(target, {.guides = draws.pooled().topRows(1000)});
  INFO(exact.evaluations << " evaluations of quadrature");
  CHECK(exact.resolved);
  const Eigen::MatrixXd all = draws.pooled();
  for (int k = 0; k < target.dimension; ++k) {
    const Eigen::MatrixXd values = draws.coordinate(k);
    const double mean = all.col(k).mean();
    CHECK(std::abs(mean - exact.mean[k]) < 4.0 * mean_mcse(values));
    const Eigen::MatrixXd squares = (values.array() - exact.mean[k]).square();
    CHECK(std::abs(squares.mean() - exact.sd[k] * exact.sd[k]) < 4.0 * mean_mcse(squares));
  }
  CHECK(std::abs(draws.log_evidence - exact.log_evidence) < 4.0 * draws.log_evidence_error + 1e-6);
  CHECK(draws.log_evidence_error < 0.05);
}

}  // namespace

TEST_CASE("draws on a banana have the mean, spread and evidence of quadrature", "[uq]") {
  for (const std::uint64_t seed : {1, 2, 3}) agrees_with_quadrature(densities::banana(), seed);
}

TEST_CASE("draws on a ridge that runs into a bound have the mean, spread and evidence of quadrature", "[uq]") {
  for (const double width : {0.05, 0.005, 0.0005}) agrees_with_quadrature(densities::ridge_at_bound(width), 4);
}

TEST_CASE("draws on a curved ridge x y = constant have the mean, spread and evidence of quadrature", "[uq]") {
  for (const std::uint64_t seed : {5, 6}) agrees_with_quadrature(densities::product_ridge(0.01), seed);
}

TEST_CASE("draws of two separate modes have the right share in each", "[uq]") {
  const Target target = densities::two_modes();
  const Draws draws = sample_mixture(target, {.seed = 7});
  REQUIRE(draws.converged);
  const Eigen::MatrixXd second = (draws.coordinate(0).array() > 0.5).cast<double>();
  CHECK(std::abs(second.mean() - densities::second_mode_share) < 4.0 * mean_mcse(second));
  agrees_with_quadrature(target, 8);
}

TEST_CASE("the mass against a bound is that of a half normal", "[uq]") {
  const double sd = 0.02;
  const Target target = make_target(densities::Gaussian{Eigen::VectorXd::Zero(1), Eigen::VectorXd::Constant(1, sd)},
                                    Eigen::VectorXd::Zero(1), Eigen::VectorXd::Ones(1),
                                    uniform_reference(Eigen::VectorXd::Zero(1), Eigen::VectorXd::Ones(1)));
  const Draws draws = sample_mixture(target, {.seed = 9});
  REQUIRE(draws.converged);
  const Eigen::MatrixXd near_bound = (draws.coordinate(0).array() < 0.1 * sd).cast<double>();
  CHECK(std::abs(near_bound.mean() - std::erf(0.1 / std::numbers::sqrt2)) < 4.0 * mean_mcse(near_bound));
  CHECK(draws.pooled().mean() == Approx(sd * std::sqrt(2.0 / std::numbers::pi)).epsilon(0.05));
}

TEST_CASE("draws are the same bits for any number of threads", "[uq]") {
  const Target target = densities::banana();
  const Draws one = sample_mixture(target, {.threads = 1, .seed = 11});
  const Draws three = sample_mixture(target, {.threads = 3, .seed = 11});
  CHECK(one.pooled() == three.pooled());
  CHECK(one.log_evidence == three.log_evidence);
  const Draws other = sample_mixture(target, {.threads = 3, .seed = 12});
  CHECK_FALSE(one.pooled().topRows(10) == other.pooled().topRows(10));
}

TEST_CASE("a sampler that runs out of draws says so and is not converged", "[uq]") {
  const Draws draws = sample_mixture(densities::banana(), {.draws = 50, .draws_max = 50, .seed = 1});
  CHECK_FALSE(draws.converged);
  CHECK(draws.reason.find("ESS") != std::string::npos);
}

TEST_CASE("a density that is zero wherever chains start is named, not sampled", "[uq]") {
  const Target target = make_target(densities::Nowhere{}, Eigen::VectorXd::Zero(1), Eigen::VectorXd::Ones(1),
                                    uniform_reference(Eigen::VectorXd::Zero(1), Eigen::VectorXd::Ones(1)));
  const Draws draws = sample_mixture(target);
  CHECK_FALSE(draws.converged);
  CHECK(draws.reason.find("zero at every start") != std::string::npos);
}

TEST_CASE("a correlated Gaussian in six dimensions has its covariance and evidence", "[uq]") {
  const Target target = densities::correlated(6, 0.99);
  const Draws draws = sample_mixture(target, {.seed = 13});
  INFO(draws.reason << " efficiency " << draws.proposal_efficiency);
  REQUIRE(draws.converged);
  for (int k = 0; k < 6; ++k) {
    const Eigen::MatrixXd squares = draws.coordinate(k).array().square();
    CHECK(std::abs(squares.mean() - 1.0) < 4.5 * mean_mcse(squares));
  }
  CHECK(std::abs(draws.log_evidence) < 4.0 * draws.log_evidence_error);
}

TEST_CASE("draws of eight parameters on a box, of which one sum is known, stay in it and are right", "[uq]") {
  const adversaries::Adversary known = adversaries::known_sum(8, 0.05);
  const Draws draws = sample_mixture(known.target, {.seed = 16});
  INFO(draws.reason << " efficiency " << draws.proposal_efficiency);
  REQUIRE(draws.converged);
  CHECK(draws.pooled().minCoeff() >= 0.0);
  CHECK(draws.pooled().maxCoeff() <= 1.0);
  CHECK(std::abs(draws.log_evidence - known.log_evidence) < 4.0 * draws.log_evidence_error);
  CHECK(draws.log_evidence_error < 0.05);
  for (int k = 0; k < 8; ++k) {
    const Eigen::MatrixXd squares = (draws.coordinate(k).array() - 0.5).square();
    CHECK(std::abs(draws.pooled().col(k).mean() - 0.5) < 4.0 * mean_mcse(draws.coordinate(k)));
    CHECK(std::abs(squares.mean() - known.sd[k] * known.sd[k]) < 4.0 * mean_mcse(squares));
  }
  const Eigen::MatrixXd sums = (draws.coordinate(0) + draws.coordinate(1)).array() - 1.0;
  CHECK(std::sqrt(sums.array().square().mean()) < 0.055);
}

namespace {

/// A thin ridge in the unit cube and, with 3 % of the mass, a wide background that rises and falls, as where a
/// surrogate knows little.
struct RidgeOnBackground {
  static constexpr double width = 0.02, background = 0.03;
  int dimension() const { return 4; }
  double log_density(const Eigen::VectorXd& x) const {
    const double away = (x[2] - 0.1 - 0.3 * x[0] * x[1]) / width;
    double waves = 1.0;
    for (const double one : x) waves *= 1.0 + 0.8 * std::cos(4.0 * std::numbers::pi * one);
    const double ridge = std::exp(-0.5 * away * away) / (width * std::sqrt(2.0 * std::numbers::pi));
    return std::log((1.0 - background) * ridge + background * waves);
  }
};

}  // namespace

TEST_CASE("of a thin ridge on a wide background draws have their share of the background", "[uq]") {
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(4), one = Eigen::VectorXd::Ones(4);
  const Target target = make_target(RidgeOnBackground{}, zero, one, uniform_reference(zero, one));
  int converged = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4}) {
    const Draws draws = sample_mixture(target, {.seed = seed});
    // Whole waves integrate to one, so the shares are as written; above 0.6 there is no ridge, and 0.4 of the waves but
    // for sin(4 pi 0.6) 0.8 / (4 pi).
    const double above = 0.4 - 0.8 * std::sin(2.4 * std::numbers::pi) / (4.0 * std::numbers::pi);
    const Eigen::MatrixXd third = draws.coordinate(2);
    const Eigen::MatrixXd high = (third.array() > 0.6).cast<double>();
    const double expected = RidgeOnBackground::background * above;
    INFO(draws.reason << ", share " << high.mean() << " of " << expected);
    converged += draws.converged ? 1 : 0;  // 15 of the first 16 seeds
    CHECK(std::abs(high.mean() - expected) < std::min(4.0 * mean_mcse(high), 0.5 * expected));
    CHECK(std::abs(draws.log_evidence) < 4.0 * draws.log_evidence_error + 1e-3);
  }
  CHECK(converged >= 3);
}
