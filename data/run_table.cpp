#include "data/run_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <set>
#include <stdexcept>

#include "data/number_text.hpp"
#include "data/run_table_files.hpp"
#include "data/steadiness.hpp"

namespace data {

RunTable empty_table(const Study& study) {
  RunTable table;
  for (const Parameter& parameter : study.parameters) table.parameters.push_back({parameter.name, parameter.unit});
  for (const Control& control : study.controls) table.controls.push_back({control.name, control.unit});
  for (const Output& output : study.outputs) table.outputs.push_back({output.name, output.unit});
  return table;
}

std::string row_key(const RunRow& row) {
  std::string key = row.material;
  for (const double input : row.inputs) key += fmt::format("|{:.11e}", input + 0.0);  // -0 and 0 are one point
  return fmt::format("{}|{}|{}", key, row.seed, row.settings);
}

RunTable merge(const RunTable& first, const RunTable& second) {
  RunTable merged = first;
  for (const Column& column : second.others)
    if (std::none_of(merged.others.begin(), merged.others.end(),
                     [&](const Column& known) { return known.name == column.name; }))
      merged.others.push_back(column);
  std::set<std::string> there;
  for (const RunRow& row : first.rows) there.insert(row_key(row));
  for (const RunRow& row : second.rows)
    if (!there.contains(row_key(row))) merged.rows.push_back(row);
  return merged;
}

std::optional<Unit> known_unit(const std::string& symbol) {
  try {
    return parse_unit(symbol.empty() ? "1" : symbol);
  } catch (const std::invalid_argument&) {
    return {};
  }
}

OutputMean kept_mean(const RunRow& row, const Column& column) {
  const auto kept = row.others.find(column.name);
  return kept != row.others.end() ? kept->second : OutputMean{};
}

bool is_unsteady(const RunRow& row) { return !row.state.empty() && row.state != to_text(FlowState::steady); }

namespace {

/// Whether the word is among those of RunRow::unreliable.
bool calls(const RunRow& row, const std::string& word) {
  return fmt::format(" {} ", row.unreliable).find(fmt::format(" {} ", word)) != std::string::npos;
}

}  // namespace

bool is_unreliable(const RunRow& row, const std::string& output) {
  return calls(row, output) || calls(row, output + brief_mark);
}

bool lacks_output(const RunTable& table, const RunRow& row) {
  for (std::size_t i = 0; i < table.outputs.size(); ++i)
    if (std::isnan(row.outputs[i]) && !is_unreliable(row, table.outputs[i].name)) return true;
  return false;
}

std::vector<std::string> drop_unreliable(RunTable& table, bool scatter_estimated) {
  std::vector<std::string> notes;
  for (std::size_t i = 0; i < table.outputs.size(); ++i) {
    const std::string& name = table.outputs[i].name;
    std::size_t dropped = 0, brief = 0;
    for (RunRow& row : table.rows) {
      const bool is_brief = calls(row, name + brief_mark);
      if (!is_brief && !calls(row, name)) continue;
      ++(is_brief ? brief : dropped);
      if (is_brief && scatter_estimated) continue;
      row.outputs[i] = row.standard_errors[i] = std::numeric_limits<double>::quiet_NaN();
    }
    if (dropped > 0)
      notes.push_back(fmt::format("{} of {} runs do not know {} or its error: they count for the other outputs",
                                  dropped, table.rows.size(), name));
    if (brief > 0)
      notes.push_back(
          fmt::format("{} of {} runs are too short to know the error of {}: {}", brief, table.rows.size(), name,
                      scatter_estimated ? "it is at least what they state, and the surrogate estimates the rest"
                                        : "they count for the other outputs"));
  }
  return notes;
}

std::size_t used_rows(const RunTable& table) {
  return static_cast<std::size_t>(
      std::count_if(table.rows.begin(), table.rows.end(), [](const RunRow& row) { return !row.left_out; }));
}

TableRead read_table(const std::string& path, const Study& study) {
  const std::string ending = lower_case(std::filesystem::path(path).extension().string());
  TableRead read = ending == ".h5" || ending == ".hdf5" ? read_table_hdf5(path, study) : read_table_csv(path, study);
  mark_rows(read, study);
  return read;
}

}  // namespace data
