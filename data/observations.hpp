#pragma once
// Measured points from a CSV: one column per control, one per output, and OUTPUT_se beside each, in the study's units.
// Other columns are left alone. A field of an output may be empty where the row has another output's value: that output
// was not measured there (Observation::has).
#include <array>
#include <map>
#include <string>
#include <string_view>

#include "data/study.hpp"

namespace data {

/// The words in the head of a file of observations before what a study must state: the error of an idle torque, which
/// is common to all rows.
inline constexpr std::string_view idle_error_mark = "its error is common to all of them: ";

/// Columns that demcal observe writes beside control, output and errors, and CONTROL_sd.
inline constexpr std::array<std::string_view, 4> columns_of_observe = {"idle", "from_s", "seconds", "independent"};

/// Indices into set.points of the points at which the output of this column (an index into set.outputs) was measured.
std::vector<std::size_t> points_with(const ObservationSet& set, std::size_t column);

/// Points of two sets at the same settings, each point once, the nearest first and then in the order of the files.
/// Settings are the same where every control differs by at most same_setting of its range: those of two instruments, or
/// of speeds as they were measured, never agree to the last digit.
inline constexpr double same_setting = 0.005;
std::vector<std::pair<std::size_t, std::size_t>> points_at_same_settings(const Study& study, const ObservationSet& set,
                                                                         const ObservationSet& other);

/// Whether a file may lack the column OUTPUT_se of an output: its standard errors are NaN then, and copies are left in.
enum class MissingErrors { refused, nan };

/// Reads the points of `path`; `settings` (SI) gives the controls of which it has no column. Name, material and place
/// are the caller's. Throws InputError: 66 missing; 65 missing column, no rows, a row without any output, text or
/// nothing for a number, a standard error that is not above 0.
ObservationSet read_observations(const std::string& path, const Study& study,
                                 const std::map<std::string, double>& settings = {},
                                 MissingErrors missing = MissingErrors::refused);

/// Takes rows that copy each other out of the points and notes them.
void count_copies_once(ObservationSet& set, const Study& study);

/// The noise that stands in the place of an output's standard errors (NuisanceKind::noise_sd), where every case and
/// prediction that reads the set has such a noise; else nullptr.
const Nuisance* noise_instead(const Study& study, const ObservationSet& set, std::size_t output);

}  // namespace data
