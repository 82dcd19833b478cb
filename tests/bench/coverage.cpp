// Do the posteriors hold the truth as often as they say, where the truth is no draw from the surrogate?
//   bench_coverage ridge [--sets N] [--first N] [--runs N] [--kernel K] [--mean M] [--scale S]
//   [--integrated|--plugged-in] bench_coverage levels [--sets N] [--first N] [--trusted]
//   bench_coverage check
//   bench_coverage faults [--sets N]
//   bench_coverage few|two_levels [--sets N] [--first N]
// ridge: ten smooth torques of friction, cohesion and speed, most of them with a ridge in friction and cohesion that no
//   speed breaks; each set is a scrambled Sobol design with runs of 2 % noise, a fit, and six measured speeds of 2 %,
//   for six truths drawn uniformly from the prior.
// levels: ten responses to friction (saturating, peaked, kinked, linear, ...) on factorial tables of 2 to 5 levels of
//   friction and on Latin hypercubes; 0.5 % noise.
// The posterior over (friction, cohesion) is summed on a grid: the emulator's mean and full covariance across speeds on
// 48 x 48 points, interpolated five times finer where the density counts. check: that this is the posterior of the
// tool's own sampler. faults: how often the surrogate's validation notices misstated errors, a kink and a wave, and
// how often the posterior still holds the truth.
// few: predictions of 6 to 60 runs of 1 %, with the hyper-parameters plugged in and integrated over.
// two_levels: predictions and posteriors of 8, 14 or 30 runs of 1 % over 80 runs of 2 % of a cheaper level that differs
//   from them by a factor, an interplay, a power or a threshold, beside the same dear runs alone.
// Printed: the share of truths inside the central 50 % and 90 % intervals of both parameters, and per function.
#include <fmt/core.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <numeric>
#include <string>
#include <vector>

#include "data/random.hpp"
#include "surrogate/design.hpp"
#include "surrogate/fit.hpp"
#include "surrogate/two_level.hpp"
#include "surrogate/validation.hpp"

#ifdef WITH_SAMPLER
#include "tests/uq/closed_form.hpp"
#include "uq/infer/mixture_sampler.hpp"
#include "uq/posterior/posterior.hpp"
#endif

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using surrogate::Prediction;

constexpr int speeds = 6;

/// Torque in mN m at a point of the unit cube (friction 0.1 to 0.8, cohesion 0 to 10 mJ/m2, speed 50 to 300 rpm).
using Torque = std::function<double(double friction, double cohesion, double speed)>;

struct Case {
  std::string name;
  Torque torque;
};

/// `w`: speed over 150 rpm.
std::vector<Case> ridges() {
  const auto scaled = [](auto law) -> Torque {
    return [law](double a, double b, double v) -> double {
      return law(0.1 + 0.7 * a, 10.0 * b, (50.0 + 250.0 * v) / 150.0);
    };
  };
  using std::exp, std::pow, std::sqrt, std::tanh;
  return {
      {"saturating + falling", scaled([](double f, double c, double w) {
         return 2.0 + 8.0 * (1.0 - exp(-f / 0.2)) + 0.75 * c * (1.2 - 0.5 * w);
       })},
      {"product of roots",
       scaled([](double f, double c, double w) { return 10.0 * sqrt(f / 0.4) * sqrt(1.0 + 0.2 * c) * pow(w, 0.05); })},
      {"sum, cohesion falling",
       scaled([](double f, double c, double w) { return 3.0 + 6.0 * f / (0.3 + f) + 0.5 * c * pow(w, -0.3); })},
      {"product of powers", scaled([](double f, double c, double w) {
         return 5.0 + 6.0 * pow(c + 2.0, 0.8) * pow(f, 0.4) / (1.0 + 0.2 * w);
       })},
      {"friction rising", scaled([](double f, double c, double w) {
         return 4.0 + 5.0 * sqrt(f) * (1.0 + 0.3 * w) + 0.4 * c / (1.0 + 0.1 * c);
       })},
      {"exponential", scaled([](double f, double c, double w) { return 6.0 * exp(0.6 * f + 0.08 * c - 0.1 * w * f); })},
      {"saturating product", scaled([](double f, double c, double w) {
         return 4.0 + 10.0 * tanh(2.0 * f) * (1.0 + 0.1 * c) / (1.0 + 0.3 * w);
       })},
      {"saturating cohesion", scaled([](double f, double c, double w) {
         return 4.0 + 6.0 * (1.0 - exp(-c / 3.0)) * (0.5 + f) + 2.0 * pow(w, 0.3);
       })},
      {"exact sum",
       scaled([](double f, double c, double w) { return 12.0 * pow(f + 0.05 * c, 0.6) * (1.0 + 0.2 / (0.3 + w)); })},
      {"ratio",
       scaled([](double f, double c, double w) { return 20.0 * pow(f, 0.3) / sqrt(1.0 + 0.15 * c) * pow(w, 0.1); })},
  };
}

/// Of friction in the unit cube; range about one.
std::vector<std::pair<std::string, std::function<double(double)>>> responses() {
  return {
      {"steep saturating", [](double x) { return 1.0 - std::exp(-x / 0.15); }},
      {"saturating", [](double x) { return 1.0 - std::exp(-x / 0.4); }},
      {"linear", [](double x) { return x; }},
      {"square", [](double x) { return x * x; }},
      {"root", [](double x) { return std::sqrt(x); }},
      {"peaked", [](double x) { return std::exp(-std::pow((x - 0.5) / 0.3, 2)); }},
      {"peaked low", [](double x) { return std::exp(-std::pow((x - 0.3) / 0.25, 2)); }},
      {"kinked", [](double x) { return std::min(x, 0.35) / 0.35; }},
      {"threshold", [](double x) { return std::max(x - 0.6, 0.0) / 0.4; }},
      {"sigmoid", [](double x) { return 1.0 / (1.0 + std::exp(-(x - 0.5) / 0.08)); }},
  };
}

Torque on_response(const std::function<double(double)>& response) {
  return [response](double a, double b, double v) -> double {
    return 4.0 + 6.0 * response(a) + 7.5 * b * (1.2 - (50.0 + 250.0 * v) / 300.0);
  };
}

surrogate::TrainingSet runs_of(const Torque& torque, MatrixXd x, double noise, data::RandomStream& random) {
  surrogate::TrainingSet training{std::move(x), {}, {}};
  training.y.resize(training.x.rows());
  for (Index i = 0; i < training.x.rows(); ++i)
    training.y[i] = torque(training.x(i, 0), training.x(i, 1), training.x(i, 2)) * (1.0 + noise * random.normal());
  training.noise_variance = (noise * training.y).cwiseAbs2();
  return training;
}

/// levels x 3 x 3.
MatrixXd factorial(int levels) {
  MatrixXd x(levels * 9, 3);
  for (int i = 0; i < levels; ++i)
    for (int j = 0; j < 9; ++j) x.row(i * 9 + j) << static_cast<double>(i) / (levels - 1), 0.5 * (j / 3), 0.5 * (j % 3);
  return x;
}

MatrixXd latin_hypercube(int runs, data::RandomStream& random) {
  MatrixXd x(runs, 3);
  for (Index k = 0; k < 3; ++k) {
    std::vector<int> order(static_cast<std::size_t>(runs));
    std::iota(order.begin(), order.end(), 0);
    for (int i = runs - 1; i > 0; --i) std::swap(order[i], order[static_cast<int>(random.uniform() * (i + 1))]);
    for (int i = 0; i < runs; ++i) x(i, k) = (order[i] + random.uniform()) / runs;
  }
  return x;
}

struct Truth {
  double friction = 0.0, cohesion = 0.0;
  VectorXd measured;  // at the six speeds, of 2 % each
};

Truth draw_truth(const Torque& torque, data::RandomStream& random) {
  Truth truth{random.uniform(), random.uniform(), VectorXd(speeds)};
  for (int j = 0; j < speeds; ++j)
    truth.measured[j] = torque(truth.friction, truth.cohesion, j / 5.0) * (1.0 + 0.02 * random.normal());
  return truth;
}

/// The posterior over the unit square on a grid.
class GridPosterior {
 public:
  static constexpr int coarse = 48, finer = 5, fine = coarse * finer;

  template <class Process>
  explicit GridPosterior(const Process& process) {
    MatrixXd points(coarse * coarse * speeds, 3);
    for (int i = 0; i < coarse; ++i)
      for (int j = 0; j < coarse; ++j)
        for (int v = 0; v < speeds; ++v)
          points.row((i * coarse + j) * speeds + v) << (i + 0.5) / coarse, (j + 0.5) / coarse, v / 5.0;
    predictions_ = process.predict_batch(points, speeds);
  }

  /// Probabilities of friction and cohesion at most their true values, and their posterior sds.
  struct Result {
    double below_friction = 0.0, below_cohesion = 0.0, sd_friction = 0.0, sd_cohesion = 0.0, mean_friction = 0.0,
           mean_cohesion = 0.0;
  };
  Result at(const Truth& truth) const {
    std::vector<double> rough(coarse * coarse);
    for (int i = 0; i < coarse; ++i)
      for (int j = 0; j < coarse; ++j)
        rough[i * coarse + j] = log_density((i + 0.5) / coarse, (j + 0.5) / coarse, truth.measured);
    const double top = *std::max_element(rough.begin(), rough.end());
    VectorXd friction = VectorXd::Zero(fine), cohesion = friction;
    for (int i = 0; i < coarse; ++i)
      for (int j = 0; j < coarse; ++j) {
        double near = -1e300;
        for (int p = std::max(0, i - 1); p <= std::min(coarse - 1, i + 1); ++p)
          for (int q = std::max(0, j - 1); q <= std::min(coarse - 1, j + 1); ++q)
            near = std::max(near, rough[p * coarse + q]);
        if (near < top - 14.0) continue;
        for (int p = i * finer; p < (i + 1) * finer; ++p)
          for (int q = j * finer; q < (j + 1) * finer; ++q) {
            const double density = std::exp(log_density((p + 0.5) / fine, (q + 0.5) / fine, truth.measured) - top);
            friction[p] += density;
            cohesion[q] += density;
          }
      }
    const VectorXd places = (VectorXd::LinSpaced(fine, 0.0, fine - 1.0).array() + 0.5) / fine;
    const auto below = [&](const VectorXd& mass, double value) {
      const double place = value * fine;
      const int cell = std::min(fine - 1, static_cast<int>(place));
      return (mass.head(cell).sum() + mass[cell] * (place - cell)) / mass.sum();
    };
    const auto mean = [&](const VectorXd& mass) { return mass.dot(places) / mass.sum(); };
    const auto sd = [&](const VectorXd& mass) {
      return std::sqrt(mass.dot((places.array() - mean(mass)).square().matrix()) / mass.sum());
    };
    return {below(friction, truth.friction),
            below(cohesion, truth.cohesion),
            sd(friction),
            sd(cohesion),
            mean(friction),
            mean(cohesion)};
  }

 private:
  /// Of measurements of 2 %, the prediction interpolated linearly.
  double log_density(double a, double b, const VectorXd& measured) const {
    const double x = a * coarse - 0.5, y = b * coarse - 0.5;
    const int i = std::clamp(static_cast<int>(std::floor(x)), 0, coarse - 2);
    const int j = std::clamp(static_cast<int>(std::floor(y)), 0, coarse - 2);
    const std::array<double, 4> weight{(1 - (x - i)) * (1 - (y - j)), (1 - (x - i)) * (y - j), (x - i) * (1 - (y - j)),
                                       (x - i) * (y - j)};
    Eigen::Matrix<double, speeds, 1> left = measured;
    Eigen::Matrix<double, speeds, speeds> covariance = Eigen::Matrix<double, speeds, speeds>::Zero();
    for (int c = 0; c < 4; ++c) {
      const Prediction& corner = predictions_[(i + c / 2) * coarse + j + c % 2];
      left -= weight[c] * corner.mean;
      covariance += weight[c] * corner.covariance;
    }
    covariance.diagonal().array() += (0.02 * measured.array()).square();
    const Eigen::LLT<Eigen::Matrix<double, speeds, speeds>> factor(covariance);
    if (factor.info() != Eigen::Success) return -1e300;
    factor.matrixL().solveInPlace(left);
    return -0.5 * left.squaredNorm() - factor.matrixLLT().diagonal().array().log().sum();
  }

  std::vector<Prediction> predictions_;
};

struct Count {
  int n = 0, half = 0, nine = 0;
  double sd = 0.0;
  void add(double below, double spread) {
    ++n;
    half += below > 0.25 && below < 0.75;
    nine += below > 0.05 && below < 0.95;
    sd += spread;
  }
  void add(const GridPosterior::Result& r) {
    add(r.below_friction, r.sd_friction);
    add(r.below_cohesion, r.sd_cohesion);
  }
  double share(int inside) const { return static_cast<double>(inside) / n; }
};

struct Options {
  int sets = 20, first = 0, runs = 60;
  surrogate::FitOptions fit = {.starts = 4,
                               .hyper_uncertainty = surrogate::HyperUncertainty::integrated_if_few,
                               .between_runs = surrogate::BetweenRuns::doubted};
};

void ridge(const Options& options) {
  constexpr int truths = 6;
  const std::vector<Case> cases = ridges();
  std::vector<Count> counts(cases.size());
  Count all;
  for (int set = options.first; set < options.first + options.sets; ++set)
    for (std::size_t k = 0; k < cases.size(); ++k) {
      data::RandomStream random(1000 + set, data::Purpose::test, 77 + static_cast<std::uint32_t>(k));
      const MatrixXd x = surrogate::scrambled_sobol(options.runs, 3, 5000 + 100 * set + k);
      const GridPosterior posterior(surrogate::fit(runs_of(cases[k].torque, x, 0.02, random), options.fit));
      for (int t = 0; t < truths; ++t) {
        const GridPosterior::Result result = posterior.at(draw_truth(cases[k].torque, random));
        counts[k].add(result);
        all.add(result);
      }
    }
  fmt::print(
      "| function | 50 % intervals hold | 90 % intervals hold | mean sd, share of the range |\n|---|---|---|---|\n");
  for (std::size_t k = 0; k < cases.size(); ++k)
    fmt::print("| {} | {:.3f} | {:.3f} | {:.3f} |\n", cases[k].name, counts[k].share(counts[k].half),
               counts[k].share(counts[k].nine), counts[k].sd / counts[k].n);
  fmt::print("| all | {:.3f} | {:.3f} | {:.3f} |\n", all.share(all.half), all.share(all.nine), all.sd / all.n);
}

void levels(const Options& options) {
  constexpr int truths = 10;
  const auto laws = responses();
  std::vector<std::string> designs{"2", "3", "4", "5", "LHS 20", "LHS 40"};
  std::vector<Count> designs_friction(designs.size()), designs_cohesion(designs.size());
  std::map<std::pair<std::size_t, std::size_t>, Count> each;
  for (int set = options.first; set < options.first + options.sets; ++set)
    for (std::size_t k = 0; k < laws.size(); ++k)
      for (std::size_t design = 0; design < designs.size(); ++design) {
        data::RandomStream random(2000 + set, data::Purpose::test,
                                  77 + static_cast<std::uint32_t>(k * designs.size() + design));
        const Torque torque = on_response(laws[k].second);
        const MatrixXd x =
            design < 4 ? factorial(static_cast<int>(design) + 2) : latin_hypercube(design == 4 ? 20 : 40, random);
        const GridPosterior posterior(surrogate::fit(runs_of(torque, x, 0.005, random), options.fit));
        for (int t = 0; t < truths; ++t) {
          const GridPosterior::Result r = posterior.at(draw_truth(torque, random));
          designs_friction[design].add(r.below_friction, r.sd_friction);
          designs_cohesion[design].add(r.below_cohesion, r.sd_cohesion);
          each[{k, design}].add(r.below_friction, r.sd_friction);
        }
      }
  fmt::print("| 90 % intervals of friction hold |");
  for (const std::string& design : designs) fmt::print(" {} |", design);
  fmt::print("\n|---|---|---|---|---|---|---|\n");
  for (std::size_t k = 0; k < laws.size(); ++k) {
    fmt::print("| {} |", laws[k].first);
    for (std::size_t design = 0; design < designs.size(); ++design)
      fmt::print(" {:.2f} |", (each[{k, design}].share(each[{k, design}].nine)));
    fmt::print("\n");
  }
  const auto row = [&](const char* name, auto value) {
    fmt::print("| {} |", name);
    for (std::size_t design = 0; design < designs.size(); ++design) fmt::print(" {:.3f} |", value(design));
    fmt::print("\n");
  };
  row("all", [&](std::size_t d) { return designs_friction[d].share(designs_friction[d].nine); });
  row("of cohesion", [&](std::size_t d) { return designs_cohesion[d].share(designs_cohesion[d].nine); });
  row("mean sd of friction", [&](std::size_t d) { return designs_friction[d].sd / designs_friction[d].n; });
}

/// What the validation says of runs that are not what they claim to be.
void faults(const Options& options) {
  const std::vector<Case> cases = ridges();
  struct Fault {
    std::string name;
    double noise, stated;
    std::function<double(double, double, double)> factor;
  };
  const auto plain = [](double, double, double) { return 1.0; };
  const std::vector<Fault> kinds{
      {"none, 2 %", 0.02, 0.02, plain},
      {"errors stated as half", 0.04, 0.02, plain},
      {"errors stated as double", 0.01, 0.02, plain},
      {"kink of 15 %", 0.01, 0.01, [](double a, double, double) { return 1.0 + 0.3 * std::max(0.0, a - 0.5); }},
      {"wave of 4 %", 0.01, 0.01,
       [](double a, double b, double v) { return 1.0 + 0.04 * std::sin(12.0 * a + 9.0 * b + 6.0 * v); }},
      {"none, 1 %", 0.01, 0.01, plain}};
  constexpr int truths = 6;
  fmt::print(
      "| fault | not good | scatter note | distance below 0.01 | nugget over stated error, median | 50 % intervals "
      "hold | 90 % hold |\n|---|---|---|---|---|---|---|\n");
  for (const Fault& fault : kinds) {
    int n = 0, noticed = 0, scatter = 0, distance = 0;
    std::vector<double> ratio;
    Count held;
    for (int set = 0; set < options.sets; ++set)
      for (std::size_t k = 0; k < cases.size(); ++k) {
        data::RandomStream random(3000 + set, data::Purpose::test, 77 + static_cast<std::uint32_t>(k));
        const Torque torque = [&](double a, double b, double v) {
          return cases[k].torque(a, b, v) * fault.factor(a, b, v);
        };
        surrogate::TrainingSet training =
            runs_of(torque, surrogate::scrambled_sobol(options.runs, 3, 5000 + 100 * set + k), fault.noise, random);
        training.noise_variance *= std::pow(fault.stated / fault.noise, 2);
        const surrogate::GaussianProcess process = surrogate::fit(training, options.fit);
        const surrogate::Validation found = surrogate::validate(training, options.fit, process);
        ++n;
        noticed += found.verdict != surrogate::SurrogateVerdict::good;
        scatter += std::any_of(found.notes.begin(), found.notes.end(),
                               [](const std::string& note) { return note.rfind("the runs' errors", 0) == 0; });
        distance += found.mahalanobis_probability < 0.01;
        ratio.push_back(process.hyper_parameters().nugget_sd / std::sqrt(training.noise_variance.mean()));
        const GridPosterior posterior(process);
        for (int t = 0; t < truths; ++t) held.add(posterior.at(draw_truth(torque, random)));
      }
    std::nth_element(ratio.begin(), ratio.begin() + n / 2, ratio.end());
    fmt::print("| {} | {:.2f} | {:.2f} | {:.2f} | {:.2f} | {:.3f} | {:.3f} |\n", fault.name,
               static_cast<double>(noticed) / n, static_cast<double>(scatter) / n, static_cast<double>(distance) / n,
               ratio[n / 2], held.share(held.half), held.share(held.nine));
    std::fflush(stdout);
  }
}

/// How predictions hold functions that are no draws from the model, at points drawn uniformly.
struct Held {
  int n = 0, nine = 0;
  double squares = 0.0;
  template <class Process>
  void add(const Process& process, const Torque& torque, std::uint64_t seed) {
    const MatrixXd points = surrogate::scrambled_sobol(64, 3, seed);
    const Prediction found = process.predict(points);
    for (Index i = 0; i < points.rows(); ++i, ++n) {
      const double z =
          (torque(points(i, 0), points(i, 1), points(i, 2)) - found.mean[i]) / std::sqrt(found.covariance(i, i));
      nine += std::abs(z) < 1.6449;
      squares += z * z;
    }
  }
  std::string text() const {
    return fmt::format("{:.3f}, {:.2f}", static_cast<double>(nine) / n, std::sqrt(squares / n));
  }
};

/// The torques of `ridge`, and one whose friction and cohesion are told apart.
std::vector<Case> all_torques() {
  std::vector<Case> cases = ridges();
  cases.push_back({"told apart", [](double a, double b, double v) {
                     const double c = 10.0 / 6.0 * b, s = 2.0 * v - 1.0;
                     return 8.0 * std::sqrt((1.0 + c) * (0.25 + 1.75 * a)) * (1.0 + 0.12 * s - 0.3 * s * c);
                   }});
  return cases;
}

/// Few runs, with their hyper-parameters plugged in and integrated over.
void few(const Options& options) {
  const std::vector<Case> cases = all_torques();
  fmt::print("| runs | plugged in: 90 % hold, rms z | integrated |\n|---|---|---|\n");
  for (const int runs : {6, 8, 10, 14, 20, 30, 60}) {
    Held plugged, integrated;
    for (int set = options.first; set < options.first + options.sets; ++set)
      for (std::size_t k = 0; k < cases.size(); ++k) {
        data::RandomStream random(5000 + set, data::Purpose::test, 77 + static_cast<std::uint32_t>(k));
        const std::uint64_t seed = 9000 + 100 * set + k;
        const surrogate::TrainingSet training =
            runs_of(cases[k].torque, surrogate::scrambled_sobol(runs, 3, seed), 0.01, random);
        surrogate::FitOptions one = options.fit;
        one.hyper_uncertainty = surrogate::HyperUncertainty::plug_in;
        plugged.add(surrogate::fit(training, one), cases[k].torque, seed + 1000);
        one.hyper_uncertainty = surrogate::HyperUncertainty::integrated;
        integrated.add(surrogate::fit(training, one), cases[k].torque, seed + 1000);
      }
    fmt::print("| {} | {} | {} |\n", runs, plugged.text(), integrated.text());
    std::fflush(stdout);
  }
}

/// Few dear runs over many cheap ones, beside the dear ones alone.
void two_levels(const Options& options) {
  constexpr int truths = 6, cheap_runs = 80;
  struct Kind {
    std::string name;
    std::function<double(double dear, double a, double b, double v)> cheap;
  };
  const std::vector<Kind> kinds{
      {"a factor", [](double y, double, double, double) { return 0.8 * y; }},
      {"an interplay",
       [](double y, double a, double, double v) { return 0.8 * y + 1.0 + 0.5 * (0.1 + 0.7 * a) * (2.0 * v - 1.0); }},
      {"a power", [](double y, double, double, double) { return 3.0 * std::pow(y, 0.6); }},
      {"a threshold", [](double y, double, double b, double v) { return 0.8 * y - 1.5 * std::max(b - 0.5, 0.0) * v; }},
      {"cohesion left out", [](double y, double, double b, double) { return 0.8 * y - 3.0 * b; }}};
  const std::vector<Case> cases = all_torques();
  fmt::print(
      "| the levels differ by | dear runs | dear alone: 90 % hold, rms z | both levels | posteriors of the torque told "
      "apart: 90 % hold, mean sd |\n|---|---|---|---|---|\n");
  for (const Kind& kind : kinds)
    for (const int dear_runs : {8, 14, 30}) {
      Held alone, both;
      Count posteriors;
      for (int set = options.first; set < options.first + options.sets; ++set)
        for (std::size_t k = 0; k < cases.size(); ++k) {
          data::RandomStream random(4000 + set, data::Purpose::test, 77 + static_cast<std::uint32_t>(k));
          const Torque& torque = cases[k].torque;
          const Torque cheap = [&](double a, double b, double v) { return kind.cheap(torque(a, b, v), a, b, v); };
          const std::uint64_t seed = 7000 + 100 * set + k;
          const surrogate::TrainingSet dear =
              runs_of(torque, surrogate::scrambled_sobol(dear_runs, 3, seed), 0.01, random);
          const surrogate::TrainingSet many =
              runs_of(cheap, surrogate::scrambled_sobol(cheap_runs, 3, seed + 1), 0.02, random);
          const surrogate::TwoLevelProcess two = surrogate::fit_two_level(surrogate::fit(many, options.fit), dear);
          alone.add(surrogate::fit(dear, options.fit), torque, seed + 1000);
          both.add(two, torque, seed + 1000);
          if (k + 1 < cases.size()) continue;
          const GridPosterior posterior(two);
          for (int t = 0; t < truths; ++t) posteriors.add(posterior.at(draw_truth(torque, random)));
        }
      fmt::print("| {} | {} | {} | {} | {:.3f}, {:.3f} |\n", kind.name, dear_runs, alone.text(), both.text(),
                 posteriors.share(posteriors.nine), posteriors.sd / posteriors.n);
      std::fflush(stdout);
    }
}

#ifdef WITH_SAMPLER
/// The grid beside the tool's own likelihood and sampler.
void check() {
  const std::vector<Case> cases = ridges();
  fmt::print("| function | friction: grid | sampler | cohesion: grid | sampler |\n|---|---|---|---|---|\n");
  for (std::size_t k = 0; k < cases.size(); k += 3) {
    data::RandomStream random(1, data::Purpose::test, static_cast<std::uint32_t>(k));
    const auto process = std::make_shared<const surrogate::GaussianProcess>(
        surrogate::fit(runs_of(cases[k].torque, surrogate::scrambled_sobol(60, 3, k), 0.02, random), Options().fit));
    const Truth truth = draw_truth(cases[k].torque, random);
    const GridPosterior::Result grid = GridPosterior(*process).at(truth);
    const VectorXd x = VectorXd::LinSpaced(speeds, 0.0, 1.0);
    uq::CaseModel model = closed_form::make_case(
        {{"friction"}, {"cohesion"}}, [](const VectorXd&, double) { return 0.0; }, x, truth.measured,
        0.02 * truth.measured);
    const std::vector<uq::EmulatorInput> inputs = model.groups.front().emulator.inputs;
    model.groups.front().emulator = uq::make_emulator(process, "", 0, inputs);
    const uq::Draws draws =
        uq::sample_mixture(uq::posterior_target(std::make_shared<const uq::CaseModel>(model)), {.seed = k});
    const MatrixXd all = draws.pooled();
    const auto text = [](double mean, double sd) { return fmt::format("{:.3f} +- {:.3f}", mean, sd); };
    const auto of = [&](Index s) {
      return text(all.col(s).mean(), std::sqrt((all.col(s).array() - all.col(s).mean()).square().mean()));
    };
    fmt::print("| {} | {} | {} | {} | {} |\n", cases[k].name, text(grid.mean_friction, grid.sd_friction), of(0),
               text(grid.mean_cohesion, grid.sd_cohesion), of(1));
  }
}
#endif

}  // namespace

int main(int count, char** arguments) {
  const std::vector<std::string> words(arguments + 1, arguments + count);
  Options options;
  for (std::size_t i = 1; i < words.size(); ++i) {
    using namespace surrogate;
    const std::string& key = words[i];
    const auto next = [&] { return words.at(++i); };
    if (key == "--sets") options.sets = std::stoi(next());
    if (key == "--first") options.first = std::stoi(next());
    if (key == "--runs") options.runs = std::stoi(next());
    if (key == "--trusted") options.fit.between_runs = BetweenRuns::trusted;
    if (key == "--integrated") options.fit.hyper_uncertainty = HyperUncertainty::integrated;
    if (key == "--plugged-in") options.fit.hyper_uncertainty = HyperUncertainty::plug_in;
    if (key == "--scale") options.fit.scale = next() == "log" ? OutputScale::log : OutputScale::linear;
    if (key == "--kernel") options.fit.kernel = next() == "se" ? Kernel::squared_exponential : Kernel::matern52;
    if (key == "--mean") {
      const std::string mean = next();
      options.fit.mean = mean == "trend"       ? MeanBasis::trend
                         : mean == "quadratic" ? MeanBasis::quadratic
                                               : MeanBasis::constant;
    }
  }
  const std::string what = words.empty() ? "" : words.front();
  if (what == "ridge") ridge(options);
  if (what == "levels") levels(options);
  if (what == "faults") faults(options);
  if (what == "few") few(options);
  if (what == "two_levels") two_levels(options);
#ifdef WITH_SAMPLER
  if (what == "check") check();
#endif
}
