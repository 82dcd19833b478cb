#pragma once
// How far a surrogate may be trusted: leave-one-out, held-out folds and the diagnostics of L. S. Bastos & A. O'Hagan,
// "Diagnostics for Gaussian process emulators", Technometrics 51:425 (2009).
//
// Held-out: the distinct points are dealt into folds (replicates together); each fold is predicted by a process whose
// hyper-parameters are fitted again without it. With error e = z - mean and V its covariance (function, nugget and
// known noise):
//   standardised errors        e_i / sqrt(V_ii), flagged above 2 (eq. 9);
//   pivoted Cholesky errors    G^-1 e, P' V P = G G' pivoting on the largest remaining variance (section 4.2.2).
//                              They are uncorrelated. Large ones at the head point at the variance, large ones at the
//                              tail at the length scales;
//   Mahalanobis distance       D = e' V^-1 e; D / m ~ F(m, n - p) for m points held out of n training points.
// Deviation: they integrate the signal variance out with the reference prior; ours is a restricted-likelihood estimate,
// for which D / m has that F law if the correlation is known and there is no known noise, and nearly so otherwise.
//   Q2 = 1 - sum e^2 / sum (y - mean y)^2.   Attainable: 1 - noise variance / variance, what a perfect surrogate
//   reaches. Q2 of the function: 1 - (mean e^2 - noise) / (var y - noise), the noise of the held-out runs taken out.
// Noise here is the known noise; the nugget joins it only where five or more replicates show that it is scatter.
// All errors are on the process's own scale (log y on the log scale).
#include <array>
#include <limits>
#include <string>
#include <vector>

#include "surrogate/fit.hpp"

namespace surrogate {

/// The thresholds at which "good" ends and "caution" ends. All are printed in the report.
struct ValidationThresholds {
  double q2_good = 0.9;                ///< Q2 of the function, held out, at least
  double q2_unusable = 0.5;            ///< below this the surrogate says little about the model
  double coverage_probability = 0.01;  ///< binomial; coverage of the 95 % interval is wrong if it is less likely
  double coverage95_unusable = 0.7;
  double mahalanobis_probability = 0.01;  ///< over all folds (Bonferroni)
  double noise_dominated = 0.67;  ///< noise variance over variance: above, the runs hardly differ beyond their noise
  double negligible = 0.02;       ///< held-out reach below which careful intervals are no reason for caution
};

struct ValidationOptions {
  int folds = 5;
  std::uint64_t seed = 0;  ///< seed of the dealing into folds
  int suggestions = 3;     ///< points to run next
  ValidationThresholds thresholds;
};

enum class SurrogateVerdict { good, caution, unusable };

/// Fraction of runs inside the central intervals of the levels.
struct Coverage {
  static constexpr std::array<double, 3> levels{0.50, 0.90, 0.95};
  std::array<double, 3> observed{};
  double at95() const { return observed[2]; }
};

/// One fold that was predicted by the others.
struct HeldOutFold {
  std::vector<int> runs;           ///< indices into the training set
  Eigen::VectorXd pivoted_errors;  ///< in pivoting order
  std::vector<int> pivots;         ///< runs in pivoting order
  double mahalanobis = 0.0;
  int degrees = 0, remaining_degrees = 0;  ///< m and n - p of the F law
  double probability = 0.0;                ///< two-sided tail probability of the distance
  bool converged = false;
};

/// Whole levels of one input left out (levels.hpp).
struct LevelCheck {
  std::string input;        ///< by name
  int levels = 0;           ///< number of values that the input takes
  int predicted = 0;        ///< runs of inner levels that were predicted from the other levels; 0: there are none
  double q2 = 0.0;          ///< Q2 of these runs
  double coverage95 = 0.0;  ///< share of these runs inside their 95 % intervals
};

/// Two inputs that no run moves together (levels.hpp), by name.
struct ApartPair {
  std::string first, second;
};

/// The runs' stated errors compared with their scatter (noise_check.hpp).
struct NoiseCheck {
  double scatter_ratio = 0.0;   ///< nugget sd over the stated errors' root mean square
  double log_ratio = 0.0;       ///< 2 log of the likelihood ratio of nugget and none
  double residual_ratio = 1.0;  ///< residuals' squares in units of the stated errors, over their expected value
  double residual_z = 0.0;      ///< difference of the two in its own sd
  double noise_share = 0.0;     ///< tr(D P) / points: share of single runs' information that is noise
  bool replicated = false;      ///< five or more replicates show that the nugget is scatter, not structure

  bool understated() const { return scatter_ratio > 0.7 && log_ratio > 7.0; }
  /// Whether the errors are stated too large. Where the noise is small, the residuals say how smooth the output is and
  /// not how large the noise is.
  bool overstated() const { return residual_z < -2.5 && residual_ratio < 0.6 && noise_share > 0.5; }
};

struct Validation {
  int runs = 0;
  LeaveOneOut leave_one_out;
  Eigen::VectorXd held_out_mean;          ///< unit of y
  Eigen::VectorXd held_out_standardised;  ///< e_i / sqrt(V_ii)
  std::vector<HeldOutFold> folds;
  /// Largest error and largest predicted standard deviation of a held-out run, the larger of the two, in standard
  /// deviations of the runs' output. That of an exact code of a smooth response is next to nothing.
  double held_out_reach = std::numeric_limits<double>::infinity();
  double q2_leave_one_out = 0.0, q2_held_out = 0.0, q2_attainable = 0.0, q2_function = 0.0;
  Coverage coverage_leave_one_out, coverage_held_out;
  std::vector<LevelCheck> levels;  ///< inputs of few values
  std::vector<ApartPair> apart;    ///< inputs that no run moves together
  NoiseCheck noise;
  double mahalanobis_probability = 0.0;  ///< smallest of the folds times their number
  int large_errors = 0;                  ///< held-out standardised errors above 2 in size
  int large_pivoted_errors = 0;
  SurrogateVerdict verdict = SurrogateVerdict::unusable;
  std::string finding, consequence, remedy;
  int more_runs = 0;               ///< runs suggested by the learning curve; 0: none needed
  Eigen::MatrixXd next_points;     ///< where to make them: unit cube, one per row
  std::vector<std::string> notes;  ///< bounds, jitter, convergence of the fit itself
};

double q2(const Eigen::VectorXd& observed, const Eigen::VectorXd& predicted);
Coverage coverage(const Eigen::VectorXd& standardised);

/// Pivoted-Cholesky errors of e with covariance V.
struct PivotedErrors {
  Eigen::VectorXd errors;
  std::vector<int> order;
};
PivotedErrors pivoted_errors(const Eigen::VectorXd& error, const Eigen::MatrixXd& covariance);

/// Two-sided tail probability of D under D / m ~ F(m, remaining).
double mahalanobis_probability(double distance, int m, int remaining);

/// What a fit has to say about itself: bounds met, jitter, starts that disagree, non-convergence.
std::vector<std::string> fit_notes(const FitDiagnostics& diagnostics);

/// Points of the unit cube (inside the training box) where the function is least known, each given those before it.
Eigen::MatrixXd least_known_points(const GaussianProcess& process, int count, std::uint64_t seed);

/// Validates a process. A poor surrogate never makes it throw: the verdict says so.
Validation validate(const TrainingSet& training, const FitOptions& fit_options, const GaussianProcess& process,
                    const ValidationOptions& options = {});

}  // namespace surrogate
