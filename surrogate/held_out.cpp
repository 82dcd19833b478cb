#include "surrogate/held_out.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "data/random.hpp"
#include "data/shuffle.hpp"

namespace surrogate {

using Eigen::Index;
using Eigen::VectorXd;

std::vector<std::vector<int>> deal(const std::vector<int>& point_of_run, int folds, std::uint64_t seed) {
  const int points = *std::max_element(point_of_run.begin(), point_of_run.end()) + 1;
  std::vector<int> order(static_cast<std::size_t>(points));
  std::iota(order.begin(), order.end(), 0);
  data::RandomStream random(seed, data::Purpose::optimiser_starts, 1);
  data::shuffle(std::span(order), random);
  std::vector<int> fold_of_point(order.size());
  for (int i = 0; i < points; ++i) fold_of_point[order[i]] = i % folds;
  std::vector<std::vector<int>> runs(static_cast<std::size_t>(folds));
  for (std::size_t i = 0; i < point_of_run.size(); ++i)
    runs[fold_of_point[point_of_run[i]]].push_back(static_cast<int>(i));
  return runs;
}

int hold_out(Validation& validation, const HeldOutData& data, const std::vector<std::vector<int>>& folds,
             const HeldOutModel& model) {
  const TrainingSet& training = data.training;
  const Index n = training.y.size();
  validation.held_out_mean = VectorXd::Constant(n, training.y.mean());
  validation.held_out_standardised = VectorXd::Zero(n);
  double worst = 1.0, reach = 0.0;
  int predicted = 0;
  for (const std::vector<int>& left : folds) {
    std::vector<int> kept;
    for (int i = 0; i < n; ++i)
      if (!std::binary_search(left.begin(), left.end(), i)) kept.push_back(i);
    const HeldOutPrediction found = model(kept, left);
    if (found.prediction.mean.size() == 0) continue;  // the kept runs are too few to fit
    const VectorXd error = training.y(left) - found.prediction.mean;
    validation.held_out_mean(left) = found.prediction.mean;
    validation.held_out_standardised(left) =
        (error.array() / found.prediction.covariance.diagonal().array().sqrt()).matrix();
    reach =
        std::max({reach, error.cwiseAbs().maxCoeff(), std::sqrt(found.prediction.covariance.diagonal().maxCoeff())});
    HeldOutFold fold;
    fold.runs = left;
    fold.converged = found.converged;
    const PivotedErrors pivoted = pivoted_errors(error, found.prediction.covariance);
    fold.pivoted_errors = pivoted.errors;
    for (const int i : pivoted.order) fold.pivots.push_back(left[i]);
    fold.mahalanobis = pivoted.errors.squaredNorm();
    fold.degrees = static_cast<int>(pivoted.errors.size());
    fold.remaining_degrees = static_cast<int>(kept.size()) - found.coefficients;
    fold.probability = mahalanobis_probability(fold.mahalanobis, fold.degrees, std::max(fold.remaining_degrees, 1));
    validation.large_pivoted_errors += static_cast<int>((pivoted.errors.array().abs() > 2.0).count());
    worst = std::min(worst, fold.probability);
    predicted += static_cast<int>(left.size());
    validation.folds.push_back(std::move(fold));
  }
  validation.mahalanobis_probability = std::min(1.0, worst * static_cast<double>(folds.size()));
  validation.large_errors = static_cast<int>((validation.held_out_standardised.array().abs() > 2.0).count());
  validation.coverage_held_out = coverage(validation.held_out_standardised);
  validation.q2_held_out = q2(training.y, validation.held_out_mean);

  // Q2 of the function is taken of the variance that the noise leaves to be explained.
  const double noise = training.noise_variance.mean() + data.scatter_variance;
  const double variance = (training.y.array() - training.y.mean()).square().mean();
  const double error = (training.y - validation.held_out_mean).squaredNorm() / static_cast<double>(n);
  if (predicted == n && variance > 0.0) validation.held_out_reach = reach / std::sqrt(variance);
  validation.q2_attainable = variance > 0.0 ? 1.0 - noise / variance : 0.0;
  validation.q2_function =
      variance > noise ? std::min(1.0, 1.0 - (error - noise) / (variance - noise)) : validation.q2_held_out;
  return predicted;
}

}  // namespace surrogate
