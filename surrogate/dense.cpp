#include "surrogate/dense.hpp"

#include <Eigen/Cholesky>

namespace surrogate {
namespace {

constexpr Eigen::Index leaf = 24;  // below it, loops

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

}  // namespace surrogate
