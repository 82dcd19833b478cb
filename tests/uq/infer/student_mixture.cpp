// The proposal of the sampler: its densities integrate to one, its draws have its moments, its fit finds what the
// points were drawn from.
#include "uq/infer/student_mixture.hpp"

#include <catch2/catch.hpp>
#include <cmath>

namespace {

/// Points of two normal clouds in the plane: one in three about (0.2, 0.3), the others about (0.8, 0.6).
Eigen::MatrixXd two_clouds(int count, data::RandomStream& random) {
  Eigen::MatrixXd points(count, 2);
  for (Eigen::Index i = 0; i < count; ++i) {
    const bool first = i % 3 == 0;
    points.row(i) << (first ? 0.2 : 0.8) + 0.03 * random.normal(), (first ? 0.3 : 0.6) + 0.05 * random.normal();
  }
  return points;
}

}  // namespace

TEST_CASE("a fitted mixture integrates to one", "[uq]") {
  data::RandomStream random(4, data::Purpose::test);
  const uq::Mixture mixture = uq::fit_mixture(two_clouds(600, random), Eigen::VectorXd::Ones(600), random);
  // A t of 8 degrees has some 1e-6 beyond 20 scales.
  const int n = 600;
  double mass = 0.0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const Eigen::Vector2d x(-2.0 + 5.0 * (i + 0.5) / n, -2.0 + 5.0 * (j + 0.5) / n);
      mass += std::exp(mixture.log_density(x)) * 25.0 / (n * n);
    }
  CHECK(mass == Approx(1.0).margin(0.01));
}

TEST_CASE("a mixture's fit finds two clouds with their shares, and its draws are of them", "[uq]") {
  data::RandomStream random(8, data::Purpose::test);
  const uq::Mixture mixture = uq::fit_mixture(two_clouds(900, random), Eigen::VectorXd::Ones(900), random);
  REQUIRE(mixture.fitted == 2);
  const auto& components = mixture.components;
  const std::size_t first = components[0].mean[0] < 0.5 ? 0 : 1;
  const double share = components[first].weight / (components[0].weight + components[1].weight);
  CHECK(share == Approx(1.0 / 3.0).margin(0.02));
  CHECK((components[first].mean - Eigen::Vector2d(0.2, 0.3)).norm() < 0.01);
  CHECK((components[1 - first].mean - Eigen::Vector2d(0.8, 0.6)).norm() < 0.01);
  double total = 0.0;
  for (const uq::MixtureComponent& one : components) total += one.weight;
  CHECK(total == Approx(1.0));
  int low = 0;
  const int draws = 6000;
  for (int i = 0; i < draws; ++i) low += mixture.draw(random)[0] < 0.5 ? 1 : 0;
  // A tenth of the weight lies in a wide component over both.
  CHECK(static_cast<double>(low) / draws == Approx(1.0 / 3.0).margin(0.05));
}

TEST_CASE("weights of points count as copies of them", "[uq]") {
  data::RandomStream random(15, data::Purpose::test);
  const Eigen::MatrixXd points = two_clouds(300, random);
  Eigen::VectorXd weights = Eigen::VectorXd::Ones(300);
  Eigen::MatrixXd copied(400, 2);
  copied.topRows(300) = points;
  for (Eigen::Index i = 0; i < 100; ++i) {
    weights[3 * i] = 2.0;
    copied.row(300 + i) = points.row(3 * i);
  }
  data::RandomStream one(3, data::Purpose::test), other(3, data::Purpose::test);
  const uq::Mixture weighted = uq::fit_mixture(points, weights, one);
  const uq::Mixture twice = uq::fit_mixture(copied, Eigen::VectorXd::Ones(400), other);
  for (const Eigen::Vector2d x : {Eigen::Vector2d(0.2, 0.3), Eigen::Vector2d(0.8, 0.62), Eigen::Vector2d(0.5, 0.5)})
    CHECK(weighted.log_density(x) == Approx(twice.log_density(x)).margin(0.1));
}

TEST_CASE("kept and added components have the shares that they state", "[uq]") {
  data::RandomStream random(1, data::Purpose::test);
  const uq::Mixture mixture = uq::fit_mixture(two_clouds(300, random), Eigen::VectorXd::Ones(300), random);
  uq::MixtureComponent far = mixture.components.front();
  far.mean = Eigen::Vector2d(3.0, 3.0);
  far.weight = 0.2;
  for (const uq::Mixture& more : {uq::with_kept(mixture, {far}), uq::with_components(mixture, {far})}) {
    double total = 0.0;
    for (const uq::MixtureComponent& one : more.components) total += one.weight;
    CHECK(total == Approx(1.0));
    int there = 0;
    for (int i = 0; i < 4000; ++i) there += more.draw(random)[0] > 1.5 ? 1 : 0;
    CHECK(there / 4000.0 == Approx(0.2).margin(0.025));
  }
}
