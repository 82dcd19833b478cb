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
  constexpr double samples_most = 1e15;  // a whole number as a double still
  const double stated = reader.number(reader.tag(segment.tags, "Samples", channel)).value_or(0.0);
  segment.samples = stated > 0.0 ? static_cast<std::size_t>(std::min(stated, samples_most)) : 0;
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

/// The segments of a file as one table: the first one's channels, and times that go on from one to the next.
class Joined {
 public:
  explicit Joined(PacketReader& reader)
      : reader_(reader), computed_(lower_case(reader.tag(reader.file_tags, "X_Columns")) == "no") {}

  bool begins_segment() const {
    const std::string& front = reader_.fields.front();
    return !segment_ || (!front.empty() && !reader_.number(front) && !is_missing(front));
  }

  void begin() {
    segment_ = begin_segment(reader_);
    ++segments_;
    in_segment_ = 0;
    offset_ = 0.0;
    if (!first_) {
      first_ = segment_;
      return;
    }
    require_same_channels();
    if (segment_->start && first_->start) offset_ = *segment_->start - *first_->start;
  }

  void add_row() {
    const std::vector<std::string>& fields = reader_.fields;
    const std::size_t names = segment_->names.size();
    if (fields.size() < names)
      fail(reader_.csv.file, reader_.lines.line(),
           fmt::format("has {} fields where the line of names has {}", fields.size(), names),
           "complete the line; the file may have been cut off here");
    if (fields.size() > names && !fields[names].empty()) ++comments_;
    times_.push_back(next_time());
    CsvRow row{.fields = {""}, .line = reader_.lines.line()};
    for (const std::size_t i : segment_->y)
      row.fields.push_back(plain_number(fields[i], reader_.mark).value_or(fields[i]));
    reader_.csv.rows.push_back(std::move(row));
    ++in_segment_;
    if (computed_ && segment_->samples > 0 && in_segment_ > segment_->samples)
      no_time(
          fmt::format("X_Columns is No, and more rows than the {} of a packet (Samples) follow: nothing says when the "
                      "next packet begins",
                      segment_->samples));
  }

  /// Headings, units and times, once all rows are read.
  void finish() {
    Csv& csv = reader_.csv;
    if (!first_)
      throw InputError(ExitStatus::bad_data, Problem{csv.file, "has no segment with samples", "export it again"});
    if (const std::string x = reader_.tag(first_->tags, "X_Dimension", first_->y.front());
        !x.empty() && lower_case(x) != "time")
      csv.no_time = fmt::format("its X values are '{}', no time", x);
    if (computed_ && !first_->step) csv.no_time = "X_Columns is No, and its header has no Delta_X";
    csv.header_line = first_->line;
    csv.headings = {"X_Value"};
    csv.units = {"s"};
    for (const std::size_t i : first_->y) {
      csv.headings.push_back(first_->names[i]);
      const std::string label = reader_.tag(first_->tags, "Y_Unit_Label", i);
      csv.units.push_back(is_unit(label) && label != "-" ? label : "");
    }
    csv.no_time.empty() ? write_times() : remove_times();
    if (segments_ > 1) csv.took.push_back(fmt::format("{} segments joined", segments_));
    if (comments_ > 0) csv.took.push_back(fmt::format("comments of {} rows left out", comments_));
  }

 private:
  void no_time(std::string why) {
    if (reader_.csv.no_time.empty()) reader_.csv.no_time = std::move(why);
  }

  void require_same_channels() const {
    const std::string& file = reader_.csv.file;
    const std::string remedy = "write each into a file of its own";
    if (segment_->names != first_->names)
      fail(file, segment_->line,
           fmt::format("the segment has the channels {}, that of line {} has {}", names_of(*segment_), first_->line,
                       names_of(*first_)),
           remedy);
    for (const std::size_t i : segment_->y) {
      const std::string here = reader_.tag(segment_->tags, "Y_Unit_Label", i);
      const std::string there = reader_.tag(first_->tags, "Y_Unit_Label", i);
      if (here != there)
        fail(file, segment_->line,
             fmt::format("'{}' is in '{}' in this segment and in '{}' in that of line {}", segment_->names[i], here,
                         there, first_->line),
             remedy);
    }
  }

  /// Of the row that is read, by the first segment's clock.
  double next_time() {
    double time = computed_
                      ? segment_->x0.value_or(0.0) + static_cast<double>(in_segment_) * segment_->step.value_or(NAN)
                      : x_of(reader_, *segment_);
    if (time < of_1904) time += offset_;
    if (in_segment_ == 0 && segments_ > 1 && time <= end_)
      no_time(fmt::format("the segment of line {} begins at {:g} s, but the one above it ends at {:g} s",
                          segment_->line, time, end_));
    if (!std::isnan(time)) end_ = time;
    return time;
  }

  void write_times() {
    Csv& csv = reader_.csv;
    const double start = !times_.empty() && times_.front() >= of_1904 ? times_.front() : 0.0;
    for (std::size_t i = 0; i < times_.size(); ++i)
      csv.rows[i].fields.front() = std::isnan(times_[i]) ? "" : shortest(times_[i] - start);
    if (computed_) csv.took.push_back(fmt::format("times by X0 and Delta_X, {:g} s apart", *first_->step));
  }

  void remove_times() {
    Csv& csv = reader_.csv;
    csv.headings.erase(csv.headings.begin());
    csv.units.erase(csv.units.begin());
    for (CsvRow& row : csv.rows) row.fields.erase(row.fields.begin());
  }

  PacketReader& reader_;
  bool computed_;  ///< no column of X values: times by X0 and Delta_X
  std::vector<double> times_;
  std::optional<Segment> first_, segment_;
  std::size_t segments_ = 0, in_segment_ = 0, comments_ = 0;
  double offset_ = 0.0;  ///< from a segment's X values to the first one's clock
  double end_ = -std::numeric_limits<double>::infinity();
};

}  // namespace

bool is_lvm(std::string_view text) { return trimmed(text.substr(0, 64)).starts_with(magic); }

Csv read_lvm(std::string_view text, const std::string& file) {
  PacketReader reader{.csv = {}, .lines = Lines(text)};
  reader.csv.file = file;
  reader.csv.took.emplace_back("a LabVIEW measurement file");
  read_file_header(reader, text);
  Joined joined(reader);
  while (reader.next()) {
    if (is_blank(reader.fields)) continue;
    if (joined.begins_segment())
      joined.begin();
    else
      joined.add_row();
  }
  joined.finish();
  return std::move(reader.csv);
}

}  // namespace data
