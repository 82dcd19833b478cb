#pragma once
// Mean functions of a Gaussian process, m(x) = h(x)' beta, of the active inputs centred in the unit cube, t = x - 1/2:
//   zero       none: the process has zero mean in the units of y, or of log y
//   constant   1
//   linear     1, t_k
//   quadratic  1, t_k, t_j t_k (j <= k)
//   trend      as quadratic, with a prior
// The coefficients are integrated out (generalised least squares, restricted likelihood). Their prior is flat, but for
// the trend: its constant is flat, the others are N(0, trend_sd^2) in units of the output's standard deviation. With a
// proper prior few runs, or few levels of an input, may have as many coefficients as they like, and what the runs leave
// open of them widens the prediction.
#include <Eigen/Core>

#include "data/texts.hpp"

namespace surrogate {

enum class MeanBasis { zero, constant, linear, quadratic, trend };
using data::to_text;

/// Prior sd of a trend's coefficients: an input may well move the output by twice its standard deviation from one end
/// of its range to the other, and bend by a quarter of that.
constexpr double trend_sd = 2.0;

/// Number of coefficients for d inputs.
inline int basis_size(MeanBasis basis, int d) {
  switch (basis) {
    case MeanBasis::zero:
      return 0;
    case MeanBasis::constant:
      return 1;
    case MeanBasis::linear:
      return 1 + d;
    case MeanBasis::quadratic:
    case MeanBasis::trend:
      return 1 + d + d * (d + 1) / 2;
  }
  return 0;
}

/// Prior precision of each coefficient, in units of the output's standard deviation; 0 where the prior is flat.
inline Eigen::VectorXd basis_precision(MeanBasis basis, int d) {
  Eigen::VectorXd precision = Eigen::VectorXd::Zero(basis_size(basis, d));
  if (basis == MeanBasis::trend) precision.tail(precision.size() - 1).setConstant(1.0 / (trend_sd * trend_sd));
  return precision;
}

/// How many coefficients the data alone must determine: those with a flat prior.
inline int flat_coefficients(MeanBasis basis, int d) { return basis == MeanBasis::trend ? 1 : basis_size(basis, d); }

/// h(x) of every row of x: rows of x by basis_size.
inline Eigen::MatrixXd basis_matrix(MeanBasis basis, const Eigen::MatrixXd& x) {
  const int d = static_cast<int>(x.cols());
  Eigen::MatrixXd h(x.rows(), basis_size(basis, d));
  if (basis == MeanBasis::zero) return h;
  h.col(0).setOnes();
  if (basis == MeanBasis::constant) return h;
  h.middleCols(1, d) = x.array() - 0.5;
  if (basis == MeanBasis::linear) return h;
  int column = 1 + d;
  for (int j = 0; j < d; ++j)
    for (int k = j; k < d; ++k) h.col(column++) = (x.col(j).array() - 0.5) * (x.col(k).array() - 0.5);
  return h;
}

/// d h(x) / d x_k of every row of x.
inline Eigen::MatrixXd basis_derivative(MeanBasis basis, const Eigen::MatrixXd& x, int coordinate) {
  const int d = static_cast<int>(x.cols());
  Eigen::MatrixXd h = Eigen::MatrixXd::Zero(x.rows(), basis_size(basis, d));
  if (basis == MeanBasis::zero || basis == MeanBasis::constant) return h;
  h.col(1 + coordinate).setOnes();
  if (basis == MeanBasis::linear) return h;
  int column = 1 + d;
  for (int j = 0; j < d; ++j)
    for (int k = j; k < d; ++k, ++column) {
      if (j == coordinate) h.col(column).array() += x.col(k).array() - 0.5;
      if (k == coordinate) h.col(column).array() += x.col(j).array() - 0.5;
    }
  return h;
}

}  // namespace surrogate

template <>
inline constexpr std::array data::texts_of<surrogate::MeanBasis> = {"zero", "constant", "linear", "quadratic", "trend"};
