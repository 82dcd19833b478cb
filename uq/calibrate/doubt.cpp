#include "uq/calibrate/doubt.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "uq/posterior/support.hpp"

namespace uq {
namespace {

/// Why nothing can rest on a case, as a predicate.
std::string predicate_of(const Identification& found, const Doubt& doubt) {
  if (!doubt.unsupported.empty()) return "has no verdict itself: " + doubt.unsupported.front();
  if (!found.fits) return fmt::format("does not fit its data (p {:.2g})", found.check.best_fit_p);
  return "";
}

/// "the data contradict the prior of r by 4.2 standard deviations".
std::string contradicted(const CaseModel& model, const PriorConflict& conflict) {
  return fmt::format("the data contradict the prior of {} by {:.2g} standard deviations",
                     model.unknowns[static_cast<std::size_t>(conflict.unknown)].label, std::abs(conflict.z));
}

/// "mu comes from case glass, which does not fit its data"; empty where all sources can be rested on.
std::string doubtful_source(const CaseModel& model, const std::vector<JudgedSource>& sources) {
  for (const Unknown& unknown : model.unknowns)
    for (const JudgedSource& source : sources)
      if (unknown.cut_from == source.name && !source.doubt.empty())
        return fmt::format("{} comes from case {}, which {}", unknown.label, source.name, source.doubt);
  return "";
}

}  // namespace

std::vector<JudgedSource> judge_sources(const SampledCase& sampled, const IdentifyOptions& options) {
  std::vector<JudgedSource> judged;
  for (const auto& source : sampled.cut_sources) {
    const std::vector<JudgedSource> beyond = judge_sources(*source, options);
    const Doubt doubt = doubt_about(*source, beyond, options);
    IdentifyOptions own = options;
    own.unsupported = doubt.unsupported;
    JudgedSource one{
        .name = source->model->name, .found = identify(*source->model, source->draws.pooled(), own), .doubt = {}};
    take_cut_verdicts(one.found, *source, beyond);
    one.doubt = predicate_of(one.found, doubt);
    judged.push_back(std::move(one));
  }
  return judged;
}

Doubt doubt_about(const SampledCase& sampled, const std::vector<JudgedSource>& sources,
                  const IdentifyOptions& options) {
  const CaseModel& model = *sampled.model;
  Doubt found{.of = DoubtOf::nothing, .unsupported = options.unsupported, .conflicts = {}};
  if (sampled.draws.converged)
    found.conflicts = prior_conflicts(model, sampled.draws.pooled(), options.thresholds.prior_conflict_sd);
  if (found.unsupported.empty()) found.unsupported = unsupported_parameters(model, sampled.support);
  if (!found.unsupported.empty()) {
    const bool unusable = !doubt_of(model).empty();
    found.of = unusable ? DoubtOf::surrogate : sampled.support.supported ? DoubtOf::runs : DoubtOf::support;
    return found;
  }
  std::string reason;
  if (!sampled.draws.converged) {
    found.of = DoubtOf::draws;
    reason = "the sampler has not converged";
  } else if (reason = doubtful_source(model, sources); !reason.empty()) {
    found.of = DoubtOf::source;
  } else if (!found.conflicts.empty()) {
    found.of = DoubtOf::prior;
    reason = contradicted(model, found.conflicts.front());
  }
  if (found.of != DoubtOf::nothing) found.unsupported.assign(static_cast<std::size_t>(model.own_count()), reason);
  return found;
}

void take_cut_verdicts(Identification& found, const SampledCase& sampled, const std::vector<JudgedSource>& sources) {
  for (const JudgedSource& source : sources)
    for (std::size_t k = 0; k < found.parameters.size(); ++k) {
      if (sampled.model->unknowns[k].cut_from != source.name) continue;
      for (const ParameterReport& known : source.found.parameters)
        if (known.name == found.parameters[k].name) {
          found.parameters[k] = known;
          found.parameters[k].sentence += fmt::format(
              " This is the posterior of case {}, cut: the data of this case do not change it.", source.name);
        }
    }
}

}  // namespace uq
