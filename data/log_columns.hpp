#pragma once
// Which columns of a table are a torque log's time, torque and speed, and in which units.
#include <cstddef>
#include <string>
#include <utility>

#include "data/csv.hpp"
#include "data/torque_log.hpp"

namespace data {

/// Headings like "Torque_Nm" of the three quantities are parted into name and unit.
void part_headings(Csv& csv, const LogColumns& columns);

/// The column of a quantity, by its name or, where there is none, by one of the other names. `option` is that of the
/// command line that names it. Throws InputError (65) where there is none, or more than one.
std::size_t find_column(const Csv& csv, const LogColumn& wanted, const std::string& option);

/// The unit of a column. `of` is a unit of its dimension, and the command line's option. Throws InputError (65).
Unit find_unit(const Csv& csv, std::size_t column, const LogColumn& wanted,
               const std::pair<std::string, std::string>& of);

/// A unit for messages: revolutions per second as rpm, and what UDUNITS-2 reads as a multiple of another unit in the
/// user's own words, "oz-in".
Unit shown_unit(const Unit& meant, const std::string& given);

/// The size of 1 in a column, in the unit that find_unit gave: Hz are shown in rpm.
double per_shown_unit(const Csv& csv, std::size_t column, const LogColumn& wanted);

}  // namespace data
