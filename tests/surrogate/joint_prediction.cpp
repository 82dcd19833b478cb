#include "surrogate/joint_prediction.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

#include "data/random.hpp"
#include "surrogate/design.hpp"
#include "surrogate/fit.hpp"

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using namespace surrogate;

namespace {

/// Runs of a curved function of two inputs.
TrainingSet runs_at(MatrixXd x) {
  data::RandomStream random(4, data::Purpose::test, 9);
  TrainingSet training{std::move(x), VectorXd(), VectorXd()};
  training.y.resize(training.x.rows());
  for (Index i = 0; i < training.y.size(); ++i)
    training.y[i] = std::sin(4.0 * training.x(i, 0)) * (1.0 + training.x(i, 1)) + 0.03 * random.normal();
  training.noise_variance = VectorXd::Constant(training.y.size(), 9e-4);
  return training;
}

}  // namespace

TEST_CASE("predictions beside fixed points are those of one call with all points") {
  MatrixXd three_levels = scrambled_sobol(18, 2, 3);
  for (Index i = 0; i < three_levels.rows(); ++i) three_levels(i, 0) = 0.5 * static_cast<double>(i % 3);
  for (const MeanBasis mean : {MeanBasis::zero, MeanBasis::constant, MeanBasis::trend})
    for (const MatrixXd& x : {scrambled_sobol(18, 2, 3), three_levels}) {
      const GaussianProcess process = fit(runs_at(x), {.mean = mean,
                                                       .starts = 1,
                                                       .hyper_uncertainty = HyperUncertainty::integrated,
                                                       .between_runs = BetweenRuns::doubted});
      CAPTURE(to_text(mean), process.averaged().size(), process.data().gaps.size());
      REQUIRE(process.averaged().size() > 1);
      const MatrixXd fixed = scrambled_sobol(5, 2, 11), points = scrambled_sobol(6, 2, 12);
      const int group = 3;
      PredictionWorkspace workspace;
      JointPrediction found;
      FixedPoints(process, fixed).predict(points, group, workspace, found);
      REQUIRE(found.mean.size() == 6);
      MatrixXd all(11, 2);
      all << fixed, points;
      const Prediction together = process.predict(all);
      CHECK((found.mean - together.mean.tail(6)).cwiseAbs().maxCoeff() < 1e-11);
      CHECK((found.cross - together.covariance.topRightCorner(5, 6)).cwiseAbs().maxCoeff() < 1e-11);
      for (Index first = 0; first < 6; first += group) {
        const MatrixXd own = found.covariance.middleCols(first, group);
        CHECK((own - together.covariance.block(5 + first, 5 + first, group, group)).cwiseAbs().maxCoeff() < 1e-11);
      }
    }
}

TEST_CASE("a process on the log scale has no normal law beside fixed points") {
  TrainingSet training = runs_at(scrambled_sobol(12, 2, 3));
  training.y.array() += 4.0;
  const GaussianProcess process = fit(training, {.scale = OutputScale::log, .starts = 1});
  CHECK_THROWS_AS(FixedPoints(process, scrambled_sobol(2, 2, 1)), std::invalid_argument);
}
