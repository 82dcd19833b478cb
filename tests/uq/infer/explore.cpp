// The search for maxima that a proposal does not know, and the weights that tell whether it covers a density.
#include "uq/infer/explore.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "tests/uq/infer/adversaries.hpp"
#include "uq/infer/climb.hpp"
#include "uq/infer/importance.hpp"

using namespace uq;

namespace {

/// A proposal that knows one place.
Mixture knowing(const Eigen::VectorXd& centre, double sd) {
  data::RandomStream random(4, data::Purpose::test, 7);
  Eigen::MatrixXd points(400, centre.size());
  for (Eigen::Index i = 0; i < points.rows(); ++i)
    for (Eigen::Index k = 0; k < points.cols(); ++k) points(i, k) = centre[k] + sd * random.normal();
  return fit_mixture(points, Eigen::VectorXd::Ones(points.rows()), random);
}

}  // namespace

TEST_CASE("a climb ends on the maximum of the basin that it began in", "[uq]") {
  const adversaries::Adversary two = adversaries::narrow_and_wide(3);
  const Knowledge nothing{.mixtures = {knowing(Eigen::VectorXd::Constant(3, 0.95), 1e-3)}, .log_levels = {-1e9}};
  // In the skirts of the narrow mode, seven of its sd from the centre: nearer to it than the wide mode's reach.
  for (const double away : {0.02, -0.03}) {
    const Climb found =
        climb(two.target, Eigen::Vector3d(0.3 + away, 0.3, 0.3 - away), Eigen::VectorXd::Ones(3), nothing);
    CHECK((found.x - Eigen::VectorXd::Constant(3, 0.3)).norm() < 1e-3);
    CHECK_FALSE(found.known);
  }
  const Climb other = climb(two.target, Eigen::Vector3d(0.6, 0.75, 0.7), Eigen::VectorXd::Ones(3), nothing);
  CHECK((other.x - Eigen::VectorXd::Constant(3, 0.7)).norm() < 1e-2);
}

TEST_CASE("a search finds the mode that the proposal lacks and nothing where it lacks none", "[uq]") {
  // Off every line through the known mode the scouts alone find the narrow one: about 20 of them lie in its basin in
  // two dimensions, three in three dimensions. Measured: 2 and 8 of 20 searches miss it, as a scout in the basin must
  // also stand out among its neighbours to be followed.
  for (const int d : {1, 2, 3}) {
    const adversaries::Adversary two = d == 1 ? adversaries::narrow_and_wide(1) : adversaries::askew(d);
    const Eigen::VectorXd wide = Eigen::VectorXd::Constant(d, d == 1 ? 0.7 : 0.6);
    int missed = 0;
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      data::RandomStream random(seed, data::Purpose::test, static_cast<std::uint32_t>(d));
      const Scouts scouts = send_scouts(two.target, random);
      // The wide mode alone is known; it holds half.
      const Knowledge knowledge{.mixtures = {knowing(wide, 0.05)}, .log_levels = {std::log(0.5 * 30.0)}};
      const Search found = search_unknown(two.target, scouts, knowledge, {.through = wide});
      CAPTURE(d, seed, found.starts, found.evaluations);
      CHECK(found.modes.size() <= 1);
      if (found.modes.empty()) ++missed;
      for (const Peak& peak : found.modes) CHECK(peak.log_mass == Approx(std::log(0.5)).margin(1e-3));
      const adversaries::Adversary one = adversaries::normals("one", {.centre = {wide}, .sd = {0.05}, .weight = {1.0}});
      const Knowledge all{.mixtures = {knowing(wide, 0.05)}, .log_levels = {std::log(30.0)}};
      CHECK(search_unknown(one.target, send_scouts(one.target, random), all, {.through = wide}).modes.empty());
    }
    CAPTURE(d);
    CHECK(missed <= (d == 1 ? 0 : d == 2 ? 4 : 12));
  }
}

TEST_CASE("a search takes the same way for any number of threads", "[uq]") {
  const adversaries::Adversary two = adversaries::askew(2);
  const Eigen::VectorXd wide = Eigen::VectorXd::Constant(2, 0.6);
  const Knowledge knowledge{.mixtures = {knowing(wide, 0.05)}, .log_levels = {std::log(15.0)}};
  std::vector<Search> found;
  for (const int threads : {1, 3}) {
    data::RandomStream random(9, data::Purpose::test, 2);
    const Scouts scouts = send_scouts(two.target, random, {.threads = threads});
    found.push_back(search_unknown(two.target, scouts, knowledge, {.through = wide}, {.threads = threads}));
  }
  REQUIRE(found[0].modes.size() == found[1].modes.size());
  for (std::size_t i = 0; i < found[0].modes.size(); ++i) CHECK(found[0].modes[i].x == found[1].modes[i].x);
  CHECK(found[0].evaluations == found[1].evaluations);
}

TEST_CASE("k-hat of Pareto weights is their shape", "[uq]") {
  // w = (1 - p)^-k has a generalised Pareto tail of shape k.
  for (const double shape : {0.2, 0.5, 0.9}) {
    double sum = 0.0;
    for (std::uint32_t repeat = 0; repeat < 8; ++repeat) {
      data::RandomStream random(21, data::Purpose::test, repeat);
      std::vector<double> log_weights(8000);
      for (double& value : log_weights) value = -shape * std::log(random.uniform());
      sum += pareto_shape(log_weights) / 8.0;
    }
    CHECK(sum == Approx(shape).margin(0.08));
  }
}

TEST_CASE("the evidence's error is that of repeated runs", "[uq]") {
  // A proposal half as wide again as the density: the weights are bounded.
  const adversaries::Adversary one =
      adversaries::normals("one", {.centre = {Eigen::Vector2d(0.5, 0.5)}, .sd = {0.02}, .weight = {1.0}});
  const Mixture proposal = knowing(Eigen::Vector2d(0.5, 0.5), 0.03);
  double square = 0.0;
  constexpr int repeats = 100;
  for (std::uint32_t repeat = 0; repeat < repeats; ++repeat) {
    data::RandomStream random(22, data::Purpose::test, repeat);
    const Proposals made = propose(one.target, proposal, 500, random);
    WeightRecord record{.log_weights = {}, .tries = made.tries};
    for (Eigen::Index i = 0; i < 500; ++i) record.log_weights.push_back(made.log_density[i] - made.log_proposal[i]);
    const Evidence evidence = evidence_of(record);
    square += std::pow(evidence.log_value / evidence.error, 2) / repeats;
  }
  CHECK(square == Approx(1.0).margin(0.5));  // 3.5 of its own standard errors
}

TEST_CASE("the unknown mass about a corner of a flat density is what lies inside and is not known", "[uq]") {
  struct Flat {
    int dimension() const { return 4; }
    double log_density(const Eigen::VectorXd&) const { return 0.0; }
  };
  const Target target = adversaries::on_box(Flat{}, Eigen::VectorXd::Zero(4), Eigen::VectorXd::Ones(4));
  const Peak corner = laplace(target, Eigen::VectorXd::Zero(4), Eigen::VectorXd::Constant(4, 0.25));
  std::int64_t evaluations = 0;
  // The proposal is a normal law of sd 1/4 about the middle, and knows what lies nearer to it than 0.7. Counted by
  // 200,000 uniform draws, 0.154 of the box lies farther away: 0.0096 about each of the 16 corners. Laplace's mass of
  // one is 0.154.
  const Mixture middle = knowing(Eigen::VectorXd::Constant(4, 0.5), 0.25);
  const double level = -middle.log_density(Eigen::Vector4d(0.15, 0.15, 0.15, 0.15));
  const double mass =
      std::exp(log_unknown_mass(target, corner, {.mixtures = {middle}, .log_levels = {level}}, evaluations));
  CHECK(mass < 0.03);
  CHECK(mass > 0.003);
  CHECK(std::exp(corner.log_mass) > 0.1);
  CHECK(evaluations > 0);
  const Knowledge all{.mixtures = {middle}, .log_levels = {1e9}};
  CHECK(log_unknown_mass(target, corner, all, evaluations) == nowhere);
}

TEST_CASE("the unknown mass of a normal mode inside the box is all of it", "[uq]") {
  struct Normal {
    int dimension() const { return 3; }
    double log_density(const Eigen::VectorXd& x) const {
      return -0.5 * (x - Eigen::VectorXd::Constant(3, 0.5)).squaredNorm() / 1e-4;
    }
  };
  const Target target = adversaries::on_box(Normal{}, Eigen::VectorXd::Zero(3), Eigen::VectorXd::Ones(3));
  const Peak mode = laplace(target, Eigen::VectorXd::Constant(3, 0.5), Eigen::VectorXd::Constant(3, 0.25));
  const Knowledge nothing{.mixtures = {knowing(Eigen::VectorXd::Constant(3, 0.95), 1e-3)}, .log_levels = {-1e9}};
  std::int64_t evaluations = 0;
  const double exact = 1.5 * std::log(2.0 * std::numbers::pi * 1e-4);
  CHECK(log_unknown_mass(target, mode, nothing, evaluations) == Approx(exact).margin(0.1));
}
