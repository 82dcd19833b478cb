#include "data/csv_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "data/error.hpp"

namespace data {
namespace {

/// "line 2" or "lines 2, 3, 4", of a long list the first ones.
std::string some_lines(const std::vector<int>& lines) {
  constexpr std::size_t shown = 6;
  const auto end = lines.begin() + static_cast<std::ptrdiff_t>(std::min(lines.size(), shown));
  return fmt::format("line{} {}{}", lines.size() > 1 ? "s" : "", fmt::join(lines.begin(), end, ", "),
                     lines.size() > shown ? ", ..." : "");
}

/// Lines that hold numbers and belong to no block, above the first heading or from there on.
std::vector<int> numbers_left_out(const CsvTable& table, bool above) {
  std::vector<int> lines;
  std::size_t from = above ? 0 : table.blocks.front().first;
  for (const CsvBlock& block : table.blocks) {
    const std::size_t to = above ? block.heading : block.first;
    for (; from < to; ++from)
      if (holds_number(table.records[from])) lines.push_back(table.records[from].line);
    if (above) return lines;
    from = block.end;
  }
  for (; from < table.records.size(); ++from)
    if (holds_number(table.records[from]) && statistic_of(table.records[from]).empty())
      lines.push_back(table.records[from].line);
  return lines;
}

std::size_t measurements_in(const CsvTable& table, std::size_t from, std::size_t to) {
  return static_cast<std::size_t>(std::count_if(table.records.begin() + static_cast<std::ptrdiff_t>(from),
                                                table.records.begin() + static_cast<std::ptrdiff_t>(to),
                                                is_measurement));
}

/// Another table than the one that is read must not be lost: measurements below another heading, or above the first.
/// A preamble may hold a line of numbers that is narrower than the table's rows, and names with values.
void refuse_other_tables(const CsvTable& table, const std::vector<CsvBlock>& others, std::size_t first_heading) {
  const CsvBlock& main = table.blocks.front();
  std::size_t rows = 0;
  for (const CsvBlock& block : table.blocks) rows += block.rows;
  for (const CsvBlock& other : others) {
    const bool below = other.line > main.line && other.headings.size() > 2;
    const std::size_t lost = std::max(measurements_in(table, other.first, other.end), below ? other.rows : 0);
    if (lost > 1 || (lost == 1 && other.headings.size() == main.headings.size()))
      refuse_data(fmt::format("{}:{}", table.csv.file, other.line),
                  fmt::format("a heading with {} rows ({}) is another than that of line {} with {} rows ({})", lost,
                              fmt::join(other.headings, ", "), main.line, rows, fmt::join(main.headings, ", ")),
                  "name the columns alike in both, in one order, or put each table into a file of its own");
  }
  std::vector<const CsvRecord*> bare;
  for (std::size_t i = 0; i < first_heading; ++i)
    if (is_measurement(table.records[i]) && table.records[i].fields.size() == main.headings.size())
      bare.push_back(&table.records[i]);
  if (bare.size() > 1)
    refuse_data(table.line(*bare.front()),
                fmt::format("there are numbers where the header line belongs, in {} lines above the heading of line {}",
                            bare.size(), main.line),
                "the first line names the columns");
}

void say_headings(CsvTable& table, bool units) {
  const CsvBlock& first = table.blocks.front();
  std::vector<std::string>& took = table.csv.took;
  const bool preamble =
      std::any_of(table.records.begin(), table.records.begin() + static_cast<std::ptrdiff_t>(first.heading),
                  [](const CsvRecord& record) { return !record.comment; });
  const std::vector<int> above = numbers_left_out(table, true), below = numbers_left_out(table, false);
  if (first.in_comment) took.push_back(fmt::format("the heading in the comment of line {}", first.line));
  if (preamble)
    took.push_back(fmt::format("the heading in line {}, below a preamble{}", first.line,
                               above.empty() ? "" : fmt::format(" (numbers in {} left out)", some_lines(above))));
  if (units) took.push_back(fmt::format("units in line {}", first.units_line));
  std::vector<int> again;
  for (std::size_t k = 1; k < table.blocks.size(); ++k) again.push_back(table.blocks[k].line);
  if (!again.empty()) took.push_back(fmt::format("the heading again in {}: the rows joined", some_lines(again)));
  if (!below.empty())
    took.push_back(fmt::format("numbers in {}, which are no rows of the table, left out", some_lines(below)));
}

/// A heading without rows: the first line of words, if no numbers stand above it.
void use_bare_heading(CsvTable& table) {
  const auto words = std::find_if(table.records.begin(), table.records.end(), is_words);
  const auto row = std::find_if(table.records.begin(), table.records.end(), is_row);
  if (words == table.records.end() && row == table.records.end())
    refuse_data(table.csv.file, "is empty: there is no header line", "the first line names the columns");
  if (words == table.records.end() || row < words)
    refuse_data(table.line(*row), "there are numbers where the header line belongs",
                "the first line names the columns");
  CsvBlock block{.headings = words->fields, .line = words->line};
  block.headings.resize(without_trailing(block.headings));
  block.heading = static_cast<std::size_t>(words - table.records.begin());
  block.first = block.heading + 1;
  block.end = table.records.size();
  table.blocks = {block};
}

}  // namespace

/// The blocks with the columns of the longest one. A preamble's names with values, however many, are no measurements.
void find_table(CsvTable& table) {
  std::vector<CsvBlock> all = find_blocks(table.records, table.dialect.separator), others;
  if (all.empty()) {
    use_bare_heading(table);
  } else {
    const auto weight = [&](const CsvBlock& block) {
      return std::pair(measurements_in(table, block.first, block.end), block.rows);
    };
    const auto longest = std::max_element(all.begin(), all.end(),
                                          [&](const CsvBlock& a, const CsvBlock& b) { return weight(a) < weight(b); });
    const std::vector<std::string> headings = longest->headings;
    for (CsvBlock& block : all)
      (same_columns(block.headings, headings) ? table.blocks : others).push_back(std::move(block));
    refuse_other_tables(table, others, std::min(all.front().heading, table.blocks.front().heading));
  }
  const CsvBlock& first = table.blocks.front();
  table.csv.header_line = first.line;
  table.csv.headings = first.headings;
  table.csv.units = first.units;
  say_headings(table, first.units_line > 0);
}

std::vector<std::string> comments_above(const CsvTable& table, std::size_t from, const CsvBlock& block) {
  std::vector<std::string> comments;
  for (std::size_t i = from; i < block.first; ++i)
    if (table.records[i].comment && table.records[i].line != block.line)
      comments.push_back(table.records[i].fields.front());
  return comments;
}

}  // namespace data
