// Verdicts on formulas whose answer is known: what is confounded, in which combination, structurally or by noise.
#include "uq/verdict/identifiability.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "tests/uq/closed_form.hpp"
#include "uq/infer/mixture_sampler.hpp"
#include "uq/posterior/posterior.hpp"
#include "uq/verdict/traded.hpp"

using namespace closed_form;
using uq::Verdict;

namespace {

const Eigen::VectorXd six = Eigen::VectorXd::LinSpaced(6, 0.0, 1.0);

uq::Identification identified(const uq::CaseModel& model, std::uint64_t seed = 1, const uq::StopRule& stop = {}) {
  const uq::Draws draws = uq::sample_mixture(uq::posterior_target(std::make_shared<const uq::CaseModel>(model)),
                                             {.stop = stop, .seed = seed});
  INFO(draws.reason);
  REQUIRE(draws.converged);
  return uq::identify(model, draws.pooled());
}

/// A torque-like response in which both parameters show at different x.
double told_apart(const Eigen::VectorXd& p, double x) { return p[0] * (1.0 + x) + p[1] * (1.0 - x * x); }

}  // namespace

TEST_CASE("parameters that act differently are identified, whatever they are called", "[uq]") {
  const uq::Identification found =
      identified(make_synthetic({{"alpha"}, {"beta"}}, told_apart, six, Eigen::Vector2d(0.4, 0.6), 0.01, 1));
  CHECK(found.fits);
  for (const auto& parameter : found.parameters) {
    INFO(parameter.sentence);
    CHECK(parameter.verdict == Verdict::identified);
    REQUIRE(parameter.profile_low);
    REQUIRE(parameter.profile_high);
    // A 95 % profile interval of a nearly linear model is the mean +- 1.96 sd.
    CHECK(*parameter.profile_high - *parameter.profile_low == Approx(2.0 * 1.96 * parameter.sd).epsilon(0.1));
  }
  CHECK(found.traded.empty());
}

TEST_CASE("a sum is known where its terms are not: structural, and the direction is found", "[uq]") {
  std::ifstream file(DEMCAL_SOURCE_DIR "/tests/reference/theory-facts.json");
  const nlohmann::json fact = nlohmann::json::parse(file)["ridge_sum"];
  const std::vector<double> at = fact["x"];
  const Eigen::VectorXd x = Eigen::Map<const Eigen::VectorXd>(at.data(), static_cast<Eigen::Index>(at.size()));
  data::Prior prior;
  prior.kind = data::PriorKind::normal;
  prior.sd = fact["prior_sd"];
  prior.low = -8.0;
  prior.high = 8.0;
  const Formula sum = [](const Eigen::VectorXd& p, double v) { return (p[0] + p[1]) * v; };
  const uq::CaseModel model = make_case({{"t1", -8.0, 8.0, prior}, {"t2", -8.0, 8.0, prior}}, sum, x, 0.7 * x,
                                        Eigen::VectorXd::Constant(5, fact["sigma"]));
  const uq::Identification found = identified(model);
  for (const auto& parameter : found.parameters) {
    INFO(parameter.sentence);
    CHECK(parameter.sd == Approx(fact["post_sd_each"].get<double>()).epsilon(0.06));
    CHECK(parameter.contraction == Approx(fact["shrink_each"].get<double>()).margin(0.06));
    CHECK(parameter.verdict == Verdict::not_identified);
    CHECK(parameter.reason == uq::Reason::structural);
    CHECK_FALSE(parameter.profile_low);
    CHECK_FALSE(parameter.profile_high);
  }
  REQUIRE(found.traded.size() == 1);
  CHECK(found.traded[0].correlation == Approx(fact["corr"].get<double>()).margin(0.002));
  CHECK(found.traded[0].combination == "t1 + t2");
  CHECK(found.traded[0].equivalent.size() == 5);
  for (const auto& point : found.traded[0].equivalent)
    CHECK(point.at("t1") + point.at("t2") == Approx(0.7).margin(0.1));
  // The prior's sd is 1, so the eigenvalues are those of the information itself.
  CHECK(found.fisher.eigenvalues[1] == Approx(fact["fim_eigs"][0].get<double>()).epsilon(1e-3));
  CHECK(found.fisher.known_directions == 1);
  CHECK(found.fisher.collinearity > 1e4);
}

TEST_CASE("a product known only as x y^3 is found without being told", "[uq][slow]") {
  const Formula product = [](const Eigen::VectorXd& p, double x) { return p[0] * std::pow(p[1], 3) * (1.0 + 0.2 * x); };
  const uq::Identification found =
      identified(make_synthetic({{"u", 0.2, 2.0}, {"v", 0.5, 2.0}}, product, six, Eigen::Vector2d(0.8, 1.0), 0.01, 3));
  for (const auto& parameter : found.parameters) {
    INFO(parameter.sentence);
    CHECK(parameter.verdict != Verdict::identified);
    if (parameter.verdict == Verdict::not_identified) CHECK(parameter.reason == uq::Reason::structural);
  }
  REQUIRE(found.traded.size() == 1);
  INFO(found.traded[0].combination);
  CHECK(found.traded[0].combination == "u * v^3");
}

TEST_CASE("a ratio H / h^2 is found as one", "[uq][slow]") {
  const Formula ratio = [](const Eigen::VectorXd& p, double x) { return 1.0 + p[0] / (p[1] * p[1]) * (1.0 + 0.2 * x); };
  const uq::Identification found =
      identified(make_synthetic({{"p", 1.0, 9.0}, {"q", 1.0, 3.0}}, ratio, six, Eigen::Vector2d(4.0, 2.0), 0.01, 4));
  REQUIRE(found.traded.size() == 1);
  INFO(found.traded[0].combination);
  CHECK(found.traded[0].combination == "p / q^2");
}

TEST_CASE("noise that hides what a better measurement would show is a practical reason", "[uq]") {
  const Formula weak = [](const Eigen::VectorXd& p, double x) { return 1.0 + p[0] + p[1] * (1.0 + 0.05 * x); };
  const uq::Identification found =
      identified(make_synthetic({{"a"}, {"b"}}, weak, six, Eigen::Vector2d(0.5, 0.5), 0.05, 5));
  REQUIRE(found.traded.size() == 1);
  for (const auto& parameter : found.parameters) {
    INFO(parameter.sentence);
    CHECK(parameter.verdict == Verdict::not_identified);
    CHECK(parameter.reason != uq::Reason::structural);
  }
}

TEST_CASE("a parameter against its physical bound has an upper limit, against a range's end only an open side",
          "[uq]") {
  const Formula line = [](const Eigen::VectorXd& p, double x) { return 1.0 + p[0] * (0.5 + x); };
  const uq::Identification zero =
      identified(make_synthetic({{"h", 0.0, 2.0}}, line, six, Eigen::VectorXd::Zero(1), 0.02, 6));
  INFO(zero.parameters[0].sentence);
  CHECK(zero.parameters[0].verdict == Verdict::weakly_identified);
  CHECK(zero.parameters[0].reason == uq::Reason::bound);
  CHECK_FALSE(zero.parameters[0].profile_low);
  CHECK(zero.parameters[0].profile_high);
  const uq::Identification shifted =
      identified(make_synthetic({{"h", 0.1, 2.0}}, line, six, Eigen::VectorXd::Constant(1, 0.1), 0.02, 6));
  INFO(shifted.parameters[0].sentence);
  CHECK(shifted.parameters[0].verdict == Verdict::not_identified);
  CHECK(shifted.parameters[0].reason == uq::Reason::one_sided);
}

TEST_CASE("a model that fits nowhere is said not to fit, and nothing is identified", "[uq]") {
  const Formula rising = [](const Eigen::VectorXd& p, double x) { return p[0] + p[1] * x; };
  const Eigen::VectorXd falling = Eigen::VectorXd::LinSpaced(6, 1.0, 0.2);
  const uq::Identification found =
      identified(make_case({{"a"}, {"b"}}, rising, six, falling, Eigen::VectorXd::Constant(6, 0.02)));
  CHECK_FALSE(found.fits);
  for (const auto& parameter : found.parameters) CHECK(parameter.verdict == Verdict::does_not_fit);
  CHECK(found.traded.empty());
}

TEST_CASE("verdicts follow when parameters are renamed, reordered and given in other units", "[uq][slow]") {
  // Structural pair (a, b), and c told apart from both. Draws enough to know contractions to 0.01.
  const uq::StopRule stop{.ess_per_chain = 2000.0, .ess_bulk = 8000.0};
  const Formula formula = [](const Eigen::VectorXd& p, double x) { return p[0] * p[1] + p[2] * x; };
  const uq::Identification first = identified(
      make_synthetic({{"a", 0.1, 1.0}, {"b", 0.1, 1.0}, {"c"}}, formula, six, Eigen::Vector3d(0.5, 0.5, 0.5), 0.02, 7),
      1, stop);
  // The same data; the third parameter first, the others renamed, in units a thousand times smaller and larger.
  const Formula reordered = [](const Eigen::VectorXd& p, double x) { return p[2] * 1e3 * p[1] * 1e-18 + p[0] * x; };
  const uq::Identification second =
      identified(make_synthetic({{"zeta"}, {"eta", 0.1e18, 1e18, {}, 1e15}, {"theta", 0.1e-3, 1e-3, {}, 1e-9}},
                                reordered, six, Eigen::Vector3d(0.5, 0.5e18, 0.5e-3), 0.02, 7),
                 1, stop);
  const std::vector<std::size_t> same = {2, 1, 0};  // a is theta, b is eta, c is zeta
  for (std::size_t k = 0; k < 3; ++k) {
    INFO(first.parameters[k].sentence << '\n' << second.parameters[same[k]].sentence);
    CHECK(first.parameters[k].verdict == second.parameters[same[k]].verdict);
    CHECK(first.parameters[k].reason == second.parameters[same[k]].reason);
    CHECK(first.parameters[k].contraction == Approx(second.parameters[same[k]].contraction).margin(0.05));
  }
  REQUIRE(first.traded.size() == 1);
  REQUIRE(second.traded.size() == 1);
  CHECK(first.traded[0].combination == "a * b");
  CHECK(second.traded[0].combination == "eta * theta");
}

TEST_CASE("verdicts are the same words for 95 of 100 data sets where no threshold is near", "[uq][slow]") {
  // Four truths of one formula, from a pair that is told apart to a pair of which only the sum is known.
  struct Setting {
    Formula formula;
    double error;
    std::pair<Verdict, Verdict> verdicts;
  };
  const Formula nearly_alike = [](const Eigen::VectorXd& p, double x) { return 1.0 + p[0] + p[1] * (1.0 + 0.05 * x); };
  const Formula sum = [](const Eigen::VectorXd& p, double x) { return (p[0] + p[1]) * (1.0 + x); };
  const Formula one_hidden = [](const Eigen::VectorXd& p, double x) {
    return 1.0 + p[0] * x + 0.002 * p[1] * (1.0 - x);
  };
  const std::vector<Setting> settings = {
      {told_apart, 0.01, {Verdict::identified, Verdict::identified}},
      {nearly_alike, 0.02, {Verdict::not_identified, Verdict::not_identified}},
      {sum, 0.01, {Verdict::not_identified, Verdict::not_identified}},
      {one_hidden, 0.02, {Verdict::identified, Verdict::not_identified}},
  };
  for (std::size_t k = 0; k < settings.size(); ++k) {
    const Setting& setting = settings[k];
    int same = 0, unfit = 0;
    for (std::uint32_t set = 0; set < 100; ++set) {
      const uq::CaseModel model =
          make_synthetic({{"p"}, {"q"}}, setting.formula, six, Eigen::Vector2d(0.45, 0.55), setting.error, 1000 + set);
      const uq::Draws draws = uq::sample_mixture(uq::posterior_target(std::make_shared<const uq::CaseModel>(model)),
                                                 {.draws = 400, .stop = {.ess_bulk = 600.0}, .seed = set});
      REQUIRE(draws.converged);
      const uq::Identification found = uq::identify(model, draws.pooled());
      unfit += found.fits ? 0 : 1;
      if (found.parameters[0].verdict == setting.verdicts.first &&
          found.parameters[1].verdict == setting.verdicts.second)
        ++same;
    }
    INFO("setting " << k << ": " << same << " of 100 the same, " << unfit << " do not fit");
    CHECK(same >= 95);
  }
}

TEST_CASE("verdicts change places when truths and names do", "[uq][slow]") {
  // Only the second acts enough to be seen; then only the first.
  const Formula second = [](const Eigen::VectorXd& p, double x) { return 1.0 + 0.01 * p[0] * (1.0 - x) + p[1] * x; };
  const Formula first = [](const Eigen::VectorXd& p, double x) { return 1.0 + 0.01 * p[1] * (1.0 - x) + p[0] * x; };
  const uq::Identification a =
      identified(make_synthetic({{"friction"}, {"hamaker"}}, second, six, Eigen::Vector2d(0.3, 0.6), 0.02, 8));
  const uq::Identification b =
      identified(make_synthetic({{"friction"}, {"hamaker"}}, first, six, Eigen::Vector2d(0.6, 0.3), 0.02, 8));
  for (std::size_t k = 0; k < 2; ++k) {
    INFO(a.parameters[k].sentence << '\n' << b.parameters[1 - k].sentence);
    CHECK(a.parameters[k].verdict == b.parameters[1 - k].verdict);
    CHECK(a.parameters[k].reason == b.parameters[1 - k].reason);
  }
  CHECK(a.parameters[0].verdict == Verdict::not_identified);
  CHECK(a.parameters[1].verdict == Verdict::identified);
}
