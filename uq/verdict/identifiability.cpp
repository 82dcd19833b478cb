#include "uq/verdict/identifiability.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "uq/findings/study_units.hpp"
#include "uq/infer/diagnostics.hpp"
#include "uq/posterior/common_share.hpp"
#include "uq/posterior/posterior.hpp"
#include "uq/posterior/support.hpp"
#include "uq/posterior/surrogate_share.hpp"
#include "uq/verdict/structure.hpp"
#include "uq/verdict/traded.hpp"

namespace uq {
namespace {

/// Values of unknown k in the study's unit.
Eigen::VectorXd shown(const Unknown& unknown, const Eigen::VectorXd& u) {
  const data::Parameter& parameter = unknown.prior.parameter();
  Eigen::VectorXd values(u.size());
  for (Eigen::Index i = 0; i < u.size(); ++i) values[i] = in_study_unit(parameter, u[i]);
  return values;
}

double shown(const Unknown& unknown, double u) { return in_study_unit(unknown.prior.parameter(), u); }

/// The parts of the interval, with the draws nearest to each.
std::vector<ValueRange> ranges_of(const Unknown& unknown, const Eigen::VectorXd& u, const Profile& profile) {
  std::vector<std::vector<double>> members(profile.parts.size());
  if (!members.empty())
    for (const double draw : u) members[part_of(profile, draw)].push_back(shown(unknown, draw));
  std::vector<ValueRange> ranges;
  for (std::size_t i = 0; i < members.size(); ++i) {
    const ProfilePart& part = profile.parts[i];
    ValueRange range{.low = shown(unknown, part.low), .high = shown(unknown, part.high)};
    range.low_open = i == 0 && !profile.low;
    range.high_open = i + 1 == members.size() && !profile.high;
    range.weight = static_cast<double>(members[i].size()) / static_cast<double>(u.size());
    range.mean = shown(unknown, profile.u[part.best]);
    if (members[i].size() > 1) {
      // A copy is aligned; sums over a map would depend on where its memory happens to lie.
      const Eigen::ArrayXd values =
          Eigen::Map<const Eigen::ArrayXd>(members[i].data(), static_cast<Eigen::Index>(members[i].size()));
      range.mean = values.mean();
      range.sd = std::sqrt((values - range.mean).square().mean());
    }
    ranges.push_back(range);
  }
  return ranges;
}

ParameterReport describe_draws(const Unknown& unknown, const Eigen::VectorXd& u, const Profile& profile) {
  const data::Parameter& parameter = unknown.prior.parameter();
  ParameterReport report;
  report.name = unknown.label;
  report.unit = parameter.unit.symbol;
  report.prior_low = shown(unknown, unknown.prior.low());
  report.prior_high = shown(unknown, unknown.prior.high());
  report.prior_mean = parameter.unit.from_si(unknown.prior.value_mean());
  report.prior_sd = unknown.prior.value_sd() / parameter.unit.factor;
  const Eigen::VectorXd values = shown(unknown, u);
  report.mean = values.mean();
  report.sd = std::sqrt((values.array() - report.mean).square().sum() / static_cast<double>(values.size() - 1));
  report.q05 = quantile(values, 0.05);
  report.q50 = quantile(values, 0.50);
  report.q95 = quantile(values, 0.95);
  report.contraction = 1.0 - std::pow(report.sd / report.prior_sd, 2);
  if (profile.low) report.profile_low = shown(unknown, *profile.low);
  if (profile.high) report.profile_high = shown(unknown, *profile.high);
  if (profile.runs_end_low) report.runs_end_low = shown(unknown, *profile.runs_end_low);
  if (profile.runs_end_high) report.runs_end_high = shown(unknown, *profile.runs_end_high);
  report.low_is_bound = !profile.low;
  report.high_is_bound = !profile.high;
  report.intervals = ranges_of(unknown, u, profile);
  for (const ProfileBarrier& barrier : profile.barriers)
    report.holes.push_back({.low = shown(unknown, barrier.low),
                            .high = shown(unknown, barrier.high),
                            .deviance = barrier.deviance,
                            .in_doubt = barrier.in_doubt});
  const Eigen::VectorXd x = shown(unknown, profile.u);
  report.profile_x.assign(x.begin(), x.end());
  report.profile_deviance.assign(profile.deviance.begin(), profile.deviance.end());
  report.profile_drop = profile.drop;
  return report;
}

/// The facts that decide the word, except its influence.
WordFacts facts_of(const ParameterReport& report, const Profile& profile, const Unknown& unknown) {
  double within = 0.0;
  for (const ValueRange& part : report.intervals) within += part.weight * part.sd * part.sd;
  return {.influences = true,
          .parts = std::max(1, static_cast<int>(profile.parts.size())),
          .open_low = !profile.low,
          .open_high = !profile.high,
          .physical_low = physical_low(unknown) && !profile.low_pinned && !profile.runs_end_low && !profile.low_unknown,
          .open_beyond = profile.low_pinned || profile.high_pinned || profile.runs_end_low || profile.runs_end_high ||
                         profile.low_unknown || profile.high_unknown,
          .contraction = report.contraction,
          .contraction_within =
              profile.parts.size() > 1 ? 1.0 - within / (report.prior_sd * report.prior_sd) : report.contraction};
}

/// The data exclude a part of its range, the surrogate's error counted in: it acts, even where the surrogate cannot
/// tell by how much over the whole range.
bool limited(const WordFacts& facts) { return !(facts.open_low && facts.open_high); }

/// Why each open or wide interval is as it is; what is traded with a structural one is so, too.
void add_structure(const CaseModel& model, const Profiles& all, std::vector<ParameterEvidence>& evidence,
                   const std::vector<TradedPair>& traded, const VerdictThresholds& thresholds) {
  for (std::size_t k = 0; k < evidence.size(); ++k) {
    ParameterEvidence& one = evidence[k];
    const Verdict word = word_of(one.facts, thresholds);
    if (!one.facts.influences || word == Verdict::identified || word == Verdict::several_values) continue;
    const Structure structure = find_structure(model, all, all.profiles[k], thresholds);
    one.structural = structure.structural;
    one.undecided = structure.undecided;
  }
  for (const TradedPair& set : traded) {
    const auto member = [&](const ParameterEvidence& one) {
      return std::find(set.parameters.begin(), set.parameters.end(), one.found.name) != set.parameters.end();
    };
    const bool some = std::any_of(evidence.begin(), evidence.end(),
                                  [&](const ParameterEvidence& one) { return member(one) && one.structural; });
    for (ParameterEvidence& one : evidence)
      if (member(one)) {
        one.traded = true;
        if (some && one.undecided) one.structural = true;
      }
  }
}

/// The label of an unknown that a profile names, or nothing.
std::string label_of(const CaseModel& model, const std::optional<int>& unknown) {
  return unknown ? model.unknowns[*unknown].label : std::string();
}

/// The mode of the posterior.
Eigen::VectorXd mode_of(const CaseModel& model, const Guides& guide, const Eigen::VectorXd& best) {
  Eigen::VectorXd level = guide.log_likelihood;
  for (Eigen::Index i = 0; i < level.size(); ++i) level[i] += log_prior(model, guide.draws.row(i).transpose());
  Eigen::Index top = 0;
  level.maxCoeff(&top);
  Eigen::MatrixXd starts(2, model.dimension());
  starts << guide.draws.row(top), best.transpose();
  const Target target = posterior_target(std::make_shared<const CaseModel>(model));
  return maximise(target.log_density_gradient, {target.lower, target.upper}, starts).x;
}

/// The evidence about a parameter before its structure is asked for.
ParameterEvidence evidence_of(ParameterReport report, const Profile& profile, const Unknown& unknown,
                              const Influence& influence, const VerdictThresholds& thresholds) {
  const WordFacts facts = facts_of(report, profile, unknown);
  ParameterEvidence one{
      .found = std::move(report), .facts = facts, .unknown_beyond = profile.low_unknown || profile.high_unknown};
  one.facts.influences = influence.some || limited(one.facts);
  one.faint = !influence.some && one.facts.contraction < thresholds.contraction_weak;
  one.hidden = influence.hidden;
  one.silent_sds = influence.shown ? 0.0 : std::sqrt(influence.doubt);
  return one;
}

/// Whether a parameter would be narrow enough for a word with an exact surrogate, as far as the draws tell.
bool runs_could_tell(const SurrogateShare& surrogate, std::size_t k, double contraction,
                     const VerdictThresholds& thresholds) {
  return !surrogate.tells(k) || 1.0 - surrogate.left[k] * (1.0 - contraction) >= thresholds.contraction_weak;
}

/// What the draws, the profile and the influence of each own parameter say of it.
std::vector<ParameterEvidence> evidence_of_each(const CaseModel& model, const Eigen::MatrixXd& draws,
                                                const Guides& guide, const Profiles& all,
                                                const IdentifyOptions& options) {
  const Eigen::VectorXd mode = mode_of(model, guide, all.best.x);
  const SurrogateShare surrogate = surrogate_share(model, guide.draws, guide.log_likelihood);
  const std::vector<CommonShare> common = common_shares(model, guide.draws);
  const bool unusable = !doubt_of(model).empty();
  std::vector<ParameterEvidence> evidence;
  for (std::size_t k = 0; k < all.profiles.size(); ++k) {
    const Profile& profile = all.profiles[k];
    const Unknown& unknown = model.unknowns[k];
    ParameterReport report = describe_draws(unknown, draws.col(k), profile);
    report.map = shown(unknown, mode[k]);
    report.low_pinned_by = label_of(model, profile.low_pinned);
    report.high_pinned_by = label_of(model, profile.high_pinned);
    report.common = common[k];
    ParameterEvidence one = evidence_of(std::move(report), profile, unknown, all.influence[k], options.thresholds);
    one.conditional_on = label_of(model, profile.conditional_on);
    if (k < options.unsupported.size()) one.unsupported = options.unsupported[k];
    one.unusable = unusable;
    one.surrogate_share = surrogate.shares[k];
    one.runs_could_tell = runs_could_tell(surrogate, k, one.facts.contraction, options.thresholds);
    evidence.push_back(std::move(one));
  }
  return evidence;
}

/// What holds for the case as a whole.
Identification whole_case(const CaseModel& model, const Eigen::MatrixXd& draws, const Profiles& all) {
  Identification found;
  found.profiles = all.profiles;
  found.influence = all.influence;
  found.best_fit = all.best;
  found.fisher = fisher_spectrum(model, all.best.x);
  found.check = check_fit(model, draws, all.best.x);
  found.surrogate_to_measurement = surrogate_to_measurement(model, all.best.x);
  return found;
}

ParameterReport with_verdict(ParameterReport report, const ParameterVerdict& verdict) {
  report.verdict = verdict.verdict;
  report.reason = verdict.reason;
  report.borderline = verdict.borderline;
  report.sentence = verdict.sentence;
  report.shares = verdict.shares;
  return report;
}

}  // namespace

Identification identify(const CaseModel& full, const Eigen::MatrixXd& draws, const IdentifyOptions& options) {
  const CaseModel& model = distinct_rows(full);
  const VerdictThresholds& thresholds = options.thresholds;
  const Eigen::MatrixXd guiding = thinned(draws, 1500);
  const Guides guide{.draws = guiding, .log_likelihood = log_likelihoods(model, guiding)};
  const Profiles all = profile_likelihood(
      model, guide, {.even_points = options.even_points, .near_points = options.near_points, .thresholds = thresholds});
  Identification found = whole_case(model, draws, all);
  const FitEvidence fit{.predictive_p = found.check.predictive_p, .best_fit_p = found.check.best_fit_p};
  found.fits = fit.fits(thresholds);

  // Each parameter by itself.
  std::vector<ParameterEvidence> evidence = evidence_of_each(model, draws, guide, all, options);
  std::vector<FoundFacts> facts;
  std::vector<Verdict> words;
  for (std::size_t k = 0; k < evidence.size(); ++k) {
    found.facts.push_back(evidence[k].facts);
    facts.push_back({evidence[k].facts, &found.profiles[k]});
    words.push_back(word_of(evidence[k].facts, thresholds));
  }

  // What several do together, and how sure the words are.
  std::vector<std::vector<WordProbability>> repeats(evidence.size());
  if (found.fits) {
    found.traded = find_traded_pairs(model, draws, all, words, thresholds);
    add_structure(model, all, evidence, found.traded, thresholds);
    repeats = repeat_words(model, facts, draws, all.best.x, thresholds, options.repeats);
    found.modes = find_modes(all, draws, thresholds);
    found.unvisited = unvisited(model, all, draws);
  }

  for (std::size_t k = 0; k < evidence.size(); ++k) {
    const ParameterVerdict verdict = judge(evidence[k], fit, repeats[k], thresholds);
    found.parameters.push_back(with_verdict(std::move(evidence[k].found), verdict));
    found.parameters[k].word_probabilities = std::move(repeats[k]);
  }
  return found;
}

Words summarise(const Identification& found, const std::string& parted_by, bool own_engine) {
  if (!found.fits)
    return {.finding = fmt::format("No values of the parameters reproduce the data: chi2 {:.1f} for {} degrees of "
                                   "freedom, posterior predictive p {:.2g}.",
                                   found.check.chi2, found.check.dof, found.check.predictive_p),
            .consequence = "The parameters' values and errors mean nothing here; none is called identified.",
            .remedies = {"Check the data's errors and units and the rig's settings (fill, geometry, speed); then free "
                         "what was fixed, or widen the ranges."}};
  return words_of({.parameters = found.parameters,
                   .traded = found.traded,
                   .parted_by = parted_by,
                   .collinearity = found.fisher.collinearity,
                   .own_engine = own_engine});
}

}  // namespace uq
