#pragma once
// Hyper-parameters from the data: maximum marginal likelihood, or its maximum a posteriori under stated priors, over
// u = (log l_1 ... log l_d, log s^2, log g) of the standardised output, inside bounds, from several starts.
//
// Priors (maximum a posteriori): each u_j is normal with the mean and sd below; they are weak, and keep a process with
// few runs from claiming that an input has no influence or that there is no run-to-run scatter.
//
// The maximiser is a damped Newton method on the average information matrix (likelihood.hpp) with the bounds as an
// active set; where it does not converge, NLopt's L-BFGS (D. C. Liu & J. Nocedal, Math. Programming 45:503 (1989)) goes
// on from its last point. Starts are a heuristic one, then scrambled Sobol points of the box of `StartBox`; the same
// seed gives the same fit.
#include <cstdint>

#include "surrogate/gaussian_process.hpp"

namespace surrogate {

enum class Estimate { maximum_likelihood, maximum_a_posteriori };

/// How hyper-parameters enter predictions: plugged in at the best setting, or integrated over (marginal.hpp;
/// predictions cost up to 33 times as much), or integrated over only where there are fewer than `enough_points`
/// distinct points per input that changes.
enum class HyperUncertainty { plug_in, integrated, integrated_if_few };

/// Number of distinct points per input below which settings plugged in give errors too small by 1.1 to 1.3
/// (COVERAGE.md).
constexpr int enough_points = 5;

/// What is predicted where no run speaks for an input: the process alone, or the process with what gaps.hpp adds.
enum class BetweenRuns { trusted, doubted };

/// Normal density of the logarithm of a hyper-parameter.
struct LogNormalPrior {
  double median = 1.0;
  double log_sd = 1.0;
};

struct HyperPriors {
  LogNormalPrior length_scale{1.0, 1.5};      ///< unit cube
  LogNormalPrior signal_variance{1.0, 3.0};   ///< in units of the data's variance
  LogNormalPrior nugget_variance{1e-3, 3.0};  ///< in units of the data's variance
};

struct Range {
  double low, high;
};

struct HyperBounds {
  Range length_scale{0.02, 50.0};  ///< unit cube
  Range signal_sd{1e-2, 300.0};    ///< in units of the data's sd
  Range nugget_sd{1e-5, 3.0};      ///< in units of the data's sd
};

struct FitOptions {
  Kernel kernel = Kernel::matern52;
  MeanBasis mean = MeanBasis::constant;
  OutputScale scale = OutputScale::linear;
  bool nugget = true;  ///< run-to-run scatter beyond the known noise
  int starts = 8;
  std::uint64_t seed = 0;
  Estimate estimate = Estimate::maximum_a_posteriori;
  HyperPriors priors;
  HyperBounds bounds;
  int iterations = 60;      ///< iterations of Newton's method, per start
  double tolerance = 1e-5;  ///< stop when the next step would raise the log likelihood by less
  HyperUncertainty hyper_uncertainty = HyperUncertainty::plug_in;
  BetweenRuns between_runs = BetweenRuns::trusted;
  int hyper_points = 1000;      ///< hyper-parameters are fitted to at most so many points, a random subset of all; the
                                ///< process is conditioned on all of them
  Eigen::VectorXd first_start;  ///< replaces the heuristic start, logs as in StartOutcome; empty: heuristic
};

/// The same options for a fit that only judges the data, such as whether a run is wrong: two starts, and the best
/// setting alone.
FitOptions quick(FitOptions options);

/// Fits a process. Throws data::InputError (65) for data that cannot train one; a fit that does not converge is in
/// diagnostics().
GaussianProcess fit(const TrainingSet& training, const FitOptions& options = {});

}  // namespace surrogate

template <>
inline constexpr std::array data::texts_of<surrogate::Estimate> = {"maximum likelihood", "maximum a posteriori"};
template <>
inline constexpr std::array data::texts_of<surrogate::HyperUncertainty> = {"plugged in", "integrated",
                                                                           "integrated if few"};
template <>
inline constexpr std::array data::texts_of<surrogate::BetweenRuns> = {"trusted", "doubted"};
