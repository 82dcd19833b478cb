#pragma once
// The words of a case whose verdicts are not the whole finding: nothing can carry them, the model does not fit, or one
// reading decides all. Each function changes the words that uq/verdict has made of the verdicts.
#include <string>

#include "data/study.hpp"
#include "uq/calibrate/doubt.hpp"
#include "uq/calibrate/misfit.hpp"
#include "uq/findings/case_results.hpp"
#include "uq/verdict/contradiction.hpp"
#include "uq/verdict/identifiability.hpp"
#include "uq/verdict/lack_of_fit.hpp"
#include "uq/verdict/outlying_reading.hpp"
#include "uq/verdict/verdict.hpp"
#include "uq/verdict/verdict_words.hpp"

namespace uq {

/// Makes it the finding that the runs, the draws or the case's source cannot carry a verdict; what is printed beside it
/// is then no result.
void say_doubt(CaseReport& report, DoubtOf of, Words& words, const data::Study& study);

/// Words for a fit that is not refused, but which data drawn from the model itself would seldom give.
void say_poor_fit(Words& words, const FitCheck& check);

/// Words for readings that lie closer to the model than their stated errors let expect: the errors are stated too
/// large, or are shared. Values stay, with intervals wider than need be.
void say_close_fit(Words& words, const FitCheck& check);

/// Words for a model that does not fit: where it is farthest off, which sets contradict each other, and units that
/// would explain it.
void say_misfit(Words& words, const CaseReport& report, const data::Study& study, const CaseModel& model,
                const Identification& found, const VerdictThresholds& thresholds);

/// Words for the one reading that contradicts all others, which fit without it.
void say_lone_reading(CaseReport& report, Words& words, const data::Study& study, const LoneReading& lone);

/// Words for the one reading that widens the errors where their size is unknown. A verdict that this widening spoils is
/// no finding.
void say_outlying_reading(Words& words, const data::Study& study, const OutlyingReading& one);
/// The outlying reading as a warning.
std::string outlying_warning(const std::string& name, const data::Study& study, const OutlyingReading& one);

/// Words for settings whose means lie farther from the model than their readings let expect, where the errors' size is
/// unknown.
void say_lack_of_fit(Words& words, const LackOfFit& lack);
/// The same as a warning.
std::string lack_of_fit_warning(const std::string& name, const LackOfFit& lack);

}  // namespace uq
