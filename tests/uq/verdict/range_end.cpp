// Values that another parameter's range decides: the move beyond its end against a linear model, and the words.
#include "uq/verdict/range_end.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/uq/closed_form.hpp"
#include "uq/posterior/posterior.hpp"
#include "uq/verdict/identifiability.hpp"

using namespace closed_form;

namespace {

constexpr double noise = 0.01;

double line(const Eigen::VectorXd& p, double x) { return p[0] * (1.0 + x) + p[1] * (1.0 - 0.5 * x); }

/// a on [0.1, 0.8] and b on [-1, 2], read at six x without noise.
uq::CaseModel measured(double a, double b, double a_low = 0.1, double a_high = 0.8) {
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(6, 0.0, 1.0);
  Eigen::VectorXd y(6);
  for (Eigen::Index i = 0; i < 6; ++i) y[i] = line(Eigen::Vector2d(a, b), x[i]);
  return make_case({{"a", a_low, a_high}, {"b", -1.0, 2.0}}, line, x, y, Eigen::VectorXd::Constant(6, noise));
}

uq::Identification identified(const uq::CaseModel& model) {
  data::RandomStream random(7, data::Purpose::test, 1);
  const uq::Maximum best = uq::maximum_likelihood(model, Eigen::MatrixXd::Constant(1, 2, 0.5));
  Eigen::MatrixXd draws(400, 2);
  for (Eigen::Index i = 0; i < draws.rows(); ++i)
    for (Eigen::Index k = 0; k < 2; ++k) draws(i, k) = std::clamp(best.x[k] + 0.01 * random.normal(), 0.0, 1.0);
  return uq::identify(model, draws, {});
}

}  // namespace

TEST_CASE("how far a value would move beyond another's range is that of the linear model", "[uq]") {
  const double a = 0.815, b = 0.7;
  const uq::CaseModel model = measured(a, b);
  const uq::Maximum best = uq::maximum_likelihood(model, Eigen::MatrixXd::Constant(1, 2, 0.5));
  REQUIRE(best.x[0] > 1.0 - 1e-6);
  const std::vector<uq::RangeEnd> ends = uq::range_ends(model, best.x);
  REQUIRE(ends.size() == 1);
  CHECK(ends[0].unknown == 0);
  CHECK(ends[0].shift[0] == 0.0);
  // With a held b has the error noise / |its column|; the true b is where the move leads.
  double square = 0.0;
  for (int i = 0; i < 6; ++i) square += std::pow(1.0 - 0.1 * i, 2);
  const double held = model.unknowns[1].value(best.x[1]);
  CHECK(ends[0].shift[1] == Approx((b - held) / (noise / std::sqrt(square))).epsilon(0.01));
}

TEST_CASE("a value that another's range decides is not identified, and says whose range", "[uq]") {
  const uq::Identification found = identified(measured(0.815, 0.7));
  const uq::ParameterReport& b = found.parameters[1];
  CHECK(b.verdict == uq::Verdict::not_identified);
  CHECK(b.reason == uq::Reason::range_of_another);
  CHECK(b.low_pinned_by == "a");
  CHECK_THAT(b.sentence, Catch::Contains("the range of a"));
  const uq::Words words = uq::summarise(found, "");
  CHECK_THAT(words.consequence, Catch::Contains("depends on where the range of a ends"));
  CHECK_THAT(uq::shown_remedy(words), Catch::Contains("Widen the range of a"));
}

TEST_CASE("a range that is narrower than the data's error is no knowledge of what lies beyond it", "[uq]") {
  // The data know a to 0.0061, beside an unknown b. Its range is 0.005 wide and ends two errors short of the truth.
  Eigen::MatrixXd columns(6, 2);
  for (int i = 0; i < 6; ++i) columns.row(i) << 1.0 + 0.2 * i, 1.0 - 0.1 * i;
  const Eigen::Matrix2d information = columns.transpose() * columns / (noise * noise);
  REQUIRE(std::sqrt(information.inverse()(0, 0)) == Approx(0.00613).epsilon(0.01));
  const double low = 0.397, high = 0.402, a = high + 0.0123, b = 0.7;
  const uq::CaseModel model = measured(a, b, low, high);
  const uq::Maximum best = uq::maximum_likelihood(model, Eigen::MatrixXd::Constant(1, 2, 0.5));
  REQUIRE(best.x[0] > 1.0 - 1e-6);
  // Of the whole move, what two widths of the range leave to be believed.
  const double left = information.determinant() / information(1, 1),
               believed = left / (left + std::pow(2.0 * (high - low), -2));
  const double held = model.unknowns[1].value(best.x[1]);
  const std::vector<uq::RangeEnd> ends = uq::range_ends(model, best.x);
  REQUIRE(ends.size() == 1);
  CHECK(ends[0].shift[1] == Approx(believed * (b - held) * std::sqrt(information(1, 1))).epsilon(0.01));
  const uq::ParameterReport found = identified(model).parameters[1];
  CHECK(found.verdict == uq::Verdict::not_identified);
  CHECK(found.reason == uq::Reason::range_of_another);
}

TEST_CASE("a best fit inside all ranges leaves the words as they are", "[uq]") {
  const uq::CaseModel model = measured(0.6, 0.7);
  const uq::Maximum best = uq::maximum_likelihood(model, Eigen::MatrixXd::Constant(1, 2, 0.5));
  CHECK(uq::range_ends(model, best.x).empty());
  for (const uq::ParameterReport& one : identified(model).parameters) CHECK(one.verdict == uq::Verdict::identified);
}

TEST_CASE("a bound of nature at which a parameter sits is no range that decides the others", "[uq]") {
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(6, 0.0, 1.0);
  Eigen::VectorXd y(6);
  for (Eigen::Index i = 0; i < 6; ++i) y[i] = line(Eigen::Vector2d(-0.02, 0.7), x[i]);
  const uq::CaseModel model =
      make_case({{"a", 0.0, 0.8}, {"b", -1.0, 2.0}}, line, x, y, Eigen::VectorXd::Constant(6, noise));
  const uq::Maximum best = uq::maximum_likelihood(model, Eigen::MatrixXd::Constant(1, 2, 0.5));
  REQUIRE(best.x[0] < 1e-6);
  CHECK(uq::range_ends(model, best.x).empty());
}
