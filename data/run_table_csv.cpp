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
#include <optional>

#include "data/atomic_file.hpp"
#include "data/csv.hpp"
#include "data/error.hpp"
#include "data/number_text.hpp"
#include "data/provenance.hpp"
#include "data/run_table_columns.hpp"
#include "data/run_table_files.hpp"

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
LeftOut left_out_by_its_columns(const Csv& csv, const CsvRow& row, const TableColumns& at) {
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

Missing not_finite(const Csv& csv, const CsvRow& row, const TableColumns& at) {
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

/// Whether the table is one of our own campaigns.
bool is_own(const Csv& csv) { return csv.find("settings") && csv.find("state") && csv.find("unreliable"); }

/// Adds empty columns for outputs that came to the study after the table was written.
void add_lacking(Csv& csv, const std::vector<Column>& outputs) {
  for (const Column& output : outputs) {
    if (csv.find(output.name)) continue;
    for (const std::string& name : {output.name, output.name + "_se"}) {
      csv.columns.push_back(name);
      csv.headings.push_back(name);
      csv.units.emplace_back();
      for (CsvRow& row : csv.rows) row.fields.emplace_back();
    }
  }
}

/// Reads the rows of a table, each in the units of its columns.
class RowReader {
 public:
  RowReader(const Csv& csv, const RunTable& table, const Study& study, std::string file_name)
      : csv_(csv),
        at_(find_columns(csv, table, study)),
        study_(study),
        inputs_(inputs_of(study)),
        file_name_(std::move(file_name)),
        notes_(csv) {
    for (const std::vector<Column>* columns : {&table.parameters, &table.controls})
      for (const Column& column : *columns)
        input_units_.push_back(csv.unit(at_.inputs[input_units_.size()], column.unit));
    for (std::size_t i = 0; i < table.outputs.size(); ++i) {
      output_units_.push_back(csv.unit(at_.outputs[i], table.outputs[i].unit));
      error_units_.push_back(
          (at_.errors[i] ? csv.unit(*at_.errors[i], output_units_.back()) : output_units_.back()).differences());
    }
    if (is_own(csv)) find_others();
    std::copy_if(at_.unread.begin(), at_.unread.end(), std::back_inserter(unread_),
                 [&](std::size_t column) { return csv.number_range(column).has_value(); });
  }

  const TableColumns& columns() const { return at_; }
  /// Outputs that the study has no longer, and where they stand with their errors.
  const std::vector<std::pair<Column, std::array<std::size_t, 2>>>& others() const { return others_; }
  /// What is said of rows that are left out, and of those that lack an output.
  std::vector<std::string> notes() const { return notes_.texts(); }

  /// The row; none where it is left out.
  std::optional<RunRow> read(const CsvRow& line) {
    if (!usable(line)) return {};
    RunRow row;
    row.material = read_material(csv_, line, at_.material, study_);
    for (std::size_t i = 0; i < at_.inputs.size(); ++i)
      row.inputs.push_back(input_units_[i].to_si(line.fields[at_.inputs[i]]));
    for (std::size_t i = 0; i < at_.outputs.size(); ++i) {
      const MeanWithError mean = read_mean(line, i);
      row.outputs.push_back(mean.value);
      row.standard_errors.push_back(mean.standard_error);
    }
    if (at_.seed) row.seed = whole_number<std::uint64_t>(csv_, line, *at_.seed);
    if (at_.settings) row.settings = line.fields[*at_.settings];
    if (at_.isa) row.isa = line.fields[*at_.isa];
    row.origin = at_.origin ? line.fields[*at_.origin] : fmt::format("{}:{}", file_name_, line.line);
    if (at_.cpu_seconds) row.cpu_seconds = csv_.number(line, *at_.cpu_seconds);
    if (at_.state) row.state = line.fields[*at_.state];
    if (at_.unreliable) row.unreliable = line.fields[*at_.unreliable];
    for (const auto& [column, at] : others_)
      if (has_number(csv_, line, at[0]) && has_number(csv_, line, at[1]))
        row.others[column.name] = {column.unit.to_si(line.fields[at[0]]),
                                   column.unit.differences().to_si(line.fields[at[1]])};
    for (const std::size_t column : unread_)
      if (const double value = csv_.number_if_any(line, column); std::isfinite(value))
        row.unread[csv_.columns[column]] = value;
    row.place = fmt::format("{}:{}", file_name_, line.line);
    row.left_out = left_out_by_its_columns(csv_, line, at_);
    return row;
  }

 private:
  void find_others() {
    for (const std::size_t column : at_.unread) {
      const std::optional<std::size_t> errors = csv_.find(csv_.columns[column] + "_se");
      const std::optional<Unit> unit = known_unit(csv_.units[column]);
      if (errors && unit) others_.push_back({{csv_.columns[column], *unit}, {column, *errors}});
    }
    std::erase_if(at_.unread, [this](std::size_t column) {
      return std::any_of(others_.begin(), others_.end(),
                         [&](const auto& other) { return other.second[0] == column || other.second[1] == column; });
    });
  }

  /// Whether a row says anything; what it lacks is noted.
  bool usable(const CsvRow& line) {
    const Missing missing = not_finite(csv_, line, at_);
    for (std::size_t i = 0; i < at_.inputs.size(); ++i) {
      if (inputs_[i].axis.scale != Scale::log || !(csv_.number(line, at_.inputs[i]) <= 0.0)) continue;
      notes_.add(line, at_.inputs[i], "which has no logarithm (scale = \"log\"), the row is left out",
                 "which has no logarithm (scale = \"log\"), the rows are left out");
      return false;
    }
    // A row of our own without any mean was a run that could not know one. It stays, or a table that is read from its
    // CSV, as its HDF5 is damaged, would lose it.
    const bool ours = at_.settings.has_value() && at_.state.has_value();
    if (missing.input || (missing.outputs.size() == at_.outputs.size() && !ours)) {
      notes_.add(line, missing.input ? *missing.input : missing.outputs.front(), "the row is left out",
                 "the rows are left out");
      return false;
    }
    for (const std::size_t column : missing.outputs)
      notes_.add(line, column, "the row counts for the other outputs only",
                 "the rows count for the other outputs only");
    return true;
  }

  struct MeanWithError {
    double value, standard_error;  ///< SI; NaN where either is missing
  };
  MeanWithError read_mean(const CsvRow& line, std::size_t output) const {
    const std::size_t column = at_.outputs[output];
    const std::optional<std::size_t> errors = at_.errors[output];
    if (!has_number(csv_, line, column) || (errors && !has_number(csv_, line, *errors)))
      return {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
    const double error = errors ? error_units_[output].to_si(line.fields[*errors]) : 0.0;
    if (error < 0.0)
      throw InputError(ExitStatus::bad_data,
                       Problem{csv_.place(line, *errors), fmt::format("{} is below 0", line.fields[*errors]),
                               "give the standard error of the run's mean, or 0 when it has none"});
    return {output_units_[output].to_si(line.fields[column]), error};
  }

  const Csv& csv_;
  TableColumns at_;
  const Study& study_;
  std::vector<Input> inputs_;
  std::string file_name_;
  std::vector<Unit> input_units_, output_units_, error_units_;
  std::vector<std::pair<Column, std::array<std::size_t, 2>>> others_;
  std::vector<std::size_t> unread_;  // of at_.unread, those of numbers
  RowNotes notes_;
};

}  // namespace

TableRead read_table_csv(const std::string& path, const Study& study) {
  const std::string text = read_file(path);
  Csv csv = parse_csv(text, shown_path(path));
  check_whole(csv, text);
  TableRead result{.table = empty_table(study)};
  if (is_own(csv)) add_lacking(csv, result.table.outputs);
  RowReader reader(csv, result.table, study, std::filesystem::path(path).filename().string());
  result.findings = column_findings(csv, reader.columns(), result.table);
  for (const auto& [column, unused] : reader.others()) result.table.others.push_back(column);
  for (const CsvRow& line : csv.rows)
    if (std::optional<RunRow> row = reader.read(line)) result.table.rows.push_back(*std::move(row));
  result.left_out = reader.notes();
  tell_failures(result);
  return result;
}

void write_table_csv(const std::string& path, const RunTable& table, const Study& study) {
  std::string text =
      fmt::format("# run table of the study '{}', written by demcal {}\n", study.name, program_version());
  std::string header, units;
  const auto add = [&](const std::string& name, const Unit& unit) {
    header += name + ',';
    units += (units.empty() ? "" : ", ") + with_unit(name, unit);
  };
  for (const Column& column : table.parameters) add(column.name, column.unit);
  for (const Column& column : table.controls) add(column.name, column.unit);
  for (const std::vector<Column>* columns : {&table.outputs, &table.others})
    for (const Column& column : *columns) {
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
    for (const Column& column : table.others) {
      const OutputMean mean = kept_mean(row, column);
      text += text_of(mean.value, column.unit) + ',' + text_of(mean.standard_error, column.unit.differences()) + ',';
    }
    text += fmt::format("{},{},{},{},{},{},{},{}\n", csv_field(row.material), row.seed, csv_field(row.settings),
                        csv_field(row.isa), csv_field(row.origin), shortest(row.cpu_seconds), csv_field(row.state),
                        csv_field(row.unreliable));
  }
  write_atomically(path, text);
}

}  // namespace data
