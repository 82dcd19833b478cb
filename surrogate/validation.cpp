#include "surrogate/validation.hpp"

#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "surrogate/design.hpp"
#include "surrogate/held_out.hpp"
#include "surrogate/judgement.hpp"
#include "surrogate/levels.hpp"
#include "surrogate/noise_check.hpp"

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

/// A design of few levels is fitted again some twenty times. From so many of the kept runs the hyper-parameters come
/// out as well as held-out errors need them; the process is conditioned on all that are kept.
constexpr int refit_points = 400;

/// A process fitted to the kept runs, from the full fit's hyper-parameters.
HeldOutModel refitted(const TrainingSet& training, const FitOptions& options) {
  return [&training, &options](const std::vector<int>& kept, const std::vector<int>& left) -> HeldOutPrediction {
    const TrainingSet part{training.x(kept, Eigen::all), training.y(kept), training.noise_variance(kept)};
    if (kept.size() < 2) return {};
    const Standardised data = standardise(part, options.scale);
    const int coefficients = flat_coefficients(options.mean, static_cast<int>(data.active.size()));
    if (data.points.rows() <= coefficients) return {};
    const GaussianProcess process = fit(part, options);
    HeldOutPrediction found{process.predict(training.x(left, Eigen::all)), coefficients,
                            process.diagnostics().converged};
    const double nugget = process.hyper_parameters().nugget_sd;
    found.prediction.covariance.diagonal() += training.noise_variance(left);
    found.prediction.covariance.diagonal().array() += nugget * nugget;
    return found;
  };
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
  result.notes = fit_notes(process.diagnostics());

  // Leave-one-out, closed form, hyper-parameters kept.
  result.leave_one_out = process.leave_one_out();
  result.q2_leave_one_out = q2(given.y, result.leave_one_out.mean);
  result.coverage_leave_one_out = coverage(result.leave_one_out.standardised);

  // Held-out folds, hyper-parameters fitted again from the full fit's.
  FitOptions fold_options = fit_options;
  fold_options.scale = OutputScale::linear;
  fold_options.starts = 1;
  fold_options.hyper_points = std::min(fit_options.hyper_points, refit_points);
  fold_options.first_start = to_logs(process.parts().front().parameters, fit_options.nugget);
  const int points = static_cast<int>(process.data().points.rows());
  // The nugget counts as noise only where replicates show that it is scatter: without them it may as well be structure
  // that the runs are too few to resolve.
  const double nugget = static_cast<int>(n) - points >= 5 ? process.hyper_parameters().nugget_sd : 0.0;
  const std::vector<std::vector<int>> folds =
      deal(process.data().point_of_run, std::clamp(options.folds, 2, points), options.seed);
  const HeldOutModel model = refitted(training, fold_options);
  const int predicted = hold_out(result, {training, nugget * nugget}, folds, model);
  if (log_scale) result.held_out_mean = result.held_out_mean.array().exp();

  result.levels = check_levels(training, model);
  for (const std::string& note : level_notes(result.levels)) result.notes.push_back(note);
  result.apart = pairs_apart(training);
  result.noise = check_noise(given, fit_options, process);
  if (const std::string note = noise_note(result.noise); !note.empty()) result.notes.push_back(note);
  result.verdict = judge(result, predicted, process.diagnostics(), options.thresholds);
  if (options.suggestions > 0) result.next_points = least_known_points(process, options.suggestions, options.seed);
  explain(result, training, model, options.thresholds);
  return result;
}

}  // namespace surrogate
