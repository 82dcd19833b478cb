#include "uq/plan/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

#include "uq/findings/study_units.hpp"
#include "uq/infer/parallel.hpp"
#include "uq/plan/plan_basis.hpp"
#include "uq/plan/plan_batches.hpp"
#include "uq/plan/plan_words.hpp"
#include "uq/posterior/common_share.hpp"
#include "uq/posterior/posterior.hpp"
#include "uq/posterior/surrogate_share.hpp"
#include "uq/verdict/remedies.hpp"

namespace uq::plan {
namespace {

using data::Study;
using Eigen::Index;
using Eigen::MatrixXd;

constexpr std::size_t asked_for_repeats = 3;  // best candidates whose readings are counted

PlanCandidate describe(const PlanBasis& basis, std::size_t i) {
  const Candidate& candidate = basis.candidates[i];
  const std::vector<Index>& rows = basis.extended.planned[i];
  PlanCandidate one{.name = candidate.name,
                    .kind = candidate.kind,
                    .material = candidate.material,
                    .outputs = {},
                    .settings = {},
                    .cost = candidate.cost,
                    .model_only = candidate.model_only,
                    .no_runs = candidate.no_runs,
                    .levels = candidate.levels,
                    .assumed_error = candidate.assumed_error,
                    .error = error_text(basis.study, candidate),
                    .parameters = {}};
  for (const std::size_t output : candidate.outputs) one.outputs.push_back(basis.study.outputs[output].name);
  for (const auto& controls : candidate.settings) one.settings.push_back(named_controls(basis.study, controls));
  const Information information = basis.information_of(rows);
  one.information = information.total.value;
  one.information_error = information.total.error;
  std::vector<double> widths;
  for (std::size_t k = 0; k < information.about.size(); ++k)
    widths.push_back(information.about[k].sd_after.value / basis.sd_now(static_cast<int>(k)));
  std::vector<std::vector<WordProbability>> words;
  if (basis.forecast) words = basis.forecast->words(rows, widths);
  for (std::size_t k = 0; k < information.about.size(); ++k) {
    const InformationAbout& about = information.about[k];
    PlannedParameter parameter{.name = basis.name_of(static_cast<int>(k)),
                               .unit = basis.unit_of(static_cast<int>(k)).symbol,
                               .information = about.information.value,
                               .information_error = about.information.error,
                               .sd_now = basis.sd_now(static_cast<int>(k)),
                               .sd_after = about.sd_after.value,
                               .words = {},
                               .repeats_needed = {},
                               .repeats_low = {},
                               .repeats_high = {},
                               .floor = {}};
    if (k < words.size()) parameter.words = words[k];
    one.parameters.push_back(std::move(parameter));
  }
  return one;
}

/// Where nobody stated a parameter and nothing teaches of the one that is known least, the question is the least known
/// of those that a candidate teaches of. Says whom it left out.
std::string choose_question(PlanBasis& basis, const std::vector<PlanCandidate>& all) {
  const auto taught = [&](int k) {
    return std::any_of(all.begin(), all.end(), [k](const PlanCandidate& one) {
      return !one.doubtful() && teaches(one, static_cast<std::size_t>(k));
    });
  };
  if (basis.stated || taught(basis.about)) return {};
  std::vector<int> order(all.front().parameters.size());
  std::iota(order.begin(), order.end(), 0);
  if (basis.found)
    std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
      return basis.found->parameters[a].contraction < basis.found->parameters[b].contraction;
    });
  const auto next = std::find_if(order.begin(), order.end(), taught);
  if (next == order.end()) return {};
  const std::string least = basis.name_of(basis.about);
  basis.about = *next;
  return fmt::format("No candidate teaches anything of {}, which is known least, so the plan asks about {}.", least,
                     basis.name_of(*next));
}

/// Whether the parameter asked for has separate values and one of the candidates is expected to part them.
bool is_parted(const PlanBasis& basis, const std::vector<PlanCandidate>& all) {
  constexpr double parted = 0.7;  // of the width over all, at most
  const auto k = static_cast<std::size_t>(basis.about);
  return basis.found && basis.found->parameters[k].verdict == Verdict::several_values &&
         std::any_of(all.begin(), all.end(), [k](const PlanCandidate& one) {
           return one.parameters[k].sd_after < parted * one.parameters[k].sd_now;
         });
}

/// The candidates ranked by what they are worth to the question, per cost. Those whose forecast need not hold come last.
std::vector<std::size_t> ranked(const PlanBasis& basis, const std::vector<PlanCandidate>& all) {
  std::vector<std::size_t> order(all.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  const auto worth = [&](std::size_t i) {
    const PlannedParameter& gain = all[i].parameters[basis.about];
    return basis.worth(gain.information, gain.sd_now, gain.sd_after) / all[i].cost;
  };
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    if (all[a].doubtful() != all[b].doubtful()) return all[b].doubtful();
    return worth(a) > worth(b);
  });
  return order;
}

/// Counts the readings that are needed of the best candidates, of the best reading made again and of the best set of
/// settings.
void count_readings(const PlanBasis& basis, std::vector<PlanCandidate>& all, const std::vector<std::size_t>& order) {
  std::vector<std::size_t> asked(
      order.begin(), order.begin() + static_cast<std::ptrdiff_t>(std::min(asked_for_repeats, order.size())));
  const auto ask_first = [&](const auto& wanted) {
    const auto first =
        std::find_if(order.begin(), order.end(), [&](std::size_t i) { return wanted(basis.candidates[i]); });
    if (first != order.end() && std::find(asked.begin(), asked.end(), *first) == asked.end()) asked.push_back(*first);
  };
  ask_first([](const Candidate& one) { return one.kind == CandidateKind::repeat; });
  ask_first([](const Candidate& one) { return one.settings.size() > 1; });
  for_each_index(static_cast<int>(asked.size()), basis.options.threads, [&](int i) {
    const std::size_t which = asked[i];
    PlannedParameter& parameter = all[which].parameters[basis.about];
    const ReadingsNeeded needed = basis.forecast->readings_needed(basis.extended.planned[which], basis.about,
                                                                  parameter.sd_after / parameter.sd_now);
    parameter.repeats_needed = needed.count;
    parameter.repeats_low = needed.low;
    parameter.repeats_high = needed.high;
    parameter.floor = to_text(needed.floor);
    if (needed.floor == Floor::meter)
      if (const std::string lever = remedy_of(shared_errors(basis.extended.model)); !lever.empty())
        parameter.floor += ": " + lever + " to lower it";
    if (!needed.count && needed.at_most >= 0.005)
      parameter.floor =
          fmt::format("at most with a probability of {:.0f} %: {}", 100.0 * needed.at_most, parameter.floor);
  });
}

/// The most that training runs can do: a surrogate that is exact.
void add_runs(const PlanBasis& basis, PlanReport& report) {
  if (!basis.found) return;
  const SurrogateShare share = surrogate_share(*basis.sampled.model, basis.draws);
  for (std::size_t k = 0; k < share.left.size(); ++k)
    if (!share.tells(k)) return;
  for (std::size_t k = 0; k < share.left.size(); ++k) {
    const double now = basis.sd_now(static_cast<int>(k)), left = std::clamp(share.left[k], 1e-12, 1.0);
    report.runs.parameters.push_back({.name = basis.name_of(static_cast<int>(k)),
                                      .unit = basis.unit_of(static_cast<int>(k)).symbol,
                                      .information = std::max(0.0, -0.5 * std::log(left)),
                                      .sd_now = now,
                                      .sd_after = now * std::sqrt(left),
                                      .words = {},
                                      .repeats_needed = {},
                                      .repeats_low = {},
                                      .repeats_high = {},
                                      .floor = {}});
  }
}

void add_arrows(const PlanBasis& basis, PlanReport& report, const std::vector<std::size_t>& order) {
  const CaseModel& model = basis.extended.model;
  const MatrixXd slopes = sensitivity(model, basis.centre);
  const StackedPrediction prediction = predict(model, basis.centre);
  for (const std::size_t i : order) {
    const Candidate& candidate = basis.candidates[i];
    if (candidate.settings.size() != 1 || candidate.outputs.size() != 1) continue;
    const Index row = basis.extended.planned[i].front();
    for (int k = 0; k < model.own_count(); ++k) {
      PlanArrow arrow{.output = basis.study.outputs[candidate.outputs.front()].name,
                      .parameter = basis.name_of(k),
                      .setting = named_controls(basis.study, candidate.settings.front())};
      arrow.change = slopes(row, k) * model.unknowns[k].prior.sd() / std::sqrt(prediction.noise[row]);
      report.arrows.push_back(std::move(arrow));
    }
  }
}

}  // namespace

PlanReport make_plan(const Study& study, const std::vector<Emulator>& emulators, std::size_t case_index,
                     const SampledCase& sampled, const data::PlanSection& section, const PlanOptions& options) {
  PlanBasis basis(study, emulators, case_index, sampled, section, options);
  PlanReport report{.about = {},
                    .prior = options.prior,
                    .cost_unit = section.cost_unit,
                    .control_units = {},
                    .budget = options.budget};
  for (const data::Control& control : study.controls)
    report.control_units.emplace_back(control.name, control.unit.symbol);
  if (basis.candidates.empty()) {
    report.about = basis.name_of(basis.about);
    report.sentence = options.budget ? "No candidate costs as little as the budget." : "There are no candidates.";
    return report;
  }
  report.candidates.resize(basis.candidates.size());
  std::atomic<int> done{0};
  for_each_index(static_cast<int>(basis.candidates.size()), options.threads, [&](int i) {
    report.candidates[i] = describe(basis, static_cast<std::size_t>(i));
    basis.tell(0.3 + 0.5 * ++done / static_cast<double>(basis.candidates.size()));
  });
  const std::string left_out = choose_question(basis, report.candidates);
  report.about = basis.name_of(basis.about);
  for (PlanCandidate& one : report.candidates) one.teaches = teaches(one, static_cast<std::size_t>(basis.about));
  basis.by_width = is_parted(basis, report.candidates);
  const std::vector<std::size_t> order = ranked(basis, report.candidates);
  const bool open = basis.found && basis.found->parameters[basis.about].verdict != Verdict::identified;
  if (open) count_readings(basis, report.candidates, order);
  report.batches = batches_of(basis);
  std::vector<PlanCandidate> best_first;
  for (const std::size_t i : order) best_first.push_back(std::move(report.candidates[i]));
  report.candidates = std::move(best_first);
  add_runs(basis, report);
  add_arrows(basis, report, order);
  report.notes = notes_of(basis, report);
  if (!left_out.empty()) report.notes.insert(report.notes.begin(), left_out);
  report.sentence = sentence_of(basis, report);
  basis.tell(1.0);
  return report;
}

}  // namespace uq::plan
