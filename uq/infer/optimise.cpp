#include "uq/infer/optimise.hpp"

#include <cmath>
#include <exception>
#include <nlopt.hpp>
#include <vector>

namespace uq {
namespace {

/// The function that NLopt calls. It makes the full point from the free coordinates, and keeps the best point.
struct Problem {
  const Differentiable& function;
  std::vector<int> free;
  Eigen::VectorXd x;
  Maximum best;
};

double call(const std::vector<double>& at, std::vector<double>& slope, void* data) {
  auto& problem = *static_cast<Problem*>(data);
  for (std::size_t i = 0; i < problem.free.size(); ++i) problem.x[problem.free[i]] = at[i];
  const Evaluation found = problem.function(problem.x);
  ++problem.best.evaluations;
  // NLopt wants numbers everywhere; a point where the function is nothing is only very bad.
  if (!std::isfinite(found.value)) {
    for (double& value : slope) value = 0.0;
    return -1e100;
  }
  for (std::size_t i = 0; i < slope.size(); ++i) {
    const double value = found.gradient[problem.free[i]];
    slope[i] = std::isfinite(value) ? value : 0.0;
  }
  if (found.value > problem.best.value) {
    problem.best.value = found.value;
    problem.best.x = problem.x;
  }
  return found.value;
}

}  // namespace

Maximum maximise(const Differentiable& function, const Box& box, const Eigen::MatrixXd& starts,
                 const std::vector<Held>& held) {
  const auto dimension = static_cast<int>(box.lower.size());
  Maximum best;
  int evaluations = 0;
  for (Eigen::Index row = 0; row < starts.rows(); ++row) {
    Problem problem{.function = function,
                    .free = {},
                    .x = starts.row(row).transpose().cwiseMax(box.lower).cwiseMin(box.upper),
                    .best = {}};
    std::vector<double> lower, upper, at;
    std::vector<bool> is_held(static_cast<std::size_t>(dimension), false);
    for (const Held& one : held) {
      problem.x[one.coordinate] = one.value;
      is_held[one.coordinate] = true;
    }
    for (int k = 0; k < dimension; ++k) {
      if (is_held[k]) continue;
      problem.free.push_back(k);
      lower.push_back(box.lower[k]);
      upper.push_back(box.upper[k]);
      at.push_back(problem.x[k]);
    }
    bool converged = true;
    if (problem.free.empty()) {
      std::vector<double> none;
      call(at, none, &problem);
    } else {
      nlopt::opt optimiser(nlopt::LD_SLSQP, static_cast<unsigned>(problem.free.size()));
      optimiser.set_lower_bounds(lower);
      optimiser.set_upper_bounds(upper);
      optimiser.set_max_objective(call, &problem);
      optimiser.set_ftol_abs(1e-7);
      optimiser.set_xtol_abs(1e-9);
      optimiser.set_maxeval(200);
      double value = 0.0;
      try {
        converged = optimiser.optimize(at, value) != nlopt::MAXEVAL_REACHED;
      } catch (const nlopt::roundoff_limited&) {
        // Stopped by rounding: as near as it comes.
      } catch (const std::exception&) {
        converged = false;
      }
    }
    evaluations += problem.best.evaluations;
    problem.best.converged = converged;
    if (problem.best.value > best.value) best = problem.best;
  }
  best.evaluations = evaluations;
  if (best.x.size() == 0 && starts.rows() > 0) best.x = starts.row(0).transpose();
  return best;
}

Differentiable with_differences(std::function<double(const Eigen::VectorXd&)> function, const Box& box) {
  return [function = std::move(function), box](const Eigen::VectorXd& x) -> Evaluation {
    Evaluation found{.value = function(x), .gradient = Eigen::VectorXd(x.size())};
    for (Eigen::Index k = 0; k < x.size(); ++k) {
      const double step = 1e-5 * (box.upper[k] - box.lower[k]);
      Eigen::VectorXd high = x, low = x;
      high[k] = std::min(x[k] + step, box.upper[k]);
      low[k] = std::max(x[k] - step, box.lower[k]);
      found.gradient[k] = (function(high) - function(low)) / (high[k] - low[k]);
    }
    return found;
  };
}

}  // namespace uq
