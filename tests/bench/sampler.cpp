// Effective draws per CPU second of the sampler that calibrations use, adaptation and diagnostics counted.
//
// What counts is the error of the answer, not the claimed effective sample size: over repeated runs with other seeds,
//   effective draws = posterior variance / mean square of (a run's mean - the true mean),   per run,
// the smallest over the unknowns, over the mean CPU time of a run. True mean and variance come from a long run.
//
//   closed form, 2 unknowns   y_i = T(mu, H, w_i) + 0.02 noise, ten w; mu and H uniform on their ranges
//   closed form, 4 unknowns   the same with an offset of prior sd 0.05 and an unknown factor on the noise (log-normal,
//   0.5) surrogate                 the first with T learnt from 64 runs of noise sd 0.02, full covariance in the
//   likelihood
// T = 1 + 2 mu (1 + 0.5 log1p(H / 2)) - 0.3 H w / (1 + H) + 0.4 w^2. sampler.R gives the first two to Stan.
#include <sys/resource.h>

#include <cmath>
#include <cstdio>
#include <cstring>

#include "surrogate/design.hpp"
#include "surrogate/fit.hpp"
#include "tests/uq/closed_form.hpp"
#include "uq/infer/mixture_sampler.hpp"
#include "uq/posterior/posterior.hpp"

namespace {

constexpr int count = 10;
constexpr double noise = 0.02;

double torque(double mu, double h, double w) {
  return 1.0 + 2.0 * mu * (1.0 + 0.5 * std::log1p(h / 2.0)) - 0.3 * h * w / (1.0 + h) + 0.4 * w * w;
}

double setting(int i) { return static_cast<double>(i) / (count - 1); }

/// T(0.4, 4, w) and a fixed "noise" that needs no generator, so that Stan gets the same numbers.
Eigen::VectorXd data() {
  Eigen::VectorXd y(count);
  for (int i = 0; i < count; ++i)
    y[i] = torque(0.4, 4.0, setting(i)) + noise * std::sin(3.0 * i + 1.0) * std::sqrt(2.0);
  return y;
}

/// mu = x0, H = x1; with four unknowns an offset x2 and log of the noise factor x3.
struct ClosedForm {
  int unknowns;
  Eigen::VectorXd y = data();
  int dimension() const { return unknowns; }
  double log_density(const Eigen::VectorXd& x) const {
    const double offset = unknowns > 2 ? x[2] : 0.0, log_factor = unknowns > 2 ? x[3] : 0.0;
    const double sd = noise * std::exp(log_factor);
    double sum = 0.0;
    for (int i = 0; i < count; ++i) {
      const double z = (y[i] - torque(x[0], x[1], setting(i)) - offset) / sd;
      sum -= 0.5 * z * z;
    }
    sum -= count * log_factor;
    if (unknowns > 2) sum -= 0.5 * std::pow(offset / 0.05, 2) + 0.5 * std::pow(log_factor / 0.5, 2);
    return sum;
  }
};

uq::Target closed_form_target(int unknowns) {
  Eigen::VectorXd low(unknowns), high(unknowns);
  low.head(2) << 0.1, 0.0;
  high.head(2) << 0.8, 10.0;
  if (unknowns > 2) {
    low.tail(2) << -0.3, -3.0;
    high.tail(2) << 0.3, 3.0;
  }
  return uq::make_target(ClosedForm{unknowns}, low, high, uq::uniform_reference(low, high));
}

uq::Target surrogate_target() {
  surrogate::TrainingSet set;
  set.x = surrogate::scrambled_sobol(64, 3, 1);
  set.y.resize(64);
  set.noise_variance.setConstant(64, noise * noise);
  data::RandomStream random(1, data::Purpose::test);
  for (int i = 0; i < 64; ++i)
    set.y[i] = torque(0.1 + 0.7 * set.x(i, 0), 10.0 * set.x(i, 1), set.x(i, 2)) + noise * random.normal();
  const auto process = std::make_shared<const surrogate::GaussianProcess>(surrogate::fit(set));
  Eigen::VectorXd w(count);
  for (int i = 0; i < count; ++i) w[i] = setting(i);
  uq::CaseModel model = closed_form::make_case(
      {{"mu", 0.1, 0.8}, {"H", 0.0, 10.0}}, [](const auto&, double) { return 0.0; }, w, data(),
      Eigen::VectorXd::Constant(count, noise));
  uq::RowGroup& group = model.groups[0];
  group.emulator = uq::make_emulator(process, "", 0, group.emulator.inputs);
  return uq::posterior_target(std::make_shared<const uq::CaseModel>(std::move(model)));
}

double cpu_seconds() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_utime.tv_sec + usage.ru_stime.tv_sec) +
         1e-6 * static_cast<double>(usage.ru_utime.tv_usec + usage.ru_stime.tv_usec);
}

void measure(const char* name, const uq::Target& target, int repeats) {
  const uq::Draws long_run = uq::sample_mixture(target, {.draws = 32000, .seed = 999});
  const Eigen::MatrixXd all = long_run.pooled();
  const Eigen::VectorXd truth = all.colwise().mean();
  const Eigen::VectorXd variance = (all.rowwise() - truth.transpose()).array().square().colwise().mean();
  Eigen::VectorXd square = Eigen::VectorXd::Zero(target.dimension);
  double seconds = 0.0, claimed = 0.0;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    const double start = cpu_seconds();
    const uq::Draws draws = uq::sample_mixture(target, {.threads = 1, .seed = static_cast<std::uint64_t>(repeat)});
    seconds += cpu_seconds() - start;
    claimed += draws.ess_bulk.minCoeff();
    square += (draws.pooled().colwise().mean().transpose() - truth).cwiseAbs2();
  }
  const double effective = (variance.array() / (square.array() / repeats)).minCoeff();
  const double each = seconds / repeats;
  std::printf("%-26s %9.0f effective draws per CPU second (%.0f of %.4f s a run; claimed %.0f); means", name,
              effective / each, effective, each, claimed / repeats);
  for (const double mean : truth) std::printf(" %.4g", mean);
  std::printf("\n");
}

}  // namespace

int main(int argc, char** argv) {
  const int repeats = argc > 1 ? std::atoi(argv[1]) : 40;
  measure("closed form, 2 unknowns", closed_form_target(2), repeats);
  measure("closed form, 4 unknowns", closed_form_target(4), repeats);
  measure("surrogate, 2 unknowns", surrogate_target(), repeats);
}
