#include "uq/posterior/plane.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace uq;

TEST_CASE("the hull of points in a square is its corners, and distances to it are those to the square", "[uq]") {
  Eigen::MatrixXd points(7, 2);
  points << 0, 0, 1, 0, 1, 1, 0, 1, 0.5, 0.5, 0.2, 0.9, 0.5, 0.0;
  const auto hull = convex_hull(points);
  CHECK(hull.size() == 4);
  CHECK(distance_to_hull(hull, {0.3, 0.3}) == 0.0);
  CHECK(distance_to_hull(hull, {1.0, 0.5}) == 0.0);
  CHECK(distance_to_hull(hull, {1.5, 0.5}) == Approx(0.5));
  CHECK(distance_to_hull(hull, {2.0, 2.0}) == Approx(std::sqrt(2.0)));
}

TEST_CASE("points on a line have no inside", "[uq]") {
  Eigen::MatrixXd line(3, 2);
  line << 0, 0, 0.5, 0.5, 1, 1;
  CHECK(distance_to_hull(convex_hull(line), {0.5, 0.5}) == Approx(0.0).margin(1e-15));
  CHECK(distance_to_hull(convex_hull(line), {0.0, 1.0}) == Approx(std::sqrt(0.5)));
  CHECK(distance_to_hull(convex_hull(line.topRows(1)), {3.0, 4.0}) == Approx(5.0));
}
