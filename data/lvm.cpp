// Tags stand in any order, each in a line of its own, with the value behind a separator. Those of a segment have a
// value in the column of each channel. Samples counts those of one packet. Without Multi_Headings more packets follow
// without a header, and nothing says how long after the first. A packet of one sample has LabVIEW's default as Delta_X.
#include "data/lvm.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <optional>

#include "data/error.hpp"
#include "data/number_text.hpp"
#include "data/unit_text.hpp"

namespace data {
namespace {

constexpr std::string_view magic = "LabVIEW Measurement", header_end = "***End_of_Header***";
constexpr double of_1904 = 1e8;  // s; X values beyond are seconds since 1904, others since the segment's stamp

using Fields = std::vector<std::string>;
using Tags = std::map<std::string, Fields>;

[[noreturn]] void fail(const std::string& file, int line, const std::string& what, const std::string& remedy) {
  refuse_data(fmt::format("{}:{}", file, line), what, remedy);
}

class Lines {
 public:
  explicit Lines(std::string_view text) : text_(text) {}
  /// The next line's fields, trimmed; false at the end.
  bool next(char separator, Fields& fields) {
    if (at_ >= text_.size()) return false;
    const std::size_t end = std::min(text_.find_first_of("\r\n", at_), text_.size());
    std::string_view line = text_.substr(at_, end - at_);
    at_ = end + (text_.substr(end, 2) == "\r\n" ? 2 : 1);
    ++line_;
    fields.clear();
    for (std::size_t from = 0; from != std::string_view::npos;) {
      const std::size_t to = line.find(separator, from);
      fields.emplace_back(trimmed(line.substr(from, to == std::string_view::npos ? to : to - from)));
      from = to == std::string_view::npos ? to : to + 1;
    }
    return true;
  }
  int line() const { return line_; }

 private:
  std::string_view text_;
  std::size_t at_ = 0;
  int line_ = 0;
};

bool is_blank(const Fields& fields) {
  return std::all_of(fields.begin(), fields.end(), [](const std::string& one) { return one.empty(); });
}

struct PacketReader {
  Csv csv;
  Lines lines;
  char separator = '\t';
  DecimalMark mark = DecimalMark::point;
  Fields fields;
  Tags file_tags;

  bool next() { return lines.next(separator, fields); }
  std::string tag(const Tags& tags, const std::string& name, std::size_t column = 1) const {
    const auto found = tags.find(name);
    return found == tags.end() || found->second.size() <= column ? std::string() : found->second[column];
  }
  std::optional<double> number(const std::string& text) const {
    const auto plain = plain_number(text, mark);
    double value = 0.0;
    if (!plain || std::from_chars(plain->data(), plain->data() + plain->size(), value).ec != std::errc{}) return {};
    return value;
  }
};

/// Tags up to the end of a header, the line at hand among them.
Tags read_tags(PacketReader& reader) {
  Tags tags;
  const int first = reader.lines.line();
  const Fields beginning = reader.fields;
  do {
    if (reader.fields.front() == header_end) return tags;
    if (reader.fields.front() == "***Start_Special***") {
      while (reader.next() && reader.fields.front() != "***End_Special***") {
      }
    } else if (!reader.fields.front().empty()) {
      tags[reader.fields.front()] = reader.fields;
    }
  } while (reader.next());
  const DecimalMark other = reader.mark == DecimalMark::comma ? DecimalMark::point : DecimalMark::comma;
  if (!beginning.front().empty() && plain_number(beginning.front(), other))
    fail(reader.csv.file, first,
         fmt::format("'{}' is no number with a decimal {}, which Decimal_Separator in the header states",
                     beginning.front(), other == DecimalMark::point ? "comma" : "point"),
         "correct that line of the header");
  fail(reader.csv.file, first, fmt::format("a header that begins here has no {}", header_end),
       "the file may have been cut off; export it again");
}

struct Segment {
  Tags tags;
  int line = 0;                    ///< of the names
  Fields names;                    ///< the column of each field of a row, without the comment
  std::vector<std::size_t> x, y;   ///< the columns of X values, and of channels
  std::optional<double> start;     ///< s, of its stamp
  std::optional<double> x0, step;  ///< s
  std::size_t samples = 0;         ///< of a packet
};

std::optional<double> stamp_of(const std::string& date, std::string time) {
  std::replace(time.begin(), time.end(), ',', '.');
  int year = 0, hours = 0, minutes = 0;
  unsigned month = 0, day = 0;
  double seconds = 0.0;
  if (std::sscanf(date.c_str(), "%d/%u/%u", &year, &month, &day) != 3 ||
      std::sscanf(time.c_str(), "%d:%d:%lf", &hours, &minutes, &seconds) != 3)
    return {};
  const std::chrono::year_month_day at{std::chrono::year(year), std::chrono::month(month), std::chrono::day(day)};
  if (!at.ok()) return {};
  return 86400.0 * static_cast<double>(std::chrono::sys_days(at).time_since_epoch().count()) + 3600.0 * hours +
         60.0 * minutes + seconds;
}

Segment begin_segment(PacketReader& reader) {
  Segment segment;
  segment.tags = read_tags(reader);
  while (reader.next() && is_blank(reader.fields)) {
  }
  segment.line = reader.lines.line();
  segment.names = reader.fields;
  while (!segment.names.empty() && segment.names.back().empty()) segment.names.pop_back();
  if (!segment.names.empty() && segment.names.back() == "Comment") segment.names.pop_back();
  if (segment.names.size() < 2 || segment.names.front() != "X_Value")
    fail(reader.csv.file, segment.line, "no line of names (X_Value, ...) follows the segment's header",
         "export the file again");
  for (std::size_t i = 0; i < segment.names.size(); ++i)
    (segment.names[i] == "X_Value" ? segment.x : segment.y).push_back(i);
  const std::size_t channel = segment.y.empty() ? 1 : segment.y.front();
  segment.start = stamp_of(reader.tag(segment.tags, "Date", channel), reader.tag(segment.tags, "Time", channel));
  segment.x0 = reader.number(reader.tag(segment.tags, "X0", channel));
  segment.step = reader.number(reader.tag(segment.tags, "Delta_X", channel));
  segment.samples = static_cast<std::size_t>(
      std::max(0.0, reader.number(reader.tag(segment.tags, "Samples", channel)).value_or(0.0)));
  return segment;
}

std::string names_of(const Segment& segment) {
  std::string names;
  for (const std::size_t i : segment.y) names += (names.empty() ? "" : ", ") + segment.names[i];
  return names;
}

/// The X value of a row [s], NaN where it has none; all that it has must agree.
double x_of(const PacketReader& reader, const Segment& segment) {
  double x = std::numeric_limits<double>::quiet_NaN();
  for (const std::size_t i : segment.x) {
    const auto value = reader.number(reader.fields[i]);
    if (!value) {
      if (is_missing(reader.fields[i])) continue;
      fail(reader.csv.file, reader.lines.line(), fmt::format("X_Value '{}' is not a number", reader.fields[i]),
           "export the file again");
    }
    if (std::isnan(x)) x = *value;
    if (std::abs(*value - x) > 0.01 * std::abs(segment.step.value_or(0.0)) + 1e-9 * std::abs(x))
      fail(reader.csv.file, reader.lines.line(),
           fmt::format("the channels are sampled at different times, {:g} s and {:g} s", x, *value),
           "write them on one clock (X_Columns One), or each into a file of its own");
  }
  return x;
}

void read_file_header(PacketReader& reader, std::string_view text) {
  // The separator is known from the line behind the tag of its own.
  const std::size_t at = text.find("Separator"), end = at == std::string_view::npos ? at : at + 9;
  reader.separator = end < text.size() && text[end] == ',' ? ',' : '\t';
  reader.next();
  reader.file_tags = read_tags(reader);
  const std::string decimal = reader.tag(reader.file_tags, "Decimal_Separator");
  if (reader.separator == ',') return;
  // Before version 2 there was no such tag: the header's own time has the mark.
  const bool comma = decimal.empty() && reader.file_tags.count("Decimal_Separator") == 0
                         ? reader.tag(reader.file_tags, "Time").find(',') != std::string::npos
                         : decimal == ",";
  if (comma) {
    reader.mark = DecimalMark::comma;
    reader.csv.took.emplace_back("decimal commas");
  }
}

}  // namespace

bool is_lvm(std::string_view text) { return trimmed(text.substr(0, 64)).starts_with(magic); }

Csv read_lvm(std::string_view text, const std::string& file) {
  PacketReader reader{.csv = {}, .lines = Lines(text)};
  Csv& csv = reader.csv;
  csv.file = file;
  csv.took.emplace_back("a LabVIEW measurement file");
  read_file_header(reader, text);

  const bool computed = lower_case(reader.tag(reader.file_tags, "X_Columns")) == "no";
  std::vector<double> times;
  std::optional<Segment> first, segment;
  std::size_t segments = 0, in_segment = 0, comments = 0;
  double offset = 0.0;  // from a segment's X values to the first one's clock
  double end = -std::numeric_limits<double>::infinity();
  while (reader.next()) {
    if (is_blank(reader.fields)) continue;
    const std::string& front = reader.fields.front();
    if (!segment || (!front.empty() && !reader.number(front) && !is_missing(front))) {
      segment = begin_segment(reader);
      ++segments;
      in_segment = 0;
      offset = 0.0;
      if (!first) {
        first = segment;
        continue;
      }
      if (segment->names != first->names)
        fail(file, segment->line,
             fmt::format("the segment has the channels {}, that of line {} has {}", names_of(*segment), first->line,
                         names_of(*first)),
             "write each into a file of its own");
      for (const std::size_t i : segment->y)
        if (reader.tag(segment->tags, "Y_Unit_Label", i) != reader.tag(first->tags, "Y_Unit_Label", i))
          fail(file, segment->line,
               fmt::format("'{}' is in '{}' in this segment and in '{}' in that of line {}", segment->names[i],
                           reader.tag(segment->tags, "Y_Unit_Label", i), reader.tag(first->tags, "Y_Unit_Label", i),
                           first->line),
               "write each into a file of its own");
      if (segment->start && first->start) offset = *segment->start - *first->start;
      continue;
    }
    if (reader.fields.size() < segment->names.size())
      fail(file, reader.lines.line(),
           fmt::format("has {} fields where the line of names has {}", reader.fields.size(), segment->names.size()),
           "complete the line; the file may have been cut off here");
    if (reader.fields.size() > segment->names.size() && !reader.fields[segment->names.size()].empty()) ++comments;
    double time = computed ? segment->x0.value_or(0.0) + static_cast<double>(in_segment) * segment->step.value_or(NAN)
                           : x_of(reader, *segment);
    if (time < of_1904) time += offset;
    if (in_segment == 0 && segments > 1 && time <= end && csv.no_time.empty())
      csv.no_time = fmt::format("the segment of line {} begins at {:g} s, but the one above it ends at {:g} s",
                                segment->line, time, end);
    if (!std::isnan(time)) end = time;
    times.push_back(time);
    CsvRow row{.fields = {""}, .line = reader.lines.line()};
    for (const std::size_t i : segment->y)
      row.fields.push_back(plain_number(reader.fields[i], reader.mark).value_or(reader.fields[i]));
    csv.rows.push_back(std::move(row));
    ++in_segment;
    if (computed && segment->samples > 0 && in_segment > segment->samples && csv.no_time.empty())
      csv.no_time = fmt::format(
          "X_Columns is No, and more rows than the {} of a packet (Samples) follow: nothing says when the next packet "
          "begins",
          segment->samples);
  }
  if (!first) throw InputError(ExitStatus::bad_data, Problem{file, "has no segment with samples", "export it again"});

  if (const std::string x = reader.tag(first->tags, "X_Dimension", first->y.front());
      !x.empty() && lower_case(x) != "time")
    csv.no_time = fmt::format("its X values are '{}', no time", x);
  if (computed && !first->step) csv.no_time = "X_Columns is No, and its header has no Delta_X";
  csv.header_line = first->line;
  csv.headings = {"X_Value"};
  csv.units = {"s"};
  for (const std::size_t i : first->y) {
    csv.headings.push_back(first->names[i]);
    const std::string label = reader.tag(first->tags, "Y_Unit_Label", i);
    csv.units.push_back(is_unit(label) && label != "-" ? label : "");
  }
  if (csv.no_time.empty()) {
    if (!times.empty() && times.front() >= of_1904) {
      const double start = times.front();
      for (double& time : times) time -= start;
    }
    for (std::size_t i = 0; i < times.size(); ++i)
      csv.rows[i].fields.front() = std::isnan(times[i]) ? "" : shortest(times[i]);
    if (computed) csv.took.push_back(fmt::format("times by X0 and Delta_X, {:g} s apart", *first->step));
  } else {
    csv.headings.erase(csv.headings.begin());
    csv.units.erase(csv.units.begin());
    for (CsvRow& row : csv.rows) row.fields.erase(row.fields.begin());
  }
  if (segments > 1) csv.took.push_back(fmt::format("{} segments joined", segments));
  if (comments > 0) csv.took.push_back(fmt::format("comments of {} rows left out", comments));
  return std::move(csv);
}

}  // namespace data
