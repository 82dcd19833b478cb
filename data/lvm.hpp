#pragma once
// LabVIEW Measurement Files (.lvm), as National Instruments' "Specification for the LabVIEW Measurement File" has them:
// a header of the file, then segments, each with a header of its own, a line of names and the samples.
//
//   time     X_Value, s; where X_Columns is "No", X0 + i Delta_X; several segments are put on the clock of the first
//            one, by their Date and Time
//   units    Y_Unit_Label, where it is a unit; a unit in a channel's name counts before it
//   left out the column Comment, special blocks
#include <string>
#include <string_view>
#include <vector>

#include "data/csv.hpp"

namespace data {

/// Whether a text begins like such a file.
bool is_lvm(std::string_view text);

/// Headings, units, rows and `took` of the segments together. The column of times comes first and is called "X_Value".
/// It is missing where nothing says the times; then `no_time` says why. Throws InputError (65): segments of other
/// channels or units; channels sampled at different times; a header or a row that is cut off.
Csv read_lvm(std::string_view text, const std::string& file);

}  // namespace data
