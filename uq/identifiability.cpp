#include "uq/identifiability.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "uq/diagnostics.hpp"
#include "uq/posterior.hpp"
#include "uq/traded.hpp"

namespace uq {
namespace {

/// Values of unknown k in the study's unit.
Eigen::VectorXd shown(const Slot& slot, const Eigen::VectorXd& u) {
  const data::Parameter& parameter = slot.prior.parameter();
  Eigen::VectorXd values(u.size());
  for (Eigen::Index i = 0; i < u.size(); ++i) values[i] = parameter.unit.from_si(from_scaled(parameter, u[i]));
  return values;
}

double shown(const Slot& slot, double u) {
  const data::Parameter& parameter = slot.prior.parameter();
  return parameter.unit.from_si(from_scaled(parameter, u));
}

ParameterReport describe_draws(const Slot& slot, const Eigen::VectorXd& u, const Profile& profile) {
  const data::Parameter& parameter = slot.prior.parameter();
  ParameterReport report;
  report.name = slot.label;
  report.unit = parameter.unit.symbol;
  report.prior_low = shown(slot, slot.prior.low());
  report.prior_high = shown(slot, slot.prior.high());
  report.prior_mean = parameter.unit.from_si(slot.prior.value_mean());
  report.prior_sd = slot.prior.value_sd() / parameter.unit.factor;
  const Eigen::VectorXd values = shown(slot, u);
  report.mean = values.mean();
  report.sd = std::sqrt((values.array() - report.mean).square().sum() / static_cast<double>(values.size() - 1));
  report.q05 = quantile(values, 0.05);
  report.q50 = quantile(values, 0.50);
  report.q95 = quantile(values, 0.95);
  report.contraction = 1.0 - std::pow(report.sd / report.prior_sd, 2);
  if (profile.low) report.profile_low = shown(slot, *profile.low);
  if (profile.high) report.profile_high = shown(slot, *profile.high);
  report.low_is_bound = !profile.low;
  report.high_is_bound = !profile.high;
  const Eigen::VectorXd x = shown(slot, profile.u);
  report.profile_x.assign(x.begin(), x.end());
  report.profile_deviance.assign(profile.deviance.begin(), profile.deviance.end());
  return report;
}

/// Sd of the emulators over that of all else that is uncertain of the data.
double median_surrogate_share(const CaseModel& model, const Eigen::VectorXd& u) {
  CaseModel emulators = model;
  for (auto& group : emulators.groups) {
    group.measurement.discrepancies.clear();
    for (auto& set : group.measurement.sets) {
      set.common_absolute = set.common_relative = 0.0;
      set.settings.clear();
    }
  }
  const Eigen::ArrayXd own = predict(emulators, u).covariance.diagonal().array().max(0.0);
  const Eigen::ArrayXd other = predict(model, u).total().diagonal().array() - own;
  return quantile((own / other).sqrt(), 0.5);
}

}  // namespace

Identification identify(const CaseModel& model, const Eigen::MatrixXd& draws, const IdentifyOptions& options) {
  Identification found;
  const Eigen::MatrixXd guiding = thinned(draws, 1500);
  Profiles profiles =
      profile_likelihood(model, {.draws = guiding, .log_likelihood = log_likelihoods(model, guiding)}, options.profile);
  found.profiles = std::move(profiles.profiles);
  found.best_fit = profiles.best;
  found.fisher = fisher_spectrum(model, found.best_fit.x);
  found.check = check_fit(model, draws, found.best_fit.x);
  found.surrogate_share = median_surrogate_share(model, found.best_fit.x);
  const FitEvidence fit{.predictive_p = found.check.predictive_p, .best_fit_p = found.check.best_fit_p};
  found.fits = fit.fits(options.thresholds);

  // The mode of the posterior.
  Eigen::Index top = 0;
  Eigen::VectorXd level = log_likelihoods(model, guiding);
  for (Eigen::Index i = 0; i < guiding.rows(); ++i) level[i] += log_prior(model, guiding.row(i).transpose());
  level.maxCoeff(&top);
  Eigen::MatrixXd starts(2, model.dimension());
  starts << guiding.row(top), found.best_fit.x.transpose();
  const Target target = posterior_target(std::make_shared<const CaseModel>(model));
  const Maximum mode = maximise(target.log_density_gradient, {target.lower, target.upper}, starts);

  std::vector<bool> identified;
  for (std::size_t k = 0; k < found.profiles.size(); ++k) {
    const Profile& profile = found.profiles[k];
    const Slot& slot = model.slots[k];
    ParameterReport report = describe_draws(slot, draws.col(static_cast<Eigen::Index>(k)), profile);
    report.map = shown(slot, mode.x[static_cast<Eigen::Index>(k)]);
    ParameterEvidence evidence{.name = report.name,
                               .unit = report.unit,
                               .mean = report.mean,
                               .sd = report.sd,
                               .q95 = report.q95,
                               .contraction = report.contraction,
                               .profile_low = report.profile_low,
                               .profile_high = report.profile_high,
                               .range_low = report.prior_low,
                               .range_high = report.prior_high,
                               .deviance_at_low = profile.deviance_at_low,
                               .deviance_at_high = profile.deviance_at_high,
                               .physical_low = physical_low(slot)};
    if (k < options.unsupported.size()) evidence.unsupported = options.unsupported[k];
    if (profile.low_pinned) evidence.low_pinned_by = model.slots[static_cast<std::size_t>(*profile.low_pinned)].label;
    if (profile.high_pinned)
      evidence.high_pinned_by = model.slots[static_cast<std::size_t>(*profile.high_pinned)].label;
    if (found.fits && !profile.closed() && found.surrogate_share <= options.thresholds.surrogate_share) {
      const NoiseFree free = noise_free_extent(model, profile, found.best_fit.x, options.thresholds.noise_free_factor,
                                               options.thresholds.profile_drop);
      evidence.structural = free.share >= options.thresholds.noise_free_share;
    }
    const ParameterVerdict verdict = judge(evidence, fit, options.thresholds);
    report.verdict = verdict.verdict;
    report.reason = verdict.reason;
    report.borderline = verdict.borderline;
    report.sentence = verdict.sentence;
    identified.push_back(verdict.verdict == Verdict::identified);
    found.parameters.push_back(std::move(report));
  }
  if (found.fits) found.traded = find_traded_pairs(model, draws, found.profiles, identified, options.thresholds);
  return found;
}

Words summarise(const CaseModel& model, const Identification& found, const VerdictThresholds& thresholds) {
  Words words;
  if (!found.fits) {
    words.finding = fmt::format(
        "No values of the parameters reproduce the data: chi2 {:.1f} for {} degrees of freedom, posterior predictive p "
        "{:.2g}.",
        found.check.chi2, found.check.dof, found.check.predictive_p);
    words.consequence = "The parameters' values and errors mean nothing here; none is called identified.";
    words.remedy =
        "Check the data's errors and units and the rig's settings (fill, geometry, speed); then free what was fixed, "
        "or widen the ranges.";
    return words;
  }
  auto join = [](const std::vector<std::string>& names) {
    std::string text;
    for (std::size_t i = 0; i < names.size(); ++i)
      text += (i == 0 ? "" : i + 1 == names.size() ? " and " : ", ") + names[i];
    return text;
  };
  auto are = [](const std::vector<std::string>& names) {
    return names.size() == 1 ? std::string("is") : std::string("are");
  };
  std::vector<std::string> known, weak, unknown;
  bool structural = false, one_sided = false, bound = false;
  for (const auto& parameter : found.parameters) {
    (parameter.verdict == Verdict::identified          ? known
     : parameter.verdict == Verdict::weakly_identified ? weak
                                                       : unknown)
        .push_back(parameter.name);
    structural = structural || parameter.reason == "structural";
    one_sided = one_sided || parameter.reason == "one-sided";
    bound = bound || parameter.reason == "bound";
  }
  if (!known.empty()) words.finding += fmt::format("The data determine {}. ", join(known));
  if (!weak.empty()) words.finding += fmt::format("{} {} only weakly identified. ", join(weak), are(weak));
  if (!unknown.empty()) words.finding += fmt::format("The data do not determine {}. ", join(unknown));
  for (const auto& pair : found.traded)
    words.finding += fmt::format("{} and {} are traded against each other: what is known is {} (correlation {:.2f}). ",
                                 pair.first, pair.second, pair.combination, pair.correlation);
  if (found.traded.empty() && found.fisher.collinearity > 10.0 && model.dimension() > 1)
    words.finding += fmt::format("The parameters' effects on the data are nearly the same (collinearity {:.0f}). ",
                                 found.fisher.collinearity);

  if (unknown.empty() && weak.empty()) {
    words.consequence = "The values with their errors can be used.";
    words.remedy = "None needed.";
  } else if (!found.traded.empty()) {
    words.consequence =
        "Any of the equivalent points predicts the measured data as well; what else they predict differs. Do not carry "
        "one point of them to another machine or fill.";
    words.remedy = structural ? "Measure another kind of quantity, or fix one of the pair by an independent "
                                "experiment: a smaller error of the same measurement will not help."
                              : "Measure a quantity that responds differently to the two, fix one by an independent "
                                "experiment, or reduce the measurement error.";
  } else if (one_sided) {
    words.consequence = "Only a limit is known; the value given depends on where the range ends.";
    words.remedy = "Widen the range, with training runs there, or measure where the response has not saturated.";
  } else if (bound) {
    words.consequence = "The limit can be used as such; zero is not excluded.";
    words.remedy = "A smaller measurement error would lower the limit or show a value.";
  } else {
    words.consequence = "The values are little better than the prior.";
    words.remedy = "Reduce the measurement error, or measure at more settings.";
  }
  if (found.surrogate_share > thresholds.surrogate_share)
    words.remedy +=
        fmt::format(" The surrogate's error is {:.0f} % of the measurement's: more training runs would help, too.",
                    100.0 * found.surrogate_share);
  while (!words.finding.empty() && words.finding.back() == ' ') words.finding.pop_back();
  return words;
}

}  // namespace uq
