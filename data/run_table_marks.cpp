// Rows of a run table that are not learnt from: those that the user names, those that say themselves that the run
// failed, and copies. They keep their place in the table, so that files and lines stay as they are.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include "data/copies.hpp"
#include "data/number_text.hpp"
#include "data/run_table_files.hpp"
#include "data/time_series.hpp"

namespace data {
namespace {

template <std::size_t N>
bool one_of(const std::string& text, const std::array<const char*, N>& words) {
  return std::find(words.begin(), words.end(), text) != words.end();
}

constexpr std::array ended_well{"converged", "ok",        "success",  "successful",
                                "finished",  "completed", "complete", "valid"};
constexpr std::array ended_badly{"failed", "failure", "crashed", "error", "aborted", "diverged"};
constexpr std::array state_columns{"status", "state", "result", "outcome", "exit", "flag", "remark", "comment", "note"};
constexpr std::array use_columns{"use", "include", "keep"};
constexpr std::array code_columns{"exit code",   "exitcode", "return code", "returncode",
                                  "exit status", "rc",       "error code",  "errorcode"};  // 0: it ended well

/// A heading without capitals, with blanks between its words, and without the word for what has the status:
/// "Run_Status".
std::string plain_heading(std::string_view name) {
  std::string plain = lower_case(trimmed(name));
  std::replace_if(
      plain.begin(), plain.end(), [](char c) { return c == '_' || c == '-' || c == '.'; }, ' ');
  for (const std::string_view of : {"run ", "job ", "case ", "sim ", "simulation ", "dem "})
    if (plain.starts_with(of)) return plain.substr(of.size());
  return plain;
}

std::string file_name(const std::string& path) { return std::filesystem::path(path).filename().string(); }

void leave_out_named(TableRead& read, const Study& study) {
  std::vector<std::string> places;
  for (RunRow& row : read.table.rows)
    for (const std::string& label : study.training.leave_out)
      if (names_row(label, row.place)) {
        row.left_out = {LeftOut::Because::study_says_so, "the study leaves it out"};
        places.push_back(row.place);
        break;
      }
  if (places.empty()) return;
  Finding finding = about_rows(FindingKind::rows_left_out, Severity::note, places);
  finding.what = fmt::format("{} {} left out, as [training] leave_out says", places.size(),
                             places.size() == 1 ? "row is" : "rows are");
  read.findings.push_back(std::move(finding));
}

/// Takes an output out of rows in which it is no result of a run, and says so. A row without any other result is left
/// out. `others`: where the others lie; `kind`: what it is, and left out.
void take_out(TableRead& read, std::size_t output, const std::vector<RunRow*>& rows, const char* because,
              const std::string& value, const std::string& others, const std::string& kind) {
  std::vector<std::string> places;
  for (RunRow* row : rows) {
    places.push_back(row->place);
    row->outputs[output] = NAN;
    row->standard_errors[output] = NAN;
    if (std::none_of(row->outputs.begin(), row->outputs.end(), [](double one) { return std::abs(one) > 0.0; }))
      row->left_out = {LeftOut::Because::it_failed, because};
  }
  Finding finding = about_rows(FindingKind::failed_runs, Severity::warning, places);
  finding.what = fmt::format("{} {} of {} {}, where {}: {}, and left out", rows.size(),
                             rows.size() == 1 ? "row gives a value" : "rows give a value",
                             read.table.outputs[output].name, value, others, kind);
  finding.remedy = "remove them, write nan, or name them in [training] leave_out";
  read.findings.push_back(std::move(finding));
}

/// "4 to 9 mN m", of SI values.
std::string from_to(const Column& column, double low, double high) {
  return fmt::format("{:.4g} to {:.4g}{}", column.unit.from_si(low), column.unit.from_si(high),
                     behind_number(column.unit.symbol));
}

/// Runs that did not want to be: 0 with a standard error of 0, where most others have one above 0.
void leave_out_zeros(TableRead& read) {
  RunTable& table = read.table;
  for (std::size_t k = 0; k < table.outputs.size(); ++k) {
    std::size_t others = 0, with_error = 0;
    std::vector<RunRow*> zeros;
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (RunRow& row : table.rows) {
      if (row.left_out || !std::isfinite(row.outputs[k])) continue;
      if (row.outputs[k] == 0.0 && row.standard_errors[k] == 0.0) {
        zeros.push_back(&row);
        continue;
      }
      ++others;
      with_error += row.standard_errors[k] > 0.0;
      low = std::min(low, row.outputs[k]);
      high = std::max(high, row.outputs[k]);
    }
    if (zeros.empty() || 2 * with_error <= others || zeros.size() > others) continue;
    take_out(read, k, zeros, "0 with a standard error of 0: a run that failed",
             "exactly 0 with a standard error of exactly 0",
             "the others lie from " + from_to(table.outputs[k], low, high), "runs that failed");
  }
}

/// The values of an output in the runs where it is not `value`; SI.
struct OtherRuns {
  std::size_t count = 0;
  double least = HUGE_VAL, largest = 0.0;  ///< magnitudes
  bool positive = true, negative = true;   ///< all of them
  /// Whether all have one sign, and `value` not.
  bool without(double value) const { return (positive && value <= 0.0) || (negative && value >= 0.0); }
};

OtherRuns runs_beside(const RunTable& table, std::size_t output, double value) {
  OtherRuns others;
  for (const RunRow& row : table.rows) {
    const double one = row.outputs[output];
    if (row.left_out || !std::isfinite(one) || one == value) continue;
    ++others.count;
    others.least = std::min(others.least, std::abs(one));
    others.largest = std::max(others.largest, std::abs(one));
    others.positive = others.positive && one > 0.0;
    others.negative = others.negative && one < 0.0;
  }
  return others;
}

/// Whether an input parts these rows from all others that are learnt from: then what they give is the model's.
bool are_apart(const RunTable& table, const std::vector<RunRow*>& rows) {
  const std::set<const RunRow*> these(rows.begin(), rows.end());
  for (std::size_t i = 0; i < rows.front()->inputs.size(); ++i) {
    double low[2] = {HUGE_VAL, HUGE_VAL}, high[2] = {-HUGE_VAL, -HUGE_VAL};
    for (const RunRow& row : table.rows) {
      if (row.left_out) continue;
      const std::size_t side = these.contains(&row) ? 0 : 1;
      low[side] = std::min(low[side], row.inputs[i]);
      high[side] = std::max(high[side], row.inputs[i]);
    }
    if (high[0] < low[1] || high[1] < low[0]) return true;
  }
  return false;
}

/// Runs that wrote one number in the place of a result: far beyond all others (1e30, 9999), or exactly 0 or of the
/// other sign (-1) where all others lie well away from 0.
void leave_out_stand_ins(TableRead& read) {
  constexpr std::size_t several = 3;                       // equal to the last digit, at different inputs
  constexpr double far = 10.0, absurd = 1e6, away = 0.05;  // of the largest of the others
  RunTable& table = read.table;
  for (std::size_t k = 0; k < table.outputs.size(); ++k) {
    std::map<double, std::vector<RunRow*>> rows_of;
    std::vector<double> sizes;
    for (RunRow& row : table.rows)
      if (!row.left_out && std::isfinite(row.outputs[k])) {
        rows_of[row.outputs[k]].push_back(&row);
        sizes.push_back(std::abs(row.outputs[k]));
      }
    const double typical = median_of(std::move(sizes));
    for (auto& [value, rows] : rows_of) {
      // Few values are looked at beside all others: those that many rows have, and the least and the largest.
      const bool extreme = value == rows_of.begin()->first || value == rows_of.rbegin()->first;
      const bool within = std::abs(value) <= far * typical;
      if ((rows.size() < several && (!extreme || within)) || (within && value != 0.0 && !extreme)) continue;
      const OtherRuns others = runs_beside(table, k, value);
      if (others.count < several || rows.size() > others.count) continue;
      const bool beyond = std::abs(value) > (rows.size() < several ? absurd : far) * others.largest;
      const bool nothing = rows.size() >= several && others.without(value) && others.least > away * others.largest &&
                           !are_apart(table, rows);
      std::set<std::vector<double>> points;
      for (const RunRow* row : rows) points.insert(row->inputs);
      if (!(beyond || nothing) || (rows.size() >= several && points.size() < several)) continue;
      take_out(read, k, rows, "one number in the place of a result: a run that failed",
               fmt::format("{:.6g}", table.outputs[k].unit.from_si(value)),
               "the magnitudes of the others lie from " + from_to(table.outputs[k], others.least, others.largest),
               "no result of a run");
    }
  }
}

void leave_out_copies(TableRead& read) {
  RunTable& table = read.table;
  std::vector<RepeatableRow> rows;
  std::vector<std::size_t> index;
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const RunRow& row = table.rows[i];
    if (row.left_out) continue;
    RepeatableRow one{.at = row.inputs, .values = {}, .errors = {}};
    const auto material = std::find_if(table.rows.begin(), table.rows.end(),
                                       [&](const RunRow& other) { return other.material == row.material; });
    one.at.push_back(static_cast<double>(material - table.rows.begin()));
    for (std::size_t k = 0; k < row.outputs.size(); ++k) {
      one.values.push_back(table.outputs[k].unit.from_si(row.outputs[k]));
      one.errors.push_back(row.standard_errors[k] / table.outputs[k].unit.factor);
    }
    rows.push_back(std::move(one));
    index.push_back(i);
  }
  const auto copies = copies_of(rows);
  std::vector<std::string> places;
  std::string example;
  bool noisy = false;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!copies[i]) continue;
    RunRow& row = table.rows[index[i]];
    const RunRow& source = table.rows[index[*copies[i]]];
    row.left_out = {LeftOut::Because::it_is_a_copy, "a copy of " + source.place};
    noisy =
        noisy || std::any_of(row.standard_errors.begin(), row.standard_errors.end(), [](double e) { return e > 0.0; });
    if (places.empty()) example = fmt::format("{} of {}", row.place, source.place);
    places.push_back(row.place);
  }
  if (places.empty()) return;
  Finding finding = about_rows(FindingKind::copied_rows, noisy ? Severity::warning : Severity::note, places);
  finding.what = fmt::format("{} of {} runs are copies of others to the last digit ({}): each is counted once",
                             places.size(), rows.size(), example);
  finding.remedy = "remove the copies; a replicate is a run with another seed, and differs";
  read.findings.push_back(std::move(finding));
}

}  // namespace

bool names_row(const std::string& label, const std::string& place) {
  const std::string name = file_name(place);
  const bool has_file = label.find(':') != std::string::npos;
  return has_file ? file_name(label) == name : name.substr(name.rfind(':') + 1) == label;
}

bool is_status_column(std::string_view name) {
  const std::string plain = plain_heading(name);
  return one_of(plain, ended_well) || one_of(plain, ended_badly) || one_of(plain, state_columns) ||
         one_of(plain, use_columns) || one_of(plain, code_columns);
}

bool is_user_column(std::string_view name) { return one_of(lower_case(name), use_columns); }

bool says_failed(std::string_view column, std::string_view field) {
  const std::string name = plain_heading(column), word = lower_case(trimmed(field));
  static constexpr std::array no{"0", "no", "false", "n", "none"};
  static constexpr std::array yes{"1", "yes", "true", "y", "x"};
  if (one_of(name, ended_well) || one_of(name, use_columns)) return one_of(word, no) || word == "0.0";
  if (one_of(name, ended_badly) && one_of(word, yes)) return true;
  if (one_of(name, code_columns))
    if (const auto code = number_with_unit(word); code && code->unit.empty()) return code->value != 0.0;
  static constexpr std::array parts{"fail",          "crash",       "abort",      "diverg",    "unstable",
                                    "timeout",       "timed out",   "killed",     "explod",    "invalid",
                                    "not converged", "unconverged", "incomplete", "unfinished"};
  // As whole words alone: "0 particles lost" is no failure.
  static constexpr std::array whole{"error", "bad", "nan", "lost", "lost particles", "particles lost"};
  if (one_of(word, whole)) return true;
  return std::any_of(parts.begin(), parts.end(),
                     [&](const char* part) { return word.find(part) != std::string::npos; });
}

void mark_rows(TableRead& read, const Study& study) {
  leave_out_named(read, study);
  leave_out_zeros(read);
  leave_out_stand_ins(read);
  leave_out_copies(read);
}

}  // namespace data
