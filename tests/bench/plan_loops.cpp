// Whether a plan's forecasts come true: closed loops on studies whose model is a formula. Each loop draws a truth from
// the prior, measures three torques with noise, plans, and then makes three readings in turn, each alone: the planner's
// first choice, a candidate at random, and the best of what was measured already once more. It prints, per study,
//   width    mean posterior sd after the reading over the mean forecast
//   words    mean forecast probability of "identified", and how often it came; Brier score beside that of the base rate
//   redone   the same probability by REDONE calibrations of readings drawn from the posterior, instead of the forecast:
//            its mean, its sd over the loops (what there is to forecast), and the rms difference of the forecast from
//            it, both without the sampling error of REDONE
//   choice   mean sd after each of the three readings, over that before
// Usage: plan_loops [LOOPS] [FIRST SEED] [REDONE] [STUDY]
#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "data/random.hpp"
#include "tests/uq/formula_study.hpp"
#include "uq/plan/plan.hpp"

namespace {

constexpr double torque_error = 0.15;
constexpr double angle_error = 0.05;  // relative, as the planner assumes

/// The study with one reading more, made at the truth.
data::Study with_reading(const data::Study& study, const formula::Pair& formulas, const uq::PlanCandidate& candidate,
                         double a, double b, data::RandomStream& random) {
  data::Study more = study;
  const double x = candidate.settings.front().at("speed");
  const bool torque = candidate.outputs.front() == "torque";
  const double exact = (torque ? formulas.torque : formulas.angle)(a, b, x);
  const double error = torque ? torque_error : angle_error * std::abs(exact);
  const data::Observation point{
      .controls = {x}, .values = {exact + error * random.normal()}, .standard_errors = {error}, .line = 9};
  if (torque) {
    more.observations[0].points.push_back(point);
  } else {
    data::ObservationSet set{.name = "more", .file = "more.csv", .outputs = {1}};
    set.points.push_back(point);
    more.observations.push_back(set);
    more.cases[0].observe.push_back("more");
  }
  return more;
}

struct After {
  double sd = 0.0;
  bool identified = false;
};

After calibrated(const data::Study& study, const formula::Pair& formulas, std::size_t about) {
  const uq::SampledCase sampled = uq::sample_case(study, formula::emulators(0.0, formulas), 0, {.seed = 1});
  const uq::Identification found = uq::identify(*sampled.model, sampled.draws.pooled());
  return {found.parameters[about].sd, found.parameters[about].verdict == uq::Verdict::identified};
}

/// Share of "identified" over `count` readings of a candidate at draws of the posterior, each calibrated.
double identified_by_calibrations(const data::Study& study, const formula::Pair& formulas,
                                  const uq::PlanCandidate& candidate, const Eigen::MatrixXd& draws, int count,
                                  data::RandomStream& random) {
  int identified = 0;
  for (int i = 0; i < count; ++i) {
    const auto row = static_cast<Eigen::Index>(random.uniform() * static_cast<double>(draws.rows()));
    const data::Study more = with_reading(study, formulas, candidate, draws(row, 0), draws(row, 1), random);
    identified += calibrated(more, formulas, 0).identified ? 1 : 0;
  }
  return static_cast<double>(identified) / count;
}

/// Of loops' forecast probabilities and those by `count` calibrations each.
struct Redone {
  std::vector<double> forecast, share;

  std::string text(int count) const {
    if (share.empty()) return "";
    const auto n = static_cast<double>(share.size());
    double mean = 0.0, sampling = 0.0, spread = 0.0, difference = 0.0;
    for (const double p : share) mean += p / n;
    for (std::size_t i = 0; i < share.size(); ++i) {
      sampling += share[i] * (1.0 - share[i]) / (count - 1) / n;
      spread += std::pow(share[i] - mean, 2) / n;
      difference += std::pow(share[i] - forecast[i], 2) / n;
    }
    const auto sd = [&](double square) { return std::sqrt(std::max(square - sampling, 0.0)); };
    return fmt::format("{:.2f} / {:.2f} / {:.2f}", mean, sd(spread), sd(difference));
  }
};

void run(const char* name, const formula::Pair& formulas, int loops, std::uint64_t seed, int redone_count) {
  double before = 0.0, forecast = 0.0, chosen = 0.0, at_random = 0.0, again = 0.0, chance = 0.0, came = 0.0,
         brier = 0.0;
  int used = 0, refused = 0, again_used = 0;
  double again_before = 0.0;
  Redone redone;
  for (int loop = 0; loop < loops; ++loop) {
    data::RandomStream random(seed, data::Purpose::test, static_cast<std::uint32_t>(loop));
    const double a = random.uniform(), b = random.uniform();
    const std::vector<double> speeds = {0.0, 0.5, 1.0};
    std::vector<double> values;
    for (const double x : speeds) values.push_back(formulas.torque(a, b, x) + torque_error * random.normal());
    const data::Study study = formula::study(speeds, values, torque_error);
    const std::vector<uq::Emulator> emulators = formula::emulators(0.0, formulas);
    const uq::SampledCase sampled = uq::sample_case(study, emulators, 0, {.seed = 1});
    uq::PlanReport plan;
    try {
      plan = uq::plan::make_plan(study, emulators, 0, sampled, {}, {.about = "a", .draws = 800});
    } catch (const std::exception&) {
      ++refused;  // the case does not fit its data
      continue;
    }
    const uq::PlanCandidate& first = plan.candidates.front();
    const uq::PlanCandidate& other =
        plan.candidates[static_cast<std::size_t>(random.uniform() * static_cast<double>(plan.candidates.size()))];
    const auto repeat = std::find_if(plan.candidates.begin(), plan.candidates.end(), [](const uq::PlanCandidate& one) {
      return one.kind == uq::CandidateKind::repeat;
    });
    double p = 0.0;
    for (const uq::WordProbability& word : first.parameters[0].words)
      if (word.verdict == uq::Verdict::identified) p = word.probability;
    const After best = calibrated(with_reading(study, formulas, first, a, b, random), formulas, 0);
    before += first.parameters[0].sd_now;
    forecast += first.parameters[0].sd_after;
    chosen += best.sd;
    at_random += calibrated(with_reading(study, formulas, other, a, b, random), formulas, 0).sd;
    if (repeat != plan.candidates.end()) {
      again += calibrated(with_reading(study, formulas, *repeat, a, b, random), formulas, 0).sd;
      again_before += first.parameters[0].sd_now;
      ++again_used;
    }
    if (redone_count > 1) {
      data::RandomStream others(seed, data::Purpose::test, static_cast<std::uint32_t>(loops + loop));
      redone.forecast.push_back(p);
      redone.share.push_back(
          identified_by_calibrations(study, formulas, first, sampled.draws.pooled(), redone_count, others));
    }
    chance += p;
    came += best.identified ? 1.0 : 0.0;
    brier += std::pow(p - (best.identified ? 1.0 : 0.0), 2);
    ++used;
  }
  const double n = used, rate = came / n;
  fmt::print("| {} | {} | {:.3f} | {:.2f} / {:.2f} | {:.3f} / {:.3f} | {} | {:.2f} / {:.2f} / {:.2f} | {} |\n", name,
             used, chosen / forecast, chance / n, rate, brier / n, rate * (1.0 - rate), redone.text(redone_count),
             chosen / before, at_random / before, again_used > 0 ? again / again_before : 0.0, refused);
  std::fflush(stdout);
}

}  // namespace

int main(int count, char** words) {
  const int loops = count > 1 ? std::atoi(words[1]) : 200;
  const std::uint64_t seed = count > 2 ? std::strtoull(words[2], nullptr, 10) : 1;
  const int redone = count > 3 ? std::atoi(words[3]) : 0;
  const std::string only = count > 4 ? words[4] : "";
  const auto study = [&](const char* name, const formula::Pair& formulas) {
    if (only.empty() || only == name) run(name, formulas, loops, seed, redone);
  };
  fmt::print(
      "| study | loops | sd found over forecast | identified: forecast / came | Brier: forecast / base rate | redone: "
      "mean / sd / rms difference | sd over "
      "before: chosen / random / again | refused |\n|---|---|---|---|---|---|---|---|\n");
  study("sum", {formula::torque, formula::angle});
  study("product", {[](double a, double b, double x) { return 4.0 + 12.0 * (0.2 + a) * (0.2 + b) + 0.2 * x * a; },
                    formula::angle});
  study("saturating",
        {[](double a, double b, double x) { return 6.0 + 6.0 * a / (a + 0.3) + 2.0 * b * (1.0 - 0.5 * x); },
         [](double a, double b, double x) { return 8.0 + 4.0 * a * a - 2.0 * b + x; }});
  return 0;
}
