#include "surrogate/fit.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "data/error.hpp"
#include "surrogate/design.hpp"
#include "surrogate/maximise.hpp"

namespace surrogate {
namespace {

using Eigen::Index;

/// Where the starts lie: an ordinary process of standardised data.
struct StartBox {
  Range length_scale{0.15, 4.0};     ///< unit cube
  Range signal_variance{0.3, 10.0};  ///< of z
  Range nugget_variance{1e-6, 0.1};  ///< of z
};

std::vector<Eigen::VectorXd> make_starts(int d, const FitOptions& options) {
  const int count = d + (options.nugget ? 2 : 1);
  const StartBox box;
  std::vector<Eigen::VectorXd> starts;
  ScaledParameters first;
  first.length_scales = Eigen::VectorXd::Constant(d, 0.5 * std::sqrt(static_cast<double>(std::max(d, 1))));
  first.signal_variance = 1.0;
  first.nugget_variance = 1e-3;
  starts.push_back(to_logs(first, options.nugget));
  if (options.starts <= 1) return starts;
  const Eigen::MatrixXd cube = scrambled_sobol(options.starts - 1, std::min(count, sobol_max_dimension), options.seed);
  for (Index i = 0; i < cube.rows(); ++i) {
    Eigen::VectorXd u(count);
    for (int j = 0; j < count; ++j) {
      const Range range = j < d ? box.length_scale : (j == d ? box.signal_variance : box.nugget_variance);
      const double t = cube(i, j % sobol_max_dimension);
      u[j] = std::log(range.low) + t * std::log(range.high / range.low);
    }
    starts.push_back(u);
  }
  return starts;
}

std::vector<BoundHit> find_bound_hits(const Objective& objective, const Eigen::VectorXd& u, const Standardised& data) {
  std::vector<BoundHit> hits;
  const auto d = static_cast<Index>(data.active.size());
  for (Index j = 0; j < u.size(); ++j) {
    const bool at_low = u[j]<objective.low[j] + 1e-3, at_high = u[j]> objective.high[j] - 1e-3;
    if (!at_low && !at_high) continue;
    BoundHit hit;
    hit.upper = at_high;
    hit.parameter =
        j < d ? fmt::format("length scale of input {}", data.active[j] + 1) : (j == d ? "signal" : "nugget");
    hit.value = std::exp((at_high ? objective.high[j] : objective.low[j]) * (j < d ? 1.0 : 0.5));
    hit.harmless = (j < d && at_high) || (j == d + 1 && at_low);
    hits.push_back(hit);
  }
  return hits;
}

}  // namespace

GaussianProcess fit(const TrainingSet& training, const FitOptions& options) {
  Standardised data = standardise(training, options.scale, centre_of(options.mean));
  const int d = static_cast<int>(data.active.size()), p = basis_size(options.mean, d);
  if (data.points.rows() <= p)
    throw data::InputError(data::ExitStatus::bad_data,
                           {"training set of the surrogate",
                            fmt::format("{} distinct points cannot fit a {} mean of {} coefficients",
                                        data.points.rows(), to_text(options.mean), p),
                            "add runs, or use a simpler mean"});
  Likelihood likelihood(data, options.kernel, options.mean, options.nugget);
  const Objective objective = make_objective(likelihood, options);

  FitDiagnostics diagnostics;
  for (const Eigen::VectorXd& start : make_starts(d, options))
    diagnostics.starts.push_back(maximise(objective, start, options));
  const StartOutcome& best = *std::max_element(diagnostics.starts.begin(), diagnostics.starts.end(),
                                               [](const auto& a, const auto& b) { return a.objective < b.objective; });
  diagnostics.converged = best.converged;
  diagnostics.agreeing_starts = static_cast<int>(
      std::count_if(diagnostics.starts.begin(), diagnostics.starts.end(),
                    [&](const StartOutcome& outcome) { return outcome.objective > best.objective - 0.1; }));
  diagnostics.bound_hits = find_bound_hits(objective, best.end, data);

  Conditioned part;
  part.parameters = from_logs(best.end, options.nugget);
  part.factorised = likelihood.factorise(part.parameters);
  if (!part.factorised.ok)
    throw data::InputError(data::ExitStatus::bad_data,
                           {"surrogate", "the covariance of the training runs cannot be factorised even with jitter",
                            "give the runs their standard errors, or use a process with a nugget"});
  part.scaled_points = data.points * part.parameters.length_scales.cwiseInverse().asDiagonal();
  diagnostics.jitter = part.factorised.jitter;
  return {options.kernel, options.mean, options.nugget, std::move(data), {std::move(part)}, std::move(diagnostics)};
}

}  // namespace surrogate
