#pragma once
// The words of a case whose verdicts are not the whole finding: nothing can carry them, the model does not fit, or one
// reading decides all. Each function changes the words that uq/verdict has made of the verdicts.
#include <string>

#include "data/study.hpp"
#include "uq/calibrate/misfit.hpp"
#include "uq/findings/results.hpp"
#include "uq/verdict/contradiction.hpp"
#include "uq/verdict/identifiability.hpp"
#include "uq/verdict/outlying_reading.hpp"
#include "uq/verdict/verdict.hpp"
#include "uq/verdict/verdict_words.hpp"

namespace uq {

/// What it is that cannot carry a verdict.
enum class DoubtOf { nothing, surrogate, support, draws, runs };

/// Where the runs or the draws cannot carry a verdict, that is the finding, and what is printed beside it is no result.
void say_doubt(CaseReport& report, DoubtOf of, Words& words, const data::Study& study);

/// A fit that is not refused, and that data of the model's own would seldom give.
void say_poor_fit(Words& words, const FitCheck& check);

/// Where a model that does not fit is farthest off, which sets contradict each other, and units that would explain it.
void say_misfit(Words& words, const CaseReport& report, const data::Study& study, const CaseModel& model,
                const Identification& found, const VerdictThresholds& thresholds);

/// The one reading that contradicts all others, which fit without it.
void say_lone_reading(CaseReport& report, Words& words, const data::Study& study, const LoneReading& lone);

/// The one reading that widens the errors where their size is unknown. What it widens is no finding.
void say_outlying_reading(Words& words, const data::Study& study, const OutlyingReading& one);
/// The same as a warning.
std::string outlying_warning(const std::string& name, const data::Study& study, const OutlyingReading& one);

}  // namespace uq
