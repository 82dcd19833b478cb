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
  for (Index i = 0; i < m; ++i)
    for (const double sign : {1.0, -1.0}) {
      const VectorXd u =
          (mode + sign * r * sd[i] * axes.eigenvectors().col(i)).cwiseMax(objective.low).cwiseMin(objective.high);
      const LikelihoodGradient there = evaluate(objective, u);
      if (!there.ok) continue;
      const VectorXd whitened = (axes.eigenvectors().transpose() * (u - mode)).cwiseQuotient(sd);
      nodes.push_back({u, 0.0});
      log_weights.push_back(-std::log(2.0 * static_cast<double>(m) * f * f) + there.value - at.value +
                            0.5 * whitened.squaredNorm());
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
