#include "data/csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>

#include "data/atomic_file.hpp"
#include "data/edit_distance.hpp"
#include "data/error.hpp"

namespace data {
namespace {

std::string trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(" \t");
  if (first == std::string_view::npos) return "";
  return std::string(text.substr(first, text.find_last_not_of(" \t") - first + 1));
}

[[noreturn]] void fail(const std::string& place, std::string what, std::string remedy) {
  throw InputError(ExitStatus::bad_data, Problem{place, std::move(what), std::move(remedy)});
}

/// Reads the text record by record; a quoted field may hold line ends.
class Reader {
 public:
  Reader(const std::string& text, const std::string& file) : text_(text), file_(file) {
    if (text_.substr(0, 3) == "\xEF\xBB\xBF") at_ = 3;
  }

  bool at_end() const { return at_ >= text_.size(); }
  int line() const { return line_; }

  /// The rest of the line when the line is a comment.
  std::optional<std::string> comment() {
    const auto first = text_.find_first_not_of(" \t", at_);
    if (first == std::string_view::npos || text_[first] != '#') return {};
    const auto end = std::min(text_.find_first_of("\r\n", first), text_.size());
    at_ = first + 1;
    std::string_view rest = text_.substr(at_, end - at_);
    if (!rest.empty() && rest.front() == ' ') rest.remove_prefix(1);
    at_ = end;
    end_line();
    return std::string(rest);
  }

  /// The fields of the next record; a single empty field for an empty line.
  std::vector<std::string> record() {
    std::vector<std::string> fields;
    for (;;) {
      fields.push_back(field());
      if (at_end() || text_[at_] != ',') break;
      ++at_;
    }
    end_line();
    return fields;
  }

 private:
  std::string field() {
    at_ = std::min(text_.find_first_not_of(" \t", at_), text_.size());
    if (at_end() || text_[at_] != '"') {
      const auto end = std::min(text_.find_first_of(",\r\n", at_), text_.size());
      const std::string value = trimmed(text_.substr(at_, end - at_));
      at_ = end;
      return value;
    }
    const int opened = line_;
    std::string value;
    for (++at_;; ++at_) {
      if (at_end()) fail(fmt::format("{}:{}", file_, opened), "a quoted field does not end", "add the closing quote");
      if (text_[at_] == '"') {
        if (at_ + 1 < text_.size() && text_[at_ + 1] == '"')
          ++at_;
        else
          break;
      }
      if (text_[at_] == '\n') ++line_;
      value += text_[at_];
    }
    at_ = std::min(text_.find_first_not_of(" \t", at_ + 1), text_.size());
    if (!at_end() && text_[at_] != ',' && text_[at_] != '\r' && text_[at_] != '\n') {
      fail(fmt::format("{}:{}", file_, line_), "text follows a closing quote",
           "double a quote that is part of the field");
    }
    return value;
  }

  void end_line() {
    if (!at_end() && text_[at_] == '\r') ++at_;
    if (!at_end() && text_[at_] == '\n') ++at_;
    ++line_;
  }

  std::string_view text_;
  std::string file_;
  std::size_t at_ = 0;
  int line_ = 1;
};

}  // namespace

std::optional<std::size_t> Csv::find(std::string_view column) const {
  const auto found = std::find(columns.begin(), columns.end(), column);
  if (found == columns.end()) return {};
  return static_cast<std::size_t>(found - columns.begin());
}

std::size_t Csv::column(std::string_view name) const {
  if (const auto found = find(name)) return *found;
  std::string remedy = fmt::format("the columns are {}", fmt::join(columns, ", "));
  if (const auto near = nearest(name, columns); near && edit_distance(name, *near) <= 2) {
    remedy += fmt::format("; is '{}' meant?", *near);
  }
  fail(fmt::format("{}:{}", file, header_line), fmt::format("the column '{}' is missing", name), remedy);
}

std::string Csv::place(const CsvRow& row, std::size_t column) const {
  return fmt::format("{}:{}: {}", file, row.line, columns.at(column));
}

double Csv::number(const CsvRow& row, std::size_t column) const {
  const std::string& field = row.fields.at(column);
  if (field.empty()) return std::numeric_limits<double>::quiet_NaN();
  const char* begin = field.data() + (field.front() == '+' ? 1 : 0);
  const char* end = field.data() + field.size();
  double value = 0.0;
  const auto [rest, error] = std::from_chars(begin, end, value);
  if (error == std::errc::result_out_of_range && rest == end) {
    fail(place(row, column), fmt::format("'{}' is too large or too small for a double", field),
         "write a number in range");
  }
  if (error != std::errc{} || rest != end) {
    fail(place(row, column), fmt::format("'{}' is not a number", field), "write a plain number with a decimal point");
  }
  return value;
}

Csv parse_csv(const std::string& text, const std::string& file) {
  Csv csv;
  csv.file = file;
  Reader reader(text, file);
  while (!reader.at_end()) {
    if (auto comment = reader.comment()) {
      if (csv.columns.empty()) csv.comments.push_back(std::move(*comment));
      continue;
    }
    const int line = reader.line();
    std::vector<std::string> fields = reader.record();
    if (fields.size() == 1 && fields.front().empty()) continue;
    if (csv.columns.empty()) {
      csv.columns = std::move(fields);
      csv.header_line = line;
      for (std::size_t i = 0; i < csv.columns.size(); ++i) {
        if (!csv.columns[i].empty() && csv.find(csv.columns[i]) != i) {
          fail(fmt::format("{}:{}", file, line), fmt::format("the column '{}' is there twice", csv.columns[i]),
               "rename or remove one");
        }
      }
      continue;
    }
    if (fields.size() != csv.columns.size()) {
      fail(fmt::format("{}:{}", file, line),
           fmt::format("has {} fields where the header has {}", fields.size(), csv.columns.size()),
           fields.size() < csv.columns.size() ? "complete the line; the file may have been cut off here"
                                              : "a field with a comma in it needs quotes");
    }
    csv.rows.push_back({std::move(fields), line});
  }
  if (csv.columns.empty()) fail(file, "is empty: there is no header line", "the first line names the columns");
  return csv;
}

Csv read_csv(const std::string& path) { return parse_csv(read_file(path), shown_path(path)); }

std::string csv_field(std::string_view text) {
  const bool plain = text.find_first_of(",\"\r\n#") == std::string_view::npos && trimmed(text) == text;
  if (plain) return std::string(text);
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"') quoted += '"';
    quoted += c;
  }
  return quoted + '"';
}

std::string shortest(double value) { return fmt::format("{}", value); }

}  // namespace data
