#include "data/csv_dialect.hpp"

#include <algorithm>
#include <map>

#include "data/number_text.hpp"
#include "data/time_text.hpp"

namespace data {
namespace {

constexpr std::size_t looked_at = 300;  // lines of the beginning

std::vector<std::string_view> first_lines(std::string_view text) {
  std::vector<std::string_view> lines;
  while (!text.empty() && lines.size() < looked_at) {
    const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
    if (const std::string_view line = trimmed(text.substr(0, end)); !line.empty()) lines.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return lines;
}

bool numeric(const std::string& field, char separator) {
  return plain_number(field, DecimalMark::point) || (separator != ',' && plain_number(field, DecimalMark::comma)) ||
         read_time(field);
}

/// How well a separator fits.
struct Fit {
  bool has_heading = false;  ///< a line without numbers has as many fields as the table
  double share = 0.0;        ///< share of fields that are numbers, in lines with as many fields as most
  double lines = 0.0;        ///< share of the lines with that many
  std::size_t fields = 1;
  double of_a_kind = 0.0;           ///< share of fields that are what most of their column are, numbers or words
  std::size_t numeric_columns = 0;  ///< columns most of whose fields are numbers
};

struct SplitLine {
  std::vector<std::string> fields;  ///< up to the last one that is not empty
  std::size_t all = 0;              ///< with the empty ones behind
  bool comment = false;
};

std::vector<SplitLine> split_lines(const std::vector<std::string_view>& lines, char separator) {
  std::vector<SplitLine> split;
  for (std::string_view line : lines) {
    std::string_view rest;
    const bool comment = is_comment(line, rest);
    SplitLine one{.fields = split_line(comment ? rest : line, separator), .comment = comment};
    one.all = one.fields.size();
    while (one.fields.size() > 1 && one.fields.back().empty()) one.fields.pop_back();
    split.push_back(std::move(one));
  }
  return split;
}

/// The number of fields that most lines have, beyond one; `times` is in how many.
std::size_t most_common(const std::map<std::size_t, std::size_t>& counts, std::size_t& times) {
  std::size_t common = 1;
  times = 0;
  for (const auto& [count, here] : counts)
    if (count > 1 && here >= times) {
      times = here;
      common = count;
    }
  return common;
}

/// Fields behind the last one that is not empty may be of the table, where its last column is mostly empty, or not.
Fit fit_of(const std::vector<std::string_view>& lines, char separator) {
  const std::vector<SplitLine> split = split_lines(lines, separator);
  std::map<std::size_t, std::size_t> filled, with_empty;
  std::size_t rows = 0, times = 0, ignored = 0;
  for (const SplitLine& line : split)
    if (!line.comment) {
      ++filled[line.fields.size()];
      ++with_empty[line.all];
      ++rows;
    }
  Fit fit;
  fit.fields = most_common(filled, times);
  if (times == 0) return fit;
  const std::size_t wide = std::max(fit.fields, most_common(with_empty, ignored));
  const auto of_table = [&](const SplitLine& line) {
    return line.fields.size() >= fit.fields && line.fields.size() <= wide &&
           (line.fields.size() == fit.fields || line.all == wide);
  };
  std::size_t numbers = 0, fields = 0, matching = 0;
  std::vector<std::size_t> of_column(fit.fields, 0);  // numbers, in lines with some
  std::size_t with_numbers = 0;
  // R names no column of row names, so that its heading has one field fewer.
  const auto is_heading_of_r = [&](const SplitLine& line) {
    return &line == &split.front() && (separator == ' ' || separator == '\t') && line.fields.size() + 1 == fit.fields &&
           std::none_of(line.fields.begin(), line.fields.end(),
                        [&](const auto& one) { return numeric(one, separator); });
  };
  for (const SplitLine& line : split) {
    if (!of_table(line) && !is_heading_of_r(line)) continue;
    matching += line.comment ? 0 : 1;
    std::size_t here = 0;
    for (const std::string& field : line.fields) here += numeric(field, separator) ? 1 : 0;
    if (here == 0) fit.has_heading = true;
    if (line.comment || here == 0) continue;
    numbers += here;
    fields += line.fields.size();
    if (line.fields.size() != fit.fields) continue;
    ++with_numbers;
    for (std::size_t i = 0; i < fit.fields; ++i) of_column[i] += numeric(line.fields[i], separator) ? 1 : 0;
  }
  for (const std::size_t count : of_column) {
    fit.of_a_kind += static_cast<double>(std::max(count, with_numbers - count));
    fit.numeric_columns += 2 * count > with_numbers ? 1 : 0;
  }
  fit.of_a_kind /= static_cast<double>(std::max<std::size_t>(1, with_numbers * fit.fields));
  fit.lines = static_cast<double>(matching) / static_cast<double>(rows);
  if (fields > 0) fit.share = static_cast<double>(numbers) / static_cast<double>(fields);
  return fit;
}

}  // namespace

std::string separator_name(char separator) {
  switch (separator) {
    case ';':
      return "semicolons";
    case '\t':
      return "tabs";
    case '|':
      return "vertical bars";
    case ' ':
      return "blanks";
    default:
      return "";
  }
}

bool is_comment(std::string_view line, std::string_view& rest) {
  const std::string_view text = trimmed(line);
  // A spreadsheet that quotes every cell begins our line of units with a quote; a '%' alone in the first cell is a
  // unit.
  const bool per_cent = text.size() > 1 && text[0] == '%' && text.find_first_of(",;\t|") != 1;
  const std::size_t signs = text.starts_with("//") || text.starts_with("\"# units: ") ? 2
                            : text.starts_with('#') || per_cent                       ? 1
                                                                                      : 0;
  if (signs == 0) return false;
  rest = text.substr(signs);
  if (!rest.empty() && rest.front() == ' ') rest.remove_prefix(1);
  return true;
}

std::vector<std::string> split_line(std::string_view line, char separator) {
  std::vector<std::string> fields;
  if (separator == ' ') {
    // What stands in quotes is one field; what stands in brackets is one with the word before: "torque [N m]".
    std::string field;
    int depth = 0;
    bool quoted = false;
    const bool quotes = std::count(line.begin(), line.end(), '"') % 2 == 0;
    for (const char c : line) {
      if (quotes && c == '"') {
        quoted = !quoted;
        continue;
      }
      if (c == '[' || c == '(') ++depth;
      if ((c == ']' || c == ')') && depth > 0) --depth;
      if (depth == 0 && !quoted && (c == ' ' || c == '\t')) {
        if (!field.empty()) fields.push_back(std::move(field));
        field.clear();
      } else {
        field += c;
      }
    }
    if (!field.empty()) fields.push_back(std::move(field));
    for (std::size_t i = 1; i < fields.size();) {
      if (fields[i].front() == '[' || fields[i].front() == '(') {
        fields[i - 1] += " " + fields[i];
        fields.erase(fields.begin() + static_cast<std::ptrdiff_t>(i));
      } else {
        ++i;
      }
    }
    if (fields.empty()) fields.emplace_back();
    return fields;
  }
  std::string field;
  bool quoted = false;
  for (std::size_t i = 0; i < line.size(); ++i) {
    const char c = line[i];
    if (c == '"') {
      quoted = !quoted;
    } else if (c == separator && !quoted) {
      fields.emplace_back(trimmed(field));
      field.clear();
    } else {
      field += c;
    }
  }
  fields.emplace_back(trimmed(field));
  return fields;
}

Dialect find_dialect(std::string_view text) {
  Dialect dialect;
  const std::size_t end = std::min(text.find_first_of("\r\n"), text.size());
  const std::string_view first = trimmed(text.substr(0, end));
  const std::string_view bare =
      first.starts_with('"') && first.ends_with('"') && first.size() > 1 ? first.substr(1, first.size() - 2) : first;
  if (lower_case(bare.substr(0, 4)) == "sep=" && bare.size() <= 5) {
    // A tab or a blank behind "sep=" was trimmed off.
    const std::size_t equals = text.find('=');
    dialect.separator = equals + 1 < end && text[equals + 1] != '"' ? text[equals + 1] : ',';
    dialect.begin = std::min(end + (text.substr(end, 2) == "\r\n" ? 2 : 1), text.size());
    dialect.first_line = 2;
    return dialect;
  }
  const std::vector<std::string_view> lines = first_lines(text);
  double best = -1.0;
  for (const char separator : {',', ';', '\t', '|', ' '}) {
    const Fit fit = fit_of(lines, separator);
    if (fit.fields < 2) continue;
    // Blanks stand in names and texts, too: they part columns only where nothing else does, of numbers, or below a
    // heading of numbers and words (a run's name, a status).
    const bool table = fit.share > 0.99 || (fit.has_heading && fit.numeric_columns > 1 && fit.of_a_kind > 0.97);
    // A separator that stands in a few remarks parts few lines.
    const double worth = separator == ' '  ? (!table || fit.lines <= 0.9 ? -1.0
                                              : fit.has_heading          ? 0.01
                                                                         : 0.005)
                         : fit.has_heading ? 1.0 + fit.share + fit.lines
                                           : 0.02 + 0.5 * fit.share * fit.lines;
    if (worth > best) {
      best = worth;
      dialect.separator = separator;
    }
  }
  return dialect;
}

}  // namespace data
