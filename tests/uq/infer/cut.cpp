// Posteriors taken without feedback, against the closed form of two linear-Gaussian stages.
#include "uq/infer/cut.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "uq/infer/diagnostics.hpp"

using namespace uq;

namespace {

/// Second stage: y2 = phi + theta + psi / 2 + e and z = theta + e', normal priors of sd 1, errors of sd 0.3 and 0.5;
/// the density is that of all three unknowns given y2 = 2, z = 0.6, so that phi, left to itself, would be moved.
struct Second {
  int dimension() const { return 3; }
  double log_density(const Eigen::VectorXd& x) const {
    const double a = (2.0 - x[0] - x[1] - 0.5 * x[2]) / 0.3, b = (0.6 - x[1]) / 0.5;
    return -0.5 * (a * a + b * b + x.squaredNorm());
  }
};

}  // namespace

TEST_CASE("a cut parameter keeps its source's law, and the others follow it as the closed form says", "[uq]") {
  constexpr double inf = std::numeric_limits<double>::infinity();
  const Eigen::VectorXd low = Eigen::VectorXd::Constant(3, -inf), high = Eigen::VectorXd::Constant(3, inf);
  const Target target =
      make_target(Second{}, low, high, normal_reference(Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()));
  // First stage: phi ~ N(0.2, 0.4^2).
  GivenDraws given{.unknowns = {0}, .chains = std::vector<Eigen::MatrixXd>(4, Eigen::MatrixXd(4000, 1))};
  for (std::uint32_t c = 0; c < 4; ++c) {
    data::RandomStream random(3, data::Purpose::test, c);
    for (double& phi : given.chains[c].reshaped()) phi = 0.2 + 0.4 * random.normal();
  }
  const Draws draws = sample_cut(target, given, {.draws = 2000, .seed = 5});
  INFO(draws.reason);
  REQUIRE(draws.converged);
  // (theta, psi) given phi is normal with precision P, mean P^-1 (h - g phi).
  Eigen::Matrix2d precision;
  precision << 1.0 + 1.0 / 0.09 + 1.0 / 0.25, 0.5 / 0.09, 0.5 / 0.09, 1.0 + 0.25 / 0.09;
  const Eigen::Vector2d constant(2.0 / 0.09 + 0.6 / 0.25, 1.0 / 0.09), slope(1.0 / 0.09, 0.5 / 0.09);
  const Eigen::Matrix2d conditional = precision.inverse();
  const Eigen::Vector2d move = -conditional * slope, mean = conditional * constant + 0.2 * move;
  const Eigen::Matrix2d covariance = conditional + 0.16 * move * move.transpose();
  const Eigen::MatrixXd phi = draws.coordinate(0);
  CHECK(std::abs(phi.mean() - 0.2) < 4.0 * mean_mcse(phi));
  CHECK(std::sqrt((phi.array() - phi.mean()).square().mean()) == Approx(0.4).epsilon(0.04));
  for (int k = 0; k < 2; ++k) {
    const Eigen::MatrixXd values = draws.coordinate(k + 1);
    CHECK(std::abs(values.mean() - mean[k]) < 4.0 * mean_mcse(values));
    CHECK(std::sqrt((values.array() - values.mean()).square().mean()) ==
          Approx(std::sqrt(covariance(k, k))).epsilon(0.04));
    // How theta follows phi: a chain that lagged behind would follow less.
    const double followed = ((phi.array() - phi.mean()) * (values.array() - values.mean())).mean() /
                            (phi.array() - phi.mean()).square().mean();
    CHECK(followed == Approx(move[k]).margin(0.03));
  }
}

TEST_CASE("cut draws are the same bits for any number of threads", "[uq]") {
  constexpr double inf = std::numeric_limits<double>::infinity();
  const Eigen::VectorXd low = Eigen::VectorXd::Constant(3, -inf), high = Eigen::VectorXd::Constant(3, inf);
  const Target target =
      make_target(Second{}, low, high, normal_reference(Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()));
  const GivenDraws given{.unknowns = {0}, .chains = std::vector<Eigen::MatrixXd>(3, Eigen::MatrixXd::Random(200, 1))};
  CHECK(sample_cut(target, given, {.draws = 200, .threads = 1}).pooled() ==
        sample_cut(target, given, {.draws = 200, .threads = 3}).pooled());
}

TEST_CASE("where all unknowns are cut their draws are what was given", "[uq]") {
  constexpr double inf = std::numeric_limits<double>::infinity();
  const Target target = make_target(Second{}, Eigen::VectorXd::Constant(3, -inf), Eigen::VectorXd::Constant(3, inf),
                                    normal_reference(Eigen::Vector3d::Zero(), Eigen::Vector3d::Ones()));
  GivenDraws given{.unknowns = {0, 1, 2}, .chains = std::vector<Eigen::MatrixXd>(4, Eigen::MatrixXd(2000, 3))};
  for (std::uint32_t c = 0; c < 4; ++c) {
    data::RandomStream random(4, data::Purpose::test, c);
    for (double& value : given.chains[c].reshaped()) value = random.normal();
  }
  const Draws draws = sample_cut(target, given, {.draws = 2000, .seed = 5});
  INFO(draws.reason);
  REQUIRE(draws.converged);
  for (std::size_t c = 0; c < 4; ++c)
    for (Eigen::Index i = 0; i < draws.chains[c].x.rows(); ++i)
      CHECK((given.chains[c].rowwise() - draws.chains[c].x.row(i)).rowwise().squaredNorm().minCoeff() == 0.0);
}
