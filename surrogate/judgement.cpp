#include "surrogate/judgement.hpp"

#include <fmt/format.h>
#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "surrogate/levels.hpp"
#include "surrogate/noise_check.hpp"

namespace surrogate {
namespace {

using Eigen::Index;

/// Two-sided tail probability of `inside` of `count` under the nominal 95 %.
double coverage_probability(double inside, int count) {
  const double expected = 0.95 * count;
  const auto k = static_cast<unsigned>(std::lround(inside));
  const auto n = static_cast<unsigned>(count);
  const double tail =
      inside < expected ? gsl_cdf_binomial_P(k, 0.95, n) : (k == 0 ? 1.0 : gsl_cdf_binomial_Q(k - 1, 0.95, n));
  return std::min(1.0, 2.0 * tail);
}

/// Stated errors that do not fit, unless replicates show that the nugget mends them.
bool noise_doubtful(const Validation& v) {
  return v.noise.overstated() || (v.noise.understated() && !v.noise.replicated);
}

bool noise_dominated(const Validation& v, const ValidationThresholds& t) {
  return v.q2_attainable < 1.0 - t.noise_dominated;
}

/// Whether intervals that are off are off to the careful side: the held-out errors are smaller than expected.
bool too_wide(const Validation& v) {
  double distance = 0.0, degrees = 0.0;
  for (const HeldOutFold& fold : v.folds) {
    distance += fold.mahalanobis;
    degrees += fold.degrees;
  }
  return v.coverage_held_out.at95() >= 0.95 && distance < degrees && !v.noise.understated();
}

/// Whether no run is missed by an error, and none predicted with one, that any measurement would feel.
bool negligible(const Validation& v, const ValidationThresholds& t) { return v.held_out_reach < t.negligible; }

/// "a and b, a and c" or "any two of the inputs"; empty where there are none.
std::string named_pairs(const std::vector<ApartPair>& pairs) {
  constexpr std::size_t most = 3;
  std::vector<std::string> names;
  for (const ApartPair& pair : pairs) names.push_back(pair.first + " and " + pair.second);
  if (names.size() > most) return fmt::format("{} and {} other pairs", names.front(), names.size() - 1);
  return fmt::format("{}", fmt::join(names, ", "));
}

/// What to do about intervals that are off.
std::string remedy_of_intervals(const Validation& v) {
  if (!too_wide(v))
    return fmt::format(
        "Look at the standardised errors above 2 (runs with a wrong standard error?); else add about {} runs, or try "
        "the log scale of the output (surrogate.log_outputs) or another kernel (surrogate.kernel).",
        v.more_runs);
  if (v.noise.overstated())
    return "State the runs' standard errors as small as they are (0 of an exact code), or leave the column out: their "
           "scatter is estimated then.";
  return "Nothing need be done. A smoother kernel may be nearer to the runs (surrogate.kernel), or the log scale of an "
         "output whose small values are known better than its large ones (surrogate.log_outputs).";
}

/// Mean squared held-out error when only about half of the runs train, for the learning curve; negative: not possible.
double error_with_half(const TrainingSet& training, const HeldOutModel& model) {
  // Dealt at random: of a design in its own order every second run lies in the same half of an input.
  const std::vector<std::vector<int>> halves = deal(points_of_rows(training.x), 2, 0);
  double sum = 0.0;
  for (const auto& [kept, left] : {std::pair{halves[0], halves[1]}, std::pair{halves[1], halves[0]}}) {
    const HeldOutPrediction found = model(kept, left);
    if (found.prediction.mean.size() == 0) return -1.0;
    sum += (training.y(left) - found.prediction.mean).squaredNorm();
  }
  return sum / static_cast<double>(training.y.size());
}

/// Runs that would bring Q2 of the function to its threshold if the error went on falling as it did from half of the
/// runs to all: error ~ n^-slope, slope between 0.5 and 4.
int runs_wanted(const Validation& v, const TrainingSet& training, const HeldOutModel& model, double q2_good) {
  const double n = static_cast<double>(training.y.size());
  const double variance = (training.y.array() - training.y.mean()).square().mean();
  const double noise = (1.0 - v.q2_attainable) * variance, signal = variance - noise;
  if (!(signal > 0.0)) return static_cast<int>(n);
  const double now = std::max((1.0 - v.q2_function) * signal, 1e-12 * signal);
  const double half = error_with_half(training, model) - noise;
  const double folds = std::max<double>(2.0, static_cast<double>(v.folds.size()));
  const double trained = n * (1.0 - 1.0 / folds);
  const double slope = half > now ? std::clamp(std::log(half / now) / std::log(trained / (0.5 * n)), 0.5, 4.0) : 0.5;
  const double wanted = trained * std::pow(now / ((1.0 - q2_good) * signal), 1.0 / slope) - n;
  return static_cast<int>(std::ceil(std::clamp(wanted, 0.25 * n, 4.0 * n)));
}

}  // namespace

std::vector<std::string> fit_notes(const FitDiagnostics& d) {
  std::vector<std::string> notes;
  if (!d.converged) notes.push_back("the maximisation of the likelihood did not converge");
  if (d.jitter > 0.0)
    notes.push_back(
        fmt::format("a jitter of {:.1e} of the output's variance was added to factorise the covariance", d.jitter));
  for (const BoundHit& hit : d.bound_hits) {
    constexpr double hardly = 0.1;  // of the output's sd
    const char* meaning = "";
    if (hit.harmless && hit.parameter == "nugget")
      meaning = ": no run-to-run scatter beyond the stated errors";
    else if (hit.harmless && hit.effect < hardly)
      meaning = ": the output hardly depends on it";
    else if (hit.harmless)
      meaning = ": the output varies along it as the simplest curve does";
    notes.push_back(fmt::format("{} is on its {} bound, {:.3g}{}", hit.parameter, hit.upper ? "upper" : "lower",
                                hit.value, meaning));
  }
  if (!d.starts.empty())
    notes.push_back(fmt::format("{} of {} starts reached the best likelihood", d.agreeing_starts, d.starts.size()));
  return notes;
}

SurrogateVerdict judge(const Validation& v, int predicted, const FitDiagnostics& diagnostics,
                       const ValidationThresholds& t) {
  if (predicted < v.runs) return SurrogateVerdict::unusable;  // too few runs to hold any out
  const double coverage95 = v.coverage_held_out.at95();
  if (coverage95 < t.coverage95_unusable) return SurrogateVerdict::unusable;
  if (noise_dominated(v, t)) return SurrogateVerdict::caution;
  if (v.q2_function < t.q2_unusable) return SurrogateVerdict::unusable;
  const bool bad_bound = std::any_of(diagnostics.bound_hits.begin(), diagnostics.bound_hits.end(),
                                     [](const BoundHit& hit) { return !hit.harmless; });
  const bool between =
      std::any_of(v.levels.begin(), v.levels.end(), [&](const LevelCheck& check) { return doubtful(check, t); });
  if (between || !v.apart.empty()) return SurrogateVerdict::caution;
  if (negligible(v, t) && coverage95 >= 0.95) return SurrogateVerdict::good;
  if (v.q2_function < t.q2_good || !diagnostics.converged || bad_bound || noise_doubtful(v) ||
      coverage_probability(coverage95 * v.runs, v.runs) < t.coverage_probability ||
      v.mahalanobis_probability < t.mahalanobis_probability)
    return SurrogateVerdict::caution;
  return SurrogateVerdict::good;
}

namespace {

/// What speaks against a surrogate that is not simply good.
struct Doubts {
  bool coverage = false, distance = false, noise = false;  ///< intervals that are off, by these
  bool dominated = false;                                  ///< by the runs' noise
  std::optional<LevelCheck> levels;                        ///< the first input of whose levels too little is known
  std::string apart;                                       ///< pairs that no run moves together

  bool of_intervals() const { return coverage || distance || noise; }
};

Doubts doubts_of(const Validation& v, const ValidationThresholds& t) {
  const auto levels =
      std::find_if(v.levels.begin(), v.levels.end(), [&](const LevelCheck& check) { return doubtful(check, t); });
  return {.coverage = coverage_probability(v.coverage_held_out.at95() * v.runs, v.runs) < t.coverage_probability,
          .distance = v.mahalanobis_probability < t.mahalanobis_probability,
          .noise = noise_doubtful(v),
          .dominated = noise_dominated(v, t),
          .levels = levels != v.levels.end() ? std::optional(*levels) : std::nullopt,
          .apart = named_pairs(v.apart)};
}

std::string finding_of(const Validation& v, const Doubts& doubts) {
  std::string finding = fmt::format(
      "Held-out runs are predicted with Q2 {:.3f}, their own noise taken off; {:.0f} % of them lie in the 95 % "
      "interval",
      v.q2_function, 100.0 * v.coverage_held_out.at95());
  if (doubts.dominated)
    finding += fmt::format("; {:.0f} % of the runs' variance is their own noise", (1.0 - v.q2_attainable) * 100.0);
  if (doubts.distance)
    finding += fmt::format("; the errors' Mahalanobis distance has probability {:.1e}", v.mahalanobis_probability);
  if (const auto& levels = doubts.levels)
    finding += levels->levels == 2 ? fmt::format("; nothing is known between the 2 levels of {}", levels->input)
                                   : fmt::format("; whole levels of {} left out are predicted with Q2 {:.3f}",
                                                 levels->input, levels->q2);
  if (!doubts.apart.empty()) finding += "; no run moves " + doubts.apart + " together";
  if (doubts.noise) finding += "; " + noise_note(v.noise);
  return finding + ".";
}

/// What the worst of the doubts means for a posterior.
const char* consequence_of(const Validation& v, const Doubts& doubts, const ValidationThresholds& t) {
  if (v.verdict == SurrogateVerdict::good)
    return "The surrogate's own uncertainty describes its error and enters the likelihood.";
  if (v.verdict == SurrogateVerdict::unusable)
    return "It does not stand for the model: no verdict that rests on it means anything.";
  if (doubts.dominated && v.coverage_held_out.at95() >= t.coverage95_unusable)
    return "The runs hardly tell the inputs apart: this output will identify little.";
  if (doubts.of_intervals())
    return too_wide(v) ? "Its intervals are wider than its errors: posteriors that rest on it are wider than need be."
                       : "Its intervals may be too narrow or too wide: posteriors that rest on it may be, too.";
  if (doubts.levels)
    return "What lies between the levels is assumed, not learnt: the posterior is as wide as that leaves it.";
  if (!doubts.apart.empty())
    return "How the effect of one depends on the other is assumed, not learnt: posteriors that rest on it may be too "
           "narrow.";
  if (v.q2_function < t.q2_good)
    return "Its error is a large part of the response; it enters the likelihood and widens the posterior.";
  return "Its hyper-parameters are not at a clean maximum (see the notes): its intervals may be off.";
}

}  // namespace

void explain(Validation& v, const TrainingSet& training, const HeldOutModel& model, const ValidationThresholds& t) {
  if (v.folds.empty()) {
    v.finding = fmt::format("{} runs are too few to hold any out", v.runs);
    v.consequence = "Nothing is known about the surrogate's error.";
    v.more_runs = std::max(10, v.runs);
    v.remedy = fmt::format("Add at least {} runs.", v.more_runs);
    return;
  }
  const Doubts doubts = doubts_of(v, t);
  v.finding = finding_of(v, doubts);
  v.consequence = consequence_of(v, doubts, t);

  const int quarter = std::max(8, v.runs / 4), half = std::max(8, v.runs / 2);
  if (v.verdict == SurrogateVerdict::good) {
    v.remedy = "None needed.";
  } else if (doubts.dominated) {
    v.remedy = "Make the runs longer or replicate them, or use an output that responds more.";
  } else if (doubts.levels && v.verdict == SurrogateVerdict::caution) {
    v.more_runs = quarter;
    v.remedy = fmt::format("Add about {} runs between the levels of {}.", v.more_runs, doubts.levels->input);
  } else if (!doubts.apart.empty() && v.verdict == SurrogateVerdict::caution) {
    v.more_runs = half;
    v.remedy = fmt::format("Add about {} runs that move all inputs at once (demcal design).", v.more_runs);
  } else if (v.q2_function < t.q2_good) {
    v.more_runs = runs_wanted(v, training, model, t.q2_good);
    v.remedy = fmt::format("Add about {} runs, the first of them where the surrogate knows least.", v.more_runs);
  } else if (doubts.of_intervals()) {
    v.more_runs = too_wide(v) ? 0 : quarter;
    v.remedy = remedy_of_intervals(v);
  } else {
    v.more_runs = quarter;
    v.remedy = fmt::format("Use more starts, or add about {} runs.", v.more_runs);
  }
}

}  // namespace surrogate
