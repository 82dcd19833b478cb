// Profile intervals against closed forms.
#include "uq/verdict/profile.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "tests/uq/closed_form.hpp"
#include "uq/infer/mixture_sampler.hpp"
#include "uq/posterior/posterior.hpp"
#include "uq/verdict/identifiability.hpp"

using namespace closed_form;

namespace {

/// A function of the parameters as a sum of squares: row i is (f_i(p) - target_i)^2.
uq::CaseModel sum_of_squares(const std::vector<FreeParameter>& unknowns,
                             const std::vector<std::function<double(const Eigen::VectorXd&)>>& terms,
                             const Eigen::VectorXd& targets) {
  const auto rows = static_cast<Eigen::Index>(terms.size());
  const Formula formula = [terms](const Eigen::VectorXd& p, double row) {
    return terms[static_cast<std::size_t>(std::lround(row))](p);
  };
  return make_case(unknowns, formula, Eigen::VectorXd::LinSpaced(rows, 0.0, static_cast<double>(rows - 1)), targets,
                   Eigen::VectorXd::Ones(rows));
}

/// Profiles at a deviance of 4, guided by points all over the box.
uq::Profiles profiles(const uq::CaseModel& model) {
  data::RandomStream random(5, data::Purpose::test, 3);
  Eigen::MatrixXd points(200, model.dimension());
  for (double& u : points.reshaped()) u = random.uniform();
  uq::ProfileOptions options;
  options.thresholds.profile_drop = 4.0;
  return uq::profile_likelihood(model, {.draws = points, .log_likelihood = uq::log_likelihoods(model, points)},
                                options);
}

double shown(const uq::CaseModel& model, const uq::Profile& profile, double u) {
  return model.unknowns[profile.unknown].value(u);
}

std::vector<FreeParameter> box(int count, double half) {
  std::vector<FreeParameter> unknowns;
  for (int k = 0; k < count; ++k) unknowns.push_back({"x" + std::to_string(k + 1), -half, half});
  return unknowns;
}

void check_interval(const uq::CaseModel& model, const uq::Profile& profile, double low, double high) {
  REQUIRE(profile.low);
  REQUIRE(profile.high);
  CHECK(shown(model, profile, *profile.low) == Approx(low).margin(2e-3));
  CHECK(shown(model, profile, *profile.high) == Approx(high).margin(2e-3));
}

}  // namespace

// LikelihoodProfiler.jl's analytic functions (models/AnalyticFuncs/analytic_funcs.jl), threshold 4, range +-20.

TEST_CASE("profile intervals of LikelihoodProfiler.jl's separable functions have its end points", "[uq]") {
  const auto x = [](int k) { return [k](const Eigen::VectorXd& p) { return p[k]; }; };
  SECTION("f_1p and f_2p: (x1 - 3)^2 + (x2 - 4)^2") {
    const uq::CaseModel model = sum_of_squares(box(2, 20.0), {x(0), x(1)}, Eigen::Vector2d(3.0, 4.0));
    const uq::Profiles found = profiles(model);
    check_interval(model, found.profiles[0], 1.0, 5.0);
    check_interval(model, found.profiles[1], 2.0, 6.0);
  }
  SECTION("f_4p_2im: two that do nothing are open on both sides") {
    const uq::CaseModel model = sum_of_squares(box(4, 20.0), {x(0), x(1)}, Eigen::Vector2d(3.0, 4.0));
    const uq::Profiles found = profiles(model);
    check_interval(model, found.profiles[0], 1.0, 5.0);
    check_interval(model, found.profiles[1], 2.0, 6.0);
    for (const std::size_t k : {2u, 3u}) {
      CHECK(found.profiles[k].flat());
      CHECK_FALSE(found.influence[k].some);
    }
  }
  SECTION("f_3p_1im: (x1 - 3)^2 + (x1 - x2 - 1)^2 + 0 x3^2") {
    const uq::CaseModel model = sum_of_squares(
        box(3, 20.0), {x(0), [](const Eigen::VectorXd& p) { return p[0] - p[1]; }}, Eigen::Vector2d(3.0, 1.0));
    const uq::Profiles found = profiles(model);
    check_interval(model, found.profiles[0], 1.0, 5.0);
    check_interval(model, found.profiles[1], 2.0 - 2.0 * std::sqrt(2.0), 2.0 + 2.0 * std::sqrt(2.0));
    CHECK(found.profiles[2].flat());
  }
}

TEST_CASE("profile intervals of LikelihoodProfiler.jl's curved functions have its end points", "[uq]") {
  SECTION("f_3p_1im2: (x1 - 3)^2 + (exp x2 - 1)^2, open below in x2") {
    const uq::CaseModel model = sum_of_squares(
        box(3, 20.0),
        {[](const Eigen::VectorXd& p) { return p[0]; }, [](const Eigen::VectorXd& p) { return std::exp(p[1]); }},
        Eigen::Vector2d(3.0, 1.0));
    const uq::Profiles found = profiles(model);
    check_interval(model, found.profiles[0], 1.0, 5.0);
    CHECK_FALSE(found.profiles[1].low);
    REQUIRE(found.profiles[1].high);
    CHECK(shown(model, found.profiles[1], *found.profiles[1].high) == Approx(std::log(3.0)).margin(2e-3));
    CHECK(found.profiles[2].flat());
  }
  SECTION("rosenbrock: (1 - x1)^2 + 100 (x2 - x1^2)^2") {
    const uq::CaseModel model = sum_of_squares(box(2, 10.0),
                                               {[](const Eigen::VectorXd& p) { return p[0]; },
                                                [](const Eigen::VectorXd& p) { return 10.0 * (p[1] - p[0] * p[0]); }},
                                               Eigen::Vector2d(1.0, 0.0));
    const uq::Profiles found = profiles(model);
    check_interval(model, found.profiles[0], -1.0, 3.0);
    REQUIRE(found.profiles[1].low);
    REQUIRE(found.profiles[1].high);
    CHECK(shown(model, found.profiles[1], *found.profiles[1].low) == Approx(-0.174).margin(2e-3));
    CHECK(shown(model, found.profiles[1], *found.profiles[1].high) == Approx(9.0).margin(5e-3));
  }
  SECTION("f_5p: 20 (x1^2 - 3 x1 + 2)^2 + (x2 - 1)^2, two minima in one interval") {
    const uq::CaseModel model =
        sum_of_squares(box(2, 20.0),
                       {[](const Eigen::VectorXd& p) { return std::sqrt(20.0) * (p[0] * p[0] - 3.0 * p[0] + 2.0); },
                        [](const Eigen::VectorXd& p) { return p[1]; }},
                       Eigen::Vector2d(0.0, 1.0));
    const uq::Profiles found = profiles(model);
    const double half = std::sqrt(9.0 - 4.0 * (2.0 - 1.0 / std::sqrt(5.0))) / 2.0;
    check_interval(model, found.profiles[0], 1.5 - half, 1.5 + half);
    check_interval(model, found.profiles[1], -1.0, 3.0);
    CHECK(found.profiles[0].parts.size() == 1);
  }
}

TEST_CASE("an interval in two parts has the ends of each, by its closed form", "[uq]") {
  // 400 (x1^2 - 3 x1 + 2)^2: below 4 where |x1^2 - 3 x1 + 2| <= 0.1, which has four roots.
  const uq::CaseModel model = sum_of_squares(
      {{"x1", 0.0, 3.0}}, {[](const Eigen::VectorXd& p) { return 20.0 * (p[0] * p[0] - 3.0 * p[0] + 2.0); }},
      Eigen::VectorXd::Zero(1));
  const uq::Profiles found = profiles(model);
  const uq::Profile& profile = found.profiles[0];
  REQUIRE(profile.parts.size() == 2);
  const double far = std::sqrt(0.25 + 0.1), near = std::sqrt(0.25 - 0.1);
  CHECK(shown(model, profile, profile.parts[0].low) == Approx(1.5 - far).margin(1e-3));
  CHECK(shown(model, profile, profile.parts[0].high) == Approx(1.5 - near).margin(1e-3));
  CHECK(shown(model, profile, profile.parts[1].low) == Approx(1.5 + near).margin(1e-3));
  CHECK(shown(model, profile, profile.parts[1].high) == Approx(1.5 + far).margin(1e-3));
  REQUIRE(profile.barriers.size() == 1);
  CHECK_FALSE(profile.barriers[0].in_doubt);
}

TEST_CASE("a narrow second maximum that no draw has seen is found, and its absence from the draws is told", "[uq]") {
  // Wells of equal width at 0.2 and 0.78, narrower than the profile's even steps, of which none falls into the second;
  // the draws are all in the first.
  const uq::CaseModel model = sum_of_squares(
      {{"x1", 0.0, 1.0}}, {[](const Eigen::VectorXd& p) { return 1000.0 * (p[0] - 0.2) * (p[0] - 0.78); }},
      Eigen::VectorXd::Zero(1));
  data::RandomStream random(6, data::Purpose::test, 4);
  Eigen::MatrixXd draws(500, 1);
  for (double& u : draws.reshaped()) u = 0.2 + random.normal() / 580.0;
  const uq::Profiles found =
      uq::profile_likelihood(model, {.draws = draws, .log_likelihood = uq::log_likelihoods(model, draws)});
  CHECK(found.profiles[0].parts.size() == 2);
  const std::vector<std::string> missed = uq::unvisited(model, found, draws);
  REQUIRE(missed.size() == 1);
  CHECK(missed[0].rfind("x1 near 0.78", 0) == 0);
}

TEST_CASE("PUQ's unidentifiable case: its contractions, one parameter known and one not", "[uq]") {
  // Surer, Plumlee, Wild (2024): th on [-8, 8]^2, y = 0, variances (100, 1): contraction .083 and .953.
  const Formula each = [](const Eigen::VectorXd& p, double row) { return row < 0.5 ? p[0] : p[1]; };
  const uq::CaseModel model = make_case({{"t1", -8.0, 8.0}, {"t2", -8.0, 8.0}}, each, Eigen::Vector2d(0.0, 1.0),
                                        Eigen::Vector2d::Zero(), Eigen::Vector2d(10.0, 1.0));
  const uq::Draws draws =
      uq::sample_mixture(uq::posterior_target(std::make_shared<const uq::CaseModel>(model)), {.seed = 1});
  const uq::Identification found = uq::identify(model, draws.pooled());
  CHECK(found.parameters[0].contraction == Approx(0.083).margin(0.04));
  CHECK(found.parameters[1].contraction == Approx(0.953).margin(0.01));
  CHECK(found.parameters[0].verdict == uq::Verdict::not_identified);
  CHECK(found.parameters[0].reason == uq::Reason::practical);
  CHECK(found.parameters[1].verdict == uq::Verdict::identified);
  CHECK(found.traded.empty());
}

TEST_CASE("a nuisance that undoes a parameter leaves it open in one piece, and the other parameter closed", "[uq]") {
  // y = 2 + 8 a + o + c z to 0.2 %: a and the offset o trade exactly.
  const Formula formula = [](const Eigen::VectorXd& p, double z) { return 2.0 + 8.0 * p[0] + p[1] * z; };
  const Eigen::VectorXd z = Eigen::VectorXd::LinSpaced(6, 0.0, 2.5);
  for (const double sd : {20.0, 200.0}) {
    CAPTURE(sd);
    Eigen::VectorXd y(6);
    for (int i = 0; i < 6; ++i) y[i] = formula(Eigen::Vector2d(0.4, 1.2), z[i]) * (1.0 + 1e-3 * std::sin(5.0 * i));
    uq::CaseModel model = make_case({{"a", 0.1, 0.8}, {"c", 0.0, 3.0}}, formula, z, y, 0.002 * y);
    data::Parameter offset{.name = "offset", .target = "offset", .low = -8.0 * sd, .high = 8.0 * sd};
    offset.prior = {.kind = data::PriorKind::normal, .low = offset.low, .high = offset.high, .mean = 0.0, .sd = sd};
    model.unknowns.push_back({.label = "offset",
                              .prior = uq::ScaledPrior(offset, offset.prior),
                              .own = false,
                              .nuisance = data::NuisanceKind::offset,
                              .cut = {}});
    model.groups[0].measurement.sets = {{.first = 0, .count = 6, .factors = {}, .offsets = {2}, .settings = {}}};
    uq::find_coordinates(model.groups[0], 3);
    const uq::Profiles found = profiles(model);
    const uq::Profile &a = found.profiles[0], &c = found.profiles[1];
    // The offset takes up all of a's range at a deviance of (8 (a - 0.4) / sd)^2.
    CHECK(a.deviance.maxCoeff() < 0.1);
    CHECK(a.parts.size() == 1);
    CHECK_FALSE(a.low);
    CHECK_FALSE(a.high);
    // Weighted least squares with the constant free: the closed form of c's error.
    const Eigen::ArrayXd weight = (0.002 * y).array().square().inverse();
    const double mean = (weight * z.array()).sum() / weight.sum();
    const double error = 1.0 / std::sqrt((weight * (z.array() - mean).square()).sum());
    const double best = (weight * (z.array() - mean) * y.array()).sum() * error * error;
    check_interval(model, c, best - 2.0 * error, best + 2.0 * error);
  }
}

TEST_CASE("an interval that ends where no run was made is open there, and says where the runs end", "[uq]") {
  // One reading of x +- 1 at 2, in a range of -10 to 10: 0 to 4 at a drop of 4.
  uq::CaseModel model = sum_of_squares({{"x", -10.0, 10.0}}, {[](const Eigen::VectorXd& p) { return p[0]; }},
                                       Eigen::VectorXd::Constant(1, 2.0));
  const auto with_runs = [&](double low, double high) {  // in the unit cube
    auto cloud = std::make_shared<uq::RunCloud>();
    cloud->points = Eigen::MatrixXd::Zero(40, model.groups[0].base.cols());
    for (Eigen::Index k = 0; k < cloud->points.cols(); ++k)
      cloud->points.col(k) = Eigen::VectorXd::LinSpaced(40, low, high);
    cloud->length_scales = Eigen::VectorXd::Ones(cloud->points.cols());
    cloud->prior_variance = 1.0;
    model.groups[0].emulator.runs = cloud;
    return profiles(model).profiles.at(0);
  };
  check_interval(model, with_runs(0.0, 1.0), 0.0, 4.0);
  check_interval(model, with_runs(0.4, 0.75), 0.0, 4.0);  // -2 to 5
  const uq::Profile above = with_runs(0.0, 0.65);         // up to 3
  CHECK_FALSE(above.high);
  REQUIRE(above.runs_end_high);
  CHECK(shown(model, above, *above.runs_end_high) == Approx(3.0));
  CHECK(shown(model, above, above.low.value()) == Approx(0.0).margin(2e-3));
  const uq::Profile below = with_runs(0.55, 1.0);  // from 1
  CHECK_FALSE(below.low);
  CHECK(shown(model, below, below.runs_end_low.value()) == Approx(1.0));
}

TEST_CASE("what only the surrogate's ignorance speaks against is not excluded", "[uq]") {
  // One reading of x +- 1 at 2, in a range of -10 to 10: 0 to 4 at a drop of 4. A surrogate of sd s adds log(1 + s^2)
  // to the deviance: beyond 4 for s above 7.4, though such a prediction excludes nothing.
  const auto with_sd = [](const std::function<double(double)>& sd) {
    uq::CaseModel model = sum_of_squares({{"x", -10.0, 10.0}}, {[](const Eigen::VectorXd& p) { return p[0]; }},
                                         Eigen::VectorXd::Constant(1, 2.0));
    const auto exact = model.groups[0].emulator.predict;
    model.groups[0].emulator.predict = [exact, sd](const Eigen::MatrixXd& points) {
      surrogate::Prediction found = exact(points);
      for (Eigen::Index i = 0; i < points.rows(); ++i) found.covariance(i, i) += std::pow(sd(found.mean[i]), 2);
      return found;
    };
    model.distinct.reset();
    return std::pair{model, profiles(model).profiles.at(0)};
  };
  SECTION("from 3 on to the end of the range") {
    const auto [model, profile] = with_sd([](double x) { return x > 3.0 ? 30.0 * (x - 3.0) : 0.0; });
    CHECK_FALSE(profile.high);
    CHECK(profile.high_unknown);
    CHECK(shown(model, profile, profile.low.value()) == Approx(0.0).margin(2e-3));
    CHECK_FALSE(profile.low_unknown);
  }
  SECTION("in a gap, beyond which the data exclude") {
    const auto [model, profile] = with_sd([](double x) { return x > 3.0 && x < 6.0 ? 30.0 : 0.0; });
    CHECK(profile.high);
    CHECK_FALSE(profile.high_unknown);
  }
  SECTION("the same everywhere: an error like another") {
    const auto [model, profile] = with_sd([](double) { return 1.0; });
    check_interval(model, profile, 2.0 - 2.0 * std::sqrt(2.0), 2.0 + 2.0 * std::sqrt(2.0));
  }
}
