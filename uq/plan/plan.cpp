#include "uq/plan/plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>

#include "data/error.hpp"
#include "uq/infer/parallel.hpp"
#include "uq/plan/forecast.hpp"
#include "uq/plan/information.hpp"
#include "uq/plan/outlook.hpp"
#include "uq/posterior/posterior.hpp"
#include "uq/posterior/surrogate_share.hpp"

namespace uq::plan {
namespace {

using data::Study;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double least_information = 0.02;    // nats: a width narrower by two per cent
constexpr int prior_repeats = 4;              // scramblings of the prior's draws
constexpr int search_draws = 600;             // for the search of batches
constexpr std::size_t asked_for_repeats = 3;  // best candidates whose readings are counted
constexpr double law_numbers = 2.4e7;         // of the laws of all planned rows, at most

/// Draws in an order in which any stretch of them is spread over all chains.
MatrixXd spread(const MatrixXd& draws, Index count) {
  const Index n = draws.rows(), kept = std::min(n, count);
  Index step = std::max<Index>(static_cast<Index>(0.6180339887 * static_cast<double>(n)), 1);
  while (std::gcd(step, n) != 1) ++step;
  MatrixXd order(kept, draws.cols());
  for (Index i = 0; i < kept; ++i) order.row(i) = draws.row((i * step) % n);
  return order;
}

data::InputError misfit(const Study& study, std::size_t case_index, const Identification& found) {
  return data::InputError(
      data::ExitStatus::bad_data,
      {study.cases[case_index].place,
       fmt::format("case '{}' does not fit its data (posterior predictive p {:.2g}), so what it says of other "
                   "measurements means nothing",
                   study.cases[case_index].name, found.check.predictive_p),
       "see what demcal calibrate says of the misfit first, or give the case discrepancy = true"});
}

int parameter_index(const Study& study, std::size_t case_index, const CaseModel& model, const std::string& name,
                    const Identification* found) {
  if (name.empty()) {
    if (found == nullptr) return 0;
    const auto least = std::min_element(
        found->parameters.begin(), found->parameters.end(),
        [](const ParameterReport& a, const ParameterReport& b) { return a.contraction < b.contraction; });
    return static_cast<int>(least - found->parameters.begin());
  }
  std::vector<std::string> names;
  for (int k = 0; k < model.own_count(); ++k) {
    names.push_back(model.slots[k].label);
    if (names.back() == name) return k;
  }
  throw data::InputError(data::ExitStatus::bad_study,
                         {study.cases[case_index].place,
                          fmt::format("case '{}' has no free parameter '{}'", study.cases[case_index].name, name),
                          fmt::format("choose one of: {}", fmt::join(names, ", "))});
}

VectorXd prior_means(const CaseModel& model) {
  VectorXd means(model.dimension());
  for (Index s = 0; s < means.size(); ++s) means[s] = model.slots[s].prior.mean();
  return means;
}

std::string error_text(const Study& study, const Candidate& candidate) {
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < candidate.outputs.size(); ++i) {
    const data::Spread& error = candidate.error[i];
    const data::Unit& unit = study.outputs[candidate.outputs[i]].unit;
    std::string text;
    if (error.relative > 0.0) text = fmt::format("{:.3g} %", 100.0 * error.relative);
    if (error.absolute > 0.0)
      text += fmt::format("{}{:.3g} {}", text.empty() ? "" : " and ", error.absolute / unit.factor, unit.symbol);
    if (std::find(parts.begin(), parts.end(), text) == parts.end()) parts.push_back(text);
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

class Planner {
 public:
  Planner(const Study& study, const std::vector<Emulator>& emulators, std::size_t case_index,
          const SampledCase& sampled, const data::PlanSection& section, const PlanOptions& options)
      : study_(study), sampled_(sampled), options_(options) {
    const CaseModel& model = *sampled.model;
    if (sampled.draws.chains.empty() && !options.prior)
      throw data::InputError(
          data::ExitStatus::bad_data,
          {study.cases[case_index].place,
           fmt::format("case '{}' could not be sampled: there is no posterior to plan on", model.name),
           "see what demcal calibrate says of it"});
    if (!options.prior) {
      draws_ = sampled.draws.pooled();
      found_ = identify(model, draws_, {.thresholds = options.thresholds, .unsupported = {}});
      if (!found_->fits) throw misfit(study, case_index, *found_);
    }
    about_ = parameter_index(study, case_index, model, options.about.empty() ? section.about : options.about,
                             found_ ? &*found_ : nullptr);
    candidates_ = candidates_of(study, emulators, case_index, section, options.candidates);
    if (options.prior)  // nothing is measured yet, so nothing is measured again
      for (Candidate& one : candidates_)
        if (one.kind == CandidateKind::repeat) one.kind = CandidateKind::setting;
    if (options.budget) std::erase_if(candidates_, [&](const Candidate& one) { return one.cost > *options.budget; });
    centre_ = options.prior ? prior_means(model) : found_->best_fit.x;
    extended_ = extend(study, emulators, case_index, model, candidates_, centre_);
    look_out();
  }

  PlanReport plan(const std::string& cost_unit) {
    PlanReport report{
        .about = name_of(about_), .prior = options_.prior, .cost_unit = cost_unit, .budget = options_.budget};
    if (candidates_.empty()) {
      report.sentence = options_.budget ? "No candidate costs as little as the budget." : "There are no candidates.";
      return report;
    }
    report.candidates.resize(candidates_.size());
    std::atomic<int> done{0};
    for_each_index(static_cast<int>(candidates_.size()), options_.threads, [&](int i) {
      report.candidates[i] = describe(static_cast<std::size_t>(i));
      tell(0.3 + 0.5 * ++done / static_cast<double>(candidates_.size()));
    });
    const std::vector<std::size_t> order = ranked(report.candidates);
    const bool open = found_ && found_->parameters[about_].verdict != Verdict::identified;
    if (open) count_readings(report.candidates, order);
    add_batches(report);
    std::vector<PlanCandidate> best_first;
    for (const std::size_t i : order) best_first.push_back(std::move(report.candidates[i]));
    report.candidates = std::move(best_first);
    add_runs(report);
    add_arrows(report, order);
    add_notes(report);
    report.sentence = sentence(report);
    tell(1.0);
    return report;
  }

 private:
  std::string name_of(int k) const { return sampled_.model->slots[k].label; }
  const data::Unit& unit_of(int k) const { return sampled_.model->slots[k].prior.parameter().unit; }
  void tell(double share) const {
    if (options_.progress) options_.progress(share);
  }

  void look_out() {
    std::size_t rows = 0, most = 1;
    for (const auto& one : extended_.planned) {
      rows += one.size();
      most = std::max(most, one.size());
    }
    const double n = static_cast<double>(std::max<std::size_t>(rows, 1));
    const int room = std::max(400, static_cast<int>(law_numbers / (n * n)));
    const int draws = std::min(options_.draws, room);
    if (options_.prior) {
      for (int r = 0; r < prior_repeats; ++r) {
        const PriorDraws prior =
            prior_draws(*sampled_.model, std::max(draws / 2, 400), static_cast<int>(most),
                        data::child_seed(options_.seed, data::Purpose::planned_prior, static_cast<std::uint32_t>(r)));
        outlooks_.emplace_back(extended_, prior.u, Outlook::Given::nothing, options_.threads);
        noise_.push_back(prior.noise);
      }
    } else {
      outlooks_.emplace_back(extended_, spread(draws_, draws), Outlook::Given::data, options_.threads);
      noise_.emplace_back();
      forecast_.emplace(extended_, *sampled_.model, *found_, outlooks_.front(), options_.thresholds, options_.seed);
    }
    tell(0.3);
  }

  Information information_of(const std::vector<Index>& rows) const {
    std::vector<Information> repeats;
    for (std::size_t r = 0; r < outlooks_.size(); ++r) {
      InformationOptions how{.seed = options_.seed, .noise = {}};
      if (noise_[r].cols() >= static_cast<Index>(rows.size()))
        how.noise = noise_[r].leftCols(static_cast<Index>(rows.size()));
      repeats.push_back(information(outlooks_[r].ensemble(rows), how));
    }
    return combined(repeats);
  }

  double sd_now(int k) const {
    const auto column = outlooks_.front().values().col(k).array();
    return std::sqrt((column - column.mean()).square().mean());
  }

  PlanCandidate describe(std::size_t i) const {
    const Candidate& candidate = candidates_[i];
    const std::vector<Index>& rows = extended_.planned[i];
    PlanCandidate one{.name = candidate.name,
                      .kind = candidate.kind,
                      .material = candidate.material,
                      .outputs = {},
                      .settings = {},
                      .cost = candidate.cost,
                      .model_only = candidate.model_only,
                      .assumed_error = candidate.assumed_error,
                      .error = error_text(study_, candidate),
                      .parameters = {}};
    for (const std::size_t output : candidate.outputs) one.outputs.push_back(study_.outputs[output].name);
    for (const auto& controls : candidate.settings) {
      std::map<std::string, double> setting;
      for (std::size_t c = 0; c < controls.size(); ++c)
        setting[study_.controls[c].name] = study_.controls[c].unit.from_si(controls[c]);
      one.settings.push_back(std::move(setting));
    }
    const Information information = information_of(rows);
    one.information = information.total.value;
    one.information_error = information.total.error;
    std::vector<std::vector<WordProbability>> words;
    if (forecast_) words = forecast_->words(rows);
    for (std::size_t k = 0; k < information.about.size(); ++k) {
      const InformationAbout& about = information.about[k];
      PlannedParameter parameter{.name = name_of(static_cast<int>(k)),
                                 .unit = unit_of(static_cast<int>(k)).symbol,
                                 .information = about.information.value,
                                 .information_error = about.information.error,
                                 .sd_now = sd_now(static_cast<int>(k)),
                                 .sd_after = about.sd_after.value,
                                 .words = {},
                                 .repeats_needed = {},
                                 .repeats_low = {},
                                 .repeats_high = {},
                                 .floor = {}};
      if (k < words.size()) parameter.words = words[k];
      one.parameters.push_back(std::move(parameter));
    }
    const Estimate& asked = information.about[about_].information;
    one.teaches = asked.value > least_information && asked.value > asked.error;
    return one;
  }

  /// By information about the parameter asked for per cost; what need not mean the same in the powder comes last.
  std::vector<std::size_t> ranked(const std::vector<PlanCandidate>& all) const {
    std::vector<std::size_t> order(all.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    const auto worth = [&](std::size_t i) { return all[i].parameters[about_].information / all[i].cost; };
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
      if (all[a].model_only != all[b].model_only) return all[b].model_only;
      return worth(a) > worth(b);
    });
    return order;
  }

  /// Of the best candidates, and of the best reading made again: how many it takes.
  void count_readings(std::vector<PlanCandidate>& all, const std::vector<std::size_t>& order) const {
    std::vector<std::size_t> asked(
        order.begin(), order.begin() + static_cast<std::ptrdiff_t>(std::min(asked_for_repeats, order.size())));
    const auto repeat = std::find_if(order.begin(), order.end(),
                                     [&](std::size_t i) { return candidates_[i].kind == CandidateKind::repeat; });
    if (repeat != order.end() && std::find(asked.begin(), asked.end(), *repeat) == asked.end())
      asked.push_back(*repeat);
    for_each_index(static_cast<int>(asked.size()), options_.threads, [&](int i) {
      const std::size_t which = asked[i];
      const ReadingsNeeded needed = forecast_->readings_needed(extended_.planned[which], about_);
      PlannedParameter& parameter = all[which].parameters[about_];
      parameter.repeats_needed = needed.count;
      parameter.repeats_low = needed.low;
      parameter.repeats_high = needed.high;
      parameter.floor = to_text(needed.floor);
      if (!needed.count && needed.at_most >= 0.005)
        parameter.floor =
            fmt::format("at most with a probability of {:.0f} %: {}", 100.0 * needed.at_most, parameter.floor);
    });
  }

  std::vector<Index> rows_of(const std::vector<std::size_t>& members) const {
    std::vector<Index> rows;
    for (const std::size_t i : members)
      rows.insert(rows.end(), extended_.planned[i].begin(), extended_.planned[i].end());
    return rows;
  }
  double cost_of(const std::vector<std::size_t>& members) const {
    double sum = 0.0;
    for (const std::size_t i : members) sum += candidates_[i].cost;
    return sum;
  }
  bool affordable(const std::vector<std::size_t>& members) const {
    return !options_.budget || cost_of(members) <= *options_.budget * (1.0 + 1e-9);
  }

  /// Information about the parameter asked for, by some of the draws.
  double quick_information(const std::vector<std::size_t>& members) const {
    Ensemble all = outlooks_.front().ensemble(rows_of(members));
    const Index n = std::min<Index>(search_draws, all.draws());
    const MatrixXd column = all.values.col(about_).head(n);
    const MatrixXd mean = all.mean.topRows(n);
    all.values = column;
    all.mean = mean;
    all.covariance.resize(static_cast<std::size_t>(n));
    return information(all, {.seed = options_.seed, .noise = {}}).about.front().information.value;
  }

  /// The member at `position` (or one more) that is best beside the others; none where no other is affordable.
  std::optional<std::size_t> best_at(std::vector<std::size_t> members, std::size_t position) const {
    std::vector<double> value(candidates_.size(), -1.0);
    for_each_index(static_cast<int>(candidates_.size()), options_.threads, [&](int i) {
      std::vector<std::size_t> tried = members;
      tried[position] = static_cast<std::size_t>(i);
      if (!candidates_[tried[position]].model_only && affordable(tried)) value[i] = quick_information(tried);
    });
    const auto best = std::max_element(value.begin(), value.end());
    if (*best < 0.0) return {};
    return static_cast<std::size_t>(best - value.begin());
  }

  void add_batches(PlanReport& report) const {
    std::vector<std::size_t> greedy;
    for (int size = 1; size <= options_.batch; ++size) {
      greedy.push_back(0);
      const std::optional<std::size_t> next = best_at(greedy, greedy.size() - 1);
      if (!next) return;
      greedy.back() = *next;
      if (size < 2) continue;
      std::vector<std::size_t> members = greedy;
      for (int sweep = 0; sweep < 2; ++sweep) {
        bool changed = false;
        for (std::size_t position = 0; position < members.size(); ++position) {
          const std::optional<std::size_t> better = best_at(members, position);
          if (!better || *better == members[position]) continue;
          members[position] = *better;
          changed = true;
        }
        if (!changed) break;
      }
      const auto about = static_cast<std::size_t>(about_);
      const Information picked = information_of(rows_of(greedy)), exchanged = information_of(rows_of(members));
      if (exchanged.about[about].information.value < picked.about[about].information.value) members = greedy;
      const Information& kept = members == greedy ? picked : exchanged;
      PlanBatch batch{.candidates = {},
                      .information = kept.about[about].information.value,
                      .information_error = kept.about[about].information.error,
                      .greedy = picked.about[about].information.value,
                      .sd_after = kept.about[about].sd_after.value,
                      .cost = cost_of(members)};
      std::sort(members.begin(), members.end());
      for (const std::size_t i : members) batch.candidates.push_back(candidates_[i].name);
      report.batches.push_back(std::move(batch));
    }
  }

  /// The most that training runs can do: a surrogate that is exact.
  void add_runs(PlanReport& report) const {
    if (!found_) return;
    const SurrogateShare share = surrogate_share(*sampled_.model, draws_);
    if (share.effective_draws < least_effective) return;
    for (std::size_t k = 0; k < share.shares.size(); ++k) {
      const double now = sd_now(static_cast<int>(k)), left = std::max(1.0 - share.shares[k], 1e-12);
      report.runs.parameters.push_back({.name = name_of(static_cast<int>(k)),
                                        .unit = unit_of(static_cast<int>(k)).symbol,
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

  void add_arrows(PlanReport& report, const std::vector<std::size_t>& order) const {
    const CaseModel& model = extended_.model;
    const MatrixXd slopes = sensitivity(model, centre_);
    const StackedPrediction prediction = predict(model, centre_);
    for (const std::size_t i : order) {
      const Candidate& candidate = candidates_[i];
      if (candidate.settings.size() != 1 || candidate.outputs.size() != 1) continue;
      const Index row = extended_.planned[i].front();
      for (int k = 0; k < model.own_count(); ++k) {
        PlanArrow arrow{
            .output = study_.outputs[candidate.outputs.front()].name, .parameter = name_of(k), .setting = {}};
        for (std::size_t c = 0; c < study_.controls.size(); ++c)
          arrow.setting[study_.controls[c].name] = study_.controls[c].unit.from_si(candidate.settings.front()[c]);
        arrow.change = slopes(row, k) * model.slots[k].prior.sd() / std::sqrt(prediction.noise[row]);
        report.arrows.push_back(std::move(arrow));
      }
    }
  }

  void add_notes(PlanReport& report) const {
    const auto some = [&](auto member) {
      return std::any_of(report.candidates.begin(), report.candidates.end(),
                         [&](const PlanCandidate& one) { return one.*member; });
    };
    if (some(&PlanCandidate::assumed_error))
      report.notes.push_back(
          fmt::format("Nobody stated the error of an output that the case has not measured; {:g} % is assumed. "
                      "[plan] states yours.",
                      100.0 * options_.candidates.assumed_error));
    if (some(&PlanCandidate::model_only))
      report.notes.push_back(
          "Outputs marked 'model only' come from enlarged grains: they need not mean the same in the real powder, "
          "and are ranked last.");
    for (const RowGroup& group : sampled_.model->groups)
      if (!group.emulator.doubt.empty())
        report.notes.push_back(
            fmt::format("The surrogate cannot carry a verdict ({}): make training runs first.", group.emulator.doubt));
    if (!sampled_.draws.converged && !options_.prior)
      report.notes.push_back("The posterior has not converged: the ranking may change.");
  }

  /// With as many digits as it takes to tell the width now from that afterwards, three at most.
  std::string width(const PlannedParameter& parameter, double sd) const {
    const bool two = fmt::format("{:.2g}", parameter.sd_now) != fmt::format("{:.2g}", parameter.sd_after);
    return fmt::format("{:.{}g}{}{}", sd, two ? 2 : 3, parameter.unit.empty() ? "" : " ", parameter.unit);
  }

  std::string chance_of_identified(const std::string& name, const PlannedParameter& gain) const {
    if (gain.words.empty()) return {};
    double chance = 0.0;
    for (const WordProbability& word : gain.words)
      if (word.verdict == Verdict::identified) chance = word.probability;
    if (chance < 0.01)
      return fmt::format(" {} is not identified by that: {}.", name, gain.floor.empty() ? "it needs more" : gain.floor);
    return fmt::format(" {} is then identified with a probability of {:.0f} %.", name, 100.0 * chance);
  }

  /// The answer: what to measure, what it gives, and what gives more.
  std::string sentence(const PlanReport& report) const {
    const auto k = static_cast<std::size_t>(about_);
    const PlanCandidate& best = report.candidates.front();
    const PlannedParameter& gain = best.parameters[k];
    const bool identified = found_ && found_->parameters[k].verdict == Verdict::identified;
    std::string text;
    if (identified) text = fmt::format("{} is identified already (+- {}). ", report.about, width(gain, gain.sd_now));
    if (best.teaches)
      text += fmt::format("Measure {}{} next: it is expected to narrow {} from +- {} to +- {} ({:.2f} nats).",
                          best.name, best.kind == CandidateKind::repeat ? " again" : "", report.about,
                          width(gain, gain.sd_now), width(gain, gain.sd_after), gain.information);
    else
      text += fmt::format("No candidate teaches {} anything: the best, {}, gives {:.2f} nats.", report.about, best.name,
                          gain.information);
    if (best.teaches && !identified) text += chance_of_identified(report.about, gain);
    const auto repeat = std::find_if(report.candidates.begin(), report.candidates.end(),
                                     [](const PlanCandidate& one) { return one.kind == CandidateKind::repeat; });
    if (best.teaches && repeat != report.candidates.end() && repeat != report.candidates.begin())
      text += fmt::format(" The best of what is measured already, once more ({}), gives {:.2f} nats.", repeat->name,
                          repeat->parameters[k].information);
    const auto other = std::max_element(
        report.candidates.begin(), report.candidates.end(),
        [&](const auto& a, const auto& b) { return a.parameters[k].information < b.parameters[k].information; });
    if (other->model_only && !best.model_only && other->parameters[k].information > 2.0 * gain.information)
      text += fmt::format(
          " {} would give {:.2f} nats, but only if it means the same in the real powder as with enlarged grains.",
          other->name, other->parameters[k].information);
    if (k < report.runs.parameters.size() &&
        report.runs.parameters[k].information > std::max(gain.information, least_information))
      text += fmt::format(
          " Training runs come first: with an exact surrogate the data that are there give {} to +- {} ({:.2f} nats).",
          report.about, width(gain, report.runs.parameters[k].sd_after), report.runs.parameters[k].information);
    return text;
  }

  const Study& study_;
  const SampledCase& sampled_;
  const PlanOptions& options_;
  MatrixXd draws_;
  VectorXd centre_;
  std::optional<Identification> found_;
  int about_ = 0;
  std::vector<Candidate> candidates_;
  ExtendedCase extended_;
  std::vector<Outlook> outlooks_;
  std::vector<MatrixXd> noise_;
  std::optional<Forecast> forecast_;
};

}  // namespace

PlanReport make_plan(const Study& study, const std::vector<Emulator>& emulators, std::size_t case_index,
                     const SampledCase& sampled, const data::PlanSection& section, const PlanOptions& options) {
  return Planner(study, emulators, case_index, sampled, section, options).plan(section.cost_unit);
}

}  // namespace uq::plan
