#include "surrogate/validation.hpp"

#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "data/random.hpp"
#include "surrogate/design.hpp"
#include "surrogate/verdict.hpp"

namespace surrogate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The training set on the process's own scale, where errors are judged.
TrainingSet on_process_scale(const TrainingSet& training, OutputScale scale) {
  TrainingSet result = training;
  if (result.noise_variance.size() == 0) result.noise_variance = VectorXd::Zero(training.y.size());
  if (scale == OutputScale::log) {
    result.noise_variance.array() /= training.y.array().square();
    result.y = training.y.array().log();
  }
  return result;
}

/// Distinct points dealt into folds in a random order.
std::vector<std::vector<int>> deal(const Standardised& data, int folds, std::uint64_t seed) {
  const auto points = static_cast<int>(data.points.rows());
  std::vector<int> order(static_cast<std::size_t>(points));
  std::iota(order.begin(), order.end(), 0);
  data::RandomStream random(seed, data::Purpose::optimiser_starts, 1);
  for (int i = points - 1; i > 0; --i) std::swap(order[i], order[static_cast<int>(random.uniform() * (i + 1))]);
  std::vector<int> fold_of_point(order.size());
  for (int i = 0; i < points; ++i) fold_of_point[order[i]] = i % folds;
  std::vector<std::vector<int>> runs(static_cast<std::size_t>(folds));
  for (std::size_t i = 0; i < data.point_of_run.size(); ++i)
    runs[fold_of_point[data.point_of_run[i]]].push_back(static_cast<int>(i));
  return runs;
}

struct FoldPrediction {
  HeldOutFold fold;
  VectorXd mean, standardised;  // of fold.runs
};

FoldPrediction predict_fold(const TrainingSet& training, const std::vector<int>& runs, const FitOptions& options) {
  std::vector<int> kept;
  for (int i = 0; i < training.y.size(); ++i)
    if (!std::binary_search(runs.begin(), runs.end(), i)) kept.push_back(i);
  const GaussianProcess process =
      fit({training.x(kept, Eigen::all), training.y(kept), training.noise_variance(kept)}, options);
  Prediction prediction = process.predict(training.x(runs, Eigen::all));
  const double nugget = process.hyper_parameters().nugget_sd;
  prediction.covariance.diagonal() += training.noise_variance(runs);
  prediction.covariance.diagonal().array() += nugget * nugget;

  FoldPrediction result;
  const VectorXd error = training.y(runs) - prediction.mean;
  result.mean = prediction.mean;
  result.standardised = error.array() / prediction.covariance.diagonal().array().sqrt();
  HeldOutFold& fold = result.fold;
  fold.runs = runs;
  fold.converged = process.diagnostics().converged;
  const PivotedErrors pivoted = pivoted_errors(error, prediction.covariance);
  fold.pivoted_errors = pivoted.errors;
  for (const int i : pivoted.order) fold.pivots.push_back(runs[i]);
  fold.mahalanobis = pivoted.errors.squaredNorm();
  fold.degrees = static_cast<int>(pivoted.errors.size());
  fold.remaining_degrees =
      static_cast<int>(kept.size()) - basis_size(options.mean, static_cast<int>(process.data().active.size()));
  fold.probability = mahalanobis_probability(fold.mahalanobis, fold.degrees, std::max(fold.remaining_degrees, 1));
  return result;
}

}  // namespace

double q2(const VectorXd& observed, const VectorXd& predicted) {
  const double total = (observed.array() - observed.mean()).square().sum();
  return total > 0.0 ? 1.0 - (observed - predicted).squaredNorm() / total : 0.0;
}

Coverage coverage(const VectorXd& standardised) {
  Coverage result;
  for (std::size_t l = 0; l < Coverage::levels.size(); ++l) {
    const double half_width = gsl_cdf_ugaussian_Pinv(0.5 + 0.5 * Coverage::levels[l]);
    result.observed[l] = static_cast<double>((standardised.array().abs() <= half_width).count()) /
                         static_cast<double>(standardised.size());
  }
  return result;
}

PivotedErrors pivoted_errors(const VectorXd& error, const MatrixXd& covariance) {
  const Index n = error.size();
  PivotedErrors result;
  result.order.resize(static_cast<std::size_t>(n));
  std::iota(result.order.begin(), result.order.end(), 0);
  // Right-looking pivoted Cholesky that carries the error along: after step k, `rest` is the covariance of what is left
  // and `left` its error, both given the first k.
  MatrixXd rest = covariance;
  VectorXd left = error;
  result.errors.resize(n);
  const double least = 1e-13 * covariance.diagonal().maxCoeff();
  for (Index k = 0; k < n; ++k) {
    Index pivot = 0;
    rest.diagonal().tail(n - k).maxCoeff(&pivot);
    pivot += k;
    rest.row(k).swap(rest.row(pivot));
    rest.col(k).swap(rest.col(pivot));
    std::swap(left[k], left[pivot]);
    std::swap(result.order[k], result.order[pivot]);
    if (!(rest(k, k) > least)) {  // the rest is known exactly: no further independent errors
      result.errors.conservativeResize(k);
      result.order.resize(static_cast<std::size_t>(k));
      break;
    }
    const double sd = std::sqrt(rest(k, k));
    result.errors[k] = left[k] / sd;
    const Index below = n - k - 1;
    const VectorXd column = rest.col(k).tail(below) / sd;
    rest.bottomRightCorner(below, below) -= column * column.transpose();
    left.tail(below) -= column * result.errors[k];
  }
  return result;
}

double mahalanobis_probability(double distance, int m, int remaining) {
  if (m < 1) return 1.0;
  const double ratio = distance / m;
  return 2.0 * std::min(gsl_cdf_fdist_P(ratio, m, remaining), gsl_cdf_fdist_Q(ratio, m, remaining));
}

Eigen::MatrixXd least_known_points(const GaussianProcess& process, int count, std::uint64_t seed) {
  constexpr int candidates = 512;
  const VectorXd low = process.data().low, span = process.data().high - low;
  MatrixXd points = scrambled_sobol(candidates, std::min(process.dimension(), sobol_max_dimension), seed, 1 << 16);
  points.conservativeResize(Eigen::NoChange, process.dimension());
  for (Index k = 0; k < points.cols(); ++k) {
    if (k >= sobol_max_dimension) points.col(k) = points.col(k % sobol_max_dimension);
    points.col(k) = low[k] + span[k] * points.col(k).array();
  }
  // The variance after a run does not depend on its outcome: the predicted mean stands in for it. Its noise is that of
  // an ordinary training run.
  const Standardised& data = process.data();
  const double noise = data.noise.mean() * data.unit * data.unit;
  MatrixXd chosen(count, process.dimension());
  GaussianProcess grown = process;
  for (int i = 0; i < count; ++i) {
    const MarginalPrediction prediction = grown.predict_marginal(points);
    Index worst = 0;
    prediction.variance.maxCoeff(&worst);
    chosen.row(i) = points.row(worst);
    const double y = prediction.mean[worst];
    grown = grown.with_run(points.row(worst), y, noise * (data.scale == OutputScale::log ? y * y : 1.0));
  }
  return chosen;
}

Validation validate(const TrainingSet& given, const FitOptions& fit_options, const GaussianProcess& process,
                    const ValidationOptions& options) {
  if (given.y.size() != process.runs())
    throw std::invalid_argument("validate: another training set than the process's");
  const TrainingSet training = on_process_scale(given, fit_options.scale);
  const Index n = training.y.size();
  const bool log_scale = fit_options.scale == OutputScale::log;
  Validation result;
  result.runs = static_cast<int>(n);
  result.notes = fit_notes(process);

  // Leave-one-out, closed form, hyper-parameters kept.
  result.leave_one_out = process.leave_one_out();
  result.q2_leave_one_out = q2(given.y, result.leave_one_out.mean);
  result.coverage_leave_one_out = coverage(result.leave_one_out.standardised);

  // Held-out folds, hyper-parameters fitted again from the full fit's.
  FitOptions fold_options = fit_options;
  fold_options.scale = OutputScale::linear;
  fold_options.starts = 1;
  fold_options.first_start = to_logs(process.parts().front().parameters, fit_options.nugget);
  const int points = static_cast<int>(process.data().points.rows());
  const int p = basis_size(fit_options.mean, static_cast<int>(process.data().active.size()));
  const int folds = std::clamp(options.folds, 2, points);
  result.held_out_mean = VectorXd::Constant(n, training.y.mean());
  result.held_out_standardised = VectorXd::Zero(n);
  double worst = 1.0;
  int predicted = 0;
  for (const std::vector<int>& runs : deal(process.data(), folds, options.seed)) {
    if (points - (points + folds - 1) / folds <= p || n - static_cast<Index>(runs.size()) < 2) continue;
    const FoldPrediction fold = predict_fold(training, runs, fold_options);
    result.held_out_mean(runs) = fold.mean;
    result.held_out_standardised(runs) = fold.standardised;
    result.large_pivoted_errors += static_cast<int>((fold.fold.pivoted_errors.array().abs() > 2.0).count());
    worst = std::min(worst, fold.fold.probability);
    predicted += static_cast<int>(runs.size());
    result.folds.push_back(fold.fold);
  }
  result.mahalanobis_probability = std::min(1.0, worst * static_cast<double>(folds));
  result.large_errors = static_cast<int>((result.held_out_standardised.array().abs() > 2.0).count());
  result.coverage_held_out = coverage(result.held_out_standardised);
  result.q2_held_out = q2(training.y, result.held_out_mean);

  // What the noise leaves to be explained.
  // The nugget counts as noise only where replicates show that it is scatter: without them it may as well be structure
  // that the runs are too few to resolve.
  const double nugget = static_cast<int>(n) - points >= 5 ? process.hyper_parameters().nugget_sd : 0.0;
  const double noise = training.noise_variance.mean() + nugget * nugget;
  const double variance = (training.y.array() - training.y.mean()).square().mean();
  const double error = (training.y - result.held_out_mean).squaredNorm() / static_cast<double>(n);
  result.q2_attainable = variance > 0.0 ? 1.0 - noise / variance : 0.0;
  result.q2_function =
      variance > noise ? std::min(1.0, 1.0 - (error - noise) / (variance - noise)) : result.q2_held_out;
  if (log_scale) result.held_out_mean = result.held_out_mean.array().exp();

  result.verdict = judge(result, predicted, process, options.thresholds);
  if (options.suggestions > 0) result.next_points = least_known_points(process, options.suggestions, options.seed);
  explain(result, training, fold_options, options);
  return result;
}

}  // namespace surrogate
