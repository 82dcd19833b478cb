#include "surrogate/dense.hpp"

#include <catch2/catch.hpp>

TEST_CASE("a triangle times few columns is what it is times many") {
  for (const int n : {1, 3, 4, 5, 37}) {
    const Eigen::MatrixXd full = Eigen::MatrixXd::Random(n, n), x = Eigen::MatrixXd::Random(n, 20);
    const Eigen::MatrixXd lower = full.triangularView<Eigen::Lower>();
    Eigen::MatrixXd product, transposed;
    for (const int columns : {1, 3, 16, 17, 20}) {
      surrogate::multiply_lower(full, x.leftCols(columns), product);
      surrogate::multiply_lower_transposed(full, x.leftCols(columns), transposed);
      CHECK(product.isApprox(lower * x.leftCols(columns), 1e-13));
      CHECK(transposed.isApprox(lower.transpose() * x.leftCols(columns), 1e-13));
    }
  }
}
