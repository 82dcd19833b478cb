// Stated errors of the runs against what they scatter by.
#include "surrogate/noise_check.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "data/random.hpp"
#include "surrogate/design.hpp"

using namespace surrogate;

namespace {

TrainingSet runs_of(double noise_sd, double stated_sd, double wave, std::uint64_t seed) {
  data::RandomStream random(seed, data::Purpose::test, 5);
  TrainingSet training{scrambled_sobol(60, 3, seed), Eigen::VectorXd(60),
                       Eigen::VectorXd::Constant(60, stated_sd * stated_sd)};
  for (int i = 0; i < 60; ++i) {
    const Eigen::VectorXd x = training.x.row(i);
    training.y[i] = 3.0 + std::sin(2.0 * x[0]) + x[0] * x[1] + 0.5 * x[2] + noise_sd * random.normal() +
                    wave * std::sin(12.0 * x[0] + 9.0 * x[1] + 6.0 * x[2]);
  }
  return training;
}

struct Alarms {
  int small = 0, large = 0;
};

Alarms alarms(double noise_sd, double stated_sd, double wave) {
  Alarms found;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const TrainingSet training = runs_of(noise_sd, stated_sd, wave, seed);
    const NoiseCheck check = check_noise(training, {.starts = 2}, fit(training, {.starts = 2}));
    found.small += check.understated();
    found.large += check.overstated();
  }
  return found;
}

}  // namespace

TEST_CASE(
    "errors of the runs that are stated half or double, and a wave finer than the runs, are noticed, and true ones "
    "not") {
  const Alarms none = alarms(0.06, 0.06, 0.0), half = alarms(0.06, 0.03, 0.0), twice = alarms(0.06, 0.12, 0.0),
               wave = alarms(0.03, 0.03, 0.12);
  CAPTURE(none.small, none.large, half.small, twice.large, wave.small);
  CHECK(none.small + none.large <= 1);
  CHECK(half.small >= 10);
  CHECK(twice.large >= 10);
  CHECK(wave.small >= 10);
}

TEST_CASE("runs without stated errors have none to be doubted") {
  TrainingSet training = runs_of(0.06, 0.0, 0.0, 1);
  const NoiseCheck check = check_noise(training, {}, fit(training));
  CHECK_FALSE(check.understated());
  CHECK_FALSE(check.overstated());
}
