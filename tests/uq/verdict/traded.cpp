// What is traded in a linear Gaussian case, whose posterior is known: N(m, S), S^-1 = I + W'W / sd^2 for priors N(0, 1)
// and readings y = W p of error sd.
#include "uq/verdict/traded.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/uq/closed_form.hpp"
#include "uq/posterior/posterior.hpp"

using namespace closed_form;
using uq::Verdict;

namespace {

constexpr double half_range = 8.0;

/// A linear case: its model, its posterior in closed form, and independent draws of it.
struct LinearCase {
  uq::CaseModel model;
  Eigen::VectorXd mean;
  Eigen::MatrixXd covariance;
  Eigen::MatrixXd draws;  // u

  double sd(const Eigen::VectorXd& weights) const { return std::sqrt(weights.dot(covariance * weights)); }
  double correlation(Eigen::Index a, Eigen::Index b) const {
    return covariance(a, b) / std::sqrt(covariance(a, a) * covariance(b, b));
  }
};

/// `weights`: a row for each reading. All readings are of the same error.
LinearCase linear_case(const std::vector<std::string>& names, const Eigen::MatrixXd& weights,
                       const Eigen::VectorXd& truth, double sd) {
  data::Prior prior;
  prior.kind = data::PriorKind::normal;
  prior.sd = 1.0;
  prior.low = -half_range;
  prior.high = half_range;
  std::vector<FreeParameter> unknowns;
  for (const std::string& name : names) unknowns.push_back({name, -half_range, half_range, prior});
  const Eigen::Index d = weights.cols(), rows = weights.rows();
  const Formula formula = [weights](const Eigen::VectorXd& p, double row) {
    return weights.row(std::lround(row)).dot(p);
  };
  const Eigen::VectorXd y = weights * truth;
  LinearCase made{
      .model = make_case(unknowns, formula, Eigen::VectorXd::LinSpaced(rows, 0.0, static_cast<double>(rows - 1)), y,
                         Eigen::VectorXd::Constant(rows, sd)),
      .mean = {},
      .covariance = {},
      .draws = Eigen::MatrixXd(2000, d)};
  const Eigen::MatrixXd precision = Eigen::MatrixXd::Identity(d, d) + weights.transpose() * weights / (sd * sd);
  made.covariance = precision.inverse();
  made.mean = made.covariance * weights.transpose() * y / (sd * sd);
  const Eigen::MatrixXd root = made.covariance.llt().matrixL();
  data::RandomStream random(20261129, data::Purpose::test, 5);
  for (Eigen::Index i = 0; i < made.draws.rows(); ++i) {
    Eigen::VectorXd z(d);
    for (double& value : z) value = random.normal();
    made.draws.row(i) = ((made.mean + root * z).array() / (2.0 * half_range) + 0.5).matrix().transpose();
  }
  return made;
}

std::vector<uq::TradedPair> traded_in(const LinearCase& linear, const std::vector<Verdict>& verdicts) {
  const uq::Profiles all = uq::profile_likelihood(
      linear.model, {.draws = linear.draws.topRows(300),
                     .log_likelihood = uq::log_likelihoods(linear.model, linear.draws.topRows(300))});
  return uq::find_traded_pairs(linear.model, linear.draws, all, verdicts, {});
}

/// Value over error of the combination `weights`: of any multiple of it the same.
double precision_of(const LinearCase& linear, const Eigen::VectorXd& weights) {
  return linear.mean.dot(weights) / linear.sd(weights);
}

/// Weights of a reading of two parameters.
Eigen::VectorXd pair_weights(Eigen::Index a, double of_a, Eigen::Index b, double of_b) {
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(4);
  weights[a] = of_a;
  weights[b] = of_b;
  return weights;
}

}  // namespace

TEST_CASE("two of four parameters that are read together alone are traded, by the posterior's own numbers", "[uq]") {
  const std::vector<std::string> names = {"p", "q", "r", "s"};
  const Eigen::Vector4d truth(0.9, 0.6, 1.1, 0.7);
  constexpr double sd = 0.05;
  struct Together {
    Eigen::Index a, b;
    double of_a, of_b;
  };
  for (const Together& two : {Together{0, 1, 1.0, 1.0}, {0, 3, 1.0, 2.0}, {1, 2, 3.0, 1.0}, {2, 3, 1.0, -1.0}}) {
    const Eigen::VectorXd weights = pair_weights(two.a, two.of_a, two.b, two.of_b);
    Eigen::MatrixXd readings(3, 4);
    readings.row(0) = weights.transpose();
    std::vector<Verdict> verdicts(4, Verdict::identified);
    verdicts[two.a] = verdicts[two.b] = Verdict::not_identified;
    Eigen::Index row = 1;  // each of the others has a reading of its own
    for (Eigen::Index k = 0; k < 4; ++k)
      if (k != two.a && k != two.b) readings.row(row++) = Eigen::VectorXd::Unit(4, k).transpose();
    const LinearCase linear = linear_case(names, readings, truth, sd);
    const std::vector<uq::TradedPair> found = traded_in(linear, verdicts);
    INFO(names[two.a] << " and " << names[two.b]);
    REQUIRE(found.size() == 1);
    CHECK(found[0].parameters == std::vector<std::string>{names[two.a], names[two.b]});
    CHECK(found[0].form == uq::CombinationForm::sum);
    // Of 1,500 draws: a correlation r is known to (1 - r^2) / sqrt(n), an error to 1 / sqrt(2 n).
    CHECK(found[0].correlation == Approx(linear.correlation(two.a, two.b)).margin(1e-3));
    CHECK(found[0].value / found[0].error == Approx(precision_of(linear, weights)).epsilon(0.08));
    // Points along the ridge are nearly as good as the best: within a deviance of 1 of what was read.
    CHECK(found[0].equivalent.size() == 5);
    for (const auto& point : found[0].equivalent)
      CHECK(std::abs(two.of_a * point.at(names[two.a]) + two.of_b * point.at(names[two.b]) - weights.dot(truth)) <
            1.01 * sd);
  }
}

TEST_CASE("what only three together determine is traded as three, and no two of them", "[uq]") {
  const Eigen::Vector3d weights = Eigen::Vector3d::Ones();
  const LinearCase linear = linear_case({"p", "q", "r"}, weights.transpose(), Eigen::Vector3d(0.5, 0.3, 0.8), 0.05);
  const std::vector<uq::TradedPair> found = traded_in(linear, std::vector<Verdict>(3, Verdict::not_identified));
  REQUIRE(found.size() == 1);
  CHECK(found[0].parameters == std::vector<std::string>{"p", "q", "r"});
  CHECK(found[0].combination == "p + q + r");
  // Here value and error are those of the sum itself.
  CHECK(found[0].value == Approx(linear.mean.sum()).margin(3e-3));
  CHECK(found[0].error == Approx(linear.sd(weights)).epsilon(0.08));
}

TEST_CASE("two independent sums are two traded sets, and none where its members are known", "[uq]") {
  Eigen::MatrixXd readings(2, 4);
  readings << 1, 1, 0, 0, 0, 0, 1, 1;
  const LinearCase linear = linear_case({"p", "q", "r", "s"}, readings, Eigen::Vector4d(0.9, 0.6, 1.1, 0.7), 0.05);
  std::vector<Verdict> verdicts(4, Verdict::not_identified);
  const std::vector<uq::TradedPair> both = traded_in(linear, verdicts);
  REQUIRE(both.size() == 2);
  std::vector<std::string> combinations = {both[0].combination, both[1].combination};
  std::sort(combinations.begin(), combinations.end());
  CHECK(combinations == std::vector<std::string>{"p + q", "r + s"});

  verdicts[0] = verdicts[1] = Verdict::identified;
  const std::vector<uq::TradedPair> one = traded_in(linear, verdicts);
  REQUIRE(one.size() == 1);
  CHECK(one[0].combination == "r + s");

  verdicts = {Verdict::several_values, Verdict::not_identified, Verdict::several_values, Verdict::not_identified};
  CHECK(traded_in(linear, verdicts).empty());  // a parameter of separate values is in no combination
}

TEST_CASE("parameters that each have a reading of their own are not traded, however little is known of them", "[uq]") {
  const LinearCase linear = linear_case({"p", "q"}, Eigen::Matrix2d::Identity(), Eigen::Vector2d(0.5, 0.3), 2.0);
  CHECK(traded_in(linear, {Verdict::not_identified, Verdict::not_identified}).empty());
}

TEST_CASE("what two pairs tie together is not said again as a third pair or as three", "[uq]") {
  Eigen::MatrixXd readings(2, 3);
  readings << 1, 1, 0, 0, 1, 1;  // so p - r is known as well, and p + 2 q + r
  const LinearCase linear = linear_case({"p", "q", "r"}, readings, Eigen::Vector3d(0.9, 0.6, 1.1), 0.05);
  const std::vector<uq::TradedPair> found = traded_in(linear, std::vector<Verdict>(3, Verdict::not_identified));
  REQUIRE(found.size() == 2);
  for (const uq::TradedPair& pair : found) CHECK(pair.parameters.size() == 2);
  CHECK(found[0].parameters != found[1].parameters);
}
