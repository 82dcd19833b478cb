// Gauss-Newton steps within a box, damped as by Levenberg and Marquardt (J. Nocedal, S. J. Wright, "Numerical
// Optimization", 2006, section 10.3): with g the gradient, J the slopes of the data's means, S their covariance and P
// the precision of what is known of the nuisances,
//   (J' S^-1 J + P + damping diag) step = g,      promised gain = g' step / 2.
// Unknowns at an end of their range that g would push beyond it stay there.
#include <algorithm>
#include <cmath>

#include "uq/posterior/curvature.hpp"
#include "uq/posterior/posterior.hpp"
#include "uq/verdict/profile.hpp"

namespace uq {
namespace {

constexpr int steps_most = 40;
constexpr double least_gain = 1e-3;  // log likelihood

/// Unknowns that may move: not held, and not at an end that the gradient points beyond.
std::vector<Eigen::Index> movable(const Box& box, const Maximum& at, const Eigen::VectorXd& gradient,
                                  const std::vector<Held>& held) {
  std::vector<Eigen::Index> found;
  for (Eigen::Index s = 0; s < at.x.size(); ++s) {
    const double slack = 1e-9 * (box.upper[s] - box.lower[s]);
    const bool is_held =
        std::any_of(held.begin(), held.end(), [&](const Held& one) { return one.coordinate == static_cast<int>(s); });
    const bool beyond = gradient[s] > 0.0 ? at.x[s] >= box.upper[s] - slack : at.x[s] <= box.lower[s] + slack;
    if (!is_held && !beyond) found.push_back(s);
  }
  return found;
}

/// Goes on from `at` while a step promises more than `least_gain`.
void climb_on(const CaseModel& model, const Box& box, const std::vector<Held>& held, Maximum& at) {
  const Differentiable likelihood = profiled(model);
  double damping = 0.0;
  for (int step = 0; step < steps_most; ++step) {
    const Eigen::VectorXd gradient = likelihood(at.x).gradient;
    const std::vector<Eigen::Index> free = movable(box, at, gradient, held);
    if (free.empty() || !gradient.allFinite()) return;
    const Eigen::VectorXd slope = gradient(free);
    const std::optional<Eigen::MatrixXd> curved = curvature(model, at.x, KnownBeside::nuisances);
    if (!curved) return;
    const Eigen::MatrixXd bend = (*curved)(free, free);
    bool moved = false;
    for (int attempt = 0; attempt < 8 && !moved; ++attempt) {
      Eigen::MatrixXd damped = bend;
      damped.diagonal() += damping * bend.diagonal();
      damped.diagonal().array() += 1e-12 * std::max(bend.diagonal().maxCoeff(), 1e-300);
      const Eigen::VectorXd move = damped.ldlt().solve(slope);
      if (!move.allFinite() || 0.5 * slope.dot(move) < least_gain) return;
      Eigen::VectorXd x = at.x;
      for (std::size_t i = 0; i < free.size(); ++i) x[free[i]] += move[i];
      x = x.cwiseMax(box.lower).cwiseMin(box.upper);
      for (const Held& one : held) x[one.coordinate] = one.value;
      const double value = log_likelihood(model, x) + log_certificates(model, x).value;
      ++at.evaluations;
      if (value > at.value + 1e-6) {
        at.x = x;
        at.value = value;
        damping = 0.1 * damping < 1e-6 ? 0.0 : 0.1 * damping;
        moved = true;
      } else {
        damping = std::max(10.0 * damping, 1e-4);
      }
    }
    if (!moved) return;
  }
}

}  // namespace

Maximum maximise_profiled(const CaseModel& model, const Box& box, const Eigen::MatrixXd& starts,
                          const std::vector<Held>& held) {
  Maximum best;
  for (Eigen::Index i = 0; i < starts.rows(); ++i) {
    Maximum one = maximise(profiled(model), box, starts.row(i), held);
    if (std::isfinite(one.value)) climb_on(model, box, held, one);
    if (i == 0 || one.value > best.value) best = std::move(one);
  }
  return best;
}

}  // namespace uq
