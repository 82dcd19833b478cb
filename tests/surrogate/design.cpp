#include "surrogate/design.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "data/error.hpp"

using surrogate::scrambled_sobol;

TEST_CASE("each coordinate of the first 2^k points has one point in each of 2^k equal cells") {
  for (const int points : {1, 2, 16, 256}) {
    const Eigen::MatrixXd design = scrambled_sobol(points, 12, 3);
    for (int k = 0; k < design.cols(); ++k) {
      std::set<int> cells;
      for (int i = 0; i < points; ++i) cells.insert(static_cast<int>(design(i, k) * points));
      CHECK(static_cast<int>(cells.size()) == points);
    }
  }
}

TEST_CASE("the first two dimensions are a (0, m, 2)-net: every elementary rectangle holds one point") {
  const Eigen::MatrixXd design = scrambled_sobol(64, 2, 11);
  for (int a = 0; a <= 6; ++a) {
    std::set<int> cells;
    for (int i = 0; i < 64; ++i)
      cells.insert((static_cast<int>(design(i, 0) * (1 << a)) << (6 - a)) +
                   static_cast<int>(design(i, 1) * (1 << (6 - a))));
    CHECK(cells.size() == 64);
  }
}

TEST_CASE("a longer design starts with the shorter one, and may be made in pieces") {
  const Eigen::MatrixXd whole = scrambled_sobol(100, 5, 42);
  CHECK(scrambled_sobol(37, 5, 42) == whole.topRows(37));
  CHECK(scrambled_sobol(63, 5, 42, 37) == whole.bottomRows(63));
  CHECK(scrambled_sobol(100, 3, 42) == whole.leftCols(3));
}

TEST_CASE("points lie in the open unit cube, and another seed gives another design") {
  const Eigen::MatrixXd design = scrambled_sobol(4096, 40, 1);
  CHECK(design.minCoeff() > 0.0);
  CHECK(design.maxCoeff() < 1.0);
  CHECK(scrambled_sobol(8, 2, 1) != scrambled_sobol(8, 2, 2));
}

TEST_CASE("over seeds each scrambled point is uniform") {
  // Owen: every point of a nested uniformly scrambled sequence is uniform on the cube. Chi-squared of 2000 seeds in 10
  // cells, per point and dimension: 9 degrees of freedom, 99.99 % quantile 33.7.
  for (int point = 0; point < 3; ++point)
    for (int k = 0; k < 2; ++k) {
      Eigen::VectorXd cells = Eigen::VectorXd::Zero(10);
      for (int seed = 0; seed < 2000; ++seed)
        cells[static_cast<int>(10.0 * scrambled_sobol(1, 2, static_cast<std::uint64_t>(seed), point)(0, k))] += 1.0;
      CHECK((cells.array() - 200.0).square().sum() / 200.0 < 33.7);
    }
}

TEST_CASE("a smooth product is integrated with an error far below that of random points") {
  double squares = 0.0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Eigen::MatrixXd design = scrambled_sobol(1024, 4, seed);
    const double mean = (2.0 * design.array()).rowwise().prod().mean();  // exactly 1
    squares += (mean - 1.0) * (mean - 1.0) / 20.0;
  }
  // Independent points: sd sqrt((4/3)^4 - 1) / 32 = 0.046.
  CHECK(std::sqrt(squares) < 0.046 / 20.0);
}

TEST_CASE("more dimensions than the sequence has are bad input") {
  CHECK_THROWS_AS(scrambled_sobol(8, 41, 1), data::InputError);
}
