#include "surrogate/dense.hpp"

#include <Eigen/Cholesky>

namespace surrogate {
namespace {

constexpr Eigen::Index leaf = 24;  // below it, loops
// Up to so many columns a product reads the triangle as it lies: with 100 to 1,000 rows Eigen's product, which arranges
// it anew, is twice as fast from four columns on, and transposed from about ten on.
constexpr Eigen::Index few_columns = 2, few_columns_transposed = 8;

using Block = Eigen::Ref<Eigen::MatrixXd>;

Eigen::Index half(Eigen::Index n) { return n / 2 / 8 * 8 + (n / 2 < 8 ? n / 2 : 0); }

}  // namespace

bool cholesky_in_place(Block a) {
  const Eigen::LLT<Block, Eigen::Lower> factor(a);
  return factor.info() == Eigen::Success && a.diagonal().allFinite();
}

void invert_lower_in_place(Block lower) {
  const Eigen::Index n = lower.rows();
  if (n <= leaf) {
    // Column by column from the right: the columns right of j already hold their inverse.
    for (Eigen::Index j = n - 1; j >= 0; --j) {
      const double diagonal = 1.0 / lower(j, j);
      lower(j, j) = diagonal;
      for (Eigen::Index i = n - 1; i > j; --i)  // in place: row i needs rows j+1..i of the old column
        lower(i, j) =
            -diagonal * lower.row(i).segment(j + 1, i - j).transpose().dot(lower.col(j).segment(j + 1, i - j));
    }
    return;
  }
  const Eigen::Index h = half(n), rest = n - h;
  invert_lower_in_place(lower.topLeftCorner(h, h));
  invert_lower_in_place(lower.bottomRightCorner(rest, rest));
  Eigen::MatrixXd scratch(rest, h);
  scratch.noalias() =
      lower.bottomRightCorner(rest, rest).triangularView<Eigen::Lower>() * lower.bottomLeftCorner(rest, h);
  lower.bottomLeftCorner(rest, h).noalias() = -scratch * lower.topLeftCorner(h, h).triangularView<Eigen::Lower>();
}

void gram_in_place(Block lower) {
  const Eigen::Index n = lower.rows();
  if (n <= leaf) {
    for (Eigen::Index j = 0; j < n; ++j)
      for (Eigen::Index i = j; i < n; ++i) lower(i, j) = lower.col(i).tail(n - i).dot(lower.col(j).tail(n - i));
    return;
  }
  const Eigen::Index h = half(n), rest = n - h;
  gram_in_place(lower.topLeftCorner(h, h));
  lower.topLeftCorner(h, h).selfadjointView<Eigen::Lower>().rankUpdate(lower.bottomLeftCorner(rest, h).transpose());
  Eigen::MatrixXd scratch(rest, h);
  scratch.noalias() =
      lower.bottomRightCorner(rest, rest).transpose().triangularView<Eigen::Upper>() * lower.bottomLeftCorner(rest, h);
  lower.bottomLeftCorner(rest, h) = scratch;
  gram_in_place(lower.bottomRightCorner(rest, rest));
}

void multiply_lower(const Eigen::MatrixXd& lower, const Eigen::MatrixXd& x, Eigen::MatrixXd& product) {
  const Eigen::Index n = lower.rows(), m = x.cols();
  if (m > few_columns) {
    product.noalias() = lower.triangularView<Eigen::Lower>() * x;
    return;
  }
  product.setZero(n, m);
  // Four columns of L at a time, so that a sum is loaded and stored once for four products.
  Eigen::Index j = 0;
  for (; j + 4 <= n; j += 4) {
    const Eigen::Index below = n - j - 4;
    for (Eigen::Index c = 0; c < m; ++c) {
      for (Eigen::Index k = 0; k < 4; ++k)
        for (Eigen::Index i = k; i < 4; ++i) product(j + i, c) += lower(j + i, j + k) * x(j + k, c);
      product.col(c).tail(below) += lower.col(j).tail(below) * x(j, c) + lower.col(j + 1).tail(below) * x(j + 1, c) +
                                    lower.col(j + 2).tail(below) * x(j + 2, c) +
                                    lower.col(j + 3).tail(below) * x(j + 3, c);
    }
  }
  for (; j < n; ++j)
    for (Eigen::Index c = 0; c < m; ++c) product.col(c).tail(n - j) += lower.col(j).tail(n - j) * x(j, c);
}

void multiply_lower_transposed(const Eigen::MatrixXd& lower, const Eigen::MatrixXd& x, Eigen::MatrixXd& product) {
  const Eigen::Index n = lower.rows(), m = x.cols();
  if (m > few_columns_transposed) {
    product.noalias() = lower.transpose().triangularView<Eigen::Upper>() * x;
    return;
  }
  product.resize(n, m);
  for (Eigen::Index j = 0; j < n; ++j)
    for (Eigen::Index c = 0; c < m; ++c) product(j, c) = lower.col(j).tail(n - j).dot(x.col(c).tail(n - j));
}

}  // namespace surrogate
