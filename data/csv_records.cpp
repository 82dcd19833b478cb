#include "data/csv_records.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "data/error.hpp"
#include "data/number_text.hpp"

namespace data {
namespace {

/// Reads the text record by record; a quoted field may hold line ends.
class Reader {
 public:
  Reader(std::string_view text, const Dialect& dialect, const std::string& file)
      : text_(text), file_(file), separator_(dialect.separator), at_(dialect.begin), line_(dialect.first_line) {
    stops_ = std::string("\r\n") + separator_;
  }

  bool at_end() const { return at_ >= text_.size(); }
  int line() const { return line_; }
  std::string_view rest_of_line() const { return text_.substr(at_, text_.find_first_of("\r\n", at_) - at_); }
  void skip_line() {
    at_ = std::min(text_.find_first_of("\r\n", at_), text_.size());
    end_line();
  }

  std::vector<std::string> record() {
    std::vector<std::string> fields;
    if (separator_ == ' ') {
      fields = split_line(rest_of_line(), ' ');
      skip_line();
      return fields;
    }
    for (;;) {
      fields.push_back(field());
      if (at_end() || text_[at_] != separator_) break;
      ++at_;
    }
    end_line();
    return fields;
  }

 private:
  void skip_blanks() {
    while (!at_end() && text_[at_] != separator_ && (text_[at_] == ' ' || text_[at_] == '\t')) ++at_;
  }

  std::string field() {
    skip_blanks();
    if (at_end() || text_[at_] != '"') {
      const auto end = std::min(text_.find_first_of(stops_, at_), text_.size());
      std::string value(trimmed(text_.substr(at_, end - at_)));
      at_ = end;
      return value;
    }
    const int opened = line_;
    std::string value;
    for (++at_;; ++at_) {
      if (at_end())
        refuse_data(fmt::format("{}:{}", file_, opened), "a quoted field does not end", "add the closing quote");
      if (text_[at_] == '"') {
        if (at_ + 1 < text_.size() && text_[at_ + 1] == '"')
          ++at_;
        else
          break;
      }
      if (text_[at_] == '\n') ++line_;
      value += text_[at_];
    }
    ++at_;
    skip_blanks();
    if (!at_end() && text_[at_] != separator_ && text_[at_] != '\r' && text_[at_] != '\n') {
      refuse_data(fmt::format("{}:{}", file_, line_), "text follows a closing quote",
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
  const std::string& file_;
  char separator_;
  std::string stops_;
  std::size_t at_;
  int line_;
};

/// R's write.table names no column of row names: every row has one field more than the heading. The names are words, or
/// count from 1; where they are other numbers, it may as well be the last column that has no name.
void name_column_of_row_names(std::vector<CsvRecord>& records) {
  const auto is_number = [](const std::string& field) { return plain_number(field, DecimalMark::point).has_value(); };
  CsvRecord* heading = nullptr;
  bool words = true, counted = true;
  std::size_t rows = 0;
  for (CsvRecord& record : records) {
    if (record.comment) continue;
    if (heading == nullptr) {
      heading = &record;
      continue;
    }
    if (record.fields.size() != heading->fields.size() + 1 || record.fields.back().empty()) return;
    ++rows;
    words = words && !is_number(record.fields.front());
    counted = counted && record.fields.front() == std::to_string(rows);
  }
  if (rows < 2 || !(words || counted) || std::any_of(heading->fields.begin(), heading->fields.end(), is_number)) return;
  heading->fields.insert(heading->fields.begin(), "");
}

}  // namespace

std::vector<CsvRecord> read_records(std::string_view text, const Dialect& dialect, const std::string& file) {
  std::vector<CsvRecord> records;
  Reader reader(text, dialect, file);
  bool gap = false;
  while (!reader.at_end()) {
    CsvRecord record{.fields = {}, .line = reader.line(), .comment = false, .gap_above = gap};
    std::string_view comment;
    if (is_comment(reader.rest_of_line(), comment)) {
      record.comment = true;
      record.fields.emplace_back(comment);
      reader.skip_line();
    } else {
      record.fields = reader.record();
    }
    gap = !record.comment &&
          std::all_of(record.fields.begin(), record.fields.end(), [](const std::string& one) { return one.empty(); });
    if (!gap || record.fields.size() > 1) records.push_back(std::move(record));
  }
  if (dialect.separator == ' ' || dialect.separator == '\t') name_column_of_row_names(records);
  return records;
}

}  // namespace data
