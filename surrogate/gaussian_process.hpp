#pragma once
// A fitted Gaussian process: an immutable value that predicts.
//
// Given z = h' beta + f + nugget + noise (likelihood.hpp), at points x* with correlations k* to the training points:
//   mean  = h*' beta + k*' a,                                   a = P m
//   cov   = k** - k*' K^-1 k* + E' E,   E = R^-1 (h* - H' K^-1 k*),  R R' = H' K^-1 H
// (universal kriging: Rasmussen & Williams 2006, section 2.7). It is the covariance of the latent function h' beta + f,
// mean uncertainty included: the nugget is run-to-run scatter and part of no prediction. y = shift + unit z (linear
// scale); on the log scale y is log-normal and mean and covariance are its moments:
//   E y_i = exp(M_i + C_ii / 2),  cov(y_i, y_j) = E y_i E y_j (exp(C_ij) - 1),  M, C of log y.
//
// With several hyper-parameter settings and weights (marginal.hpp), mean and covariance are those of the mixture.
#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "surrogate/likelihood.hpp"

namespace surrogate {

/// Mean and covariance of the output at m points, of the latent function.
struct Prediction {
  Eigen::VectorXd mean;        ///< unit of y
  Eigen::MatrixXd covariance;  ///< unit^2 of y, m x m
};

/// A prediction with its derivatives with respect to a common shift of one coordinate of all m points, for each
/// coordinate asked for.
struct PredictionGradient {
  Prediction value;
  std::vector<Eigen::VectorXd> mean_gradient;        ///< unit of y per unit-cube length
  std::vector<Eigen::MatrixXd> covariance_gradient;  ///< unit^2 of y per unit-cube length
};

/// Mean and variance at each of many points, without the covariances between them.
struct MarginalPrediction {
  Eigen::VectorXd mean;      ///< unit of y
  Eigen::VectorXd variance;  ///< unit^2 of y
};

/// Predictions of each run from the others. Runs at the same point are left out together.
/// O. Dubrule, Math. Geology 15:687 (1983): mean m_i - a_i / P_ii, variance 1 / P_ii.
struct LeaveOneOut {
  Eigen::VectorXd mean;             ///< unit of y
  Eigen::VectorXd latent_variance;  ///< unit^2 of y, of the function
  Eigen::VectorXd variance;         ///< unit^2 of y, of the run: function, nugget and known noise
  Eigen::VectorXd standardised;     ///< (z_i - mean) / sd on the process's own scale: standard normal if all is right
};

/// Hyper-parameters in the caller's units.
struct HyperParameters {
  Eigen::VectorXd length_scales;      ///< per input, in units of the unit cube; infinite for an input that never varies
  double signal_sd = 0.0;             ///< unit of y (log scale: of log y)
  double nugget_sd = 0.0;             ///< unit of y (log scale: of log y); run-to-run scatter beyond the known noise
  Eigen::VectorXd mean_coefficients;  ///< unit of y (log scale: of log y), of mean_basis.hpp's h
};

/// Outcome of one start of the optimiser.
struct StartOutcome {
  Eigen::VectorXd start;  ///< logs of length scales, signal variance, nugget variance (of the standardised output)
  Eigen::VectorXd end;
  double objective = 0.0;      ///< log likelihood (plus log prior) at the end
  double gradient_norm = 0.0;  ///< norm of its gradient there, over the parameters that are not on a bound
  int evaluations = 0;
  bool converged = false;
  int points = 0;       ///< distinct points of the likelihood that was maximised: all, or a subset where the start was
                        ///< dropped before (fit.hpp); objectives compare for equal points only
  bool agrees = false;  ///< ended within 0.1 of the best objective of its points
};

struct BoundHit {
  std::string parameter;  ///< "length scale of friction", "signal", "nugget"
  bool upper = false;
  double value = 0.0;     ///< the bound: length in the unit cube, or sd in units of the output's sd
  bool harmless = false;  ///< a nugget at its floor or an input without influence: the model means what it says
  int input = -1;         ///< the length scale's input, among the active ones
  double effect = 0.0;    ///< range of the mean along that input, in units of the output's sd
};

/// How the fit went; nothing in it is an exception.
struct FitDiagnostics {
  bool converged = false;
  double jitter = 0.0;  ///< largest jitter relative to the output's variance; 0: none was needed
  std::vector<BoundHit> bound_hits;
  std::vector<StartOutcome> starts;
  int agreeing_starts = 0;  ///< how many starts' `agrees` is true
};

/// A point asked for outside the box of the training runs.
struct OutsideRange {
  int point = 0, coordinate = 0;
  double value = 0.0, low = 0.0, high = 0.0;  ///< unit cube
};

/// Buffers of a prediction, to be reused by one thread.
struct PredictionWorkspace {
  Eigen::MatrixXd points, squares, correlations, slopes, whitened, solved, basis, projected, moved, with_fixed;
  Eigen::VectorXd log_mean;
  Eigen::MatrixXd log_covariance;
  Prediction part;
  PredictionGradient gradient_part;
};

/// One hyper-parameter setting, conditioned on the data.
struct Conditioned {
  double weight = 1.0;
  ScaledParameters parameters;
  Eigen::MatrixXd scaled_points;  ///< points / length scales
  Factorised factorised;
};

class GaussianProcess {
 public:
  GaussianProcess(Kernel kernel, MeanBasis mean, bool nugget, Standardised data, std::vector<Conditioned> parts,
                  FitDiagnostics diagnostics);

  Prediction predict(const Eigen::MatrixXd& points) const;
  void predict(const Eigen::MatrixXd& points, PredictionWorkspace& workspace, Prediction& result) const;
  /// The means of predict alone. On a linear scale they need no solve and cost a fraction of it.
  Eigen::VectorXd predict_mean(const Eigen::MatrixXd& points) const;
  PredictionGradient predict_with_gradient(const Eigen::MatrixXd& points, std::span<const int> coordinates) const;
  void predict_with_gradient(const Eigen::MatrixXd& points, std::span<const int> coordinates,
                             PredictionWorkspace& workspace, PredictionGradient& result) const;
  /// Mean and variance at many points, in blocks.
  MarginalPrediction predict_marginal(const Eigen::MatrixXd& points) const;
  /// Predicts points stacked in groups of `group` rows, one Prediction per group. This is faster than one call per
  /// group.
  std::vector<Prediction> predict_batch(const Eigen::MatrixXd& points, int group) const;

  LeaveOneOut leave_one_out() const;
  double log_marginal_likelihood() const;    ///< log likelihood of y, in the units of y, at the best setting
  HyperParameters hyper_parameters() const;  ///< hyper-parameters of the best setting
  /// The same hyper-parameters with one more run (O(n^2)); the training range grows with it.
  GaussianProcess with_run(const Eigen::VectorXd& x, double y, double noise_variance) const;
  std::vector<OutsideRange> outside_training_range(const Eigen::MatrixXd& points) const;

  int runs() const { return static_cast<int>(data_->z.size()); }
  int dimension() const { return static_cast<int>(data_->low.size()); }
  Kernel kernel() const { return kernel_; }
  MeanBasis mean() const { return mean_; }
  bool nugget() const { return nugget_; }
  const Standardised& data() const { return *data_; }
  /// All settings of the hyper-parameters; the mode, which is reported, comes first.
  const std::vector<Conditioned>& parts() const { return *parts_; }
  /// The settings that predictions average over: all but a mode that is only reported and has no weight.
  std::span<const Conditioned> averaged() const {
    return std::span(*parts_).subspan(parts_->size() > 1 && parts_->front().weight == 0.0 ? 1 : 0);
  }
  const FitDiagnostics& diagnostics() const { return *diagnostics_; }

 private:
  Kernel kernel_;
  MeanBasis mean_;
  bool nugget_;
  std::shared_ptr<const Standardised> data_;
  std::shared_ptr<const std::vector<Conditioned>> parts_;
  std::shared_ptr<const FitDiagnostics> diagnostics_;
};

/// A process with given hyper-parameters (in the caller's units; mean_coefficients ignored), not fitted ones. Throws
/// data::InputError where the data are not a training set or the covariance cannot be factorised.
struct ModelForm {
  Kernel kernel = Kernel::matern52;
  MeanBasis mean = MeanBasis::constant;
  OutputScale scale = OutputScale::linear;
};
GaussianProcess condition(const TrainingSet& training, const ModelForm& form, const HyperParameters& hyper_parameters);

}  // namespace surrogate
