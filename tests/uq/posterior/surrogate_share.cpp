// The surrogate's share of a width where it is known in closed form: y = theta, seen with variance e, by a surrogate
// whose error has variance s. The posterior's variance is s + e with that error and e without it.
#include "uq/posterior/surrogate_share.hpp"

#include <catch2/catch.hpp>

#include "data/random.hpp"
#include "uq/posterior/distinct.hpp"
#include "uq/posterior/posterior.hpp"

namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double data_variance = 0.0016;

uq::CaseModel make_model(double surrogate_variance, double bias = 0.0) {
  data::Parameter parameter;
  parameter.name = "theta";
  uq::CaseModel model;
  model.unknowns.push_back({.label = "theta", .prior = uq::ScaledPrior(parameter, parameter.prior), .cut = {}});
  uq::RowGroup group{.emulator = {},
                     .base = MatrixXd::Zero(1, 1),
                     .unknown = Eigen::MatrixXi::Zero(1, 1),
                     .observed = VectorXd::Constant(1, 0.5),
                     .variance = VectorXd::Constant(1, data_variance),
                     .origin = {{}},
                     .coordinate = {}};
  group.emulator.inputs = {{uq::InputKind::parameter, 0}};
  group.emulator.predict = [=](const MatrixXd& points) -> surrogate::Prediction {
    return {.mean = points.col(0).array() + bias,
            .covariance = surrogate_variance * MatrixXd::Identity(points.rows(), points.rows())};
  };
  uq::find_coordinates(group, 1);
  model.groups.push_back(group);
  return model;
}

MatrixXd draws_of_posterior(double mean, double sd, int count) {
  MatrixXd draws(count, 1);
  data::RandomStream random(21, data::Purpose::test);
  for (Index i = 0; i < draws.rows(); ++i) draws(i, 0) = mean + sd * random.normal();
  return draws;
}

}  // namespace

TEST_CASE("the surrogate's share of a width is what a surrogate without error would take away", "[uq]") {
  for (const double surrogate : {0.0, 0.0001, 0.0009, 0.0016}) {
    const MatrixXd draws = draws_of_posterior(0.5, std::sqrt(data_variance + surrogate), 4000);
    const uq::SurrogateShare found = uq::surrogate_share(make_model(surrogate), draws);
    INFO("surrogate's variance " << surrogate);
    CHECK(found.share == Approx(surrogate / (surrogate + data_variance)).margin(0.06));
    CHECK(found.parameter == "theta");
    REQUIRE(found.shares.size() == 1);
    CHECK(found.shares.front() == found.share);
    CHECK(found.left.front() == Approx(data_variance / (surrogate + data_variance)).margin(0.06));
    CHECK(found.moved.front() < 0.1);
  }
}

TEST_CASE("the surrogate's share is the same of one reading and of two that say as much together", "[uq]") {
  constexpr double surrogate = 0.0016;
  const MatrixXd draws = draws_of_posterior(0.5, std::sqrt(data_variance + surrogate), 4000);
  uq::CaseModel twice = make_model(surrogate);
  uq::RowGroup& group = twice.groups[0];
  group.base = MatrixXd::Zero(2, 1);
  group.unknown = Eigen::MatrixXi::Zero(2, 1);
  group.observed = VectorXd::Constant(2, 0.5);
  group.variance = VectorXd::Constant(2, 2.0 * data_variance);
  group.origin = {{}, {}};
  group.emulator.predict = [=](const MatrixXd& points) -> surrogate::Prediction {  // one error of all rows
    return {.mean = points.col(0), .covariance = MatrixXd::Constant(points.rows(), points.rows(), surrogate)};
  };
  uq::pool_rows(twice);
  REQUIRE(twice.distinct);
  CHECK(uq::surrogate_share(twice, draws).share ==
        Approx(uq::surrogate_share(make_model(surrogate), draws).share).epsilon(1e-6));
}

TEST_CASE("where hardly a draw would be left without the surrogate's error, all of the width is the surrogate's",
          "[uq]") {
  const double surrogate = 1e6 * data_variance;
  const MatrixXd draws = draws_of_posterior(0.5, 40.0, 1000);
  const uq::SurrogateShare found = uq::surrogate_share(make_model(surrogate), draws);
  CHECK(found.effective_draws < uq::least_effective);
  CHECK(found.share == 1.0);
}

TEST_CASE("shares of given log likelihoods are those of the model's own", "[uq]") {
  const uq::CaseModel model = make_model(0.0009);
  const MatrixXd draws = draws_of_posterior(0.5, 0.05, 800);
  CHECK(uq::surrogate_share(model, draws, uq::log_likelihoods(model, draws)).share ==
        uq::surrogate_share(model, draws).share);
}
