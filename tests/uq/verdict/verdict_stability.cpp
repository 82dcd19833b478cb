// How often another data set of the same kind gets the same words, where the truth lies two posterior standard
// deviations from the place at which the verdict changes. With a normal scatter that is Phi(2) = 97.7 %.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/uq/closed_form.hpp"
#include "uq/infer/mixture_sampler.hpp"
#include "uq/posterior/posterior.hpp"
#include "uq/verdict/identifiability.hpp"

using namespace closed_form;
using uq::Verdict;

namespace {

constexpr int sets = 200;
constexpr double least = 0.95;

/// Share of data sets, y = formula(truth) + sd * normal, whose last parameter gets this verdict.
double share(Verdict verdict, const std::vector<FreeParameter>& unknowns, const Formula& formula,
             const Eigen::VectorXd& truth, const Eigen::VectorXd& x, const Eigen::VectorXd& sd) {
  int same = 0;
  for (std::uint32_t set = 0; set < sets; ++set) {
    data::RandomStream random(20110726, data::Purpose::test, set);
    Eigen::VectorXd y(x.size());
    for (Eigen::Index i = 0; i < x.size(); ++i) y[i] = formula(truth, x[i]) + sd[i] * random.normal();
    const uq::CaseModel model = make_case(unknowns, formula, x, y, sd);
    const uq::Draws draws = uq::sample_mixture(uq::posterior_target(std::make_shared<const uq::CaseModel>(model)),
                                               {.draws = 500, .stop = {.ess_bulk = 1500.0}, .threads = 1, .seed = set});
    REQUIRE(draws.converged);
    same += uq::identify(model, draws.pooled()).parameters.back().verdict == verdict ? 1 : 0;
  }
  return same / static_cast<double>(sets);
}

data::Prior standard_normal() {
  return {.kind = data::PriorKind::normal, .low = -8.0, .high = 8.0, .mean = 0.0, .sd = 1.0};
}

/// Three readings at x = 0, three at x = 1.
const Eigen::VectorXd twice_three = (Eigen::VectorXd(6) << 0, 0, 0, 1, 1, 1).finished();

/// q is read at x = 0, q p at x = 1. At p = 0, with prior sd 1, p's contraction is 1 / (1 + s^2 / 3 q^2), s the error
/// of a reading of q p: it crosses a threshold at q = 1 when s^2 = 3 (1 - threshold) / threshold. q's sd is 0.1.
double share_beside(double threshold, double q, Verdict verdict) {
  const Formula formula = [](const Eigen::VectorXd& p, double x) { return x < 0.5 ? p[0] : p[0] * p[1]; };
  Eigen::VectorXd sd = Eigen::VectorXd::Constant(6, 0.1 * std::sqrt(3.0));
  sd.tail(3).setConstant(std::sqrt(3.0 * (1.0 - threshold) / threshold));
  return share(verdict, {{"q", 0.0, 2.0}, {"p", -8.0, 8.0, standard_normal()}}, formula, Eigen::Vector2d(q, 0.0),
               twice_three, sd);
}

}  // namespace

TEST_CASE("two sd from where a closed interval's contraction is 0.9, 95 % of data sets get the same word",
          "[uq][slow]") {
  const double threshold = uq::VerdictThresholds().contraction_identified;
  CHECK(share_beside(threshold, 1.2, Verdict::identified) >= least);
  CHECK(share_beside(threshold, 0.8, Verdict::weakly_identified) >= least);
}

TEST_CASE("two sd from where a closed interval's contraction is 0.5, 95 % of data sets get the same word",
          "[uq][slow]") {
  const double threshold = uq::VerdictThresholds().contraction_weak;
  CHECK(share_beside(threshold, 1.2, Verdict::weakly_identified) >= least);
  CHECK(share_beside(threshold, 0.8, Verdict::not_identified) >= least);
}

TEST_CASE("two sd from where an interval opens at a bound, 95 % of data sets get the same word", "[uq][slow]") {
  // A mean of six readings, sd 0.02: the interval is closed when it lies at least 1.96 sd inside its range, so that the
  // verdict changes there. Two sd further out is the bound itself.
  const Formula constant = [](const Eigen::VectorXd& p, double) { return 3.0 + p[0]; };
  const double sd = 0.02, closes = std::sqrt(uq::VerdictThresholds().profile_drop) * sd;
  const Eigen::VectorXd error = Eigen::VectorXd::Constant(6, sd * std::sqrt(6.0));
  const auto at = [&](double low, double above, Verdict verdict) {
    return share(verdict, {{"p", low, low + 1.0}}, constant, Eigen::VectorXd::Constant(1, low + above), twice_three,
                 error);
  };
  SECTION("the end of a range: identified, or not identified") {
    CHECK(at(0.3, closes + 2.0 * sd, Verdict::identified) >= least);
    CHECK(at(0.3, 0.0, Verdict::not_identified) >= least);
  }
  SECTION("a bound that nature sets: identified, or an upper limit only") {
    CHECK(at(0.0, closes + 2.0 * sd, Verdict::identified) >= least);
    CHECK(at(0.0, 0.0, Verdict::weakly_identified) >= least);
  }
}
