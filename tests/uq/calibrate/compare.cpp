// Bayes factors of linked cases, where both sides must see the same data, against quadrature in two dimensions.
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/temporary.hpp"
#include "uq/calibrate/calibrate.hpp"
#include "uq/infer/quadrature.hpp"
#include "uq/posterior/held.hpp"
#include "uq/posterior/posterior.hpp"

using namespace uq;

namespace {

/// torque = (friction + cohesion speed / 10) N m, cohesion and friction from 0 to 1; an error of the emulator of `sd`,
/// the same everywhere.
std::vector<Emulator> formula(double sd) {
  Emulator emulator{.material = "",
                    .output = 0,
                    .inputs = {{InputKind::parameter, 0}, {InputKind::parameter, 1}, {InputKind::control, 0}},
                    .constants = {},
                    .control_range = {},
                    .predict = {}};
  emulator.predict = [sd](const Eigen::MatrixXd& points) -> surrogate::Prediction {
    return {.mean = points.col(0) + points.col(1).cwiseProduct(points.col(2)),
            .covariance = Eigen::MatrixXd::Constant(points.rows(), points.rows(), sd * sd)};
  };
  return {emulator};
}

/// Case "one" measures friction alone, at speed 0, and cohesion is fixed; "two" takes its friction and measures both.
data::Study linked(const TemporaryFolder& folder, const std::string& compare) {
  folder.write("one.csv", "speed,torque,torque_se\n0,0.41,0.02\n0,0.38,0.02\n");
  folder.write("two.csv", "speed,torque,torque_se\n2,0.46,0.02\n5,0.56,0.02\n9,0.68,0.02\n");
  const data::StudyFile file = data::StudyFile::open(folder.write(
      "study.toml",
      "[study]\nname = \"s\"\nseed = 5\n[parameters.friction]\nlow = 0\nhigh = 1\n[parameters.cohesion]\nlow = 0\nhigh "
      "= 1\n"
      "[training]\ntable = \"runs.csv\"\n[outputs.torque]\nunit = \"N m\"\n"
      "[controls.speed]\nunit = \"rad/s\"\nlow = 0\nhigh = 10\n"
      "[[observe]]\nname = \"one\"\nfile = \"one.csv\"\n[[observe]]\nname = \"two\"\nfile = \"two.csv\"\n"
      "[[calibrate]]\nname = \"one\"\nobserve = [\"one\"]\nfree = [\"friction\"]\nfixed = { cohesion = 0 }\n"
      "[[calibrate]]\nname = \"two\"\nobserve = [\"two\"]\nfree = [\"friction\", \"cohesion\"]\n"
      "priors = { friction = { posterior = \"one\" } }\n" +
          compare));
  data::Study study = data::read_study(file);
  file.finish();
  return study;
}

}  // namespace

TEST_CASE("holding a linked parameter keeps the linked case's data: the factor is that of quadrature", "[uq]") {
  for (const double value : {0.4, 0.3}) {
    const TemporaryFolder folder;
    const data::Study study = linked(folder, "compare = { friction = " + std::to_string(value) + " }\n");
    const SampledCase sampled = sample_case(study, formula(0.0), 1);
    REQUIRE(sampled.draws.converged);
    CHECK(sampled.model->row_count() == 5);
    const std::vector<ModelComparison> found = compare_models(study, sampled, 1);
    REQUIRE(found.size() == 1);
    const Quadrature free = integrate(posterior_target(sampled.model));
    const Quadrature held = integrate(held_target(sampled.model, {{0, value}}));
    INFO(found[0].sentence);
    const double exact = free.log_evidence - held.log_evidence;
    CHECK(std::abs(found[0].log_bayes_factor - exact) < 4.0 * found[0].error + 1e-3);
    CHECK(found[0].error < 0.05);
    CHECK(found[0].surrogate_error == 0.0);
    // The truth is 0.4: the data do not ask for it to be free.
    if (value == 0.4) CHECK(found[0].log_bayes_factor < 0.0);
  }
}

TEST_CASE("a factor's error holds what the surrogate does not know", "[uq]") {
  const TemporaryFolder folder;
  const data::Study study = linked(folder, "compare = { cohesion = 0.2 }\n");
  // An error of the emulator that grows with the speed stands for cohesion: ln Z_free(f) - ln Z_held(f) over f = z sd
  // speed, z ~ N(0, 1) given the data, by quadrature with f known.
  constexpr double sd = 0.003;
  double first = 0.0, second = 0.0, weight = 0.0;
  for (double z = -3.0; z < 3.01; z += 0.5) {
    std::vector<Emulator> shifted = formula(0.0);
    shifted[0].predict = [exact = shifted[0].predict, z](const Eigen::MatrixXd& points) {
      surrogate::Prediction found = exact(points);
      found.mean += sd * z * points.col(2);
      return found;
    };
    const auto model = std::make_shared<const CaseModel>(build_case(study, shifted, 1));
    const double free = integrate(posterior_target(model)).log_evidence;
    const double factor = free - integrate(held_target(model, {{1, 0.2}})).log_evidence;
    const double p = std::exp(-0.5 * z * z + free);
    weight += p;
    first += p * factor;
    second += p * factor * factor;
  }
  const double exact = std::sqrt(second / weight - std::pow(first / weight, 2)), exact_mean = first / weight;
  const auto part = [&](bool grows) {
    std::vector<Emulator> uncertain = formula(0.0);
    uncertain[0].predict = [known = uncertain[0].predict, grows, sd = sd](const Eigen::MatrixXd& points) {
      surrogate::Prediction found = known(points);
      const Eigen::VectorXd error =
          grows ? Eigen::VectorXd(sd * points.col(2)) : Eigen::VectorXd::Constant(points.rows(), sd);
      found.covariance = error * error.transpose();
      return found;
    };
    const std::vector<ModelComparison> found = compare_models(study, sample_case(study, uncertain, 1), 1);
    REQUIRE(found.size() == 1);
    CHECK(found[0].error >= found[0].surrogate_error);
    if (grows) CHECK(found[0].sharper_factor == Approx(exact_mean).margin(0.15 * exact));
    return found[0].surrogate_error;
  };
  CHECK(exact > 0.5);
  CHECK(part(true) == Approx(exact).epsilon(0.1));
  // An error that is the same everywhere is friction's, which is free on both sides.
  CHECK(part(false) < 0.01 * exact);
}

TEST_CASE("a factor that a sharper surrogate could turn round decides nothing", "[uq]") {
  const TemporaryFolder folder;
  const data::Study study = linked(folder, "compare = { cohesion = 0.25 }\n");
  std::vector<Emulator> uncertain = formula(0.0);
  uncertain[0].predict = [known = uncertain[0].predict](const Eigen::MatrixXd& points) {
    surrogate::Prediction found = known(points);
    const Eigen::VectorXd error = 0.03 * points.col(2);
    found.covariance = error * error.transpose();
    return found;
  };
  const std::vector<ModelComparison> found = compare_models(study, sample_case(study, uncertain, 1), 1);
  REQUIRE(found.size() == 1);
  INFO(found[0].sentence);
  REQUIRE(found[0].surrogate_error > std::abs(found[0].sharper_factor));
  CHECK_THAT(found[0].sentence, Catch::StartsWith("The data do not decide"));
}

TEST_CASE("a comparison whose held value the data rule out is a finding, not an end", "[uq]") {
  const TemporaryFolder folder;
  const data::Study study = linked(folder, "compare = { friction = 1 }\n");
  const SampledCase sampled = sample_case(study, formula(0.0), 1);
  const std::vector<ModelComparison> found = compare_models(study, sampled, 1);
  REQUIRE(found.size() == 1);
  CHECK(found[0].log_bayes_factor > 100.0);
}
