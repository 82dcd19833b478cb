#include "uq/emulate/scaled_runs.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <optional>

#include "data/time_series.hpp"

namespace uq {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Constant, linear and, where `bent`, quadratic terms of the inputs.
MatrixXd basis_of(const MatrixXd& x, bool bent) {
  const Index n = x.rows(), d = x.cols();
  MatrixXd basis(n, 1 + d + (bent ? d * (d + 1) / 2 : 0));
  basis.col(0).setOnes();
  basis.middleCols(1, d) = x;
  Index column = 1 + d;
  for (Index i = 0; bent && i < d; ++i)
    for (Index j = i; j < d; ++j) basis.col(column++) = x.col(i).cwiseProduct(x.col(j));
  return basis;
}

/// Residuals of the regression that minimises absolute errors, by reweighted least squares.
VectorXd least_absolute_residuals(const MatrixXd& basis, const VectorXd& z) {
  constexpr int rounds = 40;
  VectorXd residual = z.array() - data::median_of({z.begin(), z.end()});
  const double scale = std::max(residual.cwiseAbs().mean(), 1e-12);
  for (int round = 0; round < rounds; ++round) {
    const VectorXd weight = (residual.array().abs() + 1e-4 * scale).sqrt().inverse();
    const MatrixXd weighted = weight.asDiagonal() * basis;
    residual = z - basis * weighted.colPivHouseholderQr().solve(weight.cwiseProduct(z));
  }
  return residual;
}

double spread_of(const VectorXd& residual) { return data::spread_about({residual.begin(), residual.end()}, 0.0); }

/// The residuals' second heap, above 0: fewer than half of them, farther off than the others scatter and close
/// together.
std::vector<int> second_heap(const VectorXd& residual) {
  constexpr double apart = 6.0, tight = 0.25;  // in spreads of all; the heap's spread over its distance
  const double least = std::max(apart * spread_of(residual), 0.5 * residual.maxCoeff());
  std::vector<int> heap;
  std::vector<double> distance;
  for (int i = 0; i < residual.size(); ++i) {
    if (!(residual[i] > least)) continue;
    heap.push_back(i);
    distance.push_back(residual[i]);
  }
  const int size = static_cast<int>(heap.size());
  if (size < scaled_least || 2 * size >= residual.size()) return {};
  const double middle = data::median_of(distance);
  return data::spread_about(std::move(distance), middle) < tight * middle ? heap : std::vector<int>{};
}

}  // namespace

std::vector<int> scaled_runs(const surrogate::TrainingSet& training) {
  const VectorXd& y = training.y;
  if (y.size() == 0 || !(y.minCoeff() * y.maxCoeff() > 0.0)) return {};
  constexpr Index runs_per_term = 4;
  std::optional<VectorXd> residual;  // the sharper one: a large heap can draw the quadratic aside
  for (const bool bent : {true, false}) {
    const MatrixXd basis = basis_of(training.x, bent);
    if (y.size() < runs_per_term * basis.cols()) continue;
    const VectorXd found = least_absolute_residuals(basis, y.cwiseAbs().array().log());
    if (!residual || spread_of(found) < spread_of(*residual)) residual = found;
  }
  if (!residual) return {};
  std::vector<int> heap = second_heap(*residual);
  return heap.empty() ? second_heap(-*residual) : heap;
}

std::optional<CommonFactor> common_factor(const std::vector<double>& observed, const std::vector<double>& expected) {
  if (observed.empty()) return {};
  std::vector<double> factors;
  for (std::size_t i = 0; i < observed.size(); ++i) factors.push_back(observed[i] / expected[i]);
  const double middle = data::median_of(factors);
  constexpr double alike = 1.2, share = 0.75;
  const auto agreeing = std::count_if(factors.begin(), factors.end(), [&](double factor) {
    return factor > middle / alike && factor < middle * alike;
  });
  if (agreeing < scaled_least || static_cast<double>(agreeing) < share * static_cast<double>(factors.size())) return {};
  return CommonFactor{middle, static_cast<int>(agreeing)};
}

}  // namespace uq
