#include "uq/plan/plan_basis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "data/error.hpp"
#include "data/random.hpp"
#include "uq/plan/levels.hpp"
#include "uq/posterior/support.hpp"

namespace uq::plan {
namespace {

using data::Study;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int prior_repeats = 4;       // scramblings of the prior's draws
constexpr double law_numbers = 2.4e7;  // of the laws of all planned rows, at most

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
    names.push_back(model.unknowns[k].label);
    if (names.back() == name) return k;
  }
  throw data::InputError(data::ExitStatus::bad_study,
                         {study.cases[case_index].place,
                          fmt::format("case '{}' has no free parameter '{}'", study.cases[case_index].name, name),
                          fmt::format("choose one of: {}", fmt::join(names, ", "))});
}

/// A reading would not change what is cut, and what it tells of the rest would hang on the cut parameter's own law.
void refuse_cut(const Study& study, std::size_t case_index, const CaseModel& model) {
  for (const Unknown& unknown : model.unknowns)
    if (!unknown.cut_from.empty())
      throw data::InputError(
          data::ExitStatus::bad_study,
          {study.cases[case_index].place,
           fmt::format("case '{}' takes {} cut from case '{}', so that no reading of it changes that parameter; a plan "
                       "for such a case is not made",
                       study.cases[case_index].name, unknown.label, unknown.cut_from),
           fmt::format("plan for case '{}', or plan without `cut` in the prior of {}", unknown.cut_from,
                       unknown.label)});
}

/// Marks the candidates with a reading where no run speaks. The prior reaches into corners that no run has, whatever is
/// measured: there it has to be so at half of the draws.
void mark_unsupported(const ExtendedCase& extended, const MatrixXd& draws, bool of_prior,
                      std::vector<Candidate>& candidates) {
  const double most = of_prior ? 0.5 : SupportThresholds{}.share;
  for (std::size_t i = 0; i < candidates.size(); ++i)
    candidates[i].no_runs = (unsupported_at(extended.model, extended.planned[i], draws).array() > most).any();
}

VectorXd prior_means(const CaseModel& model) {
  VectorXd means(model.dimension());
  for (Index s = 0; s < means.size(); ++s) means[s] = model.unknowns[s].prior.mean();
  return means;
}

}  // namespace

bool teaches(const PlanCandidate& candidate, std::size_t k) {
  const PlannedParameter& gain = candidate.parameters[k];
  return gain.information > std::max(least_information, gain.information_error);
}

PlanBasis::PlanBasis(const Study& of_study, const std::vector<Emulator>& emulators, std::size_t case_index,
                     const SampledCase& sampled_case, const data::PlanSection& section, const PlanOptions& how)
    : study(of_study), sampled(sampled_case), options(how) {
  const CaseModel& model = *sampled.model;
  if (sampled.draws.chains.empty() && !options.prior)
    throw data::InputError(data::ExitStatus::bad_data,
                           {study.cases[case_index].place,
                            fmt::format("case '{}' could not be sampled: there is no posterior to plan on", model.name),
                            "see what demcal calibrate says of it"});
  if (!options.prior) {
    draws = sampled.draws.pooled();
    found = identify(model, draws, {.thresholds = options.thresholds, .unsupported = {}});
    if (!found->fits) throw misfit(study, case_index, *found);
  }
  refuse_cut(study, case_index, model);
  const std::string& name = options.about.empty() ? section.about : options.about;
  stated = !name.empty();
  about = parameter_index(study, case_index, model, name, found ? &*found : nullptr);
  candidates = candidates_of(study, emulators, case_index, section, options.candidates);
  if (options.prior)  // nothing is measured yet, so nothing is measured again
    for (Candidate& one : candidates)
      if (one.kind == CandidateKind::repeat) one.kind = CandidateKind::setting;
  if (options.budget) std::erase_if(candidates, [&](const Candidate& one) { return one.cost > *options.budget; });
  centre = options.prior ? prior_means(model) : found->best_fit.x;
  const MatrixXd likely = options.prior ? prior_draws(model, 400, 1, options.seed).u : draws;
  compare_levels(study, emulators, case_index, model, options.candidates, likely, centre, candidates);
  extended = extend(study, emulators, case_index, model, candidates, centre);
  mark_unsupported(extended, likely, options.prior, candidates);
  look_out();
}

std::string PlanBasis::name_of(int parameter) const { return sampled.model->unknowns[parameter].label; }
const data::Unit& PlanBasis::unit_of(int parameter) const {
  return sampled.model->unknowns[parameter].prior.parameter().unit;
}
double PlanBasis::worth(double information, double sd_now, double sd_after) const {
  return by_width && sd_after > 0.0 ? std::log(sd_now / sd_after) : information;
}

void PlanBasis::tell(double share) const {
  if (options.progress) options.progress(share);
}

void PlanBasis::look_out() {
  std::size_t rows = 0, most = 1;
  for (const auto& one : extended.planned) {
    rows += one.size();
    most = std::max(most, one.size());
  }
  const double n = static_cast<double>(std::max<std::size_t>(rows, 1));
  const int room = std::max(400, static_cast<int>(law_numbers / (n * n)));
  const int count = std::min(options.draws, room);
  if (options.prior) {
    for (int r = 0; r < prior_repeats; ++r) {
      // The noise of a batch, too, has to differ from one scrambling to the next: that tells the error.
      const int readings = static_cast<int>(most) * std::max(options.batch, 1);
      seeds.push_back(data::child_seed(options.seed, data::Purpose::planned_prior, static_cast<std::uint32_t>(r)));
      const PriorDraws prior = prior_draws(*sampled.model, std::max(count / 2, 400), readings, seeds.back());
      outlooks.emplace_back(extended, prior.u, Outlook::Given::nothing, options.threads);
      noise.push_back(prior.noise);
    }
  } else {
    outlooks.emplace_back(extended, spread(draws, count), Outlook::Given::data, options.threads);
    noise.emplace_back();
    seeds.push_back(options.seed);
    forecast.emplace(extended, *sampled.model, *found, outlooks.front(), options.thresholds, options.seed);
  }
  tell(0.3);
}

Information PlanBasis::information_of(const std::vector<Index>& rows) const {
  std::vector<Information> repeats;
  for (std::size_t r = 0; r < outlooks.size(); ++r) {
    InformationOptions how{.seed = seeds[r], .noise = {}};
    if (noise[r].cols() >= static_cast<Index>(rows.size()))
      how.noise = noise[r].leftCols(static_cast<Index>(rows.size()));
    repeats.push_back(information(outlooks[r].ensemble(rows), how));
  }
  return combined(repeats);
}

double PlanBasis::sd_now(int parameter) const {
  const auto column = outlooks.front().values().col(parameter).array();
  return std::sqrt((column - column.mean()).square().mean());
}

}  // namespace uq::plan
