#pragma once
// Factorisation and inverse of symmetric positive definite matrices, on lower triangles and in place. Inverses are
// split recursively in halves so that nearly all work is matrix products; each costs n^3/3
// multiplications-and-additions less than a solve with the identity, which does not use its zeros.
#include <Eigen/Core>

namespace surrogate {

/// Lower Cholesky factor over the lower triangle of `a`; false when a pivot is not positive (a is then spoilt).
bool cholesky_in_place(Eigen::Ref<Eigen::MatrixXd> a);

/// L^-1 over the lower triangle L.
void invert_lower_in_place(Eigen::Ref<Eigen::MatrixXd> lower);

/// T' T (lower triangle) over the lower triangle T. With T = L^-1 this is the inverse of L L'.
void gram_in_place(Eigen::Ref<Eigen::MatrixXd> lower);

/// L x (lower triangle) and L' x. For a few columns, which a matrix product would mostly spend on arranging L anew,
/// they read L once, column by column.
void multiply_lower(const Eigen::MatrixXd& lower, const Eigen::MatrixXd& x, Eigen::MatrixXd& product);
void multiply_lower_transposed(const Eigen::MatrixXd& lower, const Eigen::MatrixXd& x, Eigen::MatrixXd& product);

}  // namespace surrogate
