#include "uq/emulate/sensitivity.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "data/random.hpp"
#include "surrogate/design.hpp"
#include "surrogate/fit.hpp"

namespace {

/// A response that is known exactly.
template <class Function>
auto exactly(Function function) {
  return [function](const Eigen::MatrixXd& points) {
    surrogate::Prediction prediction{Eigen::VectorXd(points.rows()),
                                     Eigen::MatrixXd::Zero(points.rows(), points.rows())};
    for (Eigen::Index i = 0; i < points.rows(); ++i) prediction.mean[i] = function(points.row(i));
    return prediction;
  };
}

}  // namespace

TEST_CASE("Sobol indices of the g-function are the closed ones") {
  // Sobol's g-function, prod (|4 x - 2| + a_i) / (1 + a_i), is not smooth; its square, prod (1 + c_i (2 x_i - 1)), is:
  // V_i = c_i^2 / 3 and V = prod (1 + V_i) - 1 in closed form.
  const Eigen::Vector4d c(1.0, 0.5, 0.2, 0.0);
  const auto found = uq::sobol_indices(exactly([&](const auto& x) {
                                         double product = 1.0;
                                         for (int k = 0; k < 4; ++k) product *= 1.0 + c[k] * (2.0 * x[k] - 1.0);
                                         return product;
                                       }),
                                       4);
  REQUIRE(found.size() == 4);
  const Eigen::Array4d v = c.array().square() / 3.0;
  const double all = (1.0 + v).prod();
  for (int k = 0; k < 4; ++k) {
    CAPTURE(k);
    CHECK(found[k].first == Approx(v[k] / (all - 1.0)).margin(1e-4));
    CHECK(found[k].total == Approx(v[k] * all / (1.0 + v[k]) / (all - 1.0)).margin(1e-4));
    CHECK(found[k].first_sd < 1e-3);
  }
}

TEST_CASE("Sobol indices of the Ishigami function agree with Saltelli's") {
  // A. Saltelli et al., "Global sensitivity analysis. The primer" (2008): a = 7, b = 0.1.
  constexpr double pi = std::numbers::pi;
  const auto found = uq::sobol_indices(
      exactly([](const auto& u) {
        const double x = pi * (2.0 * u[0] - 1.0), y = pi * (2.0 * u[1] - 1.0), z = pi * (2.0 * u[2] - 1.0);
        return std::sin(x) + 7.0 * std::pow(std::sin(y), 2) + 0.1 * std::pow(z, 4) * std::sin(x);
      }),
      3);
  REQUIRE(found.size() == 3);
  CHECK(found[0].first == Approx(0.3139).margin(1e-3));
  CHECK(found[1].first == Approx(0.4424).margin(1e-3));
  CHECK(found[2].first == Approx(0.0).margin(1e-3));
  CHECK(found[0].total == Approx(0.5576).margin(1e-3));
  CHECK(found[1].total == Approx(0.4424).margin(1e-3));
  CHECK(found[2].total == Approx(0.2437).margin(1e-3));
}

TEST_CASE("seven inputs, curvature and an interaction among them, have their closed indices") {
  // f = x0 + 6 x1^2 + 4 (x2 - 1/2) (x3 - 1/2) + x4 + x5 + x6: V = 1/12, 36 * 4/45, 16 / 144, 1/12 each.
  const auto found =
      uq::sobol_indices(exactly([](const auto& x) {
                          return x[0] + 6.0 * x[1] * x[1] + 4.0 * (x[2] - 0.5) * (x[3] - 0.5) + x[4] + x[5] + x[6];
                        }),
                        7);
  REQUIRE(found.size() == 7);
  const double line = 1.0 / 12.0, square = 36.0 * 4.0 / 45.0, product = 16.0 / 144.0;
  const double all = 4.0 * line + square + product;
  const std::vector<double> first = {line, square, 0.0, 0.0, line, line, line};
  const std::vector<double> total = {line, square, product, product, line, line, line};
  for (std::size_t k = 0; k < 7; ++k) {
    CAPTURE(k);
    CHECK(found[k].first == Approx(first[k] / all).margin(1e-4));
    CHECK(found[k].total == Approx(total[k] / all).margin(1e-4));
  }
}

TEST_CASE("indices from few noisy runs carry an uncertainty that holds the true ones and shrinks with runs") {
  // f = x + y^2 over the unit square: V_x = 1/12, V_y = 4/45, additive.
  const double first = (1.0 / 12.0) / (1.0 / 12.0 + 4.0 / 45.0);
  double last = 1.0;
  for (const int runs : {12, 60}) {
    surrogate::TrainingSet set;
    set.x = surrogate::scrambled_sobol(runs, 2, 3);
    set.y.resize(runs);
    set.noise_variance.setConstant(runs, 0.05 * 0.05);
    data::RandomStream random(5, data::Purpose::test);
    for (int i = 0; i < runs; ++i) set.y[i] = set.x(i, 0) + set.x(i, 1) * set.x(i, 1) + 0.05 * random.normal();
    const surrogate::GaussianProcess process = surrogate::fit(set);
    const auto found = uq::sobol_indices([&](const Eigen::MatrixXd& x) { return process.predict(x); }, 2);
    REQUIRE(found.size() == 2);
    CHECK(std::abs(found[0].first - first) < 3.0 * found[0].first_sd);
    CHECK(found[0].first_sd < last);
    last = found[0].first_sd;
  }
}

TEST_CASE("a response that does not vary, or of too many inputs, has no indices") {
  CHECK(uq::sobol_indices(exactly([](const auto&) { return 3.0; }), 2).empty());
  CHECK(uq::sobol_indices(exactly([](const auto& x) { return x.sum(); }), 8).empty());
}
