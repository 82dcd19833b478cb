#include "uq/verdict/case_facts.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>

#include "uq/findings/study_units.hpp"

namespace uq {

void add_name(Names& names, const std::string& name) {
  if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
}

SortedParameters sort_parameters(const std::vector<ParameterReport>& parameters) {
  SortedParameters sorted;
  for (const ParameterReport& parameter : parameters) {
    const std::optional<Reason>& reason = parameter.reason;
    const std::string& name = parameter.name;
    if (parameter.verdict == Verdict::identified) sorted.known.push_back(name);
    if (parameter.verdict == Verdict::several_values) sorted.several.push_back(name);
    if (parameter.verdict == Verdict::weakly_identified) sorted.weak.push_back(name);
    if (reason.has_value() && *reason == Reason::no_influence) {
      sorted.silent.push_back(name);
      continue;
    }
    if (parameter.verdict == Verdict::not_identified) sorted.unknown.push_back(name);
    if (!reason) continue;
    (*reason == Reason::structural         ? sorted.structural
     : *reason == Reason::common_error     ? sorted.common
     : *reason == Reason::practical        ? sorted.practical
     : *reason == Reason::surrogate        ? sorted.surrogate
     : *reason == Reason::traded           ? sorted.traded
     : *reason == Reason::one_sided        ? sorted.one_sided
     : *reason == Reason::range_of_another ? sorted.conditional
     : *reason == Reason::unsupported      ? sorted.beyond_runs
                                           : sorted.bound)
        .push_back(name);
    for (const auto& [end, side] : {std::pair{parameter.runs_end_low, "below"}, {parameter.runs_end_high, "above"}})
      if (end)
        sorted.wanted_runs.push_back(
            fmt::format("with {} {} {:.3g}{}", name, side, *end, behind_number(parameter.unit)));
    if (*reason == Reason::range_of_another)
      add_name(sorted.ends_of, parameter.high_pinned_by.empty() ? parameter.low_pinned_by : parameter.high_pinned_by);
    sorted.of_structure += parameter.shares.structure;
    (*reason == Reason::common_error ? sorted.of_common : sorted.of_measurement) += parameter.shares.measurement;
    const bool held = *reason == Reason::common_error || *reason == Reason::practical || *reason == Reason::bound;
    if (held && parameter.common.share > sorted.largest_common.share) sorted.largest_common = parameter.common;
    sorted.of_surrogate += parameter.shares.surrogate;
    sorted.largest_surrogate = std::max(sorted.largest_surrogate, parameter.shares.surrogate);
    sorted.of_range += parameter.shares.range;
  }
  return sorted;
}

}  // namespace uq
