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
  double share = 0.0;        ///< of the fields that are numbers, in lines with as many fields as most
  double lines = 0.0;        ///< share of the lines with that many
  std::size_t fields = 1;
};

Fit fit_of(const std::vector<std::string_view>& lines, char separator) {
  std::map<std::size_t, std::size_t> counts;
  std::vector<std::vector<std::string>> split;
  std::vector<bool> comment;
  for (std::string_view line : lines) {
    std::string_view rest;
    comment.push_back(is_comment(line, rest));
    split.push_back(split_line(comment.back() ? rest : line, separator));
    while (split.back().size() > 1 && split.back().back().empty()) split.back().pop_back();  // trailing separators
    if (!comment.back()) ++counts[split.back().size()];
  }
  Fit fit;
  std::size_t most = 0, all = 0;
  for (const auto& [count, times] : counts) {
    all += times;
    if (count > 1 && times >= most) {
      most = times;
      fit.fields = count;
    }
  }
  if (most == 0) return fit;
  fit.lines = static_cast<double>(most) / static_cast<double>(all);
  std::size_t numbers = 0, fields = 0;
  for (std::size_t i = 0; i < split.size(); ++i) {
    if (split[i].size() != fit.fields) continue;
    std::size_t here = 0;
    for (const std::string& field : split[i]) here += numeric(field, separator) ? 1 : 0;
    if (here == 0) fit.has_heading = true;
    if (comment[i] || here == 0) continue;
    numbers += here;
    fields += fit.fields;
  }
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
  const std::size_t signs = text.starts_with("//") ? 2 : !text.empty() && (text[0] == '#' || text[0] == '%') ? 1 : 0;
  if (signs == 0) return false;
  rest = text.substr(signs);
  if (!rest.empty() && rest.front() == ' ') rest.remove_prefix(1);
  return true;
}

std::vector<std::string> split_line(std::string_view line, char separator) {
  std::vector<std::string> fields;
  if (separator == ' ') {
    // What stands in brackets is one with the word before: "torque [N m]".
    std::string field;
    int depth = 0;
    for (const char c : line) {
      if (c == '[' || c == '(') ++depth;
      if ((c == ']' || c == ')') && depth > 0) --depth;
      if (depth == 0 && (c == ' ' || c == '\t')) {
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
  if ((bare.starts_with("sep=") || bare.starts_with("SEP=")) && text.substr(0, end).find("sep=") < 3 &&
      bare.size() <= 5) {
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
    // Blanks stand in names and texts, too: they part columns only where nothing else does.
    const double worth = separator == ' '  ? (fit.share > 0.99 && fit.has_heading && fit.lines > 0.9 ? 0.01 : -1.0)
                         : fit.has_heading ? 1.0 + fit.share
                                           : 0.02 + 0.5 * fit.share * fit.lines;
    if (worth > best) {
      best = worth;
      dialect.separator = separator;
    }
  }
  return dialect;
}

}  // namespace data
