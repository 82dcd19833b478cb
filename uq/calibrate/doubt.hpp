#pragma once
// What keeps a case from carrying a verdict: its surrogates, its runs, its draws, a prior that the data contradict, or
// a case whose posterior it takes without feedback. Such a posterior is believed as it comes, so that what is wrong
// with its case is wrong with this one too.
#include <string>
#include <vector>

#include "uq/calibrate/calibrate.hpp"
#include "uq/posterior/prior_conflict.hpp"
#include "uq/verdict/identifiability.hpp"

namespace uq {

/// The part of the case that cannot carry a verdict.
enum class DoubtOf { nothing, surrogate, support, draws, runs, source, prior };

struct Doubt {
  DoubtOf of = DoubtOf::nothing;
  std::vector<std::string> unsupported;  ///< the reason for each parameter in words, as IdentifyOptions has it
  std::vector<PriorConflict>
      conflicts;  ///< of priors and data, whatever the doubt is of; none of draws that have not converged
};

/// A case from which others are cut.
struct JudgedSource {
  std::string name;
  Identification found;
  std::string doubt;  ///< why nothing can rest on it, as a predicate: "does not fit its data"; empty: something can
};

/// The cases from which a case takes posteriors, each judged with its own sources.
std::vector<JudgedSource> judge_sources(const SampledCase& sampled, const IdentifyOptions& options);

/// The doubt about a case. `options.unsupported`: reasons known before the case was sampled.
Doubt doubt_about(const SampledCase& sampled, const std::vector<JudgedSource>& sources, const IdentifyOptions& options);

/// Takes the verdicts on cut parameters from their own cases.
void take_cut_verdicts(Identification& found, const SampledCase& sampled, const std::vector<JudgedSource>& sources);

}  // namespace uq
