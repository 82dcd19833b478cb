#include "data/csv_blocks.hpp"

#include <algorithm>
#include <optional>
#include <set>

#include "data/csv_dialect.hpp"
#include "data/number_text.hpp"
#include "data/time_text.hpp"
#include "data/unit_text.hpp"

namespace data {
namespace {

using Texts = std::vector<std::string>;

constexpr int most_lines_of_words = 4;  // between a line of units and the first row

bool is_number_field(const std::string& field) {
  return plain_number(field, DecimalMark::point) || plain_number(field, DecimalMark::comma) || read_time(field);
}

bool is_blank_record(const CsvRecord& record) { return !record.comment && without_trailing(record.fields) == 0; }

bool has_as_many(const CsvRecord& record, std::size_t columns) {
  return record.fields.size() >= columns && without_trailing(record.fields) <= columns;
}

std::string without_brackets(const std::string& field) {
  const bool in_brackets = field.size() >= 2 && ((field.front() == '[' && field.back() == ']') ||
                                                 (field.front() == '(' && field.back() == ')'));
  return in_brackets ? field.substr(1, field.size() - 2) : field;
}

bool in_square_brackets(const std::string& field) {
  return field.size() >= 2 && field.front() == '[' && field.back() == ']';
}

/// Fields that name a unit; a "1" or "-" says nothing.
std::size_t units_in(const CsvRecord& record) {
  return static_cast<std::size_t>(
      std::count_if(record.fields.begin(), record.fields.end(), [](const std::string& field) {
        const std::string bare = without_brackets(field);
        return !bare.empty() && bare != "-" && bare != "1" && (in_square_brackets(field) || is_unit(bare));
      }));
}

/// Whether all fields are units. A "1" among them is one; so that no row of numbers is taken for units, two others must
/// stand beside it.
bool is_units_row(const CsvRecord& record) {
  const bool all = std::all_of(record.fields.begin(), record.fields.end(), [](const std::string& field) {
    const std::string bare = without_brackets(field);
    return bare.empty() || in_square_brackets(field) || is_unit(bare);
  });
  return all && units_in(record) >= (holds_number(record) ? 2 : 1);
}

/// Whether a line below a line of names holds their units, some of which may be unknown ("% r.F.", "Skt"): half of the
/// fields and two at least are units, and more than above.
bool is_units_row_below(const CsvRecord& names, const CsvRecord& record) {
  if (is_units_row(record)) return true;
  const auto filled = static_cast<std::size_t>(
      std::count_if(record.fields.begin(), record.fields.end(), [](const std::string& one) { return !one.empty(); }));
  const std::size_t units = units_in(record);
  return is_words(record) && units >= 2 && 2 * units >= filled && units > units_in(names);
}

Texts units_of(const CsvRecord& record) {
  Texts units;
  for (const std::string& field : record.fields) units.push_back(without_brackets(field));
  return units;
}

bool names_units(const Texts& headings) {
  return std::any_of(headings.begin(), headings.end(),
                     [](const std::string& heading) { return !read_heading(heading).unit.empty(); });
}

/// The kinds of values that the columns hold in a row.
class Kinds {
 public:
  explicit Kinds(const CsvRecord& record) {
    for (const std::string& field : record.fields)
      kinds_.push_back(is_missing(field) ? Kind::nothing : is_number_field(field) ? Kind::number : Kind::words);
  }
  /// Whether a column holds numbers in the one row and words in the other.
  bool differ_from(const CsvRecord& record) const {
    for (std::size_t i = 0; i < std::min(kinds_.size(), record.fields.size()); ++i) {
      const std::string& field = record.fields[i];
      if (kinds_[i] == Kind::nothing || is_number_field(field) == (kinds_[i] == Kind::number)) continue;
      if (!is_missing(field)) return true;
    }
    return false;
  }

 private:
  enum class Kind { nothing, number, words };
  std::vector<Kind> kinds_;
};

/// Finds the blocks in one pass over the records.
class BlockFinder {
 public:
  BlockFinder(const std::vector<CsvRecord>& records, char separator) : records_(records), separator_(separator) {}

  std::vector<CsvBlock> find() {
    for (std::size_t i = 0; i < records_.size(); ++i) {
      const CsvRecord& record = records_[i];
      std::optional<CsvBlock> next = record.comment     ? repeated_in_comment(i)
                                     : is_words(record) ? below_words(i)
                                                        : std::nullopt;
      if (!next && blocks_.empty() && !record.comment && is_row(record) && !is_blank_record(record))
        next = below_comments(i);
      if (next) {
        begin(std::move(*next));
        i = blocks_.back().first;
        if (i == records_.size()) break;
      }
      if (!blocks_.empty() && !records_[i].comment && is_row(records_[i]) && !is_blank_record(records_[i]) &&
          has_as_many(records_[i], columns())) {
        if (!kinds_->differ_from(records_[i])) last_row_ = i;
        ++blocks_.back().rows;
      }
    }
    if (!blocks_.empty()) end_last();
    return std::move(blocks_);
  }

 private:
  std::size_t columns() const { return blocks_.back().headings.size(); }

  /// The next line that is neither a comment nor empty.
  std::size_t next_line(std::size_t at) const {
    for (++at; at < records_.size() && (records_[at].comment || is_blank_record(records_[at]));) ++at;
    return at;
  }

  /// Whether a row with so many fields is among the first below; others there may be damaged.
  bool rows_follow(std::size_t at, std::size_t columns) const {
    constexpr int looked_at = 10;
    for (int looked = 0; at < records_.size() && looked < looked_at && is_row(records_[at]); ++looked) {
      if (has_as_many(records_[at], columns)) return true;
      at = next_line(at);
    }
    return false;
  }

  std::optional<CsvBlock> below_words(std::size_t at) const {
    const CsvRecord& record = records_[at];
    CsvBlock block{.headings = record.fields, .line = record.line, .heading = at};
    block.headings.resize(without_trailing(record.fields));
    if (block.headings.empty()) return {};
    block.first = next_line(at);
    if (block.first < records_.size() && has_as_many(records_[block.first], block.headings.size()) &&
        is_units_row_below(record, records_[block.first])) {
      block.units = units_of(records_[block.first]);
      block.units_line = records_[block.first].line;
      block.first = next_line(block.first);
    }
    // Further lines of words: what each column is, as plotting programs have it, its rate and its amplifier.
    std::size_t behind = block.first;
    for (int line = 0; block.units_line > 0 && line < most_lines_of_words && behind < records_.size() &&
                       is_words(records_[behind]) && has_as_many(records_[behind], block.headings.size());
         ++line)
      behind = next_line(behind);
    if (rows_follow(behind, block.headings.size())) block.first = behind;
    if (!rows_follow(block.first, block.headings.size())) return {};
    const bool apart = blocks_.empty() || record.gap_above || block.units_line > 0 || names_units(block.headings) ||
                       columns() != block.headings.size() || same_columns(blocks_.back().headings, block.headings) ||
                       Kinds(records_[last_row_]).differ_from(records_[block.first]);
    return apart ? std::optional(block) : std::nullopt;
  }

  /// A comment as a heading, if it has so many fields and all are words.
  std::optional<CsvRecord> split_comment(std::size_t at, std::size_t fields) const {
    const CsvRecord& comment = records_[at];
    CsvRecord split{.fields = split_line(comment.fields.front(), separator_), .line = comment.line};
    if (split.fields.size() != fields || !is_words(split)) return {};
    return split;
  }

  /// A heading among the comments above the first row, perhaps with one of units below it: one that names units before
  /// the others, and of those the nearest.
  std::optional<CsvBlock> below_comments(std::size_t row) const {
    std::optional<CsvRecord> heading, units;
    bool with_units = false;
    for (std::size_t i = row; i-- > 0 && !with_units;) {
      if (!records_[i].comment) continue;
      std::optional<CsvRecord> split = split_comment(i, without_trailing(records_[row].fields));
      if (!split) continue;
      if (!heading && !units && is_units_row(*split)) {
        units = std::move(split);
        continue;
      }
      with_units = names_units(split->fields);
      if (!heading || with_units) heading = std::move(split);
      if (units) break;
    }
    if (!heading) return {};
    CsvBlock block{
        .headings = heading->fields, .in_comment = true, .line = heading->line, .heading = row, .first = row};
    if (units) {
      block.units = units_of(*units);
      block.units_line = units->line;
    }
    return block;
  }

  std::optional<CsvBlock> repeated_in_comment(std::size_t at) const {
    if (blocks_.empty()) return {};
    const std::optional<CsvRecord> split = split_comment(at, columns());
    if (!split || !same_columns(blocks_.back().headings, split->fields)) return {};
    CsvBlock block{.headings = split->fields, .in_comment = true, .line = split->line, .heading = at};
    block.first = next_line(at);
    if (!rows_follow(block.first, columns())) return {};
    return block;
  }

  void begin(CsvBlock block) {
    if (!blocks_.empty()) end_before(block.heading);
    last_row_ = block.first;
    kinds_.emplace(records_[block.first]);
    blocks_.push_back(std::move(block));
  }

  /// Ends the last block where the lines begin that belong to the next heading: words, and, below an empty line, names
  /// with values. What may be a damaged row stays.
  void end_before(std::size_t heading) {
    CsvBlock& block = blocks_.back();
    block.end = last_row_ + 1;
    bool gap = false;
    for (std::size_t i = last_row_ + 1; i < heading; ++i) {
      const CsvRecord& record = records_[i];
      gap = gap || record.gap_above;
      if (record.comment || is_blank_record(record)) continue;
      const bool numbers = holds_number(record);
      const bool of_next = numbers ? gap && !is_measurement(record) : !has_as_many(record, columns()) || columns() == 1;
      if (!of_next) block.end = i + 1;
    }
  }

  /// Below the last block's rows comments, empty lines, titles, notes of any words behind an empty line, and statistics
  /// of the rows may stand. What may be a damaged row stays.
  void end_last() {
    CsvBlock& block = blocks_.back();
    const auto is_title = [&](const CsvRecord& record) {
      return is_words(record) && without_trailing(record.fields) == 1 && columns() > 1;
    };
    const auto is_empty = [](const CsvRecord& record) { return record.comment || is_blank_record(record); };
    std::size_t from = records_.size();  // lines from here on may be no rows
    while (from > block.first + 1 &&
           (is_empty(records_[from - 1]) || is_words(records_[from - 1]) || is_statistic(from - 1)))
      --from;
    while (from < records_.size()) {
      const CsvRecord& record = records_[from];
      if (is_empty(record) || is_title(record) || is_statistic(from) || (record.gap_above && columns() > 1)) break;
      ++from;
    }
    block.end = from;
    for (; from < records_.size(); ++from) {
      if (is_empty(records_[from])) continue;
      if (is_statistic(from))
        block.statistics.push_back(statistic_of(records_[from]));
      else
        ++block.footers;
    }
  }

  /// A sample may bear the name of a statistic, "max": then it has all values and no empty line above it, and no other
  /// statistic stands beside it.
  bool is_statistic(std::size_t at) const {
    static const std::set<std::string> samples_too{"max", "min",   "maximum", "minimum", "sum",     "total",
                                                   "se",  "count", "range",   "media",   "standard"};
    const CsvRecord& record = records_[at];
    const std::string name = statistic_of(record);
    if (name.empty() || !statistic_of(records_[blocks_.back().first]).empty()) return false;
    const bool has_all = static_cast<std::size_t>(std::count(record.fields.begin(), record.fields.end(), "")) == 0;
    const bool beside =
        (at + 1 < records_.size() && !records_[at + 1].gap_above && !statistic_of(records_[at + 1]).empty()) ||
        !statistic_of(records_[at - 1]).empty();
    return !samples_too.contains(lower_case(name)) || record.gap_above || !has_all || beside ||
           kinds_->differ_from(record);
  }

  const std::vector<CsvRecord>& records_;
  char separator_;
  std::vector<CsvBlock> blocks_;
  std::optional<Kinds> kinds_;  ///< kinds of values in the last block's first row
  std::size_t last_row_ = 0;    ///< last row of the last block that has numbers where the first row has them
};

}  // namespace

std::vector<CsvBlock> find_blocks(const std::vector<CsvRecord>& records, char separator) {
  return BlockFinder(records, separator).find();
}

bool same_columns(const Texts& one, const Texts& other) {
  return std::equal(one.begin(), one.end(), other.begin(), other.end(), [](const std::string& a, const std::string& b) {
    return lower_case(read_heading(a).name) == lower_case(read_heading(b).name);
  });
}

bool holds_number(const CsvRecord& record) {
  return !record.comment && std::any_of(record.fields.begin(), record.fields.end(), is_number_field);
}

bool is_row(const CsvRecord& record) {
  return !record.comment &&
         (holds_number(record) || std::all_of(record.fields.begin(), record.fields.end(),
                                              [](const std::string& field) { return is_missing(field); }));
}

bool is_words(const CsvRecord& record) { return !record.comment && !is_row(record); }

std::string statistic_of(const CsvRecord& record) {
  static const std::set<std::string> names{
      "average", "avg",      "mean",    "median", "max",      "maximum",    "min",    "minimum",
      "sd",      "std",      "stdev",   "stddev", "standard", "sum",        "total",  "count",
      "range",   "rms",      "cv",      "rsd",    "stdabw",   "mittelwert", "mittel", "standardabweichung",
      "varianz", "variance", "moyenne", "media",  "ecart",    "se",         "sem",    "summe",
      "anzahl"};
  const auto first = std::find_if(record.fields.begin(), record.fields.end(), [](const auto& f) { return !f.empty(); });
  if (record.comment || first == record.fields.end()) return "";
  return names.contains(lower_case(first->substr(0, first->find_first_of(" .:_-(")))) ? *first : "";
}

bool is_measurement(const CsvRecord& record) {
  std::size_t numbers = 0, words = 0;
  bool number_first = false;
  for (const std::string& field : record.fields) {
    if (field.empty()) continue;
    const bool number = is_number_field(field);
    if (numbers + words == 0) number_first = number || (field.front() >= '0' && field.front() <= '9');
    ++(number ? numbers : words);
  }
  return !record.comment && ((number_first && numbers >= 2) || (words <= 1 && numbers >= 3));
}

std::size_t without_trailing(const Texts& fields) {
  std::size_t count = fields.size();
  while (count > 0 && fields[count - 1].empty()) --count;
  return count;
}

}  // namespace data
