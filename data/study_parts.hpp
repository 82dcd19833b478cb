#pragma once
// The parts of read_study, one per section of the file. Problems are recorded in the sections.
#include <set>
#include <string>

#include "data/study.hpp"

namespace data {

/// Names of columns that the run table has beside parameters, controls and outputs.
const std::set<std::string>& reserved_columns();

void read_parameters(const Section& root, Study& study);
void read_controls(const Section& root, Study& study);
void read_outputs(const Section& root, Study& study);
void check_column_names(const Section& root, const Study& study);

/// A prior of `parameter` from an inline table; `cases` allows { posterior = "CASE" }.
enum class PriorOf { parameter, case_ };
Prior read_prior(const Section& section, const Parameter& parameter, PriorOf owner);

/// `{ NAME = VALUE }` for parameters, bare numbers in the parameter's unit, SI.
std::map<std::string, double> read_fixed(const Section& section, const Study& study);

void read_cases(const Section& root, Study& study);

}  // namespace data
