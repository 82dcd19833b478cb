#pragma once
// Times as loggers stamp them.
#include <optional>
#include <string_view>

namespace data {

/// Which number comes first in dates like 03/05/2024.
enum class DateOrder { unknown, day_first, month_first };

/// A time of day, with or without a date: 14:02:00, 14:02:00.5, 14:02:00,5, 14:02:00:500, 2:02 PM, 2:02 p.m., 12:30.5
/// (minutes and seconds), 2024-05-03 14:02:00.5, 2024-05-03T14:02:00Z, 2024-05-03 14:02:00 UTC, 2024/05/03,
/// 03.05.2024 14:02:00, 03/05/2024 14:02, 3-May-2024 14:02, 20240503T140200.
struct ClockTime {
  double seconds = 0.0;  ///< since midnight; with a date, since 1 January 1970
  bool dated = false;
  bool day_or_month = false;             ///< a date like 03/05/2024, whose day may be either; left out of `seconds`
  DateOrder order = DateOrder::unknown;  ///< the order that a date like 31/05/2024 or 05/31/2024 shows
  bool two_parts = false;  ///< 14:02 without a date: hours and minutes, or minutes and seconds; read as the first
};
/// Reads a stamp. `order`: the order of dates like 03/05/2024, where other dates beside it show one.
std::optional<ClockTime> read_time(std::string_view text, DateOrder order = DateOrder::unknown);

}  // namespace data
