#include "surrogate/maximise.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <nlopt.hpp>
#include <utility>
#include <vector>

namespace surrogate {
namespace {

using Eigen::Index;

constexpr double reach = 2.0;  // of one step, in logarithms: a factor of 7

/// Gradient without the components that push against a bound.
Eigen::VectorXd projected_gradient(const Objective& objective, const Eigen::VectorXd& u,
                                   const Eigen::VectorXd& gradient) {
  Eigen::VectorXd projected = gradient;
  for (Index j = 0; j < u.size(); ++j)
    if ((u[j] <= objective.low[j] && gradient[j] < 0.0) || (u[j] >= objective.high[j] && gradient[j] > 0.0))
      projected[j] = 0.0;
  return projected;
}

/// Maximiser of the quadratic model g's - 1/2 s'(I + damping D)s over the box and |s_j| <= reach: Newton step, then the
/// components that left the box are put on its faces and the rest solved again.
Eigen::VectorXd model_step(const Objective& objective, const Eigen::VectorXd& u, const Eigen::VectorXd& gradient,
                           const Eigen::MatrixXd& information, double damping) {
  const Index count = u.size();
  const Eigen::VectorXd low = (objective.low - u).cwiseMax(-reach), high = (objective.high - u).cwiseMin(reach);
  Eigen::MatrixXd curvature = information;
  curvature.diagonal() += damping * (information.diagonal().array() + 1e-3).matrix();
  curvature.diagonal().array() += 1e-12 * (1.0 + information.diagonal().maxCoeff());
  Eigen::VectorXd step = Eigen::VectorXd::Zero(count);
  std::vector<bool> fixed(static_cast<std::size_t>(count), false);
  for (Index j = 0; j < count; ++j)
    fixed[j] = (low[j] >= 0.0 && gradient[j] < 0.0) || (high[j] <= 0.0 && gradient[j] > 0.0);
  for (Index round = 0; round <= count; ++round) {
    std::vector<Index> free;
    for (Index j = 0; j < count; ++j)
      if (!fixed[j]) free.push_back(j);
    if (free.empty()) break;
    const Eigen::VectorXd right = (gradient - curvature * step)(free) + curvature(free, free) * step(free);
    const Eigen::VectorXd solution = Eigen::MatrixXd(curvature(free, free)).ldlt().solve(right);
    bool left_box = false;
    for (std::size_t i = 0; i < free.size(); ++i) {
      const Index j = free[i];
      step[j] = std::clamp(solution[i], low[j], high[j]);
      if (step[j] != solution[i]) fixed[j] = left_box = true;
    }
    if (!left_box) break;
  }
  return step;
}

/// What the quadratic model promises for the best step along one coordinate inside the box: a lower bound of what its
/// maximiser gains.
double best_single_gain(const Objective& objective, const Eigen::VectorXd& u, const Eigen::VectorXd& gradient,
                        const Eigen::MatrixXd& curvature) {
  double best = 0.0;
  for (Index j = 0; j < u.size(); ++j) {
    const double low = std::max(objective.low[j] - u[j], -reach), high = std::min(objective.high[j] - u[j], reach);
    const double step = std::clamp(gradient[j] / curvature(j, j), low, high);
    best = std::max(best, (gradient[j] - 0.5 * curvature(j, j) * step) * step);
  }
  return best;
}

/// The last pairs of step and gradient change: they turn the average information, which lacks the likelihood's second
/// derivatives that vanish in expectation only, into a curvature that has the secant property (BFGS updates of a matrix
/// that is new at every iterate: Nocedal & Wright, "Numerical Optimization", 2006, section 7.2).
class SecantPairs {
 public:
  explicit SecantPairs(Index most) : most_(static_cast<std::size_t>(most)) {}

  void add(const Eigen::VectorXd& step, const Eigen::VectorXd& change) {
    if (!(step.dot(change) > 1e-10 * step.norm() * change.norm())) return;  // not concave along the step
    if (pairs_.size() == most_) pairs_.erase(pairs_.begin());
    pairs_.emplace_back(step, change);
  }

  Eigen::MatrixXd correct(const Eigen::MatrixXd& information) const {
    Eigen::MatrixXd curvature = information;
    curvature.diagonal().array() += 1e-10 * (1.0 + information.diagonal().maxCoeff());
    for (const auto& [step, change] : pairs_) {
      const Eigen::VectorXd image = curvature * step;
      curvature += change * change.transpose() / step.dot(change) - image * image.transpose() / step.dot(image);
    }
    return curvature;
  }

 private:
  std::size_t most_;
  std::vector<std::pair<Eigen::VectorXd, Eigen::VectorXd>> pairs_;
};

}  // namespace

Objective make_objective(Likelihood& likelihood, const FitOptions& options) {
  const Index count = likelihood.parameters(), d = count - (options.nugget ? 2 : 1);
  Objective objective{likelihood, Eigen::VectorXd(count), Eigen::VectorXd(count), Eigen::VectorXd::Zero(count),
                      Eigen::VectorXd::Zero(count)};
  const auto set = [&](Index j, double low, double high, const LogNormalPrior& prior) {
    objective.low[j] = std::log(low);
    objective.high[j] = std::log(high);
    if (options.estimate == Estimate::maximum_likelihood) return;
    objective.prior_mean[j] = std::log(prior.median);
    objective.prior_precision[j] = 1.0 / (prior.log_sd * prior.log_sd);
  };
  const HyperBounds& bounds = options.bounds;
  for (Index k = 0; k < d; ++k) set(k, bounds.length_scale.low, bounds.length_scale.high, options.priors.length_scale);
  set(d, bounds.signal_sd.low * bounds.signal_sd.low, bounds.signal_sd.high * bounds.signal_sd.high,
      options.priors.signal_variance);
  if (options.nugget)
    set(d + 1, bounds.nugget_sd.low * bounds.nugget_sd.low, bounds.nugget_sd.high * bounds.nugget_sd.high,
        options.priors.nugget_variance);
  return objective;
}

LikelihoodGradient evaluate(const Objective& objective, const Eigen::VectorXd& u) {
  LikelihoodGradient result = objective.likelihood.evaluate(u);
  if (!result.ok) return result;
  const Eigen::VectorXd deviation = u - objective.prior_mean;
  const Eigen::VectorXd pull = objective.prior_precision.cwiseProduct(deviation);
  result.value -= 0.5 * pull.dot(deviation);
  result.gradient -= pull;
  result.information.diagonal() += objective.prior_precision;
  return result;
}

double evaluate_value(const Objective& objective, const Eigen::VectorXd& u) {
  const Factorised at = objective.likelihood.factorise(from_logs(u, objective.likelihood.nugget()));
  if (!at.ok) return -std::numeric_limits<double>::infinity();
  const Eigen::VectorXd deviation = u - objective.prior_mean;
  return at.log_likelihood - 0.5 * deviation.dot(objective.prior_precision.cwiseProduct(deviation));
}

StartOutcome maximise_lbfgs(const Objective& objective, const Eigen::VectorXd& start, const FitOptions& options) {
  StartOutcome outcome;
  outcome.start = outcome.end = start;
  outcome.objective = -std::numeric_limits<double>::infinity();
  struct Call {
    const Objective& objective;
    StartOutcome& outcome;
  } call{objective, outcome};
  nlopt::opt optimiser(nlopt::LD_LBFGS, static_cast<unsigned>(start.size()));
  optimiser.set_lower_bounds(std::vector<double>(objective.low.begin(), objective.low.end()));
  optimiser.set_upper_bounds(std::vector<double>(objective.high.begin(), objective.high.end()));
  optimiser.set_max_objective(
      [](unsigned count, const double* u, double* gradient, void* data) -> double {
        const Call& self = *static_cast<Call*>(data);
        const Eigen::VectorXd point = Eigen::Map<const Eigen::VectorXd>(u, count);
        const LikelihoodGradient at = evaluate(self.objective, point);
        ++self.outcome.evaluations;
        if (!at.ok) {  // worse than anything, without a direction: the line search comes back
          if (gradient) std::fill(gradient, gradient + count, 0.0);
          return -1e300;
        }
        if (gradient) Eigen::Map<Eigen::VectorXd>(gradient, count) = at.gradient;
        if (at.value > self.outcome.objective) {
          self.outcome.objective = at.value;
          self.outcome.end = point;
          self.outcome.gradient_norm = projected_gradient(self.objective, point, at.gradient).norm();
        }
        return at.value;
      },
      &call);
  optimiser.set_ftol_abs(0.1 * options.tolerance);
  optimiser.set_maxeval(400);
  std::vector<double> u(start.begin(), start.end());
  try {
    double value = 0.0;
    const nlopt::result status = optimiser.optimize(u, value);
    outcome.converged = status > 0 && status != nlopt::MAXEVAL_REACHED;
  } catch (const std::exception&) {  // NLopt reports a line search that stalls at the optimum as a failure
    outcome.converged = outcome.gradient_norm < 1e-3;
  }
  return outcome;
}

StartOutcome maximise(const Objective& objective, const Eigen::VectorXd& start, const FitOptions& options) {
  Eigen::VectorXd u = start.cwiseMax(objective.low).cwiseMin(objective.high);
  StartOutcome outcome;
  outcome.start = outcome.end = u;
  outcome.objective = -std::numeric_limits<double>::infinity();
  outcome.evaluations = 1;
  LikelihoodGradient at = evaluate(objective, u);
  if (!at.ok) return outcome;
  double damping = 1e-2, growth = 2.0;
  SecantPairs pairs(u.size());
  for (int iteration = 0; iteration < options.iterations; ++iteration) {
    const Eigen::MatrixXd curvature = pairs.correct(at.information);
    const Eigen::VectorXd step = model_step(objective, u, at.gradient, curvature, damping);
    const double expected = at.gradient.dot(step) - 0.5 * step.dot(curvature * step);
    if (expected < options.tolerance && damping <= 1.0) {
      if (best_single_gain(objective, u, at.gradient, curvature) < options.tolerance) {
        outcome.converged = true;
        break;
      }
      // The box cut the step to one that leads nowhere, while one coordinate alone would gain: shorten it.
      damping = std::max(damping, 1e-3) * growth;
      growth *= 2.0;
      continue;
    }
    const Eigen::VectorXd next_u = (u + step).cwiseMax(objective.low).cwiseMin(objective.high);
    LikelihoodGradient next = evaluate(objective, next_u);
    ++outcome.evaluations;
    const double gain = next.ok ? next.value - at.value : -std::numeric_limits<double>::infinity();
    const double ratio = gain / expected;
    if (next.ok) pairs.add(next_u - u, at.gradient - next.gradient);
    if (next.ok && ratio > 1e-3) {
      // Nielsen's damping: H. B. Nielsen, "Damping parameter in Marquardt's method" (1999).
      damping = std::max(1e-8, damping * std::max(1.0 / 3.0, 1.0 - std::pow(2.0 * ratio - 1.0, 3)));
      growth = 2.0;
      u = next_u;
      at = std::move(next);
    } else {
      damping = std::max(damping, 1e-3) * growth;
      growth *= 2.0;
      if (damping > 1e12) break;  // no ascent along the gradient to rounding
    }
  }
  outcome.end = u;
  outcome.objective = at.value;
  outcome.gradient_norm = projected_gradient(objective, u, at.gradient).norm();
  if (!outcome.converged) {
    const StartOutcome polished = maximise_lbfgs(objective, u, options);
    outcome.evaluations += polished.evaluations;
    outcome.converged = polished.converged;
    if (polished.objective >= outcome.objective) {
      outcome.end = polished.end;
      outcome.objective = polished.objective;
      outcome.gradient_norm = polished.gradient_norm;
    }
  }
  return outcome;
}

}  // namespace surrogate
