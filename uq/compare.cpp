// Bayes factors between a case and itself with some parameters held.
//
// Words by R. E. Kass, A. E. Raftery, "Bayes factors", J. Am. Stat. Assoc. 90 (1995) 773, section 3.2: 2 ln B below 2
// is not worth more than a bare mention, 2 to 6 positive, 6 to 10 strong, above 10 very strong.
#include <fmt/format.h>

#include <cmath>

#include "uq/calibrate.hpp"

namespace uq {
namespace {

const char* strength(double log_bayes_factor) {
  const double twice = 2.0 * std::abs(log_bayes_factor);
  return twice < 6.0 ? "positive" : twice < 10.0 ? "strong" : "very strong";
}

std::string in_words(const ModelComparison& found, const std::string& names) {
  const std::string number = fmt::format("ln Bayes factor {:.1f} +- {:.1g}", found.log_bayes_factor, found.error);
  constexpr const char* caveat = "a wider prior range of what is held would lower it";
  if (std::abs(found.log_bayes_factor) < 1.0 + found.error)
    return fmt::format("The data do not decide between {} and {} free ({}; {}).", found.held, names, number, caveat);
  const bool free = found.log_bayes_factor > 0.0;
  return fmt::format("The data favour {} over {}: {} evidence ({}; {}).", free ? names + " free" : found.held,
                     free ? found.held : names + " free", strength(found.log_bayes_factor), number, caveat);
}

}  // namespace

std::vector<ModelComparison> compare_models(const data::Study& study, const std::vector<Emulator>& emulators,
                                            const SampledCase& sampled, std::size_t case_index,
                                            const CalibrateOptions& options) {
  const data::CalibrationCase& item = study.cases.at(case_index);
  if (item.held.empty() || std::isnan(sampled.draws.log_evidence) || sampled.draws.chains.empty()) return {};
  data::Study smaller = study;
  data::CalibrationCase& held = smaller.cases[case_index];
  ModelComparison found;
  std::string names;
  for (const auto& [name, value] : item.held) {
    std::erase(held.free, name);
    held.priors.erase(name);
    held.fixed[name] = value;
    const data::Unit& unit = study.parameters[*study.parameter_index(name)].unit;
    found.held += fmt::format("{}{} = {:.4g}{}{}", found.held.empty() ? "" : ", ", name, unit.from_si(value),
                              unit.symbol.empty() ? "" : " ", unit.symbol);
    names += (names.empty() ? "" : " and ") + name;
  }
  const SampledCase beside = sample_case(smaller, emulators, case_index, options);
  if (beside.draws.chains.empty()) return {};
  found.log_bayes_factor = sampled.draws.log_evidence - beside.draws.log_evidence;
  found.error = std::hypot(sampled.draws.log_evidence_error, beside.draws.log_evidence_error);
  found.sentence = in_words(found, names);
  return {found};
}

}  // namespace uq
