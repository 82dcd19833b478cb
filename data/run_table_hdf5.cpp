// training.h5: one dataset per column, SI.
//   /                 attributes format, version, demcal, study, rows, complete (set last)
//   /parameters/NAME  /controls/NAME  /outputs/NAME  /standard_errors/NAME   attributes "SI unit", "study unit"
//   /runs/            material, seed, settings, isa, origin, cpu_seconds, state, unreliable
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "data/atomic_file.hpp"
#include "data/error.hpp"
#include "data/hdf5.hpp"
#include "data/provenance.hpp"
#include "data/run_table_files.hpp"

namespace data {
namespace {

constexpr const char* format_name = "demcal run table";

/// A column's numbers, one per row.
template <class Value>
std::vector<double> column_of(const RunTable& table, Value value) {
  std::vector<double> numbers;
  numbers.reserve(table.rows.size());
  for (const RunRow& row : table.rows) numbers.push_back(value(row));
  return numbers;
}

void write_column(const Hdf5Group& group, const Column& column, const std::vector<double>& values) {
  group.write(column.name, values);
  group.set("SI unit", column.unit.si_symbol, column.name);
  group.set("study unit", column.unit.symbol, column.name);
}

[[noreturn]] void damaged(const std::string& place, std::string what) {
  refuse_data(place, std::move(what), "the file is truncated or was not finished: remove it and train again");
}

template <class T>
std::vector<T> checked(const Hdf5Group& group, const std::string& name, std::vector<T> values, std::size_t rows) {
  if (values.size() != rows) {
    damaged(group.place(name), fmt::format("holds {} values where the table has {} rows", values.size(), rows));
  }
  return values;
}

std::vector<double> read_column(const Hdf5Group& group, const Column& column, std::size_t rows) {
  std::vector<double> values = checked(group, column.name, group.read<double>(column.name).values, rows);
  if (group.has_attribute("SI unit", column.name)) {
    const std::string unit = group.text("SI unit", column.name);
    if (unit != column.unit.si_symbol) {
      throw InputError(ExitStatus::bad_data,
                       Problem{group.place(column.name),
                               fmt::format("is in '{}' where the study measures '{}'", unit, column.unit.si_symbol),
                               "the table belongs to another study, or the unit was changed"});
    }
  }
  return values;
}

void refuse_more(const Hdf5Group& group, const std::vector<Column>& columns, const std::string& kind) {
  for (const std::string& name : group.names()) {
    bool known = false;
    for (const Column& column : columns) known = known || column.name == name;
    if (!known) {
      throw InputError(ExitStatus::bad_data,
                       Problem{group.place(name), fmt::format("is a {} that the study does not have", kind),
                               "the table belongs to another study: choose another --out, or remove the file"});
    }
  }
}

/// Throws InputError (65) where an input came to the study after the table was written: at which value its runs were
/// made is not known.
void require_all(const Hdf5Group& group, const std::vector<Column>& columns, const std::string& kind) {
  for (const Column& column : columns)
    if (!group.has(column.name))
      refuse_data(group.place(),
                  fmt::format("has no '{}', a {} that came to the study after these runs", column.name, kind),
                  fmt::format("choose another --out for the study as it is now, or take the {} out of it again", kind));
}

/// Throws InputError (65) where this is no table that was finished, and of this version.
void check_finished(const Hdf5Group& root) {
  if (!root.has_attribute("format") || root.text("format") != format_name) {
    throw InputError(ExitStatus::bad_data, Problem{root.place(), "is not a run table of demcal", "name another file"});
  }
  if (!root.has_attribute("complete") || root.integer("complete") != 1) damaged(root.place(), "is not marked complete");
  if (root.integer("version") > 1) {
    throw InputError(ExitStatus::bad_data, Problem{root.place(), "was written by a newer demcal", "use that one"});
  }
}

/// As many empty rows as the file states. They are counted first: a damaged number may ask for more than any memory
/// holds.
std::vector<RunRow> empty_rows(const Hdf5Group& root) {
  const std::int64_t count = root.integer("rows");
  if (count < 0) damaged(root.place("@rows"), fmt::format("{} is no number of rows", count));
  const auto rows = static_cast<std::size_t>(count);
  checked(root.group("runs"), "seed", root.group("runs").read<std::uint64_t>("seed").values, rows);
  return std::vector<RunRow>(rows);
}

/// Reads the outputs that the study has no longer, to be written back.
void read_others(const Hdf5Group& outputs, const Hdf5Group& errors, RunTable& table) {
  for (const std::string& name : outputs.names()) {
    if (std::any_of(table.outputs.begin(), table.outputs.end(), [&](const Column& one) { return one.name == name; }))
      continue;
    const std::optional<Unit> unit = known_unit(outputs.text("study unit", name));
    if (!unit) damaged(outputs.place(name), "has no unit that is known");
    const Column column{name, *unit};
    const std::vector<double> values = read_column(outputs, column, table.rows.size()),
                              standard_errors = read_column(errors, column, table.rows.size());
    for (std::size_t r = 0; r < values.size(); ++r) table.rows[r].others[name] = {values[r], standard_errors[r]};
    table.others.push_back(column);
  }
}

/// Reads inputs, outputs and their errors into the table's rows.
void read_numbers(const Hdf5Group& root, RunTable& table) {
  const Hdf5Group parameters = root.group("parameters"), controls = root.group("controls"),
                  outputs = root.group("outputs"), errors = root.group("standard_errors");
  refuse_more(parameters, table.parameters, "parameter");
  refuse_more(controls, table.controls, "control");
  require_all(parameters, table.parameters, "parameter");
  require_all(controls, table.controls, "control");
  const auto append = [&](const Hdf5Group& group, const Column& column, std::vector<double> RunRow::*target) {
    const std::vector<double> values = read_column(group, column, table.rows.size());
    for (std::size_t r = 0; r < values.size(); ++r) (table.rows[r].*target).push_back(values[r]);
  };
  for (const Column& column : table.parameters) append(parameters, column, &RunRow::inputs);
  for (const Column& column : table.controls) append(controls, column, &RunRow::inputs);
  for (const Column& column : table.outputs) {
    if (!outputs.has(column.name) && !errors.has(column.name)) {  // it was no output when the table was written
      for (RunRow& row : table.rows) {
        row.outputs.push_back(OutputMean{}.value);
        row.standard_errors.push_back(OutputMean{}.standard_error);
      }
      continue;
    }
    append(outputs, column, &RunRow::outputs);
    append(errors, column, &RunRow::standard_errors);
  }
  read_others(outputs, errors, table);
}

/// Reads into the rows how each run was made and ended.
void read_runs(const Hdf5Group& runs, std::vector<RunRow>& rows) {
  const auto texts = [&](const char* name) { return checked(runs, name, runs.read_texts(name), rows.size()); };
  const auto texts_or_none = [&](const char* name) {  // tables of older versions have no such column
    return runs.has(name) ? texts(name) : std::vector<std::string>(rows.size());
  };
  const auto materials = texts("material");
  const auto seeds = checked(runs, "seed", runs.read<std::uint64_t>("seed").values, rows.size());
  const auto settings = texts("settings"), isas = texts("isa"), origins = texts("origin"),
             states = texts_or_none("state"), unreliable = texts_or_none("unreliable");
  const auto seconds = checked(runs, "cpu_seconds", runs.read<double>("cpu_seconds").values, rows.size());
  for (std::size_t r = 0; r < rows.size(); ++r) {
    RunRow& row = rows[r];
    row.material = materials[r];
    row.seed = seeds[r];
    row.settings = settings[r];
    row.isa = isas[r];
    row.origin = origins[r];
    row.cpu_seconds = seconds[r];
    row.state = states[r];
    row.unreliable = unreliable[r];
  }
}

/// Takes out the rows with an input that has no logarithm, and says so of each.
std::vector<std::string> leave_out_without_logarithm(const Hdf5Group& root, const Study& study, RunTable& table) {
  std::vector<std::string> left_out;
  std::size_t number = 0;
  const std::vector<Input> inputs = inputs_of(study);
  std::erase_if(table.rows, [&](const RunRow& row) {
    ++number;
    for (std::size_t i = 0; i < row.inputs.size(); ++i) {
      if (inputs[i].axis.scale != Scale::log || row.inputs[i] > 0.0 || std::isnan(row.inputs[i])) continue;
      const Hdf5Group group = root.group(i < study.parameters.size() ? "parameters" : "controls");
      left_out.push_back(fmt::format("{}: row {} is {}, which has no logarithm (scale = \"log\"), and is left out",
                                     group.place(inputs[i].name), number, row.inputs[i]));
      return true;
    }
    return false;
  });
  return left_out;
}

}  // namespace

void write_table_hdf5(const std::string& path, const RunTable& table, const Study& study) {
  write_atomically(path, [&](const std::string& temporary) {
    const Hdf5Group root = create_hdf5(temporary);
    root.set("format", format_name);
    root.set("version", std::int64_t{1});
    root.set("demcal", program_version());
    root.set("study", study.name);
    root.set("rows", static_cast<std::int64_t>(table.rows.size()));
    const Hdf5Group parameters = root.create_group("parameters"), controls = root.create_group("controls"),
                    outputs = root.create_group("outputs"), errors = root.create_group("standard_errors"),
                    runs = root.create_group("runs");
    for (std::size_t i = 0; i < table.parameters.size(); ++i) {
      write_column(parameters, table.parameters[i],
                   column_of(table, [i](const RunRow& row) { return row.inputs.at(i); }));
    }
    for (std::size_t i = 0; i < table.controls.size(); ++i) {
      const std::size_t at = table.parameters.size() + i;
      write_column(controls, table.controls[i],
                   column_of(table, [at](const RunRow& row) { return row.inputs.at(at); }));
    }
    for (std::size_t i = 0; i < table.outputs.size(); ++i) {
      write_column(outputs, table.outputs[i], column_of(table, [i](const RunRow& row) { return row.outputs.at(i); }));
      write_column(errors, table.outputs[i],
                   column_of(table, [i](const RunRow& row) { return row.standard_errors.at(i); }));
    }
    for (const Column& column : table.others) {
      const auto kept = [&](const RunRow& row) { return kept_mean(row, column); };
      write_column(outputs, column, column_of(table, [&](const RunRow& row) { return kept(row).value; }));
      write_column(errors, column, column_of(table, [&](const RunRow& row) { return kept(row).standard_error; }));
    }
    std::vector<std::string> materials, settings, isas, origins, states, unreliable;
    std::vector<std::uint64_t> seeds;
    for (const RunRow& row : table.rows) {
      materials.push_back(row.material);
      seeds.push_back(row.seed);
      settings.push_back(row.settings);
      isas.push_back(row.isa);
      origins.push_back(row.origin);
      states.push_back(row.state);
      unreliable.push_back(row.unreliable);
    }
    runs.write_texts("material", materials);
    runs.write("seed", seeds);
    runs.write_texts("settings", settings);
    runs.write_texts("isa", isas);
    runs.write_texts("origin", origins);
    runs.write_texts("state", states);
    runs.write_texts("unreliable", unreliable);
    runs.write("cpu_seconds", column_of(table, [](const RunRow& row) { return row.cpu_seconds; }));
    runs.set("unit", "s", "cpu_seconds");
    root.set("complete", std::int64_t{1});
    root.flush();
  });
}

TableRead read_table_hdf5(const std::string& path, const Study& study) {
  const Hdf5Group root = open_hdf5(path);
  check_finished(root);
  TableRead result{.table = empty_table(study)};
  std::vector<RunRow>& rows = result.table.rows;
  rows = empty_rows(root);
  read_numbers(root, result.table);
  read_runs(root.group("runs"), rows);
  // The CSV beside it has the same rows, and is what a user can read.
  for (std::size_t r = 0; r < rows.size(); ++r)
    rows[r].place = fmt::format("{}.csv:{}", std::filesystem::path(path).stem().string(),
                                static_cast<std::size_t>(run_table_head_lines) + r + 1);
  result.left_out = leave_out_without_logarithm(root, study, result.table);
  return result;
}

}  // namespace data
