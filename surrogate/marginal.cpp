#include "surrogate/marginal.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace surrogate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Minus the Hessian of the objective at the mode, by differences of its gradient (one-sided next to a bound).
MatrixXd curvature_by_differences(const Objective& objective, const VectorXd& mode) {
  constexpr double step = 1e-3;
  const Index m = mode.size();
  MatrixXd curvature(m, m);
  for (Index j = 0; j < m; ++j) {
    VectorXd up = mode, down = mode;
    up[j] = std::min(mode[j] + step, objective.high[j]);
    down[j] = std::max(mode[j] - step, objective.low[j]);
    const LikelihoodGradient above = evaluate(objective, up), below = evaluate(objective, down);
    if (!above.ok || !below.ok) return {};
    curvature.col(j) = (below.gradient - above.gradient) / (up[j] - down[j]);
  }
  return 0.5 * (curvature + curvature.transpose());
}

/// The node on one half of an axis, where the density's own width there (not the normal approximation's) puts it.
struct HalfAxis {
  bool ok = false;
  VectorXd u;
  double value = 0.0;   ///< objective at u
  double width = 1.0;   ///< of the density on this half, in units of the normal approximation's sd
  double radius = 0.0;  ///< of u in units of that width; less than r where the box cut it
};

/// Stretches the half-axis until the objective has fallen by r^2 / 2 at distance r width.
HalfAxis stretch(const Objective& objective, const VectorXd& mode, const VectorXd& axis, double top, double r) {
  constexpr double widest = 4.0;
  // How far the box lets the half-axis go.
  double reach = widest * r;
  for (Index j = 0; j < mode.size(); ++j) {
    if (axis[j] > 0.0) reach = std::min(reach, (objective.high[j] - mode[j]) / axis[j]);
    if (axis[j] < 0.0) reach = std::min(reach, (objective.low[j] - mode[j]) / axis[j]);
  }
  HalfAxis half;
  if (!(reach > 1e-6)) return half;  // the mode is on this face: no mass beyond it
  for (int iteration = 0; iteration < 4; ++iteration) {
    const double distance = std::min(r * half.width, reach);
    const VectorXd u = mode + distance * axis;
    const LikelihoodGradient there = evaluate(objective, u);
    if (!there.ok) return half;
    half.ok = true;
    half.u = u;
    half.value = there.value;
    half.radius = distance / half.width;
    // The width whose normal density would have fallen as much at this distance.
    const double width =
        std::clamp(distance / std::sqrt(std::max(2.0 * (top - there.value), 1e-3)), 1.0 / widest, widest);
    if (std::abs(width / half.width - 1.0) < 0.05) break;
    if (iteration < 3) half.width = width;
  }
  return half;
}

}  // namespace

std::vector<HyperNode> integration_nodes(const Objective& objective, const VectorXd& mode) {
  constexpr double f = 1.1;
  const Index m = mode.size();
  const LikelihoodGradient at = evaluate(objective, mode);
  std::vector<HyperNode> nodes{{mode, 1.0}};
  if (!at.ok) return nodes;
  MatrixXd curvature = curvature_by_differences(objective, mode);
  Eigen::SelfAdjointEigenSolver<MatrixXd> axes;
  if (curvature.size() > 0) axes.compute(curvature);
  if (curvature.size() == 0 || axes.eigenvalues().minCoeff() <= 1e-2) axes.compute(at.information);
  // A direction that the data and the priors leave flatter than a factor of e^4 counts as e^4 wide.
  const VectorXd sd = axes.eigenvalues().cwiseMax(1.0 / 16.0).cwiseSqrt().cwiseInverse();

  const double r = f * std::sqrt(static_cast<double>(m));
  nodes[0].weight = 1.0 - 1.0 / (f * f);
  std::vector<double> log_weights{std::log(nodes[0].weight)};
  for (Index i = 0; i < m; ++i) {
    const VectorXd axis = sd[i] * axes.eigenvectors().col(i);
    const HalfAxis up = stretch(objective, mode, axis, at.value, r),
                   down = stretch(objective, mode, -axis, at.value, r);
    for (const HalfAxis& half : {up, down}) {
      if (!half.ok) continue;
      nodes.push_back({half.u, 0.0});
      // Each half-axis carries mass in proportion to its width; then density over normal density at the node.
      log_weights.push_back(std::log(half.width / (up.width + down.width)) - std::log(static_cast<double>(m) * f * f) +
                            half.value - at.value + 0.5 * half.radius * half.radius);
    }
  }
  const double top = *std::max_element(log_weights.begin(), log_weights.end());
  double sum = 0.0;
  for (const double w : log_weights) sum += std::exp(w - top);
  for (std::size_t i = 0; i < nodes.size(); ++i) nodes[i].weight = std::exp(log_weights[i] - top) / sum;
  // The mode stays, whatever its weight: it is the best setting that is reported.
  double kept = 0.0;
  std::vector<HyperNode> result;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    if (i == 0 || nodes[i].weight > 1e-6) {
      kept += nodes[i].weight;
      result.push_back(nodes[i]);
    }
  for (HyperNode& node : result) node.weight /= kept;
  return result;
}

}  // namespace surrogate
