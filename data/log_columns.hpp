#pragma once
// Which columns of a table are a torque log's time, torque and speed, and in which units.
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "data/csv.hpp"
#include "data/torque_log.hpp"

namespace data {

/// Headings like "Torque_Nm" of the three quantities are parted into name and unit.
void part_headings(Csv& csv, const LogColumns& columns);

/// What a column of a log measures.
struct LogQuantity {
  std::string_view option;     ///< of the command line, which names its column
  std::string_view dimension;  ///< a unit of it
  std::string_view word;
};
inline constexpr LogQuantity time_of_log{"time", "s", "time"}, torque_of_log{"torque", "N m", "torque"},
    speed_of_log{"rpm", "rpm", "speed"};

/// The column of a quantity: by its name; where there is none, by one of the other names; where there is none either,
/// by its unit, or of the time by a clock's times, if one column alone has such (`took` says so then). A column that
/// the command line names is found by that name alone. Throws InputError (65) where there is none, or more than one.
std::size_t find_column(const Csv& csv, const LogColumn& wanted, const LogQuantity& quantity,
                        std::vector<std::string>& took);

/// Whether find_column would find one column or more.
bool may_be_column(const Csv& csv, const LogColumn& wanted, const LogQuantity& quantity);

/// Takes a unit that stands behind every number of a column, "0.1 sec", to its heading, where that has none.
void take_unit_of_cells(Csv& csv, std::size_t column, const LogColumn& wanted, const LogQuantity& quantity,
                        std::vector<std::string>& took);

/// The unit of a column. Throws InputError (65).
Unit find_unit(const Csv& csv, std::size_t column, const LogColumn& wanted, const LogQuantity& quantity);

/// A unit for messages: revolutions per second as rpm, and what UDUNITS-2 reads as a multiple of another unit in the
/// user's own words, "oz-in".
Unit shown_unit(const Unit& meant, const std::string& given);

/// The size of 1 in a column, in the unit that find_unit gave: Hz are shown in rpm.
double per_shown_unit(const Csv& csv, std::size_t column, const LogColumn& wanted);

}  // namespace data
