#pragma once
// The run that sharpens a posterior most, by the expected integrated variance of the posterior density (O. Surer, M.
// Plumlee,
// S. M. Wild, "Sequential Bayesian experimental design for calibration of expensive simulation models", Technometrics
// 66:157 (2024), arXiv 2305.16506), of a batch, with replicates among the candidates (O. Surer, arXiv 2505.03990).
//
// The density is uncertain because the surrogate is. At an unknown theta, let the surrogate's d values at the measured
// points be N(m, S), their measurement errors N(0, E), V = E + S, and r = y - m. With pi(theta) the prior, the density
// p = pi N(y; f, E), not normalised, has over the surrogate's law
//   mean           E p   = pi N(y; m, V)
//   mean square    E p^2 = pi^2 |4 Pi E|^(-1/2) N(y; m, E/2 + S)
// A batch of runs will take Phi from S, and move m by N(0, Phi). Over the values that it may give,
//   E (E p after)^2 = pi^2 |4 Pi (V - Phi)|^(-1/2) N(y; m, (V + Phi)/2)
//                   = (E p)^2 |I - A^2|^(-1/2) exp(r' V^-1 r - r' (V + Phi)^-1 r),   A = V^(-1/2) Phi V^(-1/2)
// and E p^2 stays what it was, so what the batch takes from the integrated variance is expected to be
//   reduction = integral (E (E p after)^2 - (E p)^2) dtheta,
// and minimising the expected integrated variance is maximising it. `reductions` gives it as a share of
// integral E p^2 dtheta, so that cases can be compared and added up; 1 minus the share that is known is `variance`.
//
// A run more. A run at x has the covariance b with the d values (times the meter's factors) and, its own noise
// included, the variance s^2: Phi gains b b' / s^2. With q- = b' (V - Phi)^-1 b / s^2, q+ = b' (V + Phi)^-1 b / s^2 and
// t = b' (V + Phi)^-1 r / s, the mean square of E p after gains the factor
//   (1 - q-)^(-1/2) (1 + q+)^(-1/2) exp(t^2 / (1 + q+)),
// one triangular product for each candidate. Once a run is picked, the covariances of what is left are those given it:
// b -= c_run b_run / s_run^2, whatever its outcome. The factors of the outputs that one run gives are multiplied, since
// surrogates of different outputs are independent. A replicate is a candidate at a point that has runs: it pays where
// noise, not distance, keeps S up. Reference points theta stand for the integral (reference_points).
#include <Eigen/Dense>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "uq/posterior/case_model.hpp"

namespace uq {

/// A run that could be made: the material, and what it sets, on the surrogates' scales.
struct RunPoint {
  std::string material;
  Eigen::VectorXd parameters;  ///< uq/posterior/prior.hpp's u, in the order of Study::parameters
  Eigen::VectorXd controls;    ///< by their range, in the order of Study::controls
};

/// The emulator's inputs at the points, one row each.
Eigen::MatrixXd emulator_points(const Emulator& emulator, const std::vector<RunPoint>& points);

/// The scatter of a run's value about the surrogate's function: the variance is absolute + relative * mean^2.
struct RunNoise {
  double absolute = 0.0;  ///< SI^2 of the output
  double relative = 0.0;
};

/// Points that stand for an integral over the unknowns: sum exp(log_weight) f(u) / points.
struct ReferencePoints {
  Eigen::MatrixXd u;
  Eigen::VectorXd log_weight;  ///< minus log density of the points
};

struct ReferenceOptions {
  int draws = 256;  ///< draws of the posterior
  int prior = 256;  ///< scrambled Sobol points of the prior: where the posterior may yet turn out to be
  std::uint64_t seed = 0;
};

/// Draws of the posterior (rows in u) and points of the prior, weighted as one sample from the mixture of both (the
/// balance heuristic: A. Owen & Y. Zhou, J. Am. Stat. Assoc. 95:135 (2000)). `log_evidence` is that of the draws; NaN:
/// estimated by the prior's points.
ReferencePoints reference_points(const CaseModel& model, const Eigen::MatrixXd& draws, double log_evidence,
                                 const ReferenceOptions& options);

/// The integrated variance of one case's posterior density, and what candidates would take from it.
class IntegratedVariance {
 public:
  /// Starts without any run added. `noise`: noise of a run, per group of the model.
  IntegratedVariance(const CaseModel& model, const ReferencePoints& reference, const std::vector<RunPoint>& candidates,
                     const std::vector<RunNoise>& noise);

  /// Expected reduction by each candidate beside the candidates already added; share of integral E p^2.
  Eigen::VectorXd reductions() const;
  /// Expected integrated variance after the candidates already added; share of integral E p^2, 0 to 1.
  double variance() const;
  /// Adds a run at this candidate: it is counted on from now on.
  void add(int candidate);

 private:
  struct Group {
    std::vector<int> members;  ///< candidates that give a value of this group's output
    Eigen::MatrixXd cross;     ///< (points x rows) x members, covariance of readings with the runs' values
    Eigen::MatrixXd between;   ///< members x members, covariance of the runs' latent values
    Eigen::VectorXd noise;     ///< variance of each run's own scatter
    std::vector<Eigen::MatrixXd> less, more;  ///< V - Phi, V + Phi at each point
    Eigen::MatrixXd residual;                 ///< rows x points
  };
  /// Log of the factor by which a run at each member raises the mean square of E p, at every point.
  Eigen::MatrixXd log_factors(const Group& group, const std::vector<int>& members) const;

  int candidates_ = 0;
  std::vector<Group> groups_;
  Eigen::VectorXd log_square_;  ///< log of weight times E (E p after)^2 at each point
  double log_total_ = 0.0;      ///< log of integral E p^2
};

}  // namespace uq
