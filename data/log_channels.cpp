#include "data/log_channels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <set>
#include <string_view>

#include "data/log_columns.hpp"
#include "data/log_stamps.hpp"
#include "data/log_times.hpp"
#include "data/number_text.hpp"
#include "data/unit_text.hpp"

namespace data {
namespace {

bool is_called(const std::string& heading, std::initializer_list<std::string_view> names) {
  std::string plain = lower_case(heading);
  std::erase_if(plain, [](char c) { return c == ' ' || c == '_' || c == '-'; });
  return std::find(names.begin(), names.end(), plain) != names.end();
}

bool names_values(const std::string& heading) {
  return is_called(heading, {"value", "varvalue", "val", "vvalue", "wert", "messwert", "istwert", "valeur", "valor",
                             "valore", "reading", "numericvalue", "datavalue", "tagvalue"});
}

bool names_channels(const std::string& heading) {
  return is_called(heading, {"varname",  "variable", "variablename", "tag",         "tagname",   "channel",
                             "signal",   "name",     "channelname",  "signalname",  "field",     "sensor",
                             "sensorid", "metric",   "point",        "pointname",   "topic",     "item",
                             "itemid",   "series",   "parameter",    "quantity",    "node",      "nodeid",
                             "kanal",    "kennung",  "bezeichnung",  "displayname", "sensorname"});
}

bool names_units(const std::string& heading) {
  return is_called(heading, {"unit", "units", "uom", "eu", "engunits", "einheit", "unite", "unidad"});
}

/// WinCC's Time_ms counts the days of a spreadsheet, in millionths, and no milliseconds: its TimeString is the time.
bool is_time_of_wincc(const Csv& csv, std::size_t column) {
  return csv.headings[column] == "Time_ms" && csv.find("TimeString");
}

/// The different texts of a column in the order of their first row; none where a field is a number.
std::vector<std::string> names_in(const Csv& csv, std::size_t column) {
  std::vector<std::string> names;
  std::set<std::string> seen;
  for (const CsvRow& row : csv.rows) {
    const std::string& field = row.fields[column];
    if (is_missing(field)) continue;
    if (plain_number(field, DecimalMark::point)) return {};
    if (seen.insert(field).second) names.push_back(field);
  }
  return names;
}

/// "Torque" of "Line 1\Mixer.Torque" and of "ns=2;s=Mixer.Torque".
std::string last_part(const std::string& channel) {
  const auto mark = channel.find_last_of("./\\:|=!");
  return mark == std::string::npos || mark + 1 == channel.size() ? channel : channel.substr(mark + 1);
}

/// What a channel's rows say of its unit, where all say the same.
std::string unit_of(const Csv& csv, const std::vector<std::size_t>& rows, std::optional<std::size_t> units) {
  if (!units || rows.empty()) return "";
  const std::string& unit = csv.rows[rows.front()].fields[*units];
  const bool same =
      std::all_of(rows.begin(), rows.end(), [&](std::size_t row) { return csv.rows[row].fields[*units] == unit; });
  return same && !is_missing(unit) ? unit : "";
}

/// A channel by its name, "Mixer.Torque [N m]".
struct Channel {
  std::string name;
  std::vector<std::size_t> rows;  ///< in the order of time
};

/// The channels; those of a clock without dates go on past midnight, each for itself, as one may follow the other.
std::vector<Channel> channels_of(const Csv& csv, std::size_t column, Stamps& stamps) {
  std::vector<Channel> channels;
  for (std::string& name : names_in(csv, column)) channels.push_back({.name = std::move(name), .rows = {}});
  for (Channel& channel : channels) {
    std::vector<double> seconds;
    for (std::size_t i = 0; i < csv.rows.size(); ++i) {
      if (csv.rows[i].fields[column] != channel.name || !std::isfinite(stamps.seconds[i])) continue;
      channel.rows.push_back(i);
      seconds.push_back(stamps.seconds[i]);
    }
    if (stamps.of_day) pass_midnight(seconds, true);
    for (std::size_t k = 0; k < seconds.size(); ++k) stamps.seconds[channel.rows[k]] = seconds[k];
    std::stable_sort(channel.rows.begin(), channel.rows.end(),
                     [&](std::size_t a, std::size_t b) { return stamps.seconds[a] < stamps.seconds[b]; });
  }
  return channels;
}

/// "3 rows without a time left out, the first in line 7"; nothing where all have one.
std::string rows_without_time(const Csv& csv, const Stamps& stamps) {
  std::size_t count = 0, first = 0;
  for (std::size_t i = csv.rows.size(); i-- > 0;) {
    if (std::isfinite(stamps.seconds[i])) continue;
    ++count;
    first = csv.rows[i].line;
  }
  if (count == 0) return "";
  return fmt::format("{} without a time left out, the first in line {}",
                     count == 1 ? "1 row" : fmt::format("{} rows", count), first);
}

constexpr std::size_t none = static_cast<std::size_t>(-1);

/// For each row of the torque the row of another channel that was written last; `none` before its first. Rows are in
/// the order of time. Channels with the same stamps were read together, one value beside the other. Else, where several
/// values of the torque share a stamp and all lines are in the order of time, the lines say what was written before.
std::vector<std::size_t> last_written(const std::vector<std::size_t>& of, const std::vector<std::size_t>& torque,
                                      const std::vector<double>& seconds) {
  const auto same = [&](std::size_t a, std::size_t b) { return seconds[a] == seconds[b]; };
  if (std::equal(of.begin(), of.end(), torque.begin(), torque.end(), same)) return of;
  const bool by_line = std::is_sorted(seconds.begin(), seconds.end()) &&
                       std::adjacent_find(torque.begin(), torque.end(), same) != torque.end();
  std::vector<std::size_t> last;
  std::size_t next = 0;
  for (const std::size_t row : torque) {
    const auto before = [&](std::size_t other) {
      return seconds[other] < seconds[row] || (same(other, row) && (!by_line || other < row));
    };
    while (next < of.size() && before(of[next])) ++next;
    last.push_back(next > 0 ? of[next - 1] : none);
  }
  return last;
}

/// When each row was written: by its stamp, or where stamps are not used by its place.
Stamps stamps_of_rows(const Csv& csv, const LogColumns& columns) {
  if (!columns.rate) {
    std::vector<std::string> said_later;
    const auto wincc = csv.find("TimeString");
    return read_stamps(csv, wincc ? *wincc : find_column(csv, columns.time, time_of_log, said_later), columns.time);
  }
  Stamps places{.seconds = std::vector<double>(csv.rows.size()), .took = {}};
  std::iota(places.seconds.begin(), places.seconds.end(), 0.0);
  return places;
}

/// The columns of the new table: those that are not of channel, value and unit, and one for each channel.
Csv headings_of(const Csv& csv, const std::vector<std::size_t>& kept, const std::vector<Channel>& channels) {
  Csv wide{.file = csv.file, .header_line = csv.header_line, .no_time = csv.no_time, .took = csv.took};
  for (const std::size_t i : kept) {
    wide.columns.push_back(csv.columns[i]);
    wide.headings.push_back(csv.headings[i]);
    wide.units.push_back(csv.units[i]);
  }
  std::optional<std::size_t> units;
  for (std::size_t i = 0; i < csv.columns.size(); ++i)
    if (names_units(csv.headings[i])) units = i;
  for (const Channel& channel : channels) {
    const Heading heading = read_heading(channel.name);
    const std::string last = lower_case(last_part(heading.name));
    const auto ends_so = [&](const Channel& other) {
      return lower_case(last_part(read_heading(other.name).name)) == last;
    };
    const bool alone = std::count_if(channels.begin(), channels.end(), ends_so) == 1;
    wide.columns.push_back(alone ? last_part(heading.name) : heading.name);
    wide.headings.push_back(channel.name);
    wide.units.push_back(heading.unit.empty() ? unit_of(csv, channel.rows, units) : heading.unit);
  }
  return wide;
}

}  // namespace

std::optional<ChannelColumns> find_channels(const Csv& csv, const LogColumns& columns) {
  if (may_be_column(csv, columns.torque, torque_of_log)) return {};
  std::vector<std::size_t> values;
  std::optional<std::size_t> channel;
  std::size_t most = 0;
  for (std::size_t i = 0; i < csv.columns.size(); ++i) {
    if (names_values(csv.headings[i])) values.push_back(i);
    if (!names_channels(csv.headings[i])) continue;
    const std::size_t names = names_in(csv, i).size();
    if (names > most && 2 * names <= csv.rows.size()) {
      most = names;
      channel = i;
    }
  }
  if (values.size() != 1 || !channel) return {};
  return ChannelColumns{*channel, values.front()};
}

Csv with_channels_as_columns(const Csv& csv, const ChannelColumns& at, const LogColumns& columns,
                             std::vector<std::string>& took) {
  Stamps stamps = stamps_of_rows(csv, columns);
  const std::vector<Channel> channels = channels_of(csv, at.channel, stamps);
  const std::vector<double>& seconds = stamps.seconds;
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < csv.columns.size(); ++i)
    if (i != at.channel && i != at.value && !names_units(csv.headings[i]) && !is_time_of_wincc(csv, i))
      kept.push_back(i);
  Csv wide = headings_of(csv, kept, channels);
  part_headings(wide, columns);
  std::vector<std::string> said_later;
  const Channel& torque = channels[find_column(wide, columns.torque, torque_of_log, said_later) - kept.size()];

  std::vector<std::vector<std::size_t>> written;
  for (const Channel& channel : channels) written.push_back(last_written(channel.rows, torque.rows, seconds));
  for (std::size_t k = 0; k < torque.rows.size(); ++k) {
    const CsvRow& row = csv.rows[torque.rows[k]];
    CsvRow made{.fields = {}, .line = row.line};
    for (const std::size_t i : kept) made.fields.push_back(row.fields[i]);
    for (const std::vector<std::size_t>& of : written)
      made.fields.push_back(of[k] == none ? std::string() : csv.rows[of[k]].fields[at.value]);
    wide.rows.push_back(std::move(made));
  }
  took.push_back(fmt::format(
      "a row for each value of {}: its {} channels as columns, at the times of '{}', the others as last written",
      csv.headings[at.channel], channels.size(), torque.name));
  if (std::string said = rows_without_time(csv, stamps); !said.empty()) took.push_back(std::move(said));
  return wide;
}

}  // namespace data
