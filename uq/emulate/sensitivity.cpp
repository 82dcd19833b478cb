#include "uq/emulate/sensitivity.hpp"

#include <gsl/gsl_integration.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <memory>

#include "data/random.hpp"

namespace uq {
namespace {

/// A tensor grid over the unit cube; the last input varies fastest.
struct Grid {
  int inputs = 0, nodes = 0;
  Eigen::VectorXd node, node_weight;  ///< nodes and weights of one input
  Eigen::MatrixXd points;             ///< one per row
  Eigen::VectorXd weight;             ///< weights of the points; they add up to one

  int coordinate(Eigen::Index point, int input) const {
    for (int k = inputs - 1; k > input; --k) point /= nodes;
    return static_cast<int>(point % nodes);
  }
};

Grid make_grid(int inputs, const SensitivityOptions& options) {
  Grid grid{.inputs = inputs};
  const double each = std::pow(static_cast<double>(options.points_max), 1.0 / inputs);
  grid.nodes = std::clamp(static_cast<int>(each), 3, options.nodes_max);
  const std::unique_ptr<gsl_integration_glfixed_table, void (*)(gsl_integration_glfixed_table*)> table(
      gsl_integration_glfixed_table_alloc(static_cast<std::size_t>(grid.nodes)), gsl_integration_glfixed_table_free);
  grid.node.resize(grid.nodes);
  grid.node_weight.resize(grid.nodes);
  for (int i = 0; i < grid.nodes; ++i)
    gsl_integration_glfixed_point(0.0, 1.0, static_cast<std::size_t>(i), &grid.node[i], &grid.node_weight[i],
                                  table.get());
  Eigen::Index points = 1;
  for (int k = 0; k < inputs; ++k) points *= grid.nodes;
  grid.points.resize(points, inputs);
  grid.weight.setOnes(points);
  for (Eigen::Index p = 0; p < points; ++p)
    for (int k = 0; k < inputs; ++k) {
      const int i = grid.coordinate(p, k);
      grid.points(p, k) = grid.node[i];
      grid.weight[p] *= grid.node_weight[i];
    }
  return grid;
}

/// First and total index of each input for one response on the grid.
struct Shares {
  Eigen::VectorXd first, total;
};

Shares shares(const Grid& grid, const Eigen::VectorXd& response) {
  const double mean = grid.weight.dot(response);
  const Eigen::VectorXd f = response.array() - mean;
  const double variance = grid.weight.dot(f.cwiseAbs2());
  Shares result{Eigen::VectorXd::Zero(grid.inputs), Eigen::VectorXd::Zero(grid.inputs)};
  if (!(variance > 0.0)) return result;
  Eigen::Index stride = 1;
  for (int k = grid.inputs - 1; k >= 0; --k, stride *= grid.nodes) {
    Eigen::VectorXd given = Eigen::VectorXd::Zero(grid.nodes);  // E[f | x_k], times the weight of the node
    double without = 0.0;                                       // Var(E[f | x_~k])
    for (Eigen::Index p = 0; p < f.size(); ++p) {
      given[grid.coordinate(p, k)] += grid.weight[p] * f[p];
      if (grid.coordinate(p, k) != 0) continue;
      double average = 0.0;
      for (int i = 0; i < grid.nodes; ++i) average += grid.node_weight[i] * f[p + i * stride];
      without += grid.weight[p] / grid.node_weight[0] * average * average;
    }
    result.first[k] = given.cwiseAbs2().cwiseQuotient(grid.node_weight).sum() / variance;
    result.total[k] = 1.0 - without / variance;
  }
  return result;
}

}  // namespace

std::vector<SobolIndex> sobol_indices(const std::function<surrogate::Prediction(const Eigen::MatrixXd&)>& predict,
                                      int inputs, const SensitivityOptions& options) {
  if (inputs < 1 || inputs > sensitivity_inputs_max) return {};
  const Grid grid = make_grid(inputs, options);
  const surrogate::Prediction response = predict(grid.points);
  const double scale = response.covariance.diagonal().maxCoeff();
  const double spread = grid.weight.dot((response.mean.array() - grid.weight.dot(response.mean)).square().matrix());
  const double rounding = 1e-12 * response.mean.cwiseAbs().maxCoeff();
  if (!(spread + scale > rounding * rounding)) return {};
  Eigen::MatrixXd covariance = response.covariance;
  covariance.diagonal().array() += 1e-10 * std::max(scale, spread);  // of the rounding of a nearly singular matrix
  const Eigen::LLT<Eigen::MatrixXd> root(covariance);
  if (root.info() != Eigen::Success) return {};

  data::RandomStream random(options.seed, data::Purpose::sobol);
  Eigen::MatrixXd first(inputs, options.draws), total(inputs, options.draws);
  for (int draw = 0; draw < options.draws; ++draw) {
    Eigen::VectorXd z(response.mean.size());
    for (double& value : z) value = random.normal();
    const Eigen::VectorXd f = response.mean + root.matrixL() * z;
    const Shares one = shares(grid, f);
    first.col(draw) = one.first;
    total.col(draw) = one.total;
  }
  std::vector<SobolIndex> indices(static_cast<std::size_t>(inputs));
  for (int k = 0; k < inputs; ++k) {
    SobolIndex& index = indices[k];
    const auto sd = [](const auto& row) { return std::sqrt((row.array() - row.mean()).square().mean()); };
    index = {.first = first.row(k).mean(),
             .first_sd = sd(first.row(k)),
             .total = total.row(k).mean(),
             .total_sd = sd(total.row(k))};
  }
  return indices;
}

}  // namespace uq
