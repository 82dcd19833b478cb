// Combinations that clouds of values share, where the answer is known.
#include "uq/verdict/combination.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "data/random.hpp"

using namespace uq;

namespace {

/// Values in [low, high] of all columns but the last, which is computed, if inside the same range.
template <class Last>
Eigen::MatrixXd cloud(int columns, std::pair<double, double> range, double noise, Last last) {
  data::RandomStream random(3, data::Purpose::test, 9);
  Eigen::MatrixXd values(1000, columns);
  for (Eigen::Index i = 0; i < values.rows();) {
    Eigen::VectorXd row(columns);
    for (int k = 0; k + 1 < columns; ++k) row[k] = random.uniform(range.first, range.second);
    row[columns - 1] = last(row) * (1.0 + noise * random.normal());
    if (row[columns - 1] < range.first || row[columns - 1] > range.second) continue;
    values.row(i++) = row.transpose();
  }
  return values;
}

std::string text_of(const Eigen::MatrixXd& values) {
  std::vector<CombinationColumn> columns;
  for (Eigen::Index k = 0; k < values.cols(); ++k)
    columns.push_back({std::string(1, static_cast<char>('a' + k)), "", values.col(k).cwiseAbs().mean()});
  const Eigen::VectorXd ranges = values.colwise().maxCoeff() - values.colwise().minCoeff();
  return write_combination(fit_combination(values, ranges), columns).text;
}

}  // namespace

TEST_CASE("sums and products of three are found from clouds on them, with noise", "[uq]") {
  CHECK(text_of(cloud(3, {-1.0, 1.0}, 0.05, [](const auto& p) { return 0.3 - p[0] - p[1]; })) == "a + b + c");
  CHECK(text_of(cloud(3, {0.4, 2.0}, 0.01, [](const auto& p) { return 1.0 / (p[0] * p[1]); })) == "a * b * c");
  CHECK(text_of(cloud(3, {0.4, 2.0}, 0.01, [](const auto& p) { return p[0] * p[1] / 0.9; })) == "a * b / c");
  CHECK(text_of(cloud(2, {0.2, 2.0}, 0.01, [](const auto& p) { return std::pow(0.8 / p[0], 1.0 / 3.0); })) ==
        "a * b^3");
  CHECK(text_of(cloud(2, {0.1, 2.0}, 0.01, [](const auto& p) { return 2.0 - 2.0 * p[0]; })) == "a + 0.5 x b");
}

TEST_CASE("independent values share no combination, and fill their room", "[uq]") {
  data::RandomStream random(4, data::Purpose::test, 9);
  Eigen::MatrixXd values(1000, 2);
  for (double& value : values.reshaped()) value = random.uniform();
  CHECK(fit_combination(values, Eigen::Vector2d::Ones()).share > 0.9);
  CHECK(filled_share(values) == Approx(1.0).margin(0.2));
}

TEST_CASE("a ring fills little of its room, and is no straight combination", "[uq]") {
  data::RandomStream random(4, data::Purpose::test, 9);
  Eigen::MatrixXd values(1000, 2);
  for (Eigen::Index i = 0; i < values.rows(); ++i) {
    const double angle = random.uniform(0.0, 6.283185307179586), radius = 1.0 + 0.02 * random.normal();
    values.row(i) << radius * std::cos(angle), radius * std::sin(angle);
  }
  CHECK(filled_share(values) < 0.2);
  CHECK(text_of(values) == "a^2 + b^2");
}

TEST_CASE("units are readable where they would be mixed", "[uq]") {
  // friction - 0.1 hamaker / 1e-18 J = -0.45
  Eigen::MatrixXd values = cloud(2, {0.1, 20.0}, 0.0, [](const auto& p) { return 4.5 + 10.0 * p[0]; });
  values.col(1) *= 1e-18;
  const Eigen::Vector2d ranges(20.0, 2e-17);
  const CombinationText found =
      write_combination(fit_combination(values, ranges), {{"friction", "", 0.8}, {"hamaker", "J", 9e-18}});
  CHECK(found.text == "friction - 0.1 x hamaker/(1e-18 J)");
  CHECK(found.unit.empty());
  CHECK(found.scale * evaluate(found.written, Eigen::Vector2d(0.55, 10e-18)) == Approx(-0.45));
}

TEST_CASE("a divisor with a unit of its own stands in brackets", "[uq]") {
  FittedCombination quotient{.form = CombinationForm::product, .terms = {{1.0, 1.0}, {-1.0, 1.0}}};
  const CombinationText found = write_combination(quotient, {{"hamaker", "J", 2e-20}, {"modulus", "Pa", 3e7}});
  CHECK(found.text == "hamaker/(1e-20 J) / (modulus/(1e+07 Pa))");
}

TEST_CASE("the combination that points share is named by the form that keeps nearer to them", "[uq]") {
  Eigen::MatrixXd hyperbola(9, 2), line(9, 2);
  for (Eigen::Index i = 0; i < 9; ++i) {
    const double a = 0.1 * static_cast<double>(i + 1);
    hyperbola.row(i) << a, std::pow(0.2 / a, 1.0 / 0.9);
    line.row(i) << a, 2.0 - 1.5 * a;
  }
  const auto text = [](const Eigen::MatrixXd& points) {
    const uq::FittedCombination found = uq::fit_combination(points, Eigen::Vector2d(1.0, 2.0));
    return uq::write_combination(found, {{"friction", "", 1.0}, {"hamaker", "", 1.0}}).text;
  };
  CHECK(text(hyperbola) == "friction * hamaker^0.9");
  CHECK(text(line) == "friction + 0.667 x hamaker");
}

TEST_CASE("a ridge that bends away from every simple form keeps near none", "[uq]") {
  Eigen::MatrixXd bent(21, 2);  // falls, then rises
  for (Eigen::Index i = 0; i < 21; ++i) {
    const double a = 0.1 + 0.035 * static_cast<double>(i);
    bent.row(i) << a, 0.6 + 4.0 * (a - 0.35) * (a - 0.35);
  }
  CHECK(uq::fit_combination(bent, Eigen::Vector2d(0.7, 1.5)).spread > 0.05);
}
