#pragma once
// The parts of read_study, one per section of the file. Problems are recorded in the sections.
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "data/study.hpp"

namespace data {

/// Names of columns that the run table has beside parameters, controls and outputs.
const std::set<std::string>& reserved_columns();

/// The unit of a bare number; none for a dimensionless quantity.
const Unit* bare_unit(const Unit& unit);

void read_parameters(const Section& root, Study& study);
void read_controls(const Section& root, Study& study);
void read_outputs(const Section& root, Study& study);
void check_column_names(const Section& root, const Study& study);

/// Whose prior a table states. That of a case may be { posterior = "CASE" }, too.
enum class PriorOf { parameter, case_ };
/// A prior of `parameter` from an inline table.
Prior read_prior(const Section& section, const Parameter& parameter, PriorOf owner);

/// `{ NAME = VALUE }` for parameters, bare numbers in the parameter's unit, SI.
std::map<std::string, double> read_fixed(const Section& section, const Study& study);

/// Reads [rig] scale. The functions below read what is known of the meter and the settings of an [[observe]]
/// (study_measurement.cpp).
void read_rig_scale(const Section& root, Study& study);
/// What a number without a unit is.
enum class BareNumber { share, value };
/// Reads "2 %", or a value with its unit; `section_unit` is the unit of a bare number.
Spread read_spread(const Section& section, std::string_view key, const Unit& unit, BareNumber bare,
                   const Unit* section_unit = nullptr);
std::optional<SettingError> read_uncertainty(const Section& section, std::string_view key, const Control& control,
                                             const Unit* section_unit);
void read_measurement(const Section& root, const Section& section, const Study& study, ObservationSet& set);
/// Reads [[observe.correlation]] of every set, once all sets are there.
void read_correlations(const Section& root, Study& study);
/// Reads the values of controls of which an observation file has no column: settings = { fill = 2400 }.
std::map<std::string, double> read_settings(const Section& section, const Study& study);
/// Reads offset, gain, noise and discrepancy of a case.
std::vector<Nuisance> read_nuisances(const Section& section, const Study& study);

/// The material that an [[observe]], or a case without one, is about: the key `material`, or the study's only one.
std::string material_of(const Section& section, const Study& study);

void read_cases(const Section& root, Study& study);
void read_unused_data(const Section& root, Study& study);

}  // namespace data
