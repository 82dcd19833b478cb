#include "data/run_table_columns.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <set>
#include <string>

#include "data/number_text.hpp"
#include "data/run_table_files.hpp"
#include "data/steadiness.hpp"
#include "data/study_parts.hpp"

namespace data {
namespace {

/// Another code's column `state` says something else.
bool says_steadiness(const Csv& csv, std::size_t column) {
  return std::all_of(csv.rows.begin(), csv.rows.end(), [column](const CsvRow& row) {
    const std::string& state = row.fields[column];
    return state.empty() || from_text<FlowState>(state);
  });
}

/// The first of the columns OUTPUT_WORD that is there.
template <std::size_t n>
std::optional<std::size_t> beside(const Csv& csv, const std::string& output, const std::array<const char*, n>& words) {
  for (const char* word : words)
    if (const auto column = csv.find(output + "_" + word, Csv::Capitals::any)) return column;
  return {};
}

/// The column of an output's standard errors; an own table without one is damaged, and another's has none.
std::optional<std::size_t> errors_of(const Csv& csv, const std::string& output) {
  if (csv.find("settings")) return csv.column(output + "_se");
  return beside(csv, output, std::array{"se", "sem", "stderr", "standard_error", "std_error"});
}

/// A column that may be an output's standard errors, or the standard deviations of its samples.
std::optional<std::size_t> doubtful_errors_of(const Csv& csv, const std::string& output) {
  return beside(csv, output, std::array{"sd", "std", "stdev", "err", "error", "sigma", "unc", "uncertainty"});
}

bool is_empty(const Csv& csv, std::size_t column) {
  return std::all_of(csv.rows.begin(), csv.rows.end(),
                     [column](const CsvRow& row) { return trimmed(row.fields[column]).empty(); });
}

}  // namespace

TableColumns find_columns(const Csv& csv, const RunTable& table, const Study& study) {
  TableColumns at;
  for (const Column& column : table.parameters) at.inputs.push_back(csv.column(column.name));
  for (const Column& column : table.controls) at.inputs.push_back(csv.column(column.name));
  for (const Column& column : table.outputs) {
    at.outputs.push_back(csv.column(column.name));
    std::optional<std::size_t> errors = errors_of(csv, column.name);
    if (errors && is_empty(csv, *errors)) errors.reset();
    at.errors.push_back(errors);
  }
  at.material = study.materials.size() > 1 ? csv.column("material") : csv.find("material");
  at.seed = csv.find("seed");
  at.settings = csv.find("settings");
  at.isa = csv.find("isa");
  at.origin = csv.find("origin");
  at.cpu_seconds = csv.find("cpu_seconds");
  if (const auto column = csv.find("state"); column && says_steadiness(csv, *column)) {
    at.state = column;
    at.unreliable = csv.find("unreliable");
  }
  std::set<std::size_t> read(at.inputs.begin(), at.inputs.end());
  read.insert(at.outputs.begin(), at.outputs.end());
  for (const auto& error : at.errors)
    if (error) read.insert(*error);
  if (at.material) read.insert(*at.material);
  for (std::size_t i = 0; i < csv.columns.size(); ++i) {
    if (read.contains(i) || reserved_columns().contains(csv.columns[i]) || i == at.state || i == at.unreliable)
      continue;
    (is_status_column(csv.columns[i]) ? at.status : at.unread).push_back(i);
  }
  return at;
}

std::vector<Finding> column_findings(const Csv& csv, const TableColumns& at, const RunTable& table) {
  std::vector<Finding> findings;
  const std::string place = fmt::format("{}:{}", csv.file, csv.header_line);
  std::vector<std::string> without, doubtful;
  for (std::size_t i = 0; i < at.errors.size(); ++i) {
    if (at.errors[i]) continue;
    without.push_back(table.outputs[i].name + "_se");
    if (const auto column = doubtful_errors_of(csv, table.outputs[i].name)) doubtful.push_back(csv.columns[*column]);
  }
  if (!without.empty())
    findings.push_back(
        {.kind = FindingKind::zero_standard_error,
         .place = place,
         .severity = Severity::note,
         .what = fmt::format("has no {}: the runs' scatter is estimated{}", fmt::join(without, ", "),
                             doubtful.empty()
                                 ? ""
                                 : fmt::format(" ({} may be standard deviations, and {} not read)",
                                               fmt::join(doubtful, " and "), doubtful.size() == 1 ? "is" : "are")),
         .remedy = doubtful.empty() ? "where the code states standard errors, give their column that name"
                                    : "where they are the standard errors of the runs' means, give them that name",
         .places = {}});
  if (!at.unread.empty()) {
    std::vector<std::string> names;
    for (const std::size_t column : at.unread) names.push_back(column_in_words(csv, column));
    findings.push_back(
        {.kind = FindingKind::unread_columns,
         .place = place,
         .severity = Severity::note,
         .what =
             fmt::format("nothing reads the {} {}", names.size() == 1 ? "column" : "columns", fmt::join(names, ", ")),
         .remedy = "an input among them belongs under [parameters] or [controls], an output under [outputs]"});
  }
  // Our own tables have settings; a seed beside none is another code's.
  if (at.seed && !at.settings)
    findings.push_back({.kind = FindingKind::seed_column,
                        .place = place,
                        .severity = Severity::note,
                        .what = "the column seed is kept with the run and is no input; rows of one point are "
                                "replicates, whatever it says",
                        .remedy = ""});
  return findings;
}

}  // namespace data
