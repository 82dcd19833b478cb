// What a meter adds to a prediction: gradients against differences, closed forms of integrated nuisances, and the keys
// of a study.
#include "uq/posterior/measurement.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "surrogate/fit.hpp"
#include "tests/uq/closed_form.hpp"
#include "uq/infer/diagnostics.hpp"
#include "uq/infer/mixture_sampler.hpp"
#include "uq/infer/quadrature.hpp"
#include "uq/posterior/posterior.hpp"
#include "uq/verdict/identifiability.hpp"

using namespace closed_form;

namespace {

const Eigen::VectorXd five = Eigen::VectorXd::LinSpaced(5, 0.1, 0.9);

data::Prior normal_prior(double mean, double sd) {
  return {.kind = data::PriorKind::normal, .low = mean - 8.0 * sd, .high = mean + 8.0 * sd, .mean = mean, .sd = sd};
}

uq::Unknown nuisance(const std::string& name, data::NuisanceKind kind, double mean, double sd) {
  data::Parameter parameter{.name = name, .target = name, .low = mean - 8.0 * sd, .high = mean + 8.0 * sd};
  return {.label = name,
          .prior = uq::ScaledPrior(parameter, normal_prior(mean, sd)),
          .own = false,
          .nuisance = kind,
          .cut = {}};
}

uq::ReadSet all_rows(Eigen::Index count) { return {.first = 0, .count = count, .factors = {}, .settings = {}}; }

/// A process over (a, b, x).
uq::Emulator process_of(const std::vector<uq::EmulatorInput>& inputs) {
  surrogate::TrainingSet set{
      .x = Eigen::MatrixXd(40, 3), .y = Eigen::VectorXd(40), .noise_variance = Eigen::VectorXd::Constant(40, 1e-4)};
  data::RandomStream random(1, data::Purpose::test);
  for (Eigen::Index i = 0; i < 40; ++i) {
    for (Eigen::Index k = 0; k < 3; ++k) set.x(i, k) = random.uniform();
    set.y[i] =
        1.0 + std::sin(3.0 * set.x(i, 0)) + set.x(i, 1) * set.x(i, 1) + 0.5 * set.x(i, 2) + 0.01 * random.normal();
  }
  return uq::make_emulator(std::make_shared<const surrogate::GaussianProcess>(surrogate::fit(set, {.starts = 2})), "",
                           0, inputs);
}

/// A line a + b x with normal priors, linear in everything: integrals of nuisances are Gaussian.
uq::CaseModel line(const Eigen::VectorXd& y, double sd) {
  const Formula formula = [](const Eigen::VectorXd& p, double x) { return p[0] + p[1] * x; };
  return make_case({{"a", -7.0, 9.0, normal_prior(1.0, 1.0)}, {"b", -8.0, 8.0, normal_prior(0.0, 1.0)}}, formula, five,
                   y, Eigen::VectorXd::Constant(5, sd));
}

/// Mean and covariance of the line's parameters given data of covariance S.
struct Exact {
  Eigen::Vector2d mean;
  Eigen::Matrix2d covariance;
};
Exact exact_line(const Eigen::VectorXd& y, const Eigen::MatrixXd& noise) {
  Eigen::MatrixXd x(5, 2);
  x << Eigen::VectorXd::Ones(5), five;
  const Eigen::MatrixXd weights = noise.inverse();
  const Eigen::Vector2d prior_mean(1.0, 0.0);
  const Eigen::Matrix2d precision = x.transpose() * weights * x + Eigen::Matrix2d::Identity();
  const Eigen::Matrix2d covariance = precision.inverse();
  const Eigen::Vector2d mean = covariance * (x.transpose() * weights * y + prior_mean);
  return {.mean = mean, .covariance = covariance};
}

/// The first two unknowns' moments from draws, in their own units.
void check_moments(const uq::CaseModel& model, const Exact& exact) {
  const uq::Draws draws = uq::sample_mixture(uq::posterior_target(std::make_shared<const uq::CaseModel>(model)),
                                             {.draws = 4000, .seed = 5});
  INFO(draws.reason);
  REQUIRE(draws.converged);
  for (int k = 0; k < 2; ++k) {
    Eigen::MatrixXd values = draws.coordinate(k);
    for (double& value : values.reshaped()) value = model.unknowns[k].value(value);
    const double sd = std::sqrt(exact.covariance(k, k));
    CHECK(std::abs(values.mean() - exact.mean[k]) < 4.0 * uq::mean_mcse(values));
    CHECK(std::sqrt((values.array() - values.mean()).square().mean()) == Approx(sd).epsilon(0.03));
  }
}

const Eigen::VectorXd line_data = (Eigen::VectorXd(5) << 1.31, 1.22, 1.55, 1.71, 1.66).finished();

}  // namespace

TEST_CASE("the gradient through gain, offset, noise, common errors, settings and discrepancy is that of differences",
          "[uq]") {
  uq::CaseModel model =
      make_case({{"a"}, {"b"}}, {}, five, Eigen::VectorXd::LinSpaced(5, 1.9, 2.4), Eigen::VectorXd::Constant(5, 0.05));
  uq::RowGroup& group = model.groups[0];
  group.emulator = process_of(group.emulator.inputs);
  model.unknowns.push_back(nuisance("gain", data::NuisanceKind::gain, 1.0, 0.05));
  model.unknowns.push_back(nuisance("scale", data::NuisanceKind::scale, 2.0, 0.1));
  model.unknowns.push_back(nuisance("offset", data::NuisanceKind::offset, 0.1, 0.05));
  model.unknowns.push_back(nuisance("noise", data::NuisanceKind::noise_scale, 1.2, 0.1));
  model.unknowns.push_back(nuisance("discrepancy_sd", data::NuisanceKind::discrepancy_sd, 0.1, 0.01));
  model.unknowns.push_back(nuisance("discrepancy_length", data::NuisanceKind::discrepancy_length, 0.4, 0.03));
  uq::ReadSet first = all_rows(3), second = all_rows(2);
  second.first = 3;
  first.factors = {2, 3};
  first.offsets = {4};
  first.noise = 5;
  first.common_absolute = 0.02;
  first.common_relative = 0.03;
  first.settings = {
      {.column = 2, .error = Eigen::VectorXd::Constant(3, 0.05), .level = Eigen::Vector3d(1.0, 2.0, 1.0)},
      {.column = 2, .error = Eigen::VectorXd::LinSpaced(3, 0.02, 0.04), .level = Eigen::Vector3d::Zero()}};
  second.factor = 1.5;
  second.factors = {2};
  second.noise = 5;
  second.noise_is_sd = true;
  second.settings = {{.column = 2, .error = Eigen::VectorXd::Constant(2, 0.03), .level = Eigen::Vector2d::Zero()}};
  group.measurement.sets = {first, second};
  group.measurement.discrepancies = {
      {.first = 1, .count = 4, .sd = 6, .length = 7, .magnitude = 2.0, .controls = five.tail(4)}};
  uq::find_coordinates(group, model.dimension());
  REQUIRE(group.uniform);
  const auto matches = [](const uq::CaseModel& tested, const std::vector<double>& at) {
    const uq::Target target = uq::posterior_target(std::make_shared<const uq::CaseModel>(tested));
    const Eigen::VectorXd u = Eigen::Map<const Eigen::VectorXd>(at.data(), 8);
    const uq::Evaluation found = target.log_density_gradient(u);
    CHECK(found.value == Approx(target.log_density(u)).epsilon(1e-10));
    CHECK(target.log_densities(u.transpose())[0] == Approx(found.value).epsilon(1e-10));
    for (Eigen::Index k = 0; k < 8; ++k) {
      Eigen::VectorXd up = u, down = u;
      up[k] += 1e-5;
      down[k] -= 1e-5;
      INFO("unknown " << k);
      const double difference = (target.log_density(up) - target.log_density(down)) / 2e-5;
      CHECK(found.gradient[k] == Approx(difference).epsilon(1e-4).margin(1e-4));
    }
  };
  matches(model, {0.3, 0.4, 0.5, 0.45, 0.6, 0.4, 0.5, 0.55});
  matches(model, {0.8, 0.2, 0.6, 0.5, 0.3, 0.7, 0.6, 0.4});
  // Also where no common shift exists.
  model.groups[0].unknown(0, 1) = -1;
  model.groups[0].base(0, 1) = 0.5;
  uq::find_coordinates(model.groups[0], model.dimension());
  REQUIRE_FALSE(model.groups[0].uniform);
  matches(model, {0.3, 0.4, 0.5, 0.45, 0.6, 0.4, 0.5, 0.55});
}

TEST_CASE("an unknown offset with a normal prior widens the posterior as the closed form says", "[uq]") {
  uq::CaseModel model = line(line_data, 0.05);
  model.unknowns.push_back(nuisance("offset", data::NuisanceKind::offset, 0.2, 0.3));
  uq::ReadSet set = all_rows(5);
  set.offsets = {2};
  model.groups[0].measurement.sets = {set};
  const Eigen::MatrixXd noise = 0.0025 * Eigen::MatrixXd::Identity(5, 5) + 0.09 * Eigen::MatrixXd::Ones(5, 5);
  check_moments(model, exact_line(line_data.array() - 0.2, noise));
}

TEST_CASE("an error common to all points is an unknown offset that was integrated out", "[uq]") {
  uq::CaseModel model = line(line_data, 0.05);
  uq::ReadSet set = all_rows(5);
  set.common_absolute = 0.3;
  model.groups[0].measurement.sets = {set};
  const Eigen::MatrixXd noise = 0.0025 * Eigen::MatrixXd::Identity(5, 5) + 0.09 * Eigen::MatrixXd::Ones(5, 5);
  check_moments(model, exact_line(line_data, noise));
}

TEST_CASE("a control's error enters by the slope of the model, and rows of one level share it", "[uq]") {
  // At b = 0.5 nearly fixed, an error e of x is an error 0.5 e of y.
  uq::CaseModel model = line(line_data, 0.05);
  for (const std::vector<double>& level : {std::vector<double>{0, 0, 0, 0, 0}, {1, 2, 3, 4, 5}, {1, 2, 1, 2, 3}}) {
    uq::ReadSet set = all_rows(5);
    set.settings = {{.column = 2,
                     .error = Eigen::VectorXd::Constant(5, 0.2),
                     .level = Eigen::Map<const Eigen::VectorXd>(level.data(), 5)}};
    model.groups[0].measurement.sets = {set};
    const Eigen::Vector2d u(0.5, 0.5 + 0.5 / 16.0);
    const Eigen::MatrixXd covariance = uq::predict(model, u).covariance;
    for (Eigen::Index i = 0; i < 5; ++i)
      for (Eigen::Index j = 0; j < 5; ++j)
        CHECK(covariance(i, j) == Approx(level[i] == level[j] ? 0.01 : 0.0).margin(1e-10));
  }
}

TEST_CASE("a relative common error is a gain that was integrated out: the same posterior to first order", "[uq]") {
  const uq::CaseModel plain = line(line_data, 0.05);
  uq::CaseModel with_gain = plain, with_covariance = plain;
  with_gain.unknowns.push_back(nuisance("gain", data::NuisanceKind::gain, 1.0, 0.03));
  uq::ReadSet set = all_rows(5);
  set.factors = {2};
  with_gain.groups[0].measurement.sets = {set};
  set.factors.clear();
  set.common_relative = 0.03;
  with_covariance.groups[0].measurement.sets = {set};
  const auto sample = [](const uq::CaseModel& model) {
    return uq::sample_mixture(uq::posterior_target(std::make_shared<const uq::CaseModel>(model)),
                              {.draws = 4000, .seed = 6});
  };
  const uq::Draws a = sample(with_gain), b = sample(with_covariance);
  REQUIRE(a.converged);
  REQUIRE(b.converged);
  for (int k = 0; k < 2; ++k) {
    const Eigen::MatrixXd x = a.coordinate(k), y = b.coordinate(k);
    CHECK(std::abs(x.mean() - y.mean()) < 4.0 * std::hypot(uq::mean_mcse(x), uq::mean_mcse(y)) + 2e-4);
    CHECK(std::sqrt((x.array() - x.mean()).square().mean()) ==
          Approx(std::sqrt((y.array() - y.mean()).square().mean())).epsilon(0.04));
  }
}

TEST_CASE("an unknown noise scale finds the scatter that the data have, and widens the parameters with it", "[uq]") {
  // Twenty points with three times the stated scatter.
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(20, 0.0, 1.0);
  data::RandomStream random(4, data::Purpose::test);
  Eigen::VectorXd y(20);
  for (Eigen::Index i = 0; i < 20; ++i) y[i] = 1.0 + 0.5 * x[i] + 0.15 * random.normal();
  const Formula formula = [](const Eigen::VectorXd& p, double at) { return p[0] + p[1] * at; };
  uq::CaseModel model =
      make_case({{"a", -3.0, 3.0}, {"b", -3.0, 3.0}}, formula, x, y, Eigen::VectorXd::Constant(20, 0.05));
  data::Parameter parameter{.name = "noise", .target = "noise", .low = 0.1, .high = 10.0, .scale = data::Scale::log};
  const data::Prior prior{.kind = data::PriorKind::log_normal, .low = 0.1, .high = 10.0, .mean = 1.0, .sd = 0.5};
  const auto sd_of_slope = [](const uq::CaseModel& tested) {
    const uq::Draws draws =
        uq::sample_mixture(uq::posterior_target(std::make_shared<const uq::CaseModel>(tested)), {.seed = 3});
    REQUIRE(draws.converged);
    Eigen::VectorXd slope = draws.pooled().col(1);
    return std::pair{std::sqrt((slope.array() - slope.mean()).square().mean()), draws};
  };
  const double stated = sd_of_slope(model).first;
  model.unknowns.push_back({.label = "noise",
                            .prior = uq::ScaledPrior(parameter, prior),
                            .own = false,
                            .nuisance = data::NuisanceKind::noise_scale,
                            .cut = {}});
  uq::ReadSet set = all_rows(20);
  set.noise = 2;
  model.groups[0].measurement.sets = {set};
  const auto [widened, draws] = sd_of_slope(model);
  Eigen::VectorXd scale = draws.pooled().col(2);
  for (double& value : scale) value = model.unknowns[2].value(value);
  CHECK(uq::quantile(scale, 0.05) < 3.0);
  CHECK(uq::quantile(scale, 0.95) > 2.4);
  CHECK(widened / stated == Approx(scale.mean()).epsilon(0.1));
}

TEST_CASE(
    "a gain known to 2 % leaves its 2 % in a parameter that multiplies, and a gain of no prior would leave nothing",
    "[uq]") {
  const Formula product = [](const Eigen::VectorXd& p, double x) { return p[0] * (1.0 + x); };
  for (const double sd : {0.02, 0.5}) {
    uq::CaseModel model = make_synthetic({{"a", 0.0, 4.0}}, product, five, Eigen::VectorXd::Constant(1, 1.0), 0.03, 1);
    model.unknowns.push_back(nuisance("gain", data::NuisanceKind::gain, 1.0, sd));
    model.unknowns[1].prior = [&] {
      data::Parameter parameter{
          .name = "gain", .target = "gain", .low = std::max(0.02, 1.0 - 6.0 * sd), .high = 1.0 + 6.0 * sd};
      data::Prior prior = normal_prior(1.0, sd);
      prior.low = parameter.low;
      prior.high = parameter.high;
      return uq::ScaledPrior(parameter, prior);
    }();
    uq::ReadSet set = all_rows(5);
    set.factors = {1};
    model.groups[0].measurement.sets = {set};
    const uq::Draws draws =
        uq::sample_mixture(uq::posterior_target(std::make_shared<const uq::CaseModel>(model)), {.seed = 3});
    INFO(draws.reason);
    REQUIRE(draws.converged);
    const uq::Identification found = uq::identify(model, draws.pooled());
    INFO(found.parameters[0].sentence);
    REQUIRE(found.parameters.size() == 1);
    if (sd < 0.1) {
      CHECK(found.parameters[0].verdict == uq::Verdict::identified);
      const double expected = std::hypot(0.02, 0.03 / std::sqrt(5.0));
      CHECK(found.parameters[0].sd == Approx(expected).epsilon(0.1));
      // The profile knows of the meter's certificate.
      REQUIRE(found.parameters[0].profile_high);
      CHECK(*found.parameters[0].profile_high - *found.parameters[0].profile_low ==
            Approx(3.92 * expected).epsilon(0.1));
    } else {
      CHECK(found.parameters[0].verdict != uq::Verdict::identified);
    }
  }
}
