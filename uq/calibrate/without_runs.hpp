#pragma once
// A case without the runs that the others contradict (uq/emulate/outlying_runs.hpp): what it says then, and whether it
// says something else.
#include <optional>
#include <string>
#include <vector>

#include "uq/calibrate/calibrate.hpp"

namespace uq {

/// What was found of a parameter when the case was calibrated again.
ParameterAgain again(const ParameterReport& parameter);

/// The surrogates again without the runs that the others contradict; none where there are no such runs, or too few
/// others.
std::vector<FittedSurrogate> without_outlying(const data::Study& study, const data::RunTable& table,
                                              SurrogateOptions options, const std::vector<FittedSurrogate>& fitted);

/// The surrogates of all runs, and those of the others.
struct BothSurrogates {
  const std::vector<FittedSurrogate>& all;
  const std::vector<FittedSurrogate>& others;  ///< none where no run is contradicted
};

/// The case with the surrogates of the other runs, where it rests on runs that they contradict.
std::optional<WithoutRuns> without_runs(const data::Study& study, const BothSurrogates& surrogates,
                                        const SampledCase& sampled, std::size_t case_index,
                                        const CalibrateOptions& options);

/// Whether a parameter has another value or another width without the runs.
bool depends_on_runs(const SampledCase& sampled, const WithoutRuns& without);

}  // namespace uq
