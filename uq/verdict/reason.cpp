#include "uq/verdict/reason.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <vector>

#include "uq/findings/listed.hpp"
#include "uq/findings/thresholds.hpp"

namespace uq {
namespace {

/// "the offset zero".
std::string in_words(const CommonError& error) {
  switch (error.kind) {
    case CommonErrorKind::offset:
      return "the offset " + error.name;
    case CommonErrorKind::gain:
      return "the gain " + error.name;
    case CommonErrorKind::scale:
      return "the rig's scale";
    case CommonErrorKind::setting:
      return "the true " + (error.name.empty() ? "settings" : error.name);
    case CommonErrorKind::meter:
      return "the meter's common error";
    case CommonErrorKind::discrepancy:
      break;
  }
  return "the discrepancy";
}

/// Whether the posterior ends well inside the range on the side that the data leave open: a stated prior ends it there,
/// and not the range.
bool ended_by_prior(const ParameterEvidence& evidence) {
  const double room = evidence.facts.open_high ? evidence.found.prior_high - evidence.found.mean
                                               : evidence.found.mean - evidence.found.prior_low;
  return room > ended_by_prior_sds * evidence.found.sd;
}

}  // namespace

std::optional<Reason> find_reason(const ParameterEvidence& evidence, Verdict verdict) {
  if (verdict != Verdict::not_identified && verdict != Verdict::weakly_identified) return {};
  const WordFacts& facts = evidence.facts;
  if (!facts.influences)
    return evidence.hidden                    ? Reason::practical
           : evidence.silent_sds > hiding_sds ? Reason::surrogate
                                              : Reason::no_influence;
  if (evidence.found.runs_end_low || evidence.found.runs_end_high) return Reason::unsupported;
  if (evidence.found.common.share > mostly_share && evidence.surrogate_share <= mostly_share)
    return Reason::common_error;
  if (evidence.structural) return Reason::structural;
  if (!evidence.conditional_on.empty()) return Reason::range_of_another;
  const bool pinned = !evidence.found.low_pinned_by.empty() || !evidence.found.high_pinned_by.empty();
  // The end of one's range where a combination alone is known is no limit that better data of the same kind would move.
  const bool half_open = facts.open_low != facts.open_high && !pinned;
  if (evidence.traded && verdict == Verdict::not_identified && (half_open || evidence.unknown_beyond) &&
      evidence.surrogate_share <= mostly_share)
    return Reason::traded;
  if ((evidence.unknown_beyond || evidence.faint) && evidence.runs_could_tell) return Reason::surrogate;
  if (facts.open_low && !facts.open_high && facts.physical_low) return Reason::bound;
  if (half_open && !ended_by_prior(evidence)) return Reason::one_sided;
  if (evidence.surrogate_share > mostly_share) return Reason::surrogate;
  if (evidence.undecided) return Reason::traded;
  return Reason::practical;
}

std::string because(Reason reason, const ParameterEvidence& evidence) {
  switch (reason) {
    case Reason::structural:
      return "; other parameters do the same to all that was measured, so that a better measurement of the same kind "
             "would not help";
    case Reason::practical:
      return "; the measurement's noise hides it";
    case Reason::common_error: {
      std::vector<std::string> names;
      for (const CommonError& error : evidence.found.common.errors) names.push_back(in_words(error));
      return fmt::format("; {}, which repeated readings share, {} it", listed(names),
                         names.size() == 1 ? "hides" : "hide");
    }
    case Reason::surrogate:
      if (!evidence.facts.influences)
        return fmt::format(
            ": the data say nothing of it. The runs show no effect of its range; the surrogate could miss one of "
            "{:.1f} measurement errors",
            evidence.silent_sds);
      return "; the surrogate's error hides it";
    case Reason::traded:
      return "; other parameters do much the same to all that was measured";
    case Reason::range_of_another:
      return fmt::format("; its value depends on where the range of {} ends, which the data would go beyond",
                         evidence.conditional_on);
    case Reason::one_sided:
    case Reason::bound:
    case Reason::unsupported:  // its sentence says why by itself
      return "";
    case Reason::no_influence:
      break;
  }
  return ": the data say nothing of it. Its whole range changes nothing that was measured, as far as the surrogate and the "
         "measurement can tell";
}

WidthShares find_shares(const ParameterEvidence& evidence, std::optional<Reason> reason) {
  const double surrogate = std::clamp(evidence.surrogate_share, 0.0, 1.0);
  if (reason == Reason::structural) return {.measurement = 0.0, .surrogate = 0.0, .structure = 1.0, .range = 0.0};
  if (reason == Reason::one_sided || reason == Reason::range_of_another || reason == Reason::unsupported)
    return {.measurement = 0.0, .surrogate = 0.0, .structure = 0.0, .range = 1.0};
  if (reason == Reason::surrogate && (evidence.unknown_beyond || evidence.faint || !evidence.facts.influences))
    return {.measurement = 0.0, .surrogate = 1.0, .structure = 0.0, .range = 0.0};
  if (reason == Reason::no_influence) return {.measurement = 0.0, .surrogate = 0.0, .structure = 0.0, .range = 1.0};
  return {.measurement = 1.0 - surrogate, .surrogate = surrogate, .structure = 0.0, .range = 0.0};
}

}  // namespace uq
