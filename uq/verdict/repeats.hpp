#pragma once
// The certainty of a verdict's word: what the words would be if the measurement were made again.
//
// Repeats are drawn from the posterior predictive, y' = m(u') + S^1/2 z, u' a draw, S the covariance of the data at the
// best fit. The case is not sampled again. About each point i of a profile's path the model is taken as linear in the
// other unknowns; with residual r = L^-1 (y' - m_i), slopes A = L^-1 dm/du, L L' = S_i and the priors' widths as weak
// springs P about the path,
//   deviance'_i = |r|^2 - p' (A' A + P)^-1 p + log |S_i| - 2 c_i,   p = A' r + dc_i/du    (less its least over i),
// c the log density of what calibrated the nuisances, such as a meter's gain: a path may lead far from it.
// From it come the open sides, the parts, and the contraction: 1 - contraction changes as the variance of
// prior x exp(-deviance' / 2) does. A hole that two of the surrogate's sds explain is none. What does not hang on the
// data's noise stays as found: influence, structure, a side that another parameter's range ends. An unknown at the end
// of its range on the path stays there.
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "uq/findings/parameter_results.hpp"
#include "uq/posterior/case_model.hpp"
#include "uq/verdict/profile.hpp"
#include "uq/verdict/verdict.hpp"

namespace uq {

struct RepeatOptions {
  int repeats = 200;
  int rows_max = 300;  ///< rows of data at most; with more, nothing is repeated
  std::uint64_t seed = 1;
};

/// The facts of one of the case's own parameters, as found, with the draws' share.
struct FoundFacts {
  WordFacts facts;
  const Profile* profile = nullptr;
};

/// The model about one point of a profile's path: the law of its rows, and how the other unknowns move it.
struct PathPoint {
  double u = 0.0;
  Eigen::VectorXd others;  ///< all unknowns there
  double log_prior = 0.0;  ///< of the profiled parameter, there
  double doubt = 0.0;      ///< the surrogate's doubt against the best fit, in data errors
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;  ///< without the noise
  Eigen::VectorXd noise;       ///< variances
  std::vector<LinkedErrors> linked_errors;
  Eigen::MatrixXd slopes;                ///< rows x the unknowns that can move
  Eigen::VectorXd precision;             ///< precisions of these unknowns' priors
  double log_certificates = 0.0;         ///< of what calibrated the nuisances, there
  Eigen::VectorXd pull_of_certificates;  ///< its slope along the unknowns that can move
  std::optional<int> at_end;             ///< another of the case's parameters that stands at the end of its range
};

/// Points that may matter: near enough to the best or beside such a point, and the two ends; all of them when `all`.
/// `judged`: the model whose data the doubt is measured in.
std::vector<PathPoint> path_points(const CaseModel& model, const CaseModel& judged, const Profile& profile,
                                   const Eigen::VectorXd& best, bool all = false);

/// Deviances and words along a path, for any data of some of the model's rows.
class PathWords {
 public:
  /// Prepares the points for some rows. `noise_share`: share of each row's noise variance, 1 / n for a mean of n
  /// readings.
  PathWords(const std::vector<PathPoint>& points, const std::vector<Eigen::Index>& rows,
            const Eigen::VectorXd& noise_share);
  bool usable() const { return points_.size() >= 3; }
  /// The deviances less their least, at the points where a covariance could be factored.
  Eigen::VectorXd deviances(const Eigen::VectorXd& y) const;
  /// Whether the interval's low and high end lie where another parameter's range ends, and not this one's data.
  std::pair<bool, bool> ends_by_another(const Eigen::VectorXd& deviance, double drop) const;
  /// Facts as found, with what hangs on the data's noise taken from `deviance`; `before`, `found_deviance`: those of
  /// the data as they were found.
  WordFacts facts(const FoundFacts& found, const PathWords& before, const Eigen::VectorXd& found_deviance,
                  const Eigen::VectorXd& deviance, const VerdictThresholds& thresholds) const;

 private:
  struct Local {
    double u = 0.0, log_prior = 0.0, doubt = 0.0;
    Eigen::VectorXd mean;
    Eigen::LLT<Eigen::MatrixXd> covariance;
    double log_determinant = 0.0;
    double log_certificates = 0.0;
    Eigen::VectorXd pull_of_certificates;
    Eigen::MatrixXd slopes;            ///< whitened
    Eigen::LLT<Eigen::MatrixXd> bent;  ///< A' A + P
    std::optional<int> at_end;
    Eigen::VectorXd others;
  };
  struct Parts {
    int count = 0;
    std::vector<std::size_t> of;  ///< for each point the part nearest to it
  };
  Parts parts(const Eigen::VectorXd& deviance, double drop, double least_mass) const;
  /// The best points of hills that are parts though they lie above the drop (hills.hpp).
  std::vector<bool> minor_hills(const Eigen::VectorXd& deviance, double drop, double least_mass) const;
  double variance(const Eigen::VectorXd& deviance, const Parts& parts, bool within) const;

  std::vector<Local> points_;
};

/// The words' probabilities of each parameter, the largest first; empty where there are too many rows.
std::vector<std::vector<WordProbability>> repeat_words(const CaseModel& model, const std::vector<FoundFacts>& found,
                                                       const Eigen::MatrixXd& draws, const Eigen::VectorXd& best,
                                                       const VerdictThresholds& thresholds,
                                                       const RepeatOptions& options);

}  // namespace uq
