#pragma once
// Mean functions of a Gaussian process, m(x) = h(x)' beta, of the active inputs centred in the unit cube, t = x - 1/2:
//   zero: none (the process has zero mean in the units of y, or of log y);  constant: 1;  linear: 1, t_k;  quadratic:
//   1, t_k, t_j t_k (j <= k).
// The coefficients have a flat prior and are integrated out (generalised least squares, restricted likelihood).
#include <Eigen/Core>

namespace surrogate {

enum class MeanBasis { zero, constant, linear, quadratic };

inline const char* to_text(MeanBasis basis) {
  switch (basis) {
    case MeanBasis::zero:
      return "zero";
    case MeanBasis::constant:
      return "constant";
    case MeanBasis::linear:
      return "linear";
    case MeanBasis::quadratic:
      return "quadratic";
  }
  return "";
}

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
      return 1 + d + d * (d + 1) / 2;
  }
  return 0;
}

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
