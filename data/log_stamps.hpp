#pragma once
// What a log's clock stamped on its rows, as seconds.
#include <string>
#include <vector>

#include "data/csv.hpp"
#include "data/torque_log.hpp"

namespace data {

/// The stamps of all rows, s; NaN where there is none.
struct Stamps {
  std::vector<double> seconds;
  bool clock = false;    ///< times of day, with or without a date
  bool of_day = false;   ///< without
  bool assumed = false;  ///< numbers whose unit nothing states
  std::vector<std::string> took;
};

/// Reads a column of stamps: numbers in a unit, times of day or dates with times, with the days of a column of dates
/// beside it. Throws InputError (65) where they are not all alike, or can be read in two ways.
Stamps read_stamps(const Csv& csv, std::size_t column, const LogColumn& wanted);

}  // namespace data
