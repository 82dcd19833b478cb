// Bayes factors between a case and itself with some parameters held (uq/posterior/held.hpp): the same data on both
// sides, those of linked cases included.
//
// Words by R. E. Kass, A. E. Raftery, "Bayes factors", J. Am. Stat. Assoc. 90 (1995) 773, section 3.2: 2 ln B below 2
// is not worth more than a bare mention, 2 to 6 positive, 6 to 10 strong, above 10 very strong.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "uq/calibrate/calibrate.hpp"
#include "uq/findings/study_units.hpp"
#include "uq/posterior/held.hpp"

namespace uq {
namespace {

const char* strength(double log_bayes_factor) {
  const double twice = 2.0 * std::abs(log_bayes_factor);
  return twice < 6.0 ? "positive" : twice < 10.0 ? "strong" : "very strong";
}

/// The draw of the largest density.
Eigen::VectorXd highest(const Draws& draws) {
  Eigen::Index at = 0;
  draws.pooled_log_density().maxCoeff(&at);
  return draws.pooled().row(at).transpose();
}

/// Two digits at most, and no exponent.
std::string plain_error(double error) {
  return error < 10.0 ? fmt::format("{:.1g}", error) : fmt::format("{:.0f}", error);
}

/// The evidence on each side is the mean over the torques that the surrogate allows, so its doubt is in the Bayes
/// factor. What a sharper surrogate, that is one of these torques alone, would find is said beside it, and where that
/// may have the other sign nothing is decided.
std::string in_words(const ModelComparison& found, const std::string& names) {
  std::string number =
      fmt::format("ln Bayes factor {:.1f} +- {}", found.log_bayes_factor, plain_error(found.sampling_error));
  if (found.surrogate_error > std::max(found.sampling_error, 0.1 * std::abs(found.log_bayes_factor)))
    number += fmt::format(", the mean over all that the surrogate leaves open; a sharper one would find {:.0f} +- {}",
                          found.sharper_factor, plain_error(found.surrogate_error));
  constexpr const char* caveat = "a wider prior range of what is held would lower it";
  const double sign = found.log_bayes_factor > 0.0 ? 1.0 : -1.0;
  if (std::abs(found.log_bayes_factor) < 1.0 + 2.0 * found.sampling_error ||
      sign * found.sharper_factor < found.surrogate_error)
    return fmt::format("The data do not decide between {} and {} free ({}; {}).", found.held, names, number, caveat);
  const bool free = found.log_bayes_factor > 0.0;
  return fmt::format("The data favour {} over {}: {} evidence ({}; {}).", free ? names + " free" : found.held,
                     free ? found.held : names + " free", strength(found.log_bayes_factor), number, caveat);
}

}  // namespace

std::vector<ModelComparison> compare_models(const data::Study& study, const SampledCase& sampled,
                                            std::size_t case_index, const CalibrateOptions& options) {
  const data::CalibrationCase& item = study.cases.at(case_index);
  if (item.held.empty() || std::isnan(sampled.draws.log_evidence) || sampled.draws.chains.empty()) return {};
  ModelComparison found;
  std::string names;
  std::vector<Held> held;
  for (const auto& [name, value] : item.held) {
    const data::Parameter& parameter = study.parameters[*study.parameter_index(name)];
    const auto unknown = std::find_if(sampled.model->unknowns.begin(), sampled.model->unknowns.end(),
                                      [label = name](const Unknown& one) { return one.label == label; });
    held.push_back({.coordinate = static_cast<int>(unknown - sampled.model->unknowns.begin()),
                    .value = parameter.axis().to_unit(value)});
    found.held += fmt::format("{}{} = {:.4g}{}", found.held.empty() ? "" : ", ", name, parameter.unit.from_si(value),
                              behind_number(parameter.unit.symbol));
    names += (names.empty() ? "" : " and ") + name;
  }
  MixtureSamplerOptions sampler = options.mixture;
  const std::uint64_t seed = seed_of(study, options);
  sampler.seed = data::child_seed(seed, data::Purpose::comparison_seed, static_cast<std::uint32_t>(case_index));
  sampler.threads = options.threads;
  const Draws beside = sample_mixture(held_target(sampled.model, held), sampler);
  if (beside.chains.empty()) {
    // The data rule the held value out, or nearly: a finding without a number, and no reason to end.
    found.log_bayes_factor = found.error = std::numeric_limits<double>::quiet_NaN();
    found.sentence = fmt::format("{} could not be compared with {} free: {}.", found.held, names, beside.reason);
    return {found};
  }
  found.log_bayes_factor = sampled.draws.log_evidence - beside.log_evidence;
  found.sampling_error = std::hypot(sampled.draws.log_evidence_error, beside.log_evidence_error);
  const int unknowns = sampled.model->dimension();
  const Eigen::VectorXd best = with_held(highest(beside).transpose(), held).row(0).transpose();
  const SharperFactor sharper = sharper_factor(*sampled.model, {highest(sampled.draws), unknowns_left(unknowns, {})},
                                               {best, unknowns_left(unknowns, held)});
  found.surrogate_error = sharper.sd;
  found.sharper_factor = found.log_bayes_factor + sharper.shift;
  found.error = std::hypot(found.sampling_error, found.surrogate_error);
  found.sentence = in_words(found, names);
  if (!beside.converged)
    found.sentence += fmt::format(" The draws with {} have not converged: {}.", found.held, beside.reason);
  return {found};
}

}  // namespace uq
