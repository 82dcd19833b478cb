#pragma once
// Log marginal likelihood of the hyper-parameters of a Gaussian process, with its gradient and an information matrix.
//
//   z = h(x)' beta + f(x) + nugget + noise,   f ~ GP(0, s^2 c(r)),   flat prior on beta;
//   K = s^2 C + diag(v),  v from pooling (training.hpp),  p = number of mean coefficients, n = number of points:
//   l = -1/2 m' P m - 1/2 log|K| - 1/2 log|H' K^-1 H| - (n - p)/2 log(2 pi) + E
//   P = K^-1 - K^-1 H (H' K^-1 H)^-1 H' K^-1
// (restricted likelihood: Harville, JASA 72:320 (1977); Rasmussen & Williams 2006, eq. 2.45). With p = 0 it is the
// plain marginal likelihood. Coefficients with a prior N(0, B) (mean_basis.hpp) enter as H' K^-1 H + B^-1 in place of
// H' K^-1 H, with -1/2 log|B|, and p counts the flat ones. Parameters are logarithms: u = (log l_1 ... log l_d, log
// s^2, log g).
//   dl/du_j = 1/2 a' K_j a - 1/2 tr(P K_j),   a = P m,   K_j = dK/du_j
//   information  I_jk = 1/2 a' K_j P K_k a  (average of the observed and expected information: Gilmour, Thompson &
//   Cullis, Biometrics 51:1440 (1995)): it costs n^2 where the expected one costs n^3.
// For the nugget, m depends on g too where runs are pooled; a' K_j a etc. then carry dm/du (see likelihood.cpp).
#include <Eigen/Core>
#include <vector>

#include "surrogate/kernel.hpp"
#include "surrogate/mean_basis.hpp"
#include "surrogate/training.hpp"

namespace surrogate {

/// Where z is zero for a mean function. A process with zero mean is one of g(y) itself; any other basis has a constant
/// and may be shifted.
inline Centre centre_of(MeanBasis mean) { return mean == MeanBasis::zero ? Centre::zero : Centre::data_mean; }

/// Hyper-parameters of z over the active inputs, as variances and lengths (not logarithms).
struct ScaledParameters {
  Eigen::VectorXd length_scales;  ///< active inputs, units of the unit cube
  double signal_variance = 1.0;   ///< variance of z
  double nugget_variance = 0.0;   ///< variance of z; run-to-run scatter beyond the known noise
};

/// The logarithms u of the file's head; the nugget is left out where there is none.
Eigen::VectorXd to_logs(const ScaledParameters& parameters, bool nugget);
ScaledParameters from_logs(const Eigen::VectorXd& u, bool nugget);

/// A factorised covariance matrix and what is needed to predict and to differentiate.
struct Factorised {
  bool ok = false;
  double jitter = 0.0;          ///< variance of z added to the diagonal of K to factorise it
  double log_likelihood = 0.0;  ///< of z
  Pooled pooled;
  Eigen::MatrixXd inverse_factor;     ///< L^-1, lower
  Eigen::VectorXd residual_weights;   ///< a = P m
  Eigen::VectorXd mean_coefficients;  ///< beta
  Eigen::MatrixXd whitened_basis;     ///< L^-1 H
  Eigen::MatrixXd basis_factor;       ///< R^-1, lower, with R R' = H' K^-1 H
};

struct LikelihoodGradient {
  bool ok = false;
  double jitter = 0.0;
  double value = 0.0;
  Eigen::VectorXd gradient;
  Eigen::MatrixXd information;
};

/// The likelihood of one training set, with scratch space that is kept between calls (so: one thread at a time).
class Likelihood {
 public:
  Likelihood(const Standardised& data, Kernel kernel, MeanBasis mean, bool nugget);

  int parameters() const { return static_cast<int>(data_.points.cols()) + (nugget_ ? 2 : 1); }
  bool nugget() const { return nugget_; }
  Factorised factorise(const ScaledParameters& parameters);
  /// The factorisation after one more point, which is the last of the data, from the one before (add_run.cpp).
  Factorised border(const Factorised& old, const ScaledParameters& parameters);
  LikelihoodGradient evaluate(const Eigen::VectorXd& u);

 private:
  void complete(Factorised& result) const;
  bool build(const ScaledParameters& parameters, const Eigen::VectorXd& variance, bool slopes);

  Standardised data_;
  Kernel kernel_;
  MeanBasis mean_;
  bool nugget_;
  Eigen::MatrixXd basis_;
  Eigen::VectorXd precision_;  // prior precision of the mean's coefficients
  Eigen::MatrixXd matrix_;     // K, then L, L^-1, K^-1 (lower)
  Eigen::MatrixXd slope_;      // s^2 f (lower)
  Eigen::MatrixXd scaled_;     // points / length scales
  Eigen::ArrayXd square_;
  double jitter_ = 0.0;
};

}  // namespace surrogate
