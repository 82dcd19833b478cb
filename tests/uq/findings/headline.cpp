#include "uq/findings/headline.hpp"

#include <catch2/catch.hpp>

#include "tests/uq/findings/report_fixture.hpp"

using namespace uq;

namespace {

constexpr auto plain = Typography::ascii;

ParameterReport parameter(const std::string& name, Verdict verdict) {
  ParameterReport made;
  made.name = name;
  made.mean = 0.4;
  made.sd = 0.02;
  made.verdict = verdict;
  return made;
}

CaseReport measured(std::vector<ParameterReport> parameters) {
  CaseReport result;
  result.parameters = std::move(parameters);
  PredictivePoint point;
  point.output = "torque";
  result.predictive = {point, point};
  return result;
}

}  // namespace

TEST_CASE("what is fixed is said with its value, and what is open by its name") {
  CHECK(headline(measured({parameter("friction", Verdict::identified)}), plain) ==
        "Torque fixes friction at 0.400 +- 0.020.");
  const std::string text = headline(
      measured({parameter("friction", Verdict::identified), parameter("hamaker", Verdict::not_identified)}), plain);
  CHECK(text.starts_with("Torque fixes friction at 0.400 +- 0.020, not hamaker itself."));
}

TEST_CASE("a combination that is known stands where its terms do not") {
  CaseReport result = measured({parameter("a", Verdict::not_identified), parameter("b", Verdict::not_identified)});
  TradedPair traded;
  traded.combination = "a + b";
  traded.value = 0.7;
  traded.error = 0.01;
  result.traded = {traded};
  CHECK(headline(result, plain).starts_with("Torque fixes a + b at 0.700 +- 0.010, not a and b themselves."));
  result.traded.front().value = std::numeric_limits<double>::quiet_NaN();
  CHECK(headline(result, plain).starts_with("Torque ties a and b together along a curve, and fixes neither."));
}

TEST_CASE("the first choice of a plan is the next step") {
  CaseReport result = measured({parameter("a", Verdict::not_identified)});
  CHECK(headline(result, plain).ends_with("Next: demcal plan says what to measure."));
  PlanReport plan;
  PlanCandidate candidate;
  candidate.name = "torque at 300 rpm";
  plan.candidates = {candidate};
  result.plan = plan;
  CHECK(headline(result, plain).ends_with("Next: measure torque at 300 rpm."));
  PlannedParameter about;
  about.name = "a";
  about.floor = "the surrogate's error is the floor";
  result.plan->about = "a";
  result.plan->candidates.front().parameters = {about};
  CHECK(headline(result, plain).ends_with("however often it is read it does not identify it."));
  result.plan->candidates.front().parameters.front().repeats_needed = 12;
  CHECK(headline(result, plain).ends_with("Next: measure torque at 300 rpm."));
}

TEST_CASE("of what does not fit, or rests on a surrogate that cannot be used, no value is said") {
  CaseReport result = measured({parameter("friction", Verdict::identified)});
  result.fits = false;
  CHECK(headline(result, plain) == "No values of the parameters reproduce the measured torque.");
  result.fits = true;
  result.doubt = "12 % of the posterior lies where no run speaks";
  CHECK(headline(result, plain).find("0.4") == std::string::npos);
  result.unusable = true;
  CHECK(headline(result, plain).find("Ignore what follows") != std::string::npos);
}

TEST_CASE("synthetic data are known by the first word of their file") {
  CaseReport result;
  CHECK(!is_synthetic(result));
  result.observed_notes = {"Synthetic: made by a formula"};
  CHECK(is_synthetic(result));
  result.observed_notes = {"measured with synthetic grease"};
  CHECK(!is_synthetic(result));
}
