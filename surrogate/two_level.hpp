#pragma once
// Two levels of one model: many cheap runs (a slice, coarse grains) under a handful of dear ones (the machine, fine
// grains).
//
// Autoregression (M. C. Kennedy & A. O'Hagan, Biometrika 87:1 (2000), eq. 1): y_high(x) = rho y_low(x) + delta(x),
// delta a Gaussian process independent of the low level. The low level is fitted to its own runs; given them, y_low at
// any points is normal with mean m(x) and covariance S(x, x') (gaussian_process.hpp), so that for the high level
//   mean   rho m(x) + h(x)' b,   covariance   rho^2 S(x, x') + s^2 c(x, x'; l_k = q min(l_k,low, 1)),
// noise and nugget on top, b with a flat prior: co-kriging with every run of both levels in it, whether or not the high
// runs' points are among the low ones (the recursive form is that of L. Le Gratiet & J. Garnier, Int. J. Uncertainty
// Quantification 4:365 (2014)). rho, q, s and the nugget have the priors below and, since a handful of runs leaves them
// vague, are integrated over (marginal.hpp). q is one factor on all length scales, since a handful of runs cannot tell
// d of them. They start from the low level's, but not from more than the range of an input: where the model is smooth,
// its scales are several ranges long, and a discrepancy as smooth as that is a plane, so that what two inputs do
// together would count as scatter of the runs (COVERAGE.md). Deviation: the low level's hyper-parameters are not fitted
// again to the high runs.
#include <optional>
#include <span>
#include <vector>

#include "surrogate/fit.hpp"
#include "surrogate/joint_prediction.hpp"
#include "surrogate/validation.hpp"

namespace surrogate {

/// Options of the high level's fit. Its priors, with r the ratio of the two levels' spreads over the high runs and t
/// the spread of the high runs: rho/r ~ N(1, 1), log q ~ N(0, 1), log s/t ~ N(log 0.3, 1.5), log(nugget sd/t) ~ N(log
/// 0.03, 1.5).
struct TwoLevelOptions {
  MeanBasis discrepancy_mean = MeanBasis::constant;  ///< h: zero or constant
  bool nugget = true;                                ///< run-to-run scatter of the high runs beyond their known noise
  HyperUncertainty hyper_uncertainty = HyperUncertainty::integrated;
  int starts = 6;
  std::uint64_t seed = 0;
};

struct TwoLevelParameters {
  double weight = 1.0;          ///< among the settings integrated over
  double rho = 1.0;             ///< high output per low output
  double length_factor = 1.0;   ///< q
  double discrepancy_sd = 0.0;  ///< s, unit of the high output
  double nugget_sd = 0.0;       ///< unit of the high output
};

/// The runs that the high level was fitted to, and the outcome.
struct HighLevel {
  TrainingSet runs;
  MeanBasis discrepancy_mean = MeanBasis::constant;
  std::vector<TwoLevelParameters> settings;  ///< the best first
  FitDiagnostics diagnostics;
};

class TwoLevelProcess {
 public:
  /// Throws data::InputError (65) where the covariance of the high runs cannot be factorised.
  TwoLevelProcess(GaussianProcess low, HighLevel high);

  Prediction predict(const Eigen::MatrixXd& points) const;  ///< prediction of the high level's latent function
  Eigen::VectorXd predict_mean(const Eigen::MatrixXd& points) const { return predict(points).mean; }
  /// Points stacked in groups of `group` rows.
  std::vector<Prediction> predict_batch(const Eigen::MatrixXd& points, int group) const;
  /// Predicts with derivatives with respect to a common shift of each coordinate, by central differences of predict
  /// (step 1e-4 of the unit cube).
  PredictionGradient predict_with_gradient(const Eigen::MatrixXd& points, std::span<const int> coordinates) const;

  const GaussianProcess& low() const { return low_; }
  const HighLevel& high() const { return high_; }
  const TwoLevelParameters& parameters() const { return high_.settings.front(); }  ///< parameters of the best setting
  double mean_rho() const;                                                         ///< mean of rho over the settings

 private:
  struct Part {
    Eigen::MatrixXd inverse_factor, whitened_basis, basis_factor;
    Eigen::VectorXd weights, coefficients;
  };
  struct Workspace;
  /// Predicts the groups of one block, from results[0] on.
  void predict_block(const Eigen::MatrixXd& points, int group, Workspace& workspace,
                     std::span<Prediction> results) const;

  GaussianProcess low_;
  HighLevel high_;
  FixedPoints low_at_high_;      // the low level beside the high runs
  Eigen::VectorXd lengths_;      // of the discrepancy at q = 1, unit cube
  Eigen::MatrixXd scaled_runs_;  // the high runs' points by these lengths
  std::vector<Part> parts_;
};

/// Throws data::InputError (65) for data that cannot train: fewer than three high runs, other columns than the low
/// level's inputs, a low level on the log scale.
TwoLevelProcess fit_two_level(const GaussianProcess& low, const TrainingSet& high, const TwoLevelOptions& options = {});

/// Judges the high level as validate() judges one process: by runs held out (each in turn, or in twenty folds where
/// they are more), with rho and the discrepancy fitted again without them.
Validation validate(const TwoLevelProcess& process, const TwoLevelOptions& options,
                    const ValidationOptions& validation_options = {});

}  // namespace surrogate
