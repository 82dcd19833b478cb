#pragma once
// Times as loggers stamp them.
#include <optional>
#include <string_view>

namespace data {

/// A time of day, with or without a date: 14:02:00, 14:02:00.5, 14:02:00,5, 14:02:00:500, 2:02 PM, 2:02 p.m., 12:30.5
/// (minutes and seconds), 2024-05-03 14:02:00.5, 2024-05-03T14:02:00Z, 2024-05-03 14:02:00 UTC, 2024/05/03,
/// 03.05.2024 14:02:00, 03/05/2024 14:02, 3-May-2024 14:02, 20240503T140200.
struct ClockTime {
  double seconds = 0.0;  ///< since midnight; with a date, since 1 January 1970
  bool dated = false;
  bool day_or_month = false;  ///< a date like 03/05/2024, whose day may be either; left out of `seconds`
  bool two_parts = false;     ///< 14:02 without a date: hours and minutes, or minutes and seconds; read as the first
};
std::optional<ClockTime> read_time(std::string_view text);

}  // namespace data
