// The run table as CSV, in the study's units:
//   friction,cohesion,speed,torque[,torque_se,material,seed,settings,isa,origin,cpu_seconds,state,unreliable]
// SI numbers go through the unit and back without losing a bit: v = (si - offset) / factor is taken to long double,
// written with as few digits as read back to the same `si`, and read in long double again. Our own files state their
// number of rows in the head ("# rows: 80"), so that one that was cut off is found out.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>

#include "data/atomic_file.hpp"
#include "data/csv.hpp"
#include "data/error.hpp"
#include "data/provenance.hpp"
#include "data/run_table_files.hpp"
#include "data/steadiness.hpp"
#include "data/study_parts.hpp"

namespace data {
namespace {

std::string text_of(double si, const Unit& unit) { return std::isfinite(si) ? unit.digits(si) : shortest(si); }

template <class Integer>
Integer whole_number(const Csv& csv, const CsvRow& row, std::size_t column) {
  const std::string& field = row.fields[column];
  Integer value = 0;
  if (field.empty()) return value;
  const auto [rest, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc{} || rest != field.data() + field.size()) {
    throw InputError(ExitStatus::bad_data,
                     Problem{csv.place(row, column), fmt::format("'{}' is not a whole number", field),
                             "write a whole number from 0"});
  }
  return value;
}

/// Throws when the head states another number of rows than there are.
void check_whole(const Csv& csv, const std::string& text) {
  for (const std::string& comment : csv.comments) {
    if (comment.rfind("rows: ", 0) != 0) continue;
    const std::string stated = comment.substr(6);
    if (stated != std::to_string(csv.rows.size()) || text.back() != '\n') {
      throw InputError(
          ExitStatus::bad_data,
          Problem{fmt::format("{}:{}", csv.file, csv.rows.empty() ? csv.header_line : csv.rows.back().line),
                  fmt::format("the file ends here after {} rows, but its head states {}", csv.rows.size(), stated),
                  "it was cut off: make it again (or, after editing by hand, correct the line '# rows:')"});
    }
  }
}

struct Columns {
  std::vector<std::size_t> inputs, outputs;
  std::vector<std::optional<std::size_t>> errors;  ///< none: nobody stated them, and 0 stands for it
  std::optional<std::size_t> material, seed, settings, isa, origin, cpu_seconds, state, unreliable;
  std::vector<std::size_t> status;  ///< columns that say how a run ended
  std::vector<std::size_t> unread;  ///< columns that nobody asks for
};

/// Another code's column `state` says something else.
bool says_steadiness(const Csv& csv, std::size_t column) {
  return std::all_of(csv.rows.begin(), csv.rows.end(), [column](const CsvRow& row) {
    const std::string& state = row.fields[column];
    return state.empty() || from_text<FlowState>(state);
  });
}

/// Whether the table has the column of an output's standard errors, or should: one of our own, or one that has another
/// word for an error there, which may be a standard deviation.
bool has_errors(const Csv& csv, const std::string& output) {
  constexpr std::array words = {"se",  "sd",    "std",   "stdev", "sem",        "stderr",
                                "err", "error", "sigma", "unc",   "uncertainty"};
  return csv.find("settings").has_value() || std::any_of(words.begin(), words.end(), [&](const char* word) {
           return csv.find(output + "_" + word, Csv::Capitals::any).has_value();
         });
}

bool is_empty(const Csv& csv, std::size_t column) {
  return std::all_of(csv.rows.begin(), csv.rows.end(),
                     [column](const CsvRow& row) { return trimmed(row.fields[column]).empty(); });
}

Columns find_columns(const Csv& csv, const RunTable& table, const Study& study) {
  Columns at;
  for (const Column& column : table.parameters) at.inputs.push_back(csv.column(column.name));
  for (const Column& column : table.controls) at.inputs.push_back(csv.column(column.name));
  for (const Column& column : table.outputs) {
    at.outputs.push_back(csv.column(column.name));
    std::optional<std::size_t> errors;
    if (has_errors(csv, column.name)) errors = csv.column(column.name + "_se");
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
  for (std::size_t i = 0; i < csv.columns.size(); ++i) {
    if (read.contains(i) || reserved_columns().contains(csv.columns[i]) || i == at.state || i == at.unreliable)
      continue;
    (is_status_column(csv.columns[i]) ? at.status : at.unread).push_back(i);
  }
  return at;
}

/// The contents of an unread column in words: "fill (from 200 to 300)", "note (text)".
std::string contents(const Csv& csv, std::size_t column) {
  double low = HUGE_VAL, high = -HUGE_VAL;
  for (const CsvRow& row : csv.rows) {
    const std::string& field = row.fields[column];
    double value = 0.0;
    const auto [rest, error] = std::from_chars(field.data(), field.data() + field.size(), value);
    if (field.empty() || error != std::errc{} || rest != field.data() + field.size())
      return csv.columns[column] + " (text)";
    low = std::min(low, value);
    high = std::max(high, value);
  }
  return low == high ? fmt::format("{} ({:.5g} everywhere)", csv.columns[column], low)
                     : fmt::format("{} (from {:.5g} to {:.5g})", csv.columns[column], low, high);
}

/// Names the columns that do not enter, and what those of other codes' names do.
void tell_columns(const Csv& csv, const Columns& at, TableRead& result) {
  const std::string place = fmt::format("{}:{}", csv.file, csv.header_line);
  std::vector<std::string> without;
  for (std::size_t i = 0; i < at.errors.size(); ++i)
    if (!at.errors[i]) without.push_back(result.table.outputs[i].name + "_se");
  if (!without.empty())
    result.findings.push_back(
        {.kind = FindingKind::zero_standard_error,
         .place = place,
         .severity = Severity::note,
         .what = fmt::format("has no {}: the runs' scatter is estimated", fmt::join(without, ", ")),
         .remedy = "where the code states standard errors, give their column that name",
         .places = {}});
  if (!at.unread.empty()) {
    std::vector<std::string> names;
    for (const std::size_t column : at.unread) names.push_back(contents(csv, column));
    result.findings.push_back(
        {.kind = FindingKind::unread_columns,
         .place = place,
         .severity = Severity::note,
         .what =
             fmt::format("nothing reads the {} {}", names.size() == 1 ? "column" : "columns", fmt::join(names, ", ")),
         .remedy = "an input among them belongs under [parameters] or [controls], an output under [outputs]"});
  }
  // Our own tables have settings; a seed beside none is another code's.
  if (at.seed && !at.settings)
    result.findings.push_back({.kind = FindingKind::seed_column,
                               .place = place,
                               .severity = Severity::note,
                               .what = "the column seed is kept with the run and is no input; rows of one point are "
                                       "replicates, whatever it says",
                               .remedy = ""});
}

/// Rows whose own columns say that they are not to be learnt from.
void tell_failures(TableRead& result) {
  for (const bool asked : {true, false}) {
    std::vector<std::string> places;
    std::string example;
    for (const RunRow& row : result.table.rows) {
      if (!row.left_out || (row.left_out.because == LeftOut::Because::its_column_says_so) != asked) continue;
      if (places.empty()) example = row.left_out.words;
      places.push_back(row.place);
    }
    if (places.empty()) continue;
    result.findings.push_back(
        {.kind = asked ? FindingKind::rows_left_out : FindingKind::failed_runs,
         .place = list_places(places),
         .severity = asked ? Severity::note : Severity::warning,
         .what = fmt::format("{} {} left out: {}", places.size(), places.size() == 1 ? "row is" : "rows are", example),
         .remedy = asked ? "" : "remove the rows, or name them in [training] leave_out",
         .places = places});
  }
}

/// Whether a status column, or a column by which the user chooses rows, leaves the row out.
LeftOut left_out_by_its_columns(const Csv& csv, const CsvRow& row, const Columns& at) {
  for (const std::size_t column : at.status) {
    if (!says_failed(csv.columns[column], row.fields[column])) continue;
    const bool chosen = is_user_column(csv.columns[column]);
    return {chosen ? LeftOut::Because::its_column_says_so : LeftOut::Because::it_failed,
            fmt::format("{} {} says '{}'", chosen ? "its own column" : "the column", csv.columns[column],
                        row.fields[column])};
  }
  return {};
}

std::string read_material(const Csv& csv, const CsvRow& row, const std::optional<std::size_t>& column,
                          const Study& study) {
  if (!column) return study.materials.empty() ? "" : study.materials.front().name;
  const std::string& name = row.fields[*column];
  std::vector<std::string> names;
  for (const Material& material : study.materials) {
    if (material.name == name) return name;
    names.push_back(material.name);
  }
  throw InputError(ExitStatus::bad_data,
                   Problem{csv.place(row, *column), fmt::format("'{}' is not a material of the study", name),
                           fmt::format("the study has '{}'", fmt::join(names, "', '"))});
}

/// Notes about single rows. Rows with the same note share a line where they are many.
class RowNotes {
 public:
  explicit RowNotes(const Csv& csv) : csv_(csv) {}

  /// "is empty, the row is left out" of a field; `what` names the one row, `whats` several.
  void add(const CsvRow& row, std::size_t column, const char* what, const char* whats) {
    const std::string& field = row.fields[column];
    const std::string found = field.empty()                                  ? "is empty"
                              : !is_missing(field) && says_failed("", field) ? "says '" + field + "'"
                                                                             : "is " + field;
    const auto same = std::find_if(notes_.begin(), notes_.end(), [&](const Note& note) {
      return note.column == column && note.found == found && note.what == what;
    });
    Note& note = same != notes_.end() ? *same : notes_.emplace_back(Note{column, found, what, whats, {}});
    note.rows.push_back(&row);
  }

  std::vector<std::string> texts() const {
    constexpr std::size_t few = 3;  // rows of one kind that have a line each
    std::vector<std::string> texts;
    for (const Note& note : notes_) {
      if (note.rows.size() <= few) {
        for (const CsvRow* row : note.rows)
          texts.push_back(fmt::format("{}: {}, {}", csv_.place(*row, note.column), note.found, note.what));
        continue;
      }
      std::vector<std::string> places;
      for (const CsvRow* row : note.rows) places.push_back(fmt::format("{}:{}", csv_.file, row->line));
      texts.push_back(
          fmt::format("{}: {}: {}, {}", list_places(places), csv_.columns[note.column], note.found, note.whats));
    }
    return texts;
  }

 private:
  struct Note {
    std::size_t column;
    std::string found;
    const char *what, *whats;
    std::vector<const CsvRow*> rows;
  };
  const Csv& csv_;
  std::vector<Note> notes_;
};

/// Whether a result is there. Some codes write in its place that the run failed.
bool has_number(const Csv& csv, const CsvRow& row, std::size_t column) {
  return !says_failed("", row.fields[column]) && std::isfinite(csv.number(row, column));
}

/// Columns of a row in which a number is missing or not finite.
struct Missing {
  std::optional<std::size_t> input;  ///< the first: the row is of no use
  std::vector<std::size_t> outputs;  ///< value or standard error, one per output: the row lacks these
};

Missing not_finite(const Csv& csv, const CsvRow& row, const Columns& at) {
  Missing missing;
  for (const std::size_t column : at.inputs)
    if (!missing.input && !std::isfinite(csv.number(row, column))) missing.input = column;
  for (std::size_t i = 0; i < at.outputs.size(); ++i) {
    if (!has_number(csv, row, at.outputs[i])) {
      missing.outputs.push_back(at.outputs[i]);
    } else if (at.errors[i] && !has_number(csv, row, *at.errors[i])) {
      missing.outputs.push_back(*at.errors[i]);
    }
  }
  return missing;
}

}  // namespace

TableRead read_table_csv(const std::string& path, const Study& study) {
  const std::string text = read_file(path);
  const Csv csv = parse_csv(text, shown_path(path));
  check_whole(csv, text);
  TableRead result{.table = empty_table(study)};
  RunTable& table = result.table;
  const Columns at = find_columns(csv, table, study);
  const std::string file_name = std::filesystem::path(path).filename().string();

  std::vector<Unit> input_units, output_units, error_units;
  for (const std::vector<Column>* columns : {&table.parameters, &table.controls})
    for (const Column& column : *columns) input_units.push_back(csv.unit(at.inputs[input_units.size()], column.unit));
  for (std::size_t i = 0; i < table.outputs.size(); ++i) {
    output_units.push_back(csv.unit(at.outputs[i], table.outputs[i].unit));
    error_units.push_back(
        (at.errors[i] ? csv.unit(*at.errors[i], output_units.back()) : output_units.back()).differences());
  }
  tell_columns(csv, at, result);
  RowNotes notes(csv);
  const std::vector<Input> inputs = inputs_of(study);
  for (const CsvRow& line : csv.rows) {
    const Missing missing = not_finite(csv, line, at);
    std::size_t no_logarithm = at.inputs.size();
    for (std::size_t i = at.inputs.size(); i-- > 0;)
      if (inputs[i].axis.scale == Scale::log && csv.number(line, at.inputs[i]) <= 0.0) no_logarithm = i;
    if (no_logarithm < at.inputs.size()) {
      notes.add(line, at.inputs[no_logarithm], "which has no logarithm (scale = \"log\"), the row is left out",
                "which has no logarithm (scale = \"log\"), the rows are left out");
      continue;
    }
    // A row of our own without any mean was a run that could not know one. It stays, or a table that is read from its
    // CSV, as its HDF5 is damaged, would lose it.
    const bool ours = at.settings.has_value() && at.state.has_value();
    if (missing.input || (missing.outputs.size() == at.outputs.size() && !ours)) {
      notes.add(line, missing.input ? *missing.input : missing.outputs.front(), "the row is left out",
                "the rows are left out");
      continue;
    }
    for (const std::size_t column : missing.outputs)
      notes.add(line, column, "the row counts for the other outputs only", "the rows count for the other outputs only");
    RunRow row;
    row.material = read_material(csv, line, at.material, study);
    for (std::size_t i = 0; i < at.inputs.size(); ++i)
      row.inputs.push_back(input_units[i].to_si(line.fields[at.inputs[i]]));
    for (std::size_t i = 0; i < at.outputs.size(); ++i) {
      if (!has_number(csv, line, at.outputs[i]) || (at.errors[i] && !has_number(csv, line, *at.errors[i]))) {
        row.outputs.push_back(std::numeric_limits<double>::quiet_NaN());
        row.standard_errors.push_back(std::numeric_limits<double>::quiet_NaN());
        continue;
      }
      row.outputs.push_back(output_units[i].to_si(line.fields[at.outputs[i]]));
      row.standard_errors.push_back(at.errors[i] ? error_units[i].to_si(line.fields[*at.errors[i]]) : 0.0);
      if (row.standard_errors.back() < 0.0) {
        throw InputError(
            ExitStatus::bad_data,
            Problem{csv.place(line, *at.errors[i]), fmt::format("{} is below 0", line.fields[*at.errors[i]]),
                    "give the standard error of the run's mean, or 0 when it has none"});
      }
    }
    if (at.seed) row.seed = whole_number<std::uint64_t>(csv, line, *at.seed);
    if (at.settings) row.settings = line.fields[*at.settings];
    if (at.isa) row.isa = line.fields[*at.isa];
    row.origin = at.origin ? line.fields[*at.origin] : fmt::format("{}:{}", file_name, line.line);
    if (at.cpu_seconds) row.cpu_seconds = csv.number(line, *at.cpu_seconds);
    if (at.state) row.state = line.fields[*at.state];
    if (at.unreliable) row.unreliable = line.fields[*at.unreliable];
    row.place = fmt::format("{}:{}", file_name, line.line);
    row.left_out = left_out_by_its_columns(csv, line, at);
    table.rows.push_back(std::move(row));
  }
  result.left_out = notes.texts();
  tell_failures(result);
  return result;
}

void write_table_csv(const std::string& path, const RunTable& table, const Study& study) {
  std::string text =
      fmt::format("# run table of the study '{}', written by demcal {}\n", study.name, program_version());
  std::string header, units;
  const auto add = [&](const std::string& name, const Unit& unit) {
    header += name + ',';
    units += fmt::format("{}{} [{}]", units.empty() ? "" : ", ", name, unit.symbol.empty() ? "1" : unit.symbol);
  };
  for (const Column& column : table.parameters) add(column.name, column.unit);
  for (const Column& column : table.controls) add(column.name, column.unit);
  for (const Column& column : table.outputs) {
    add(column.name, column.unit);
    header += column.name + "_se,";
  }
  text += fmt::format("# units: {}; NAME_se: the standard error of NAME; cpu_seconds [s]\n# rows: {}\n", units,
                      table.rows.size());
  text += header + "material,seed,settings,isa,origin,cpu_seconds,state,unreliable\n";
  for (const RunRow& row : table.rows) {
    for (std::size_t i = 0; i < row.inputs.size(); ++i) {
      const bool parameter = i < table.parameters.size();
      const Column& column = parameter ? table.parameters[i] : table.controls.at(i - table.parameters.size());
      text += text_of(row.inputs[i], column.unit) + ',';
    }
    for (std::size_t i = 0; i < row.outputs.size(); ++i) {
      const Unit& unit = table.outputs.at(i).unit;
      text += text_of(row.outputs[i], unit) + ',';
      text += text_of(row.standard_errors.at(i), unit.differences()) + ',';
    }
    text += fmt::format("{},{},{},{},{},{},{},{}\n", csv_field(row.material), row.seed, csv_field(row.settings),
                        csv_field(row.isa), csv_field(row.origin), shortest(row.cpu_seconds), csv_field(row.state),
                        csv_field(row.unreliable));
  }
  write_atomically(path, text);
}

}  // namespace data
