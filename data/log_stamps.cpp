#include "data/log_stamps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "data/error.hpp"
#include "data/log_columns.hpp"
#include "data/number_text.hpp"
#include "data/time_text.hpp"

namespace data {
namespace {

/// The column of dates beside one of times of day.
std::optional<std::size_t> find_dates(const Csv& csv, std::size_t times, const CsvRow& first) {
  for (std::size_t i = 0; i < csv.columns.size(); ++i) {
    const std::string name = lower_case(csv.columns[i]);
    if (i == times || (name != "date" && name != "datum")) continue;
    const auto both = read_time(first.fields[i] + " " + first.fields[times]);
    if (both && both->dated && !read_time(first.fields[times])->dated) return i;
  }
  return {};
}

}  // namespace

Stamps read_stamps(const Csv& csv, std::size_t column, const LogColumn& wanted) {
  Stamps stamps;
  const auto first = std::find_if(csv.rows.begin(), csv.rows.end(),
                                  [&](const CsvRow& row) { return !is_missing(row.fields[column]); });
  stamps.clock = first != csv.rows.end() && read_time(first->fields[column]).has_value();
  stamps.assumed = !stamps.clock && wanted.unit.empty() && csv.units[column].empty();
  const Unit unit = stamps.clock ? parse_unit("s") : find_unit(csv, column, wanted, time_of_log);
  const std::optional<std::size_t> dates = stamps.clock ? find_dates(csv, column, *first) : std::nullopt;
  if (dates) stamps.took.push_back(fmt::format("days by the column '{}'", csv.headings[*dates]));
  const auto text_of = [&](const CsvRow& row) {
    return dates ? row.fields[*dates] + " " + row.fields[column] : row.fields[column];
  };
  DateOrder order = DateOrder::unknown;  // the day of 01/06/2024, as 31/05/2024 above or below shows it
  if (stamps.clock)
    for (const CsvRow& row : csv.rows)
      if (const auto time = read_time(text_of(row)); time && time->order != DateOrder::unknown) order = time->order;
  bool dated = false, either = false;
  for (const CsvRow& row : csv.rows) {
    const std::string& field = row.fields[column];
    if (is_missing(field)) {
      stamps.seconds.push_back(std::numeric_limits<double>::quiet_NaN());
    } else if (!stamps.clock) {
      stamps.seconds.push_back(unit.to_si(csv.number(row, column)));
    } else {
      const auto time = read_time(text_of(row), order);
      if (!time && dates)
        refuse_data(csv.place(row, *dates), fmt::format("'{}' is no date like those before", row.fields[*dates]),
                    "write every date alike");
      if (!time)
        refuse_data(csv.place(row, column), fmt::format("'{}' is no time like those before", field),
                    "write every time alike");
      if (time->two_parts)
        refuse_data(csv.place(row, column), fmt::format("'{}' may be hours and minutes, or minutes and seconds", field),
                    "write hours, minutes and seconds, or seconds alone");
      dated = dated || time->dated;
      either = either || time->day_or_month;
      stamps.seconds.push_back(time->seconds);
    }
  }
  if (stamps.clock) stamps.took.push_back(dated ? "dates and times" : "times of day");
  stamps.of_day = stamps.clock && !dated;
  if (dated && either)
    refuse_data(csv.place(*first, column), "has dates whose day and month cannot be told apart beside others",
                "write dates like 2024-05-31");
  return stamps;
}

}  // namespace data
