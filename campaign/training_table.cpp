// The order by hash is the same in every file with the same rows, and has no trend: neighbours in the table are no
// neighbours in the design, as cross-validation by blocks of rows needs.
#include "campaign/training_table.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <filesystem>
#include <tuple>

#include "campaign/out_files.hpp"
#include "data/atomic_file.hpp"
#include "data/hash.hpp"
#include "data/origin.hpp"

namespace campaign {
namespace fs = std::filesystem;

data::TableRead read_own_table(const Workspace& workspace, std::vector<std::string>& notes) {
  const std::string table = training_path(workspace);
  const std::string copy = training_copy_path(workspace);
  const data::Origin origin = data::origin_of(table);
  const bool damaged = origin == data::Origin::changed || origin == data::Origin::unmarked;
  const std::string runs = data::shown_path((fs::path(workspace.out) / "runs").string());
  const bool has_copy = data::origin_of(copy) == data::Origin::ours;
  if (origin == data::Origin::absent) {
    data::require_unchanged(copy, "move it away; demcal train makes the table again from the runs in " + runs);
    notes.push_back(
        fmt::format("{} is not there; its rows are read from training.csv beside it", data::shown_path(table)));
    return data::read_table(copy, workspace.study);
  }
  if (!damaged || (origin == data::Origin::unmarked && !has_copy)) return data::read_table(table, workspace.study);
  if (!has_copy)
    throw data::InputError(
        data::ExitStatus::bad_data,
        {data::shown_path(table), "is damaged, and training.csv beside it is not as demcal wrote it either",
         "move both away; demcal train makes the table again from the runs in " + runs});
  notes.push_back(
      fmt::format("{} is damaged; its rows are read from training.csv beside it, and demcal train writes it again",
                  data::shown_path(table)));
  return data::read_table(copy, workspace.study);
}

void write_tables(const Workspace& workspace, const data::RunTable& rows, const std::vector<data::RunRow>& kept) {
  data::RunTable table = rows, others = rows;
  others.rows = kept;
  table = data::merge(table, others);
  using Key = std::tuple<std::size_t, std::string, std::string>;
  std::vector<std::pair<Key, data::RunRow>> order;
  const std::vector<data::Material>& materials = workspace.study.materials;
  for (data::RunRow& row : table.rows) {
    const auto material = std::find_if(materials.begin(), materials.end(),
                                       [&](const data::Material& one) { return one.name == row.material; });
    const std::string key = data::row_key(row);
    std::string rest;
    for (std::size_t i = 0; i < row.outputs.size(); ++i)
      rest += fmt::format("{} {} ", row.outputs[i], row.standard_errors[i]);
    order.push_back({Key{material - materials.begin(), data::hash_text(key), rest + row.origin}, std::move(row)});
  }
  std::stable_sort(order.begin(), order.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  table.rows.clear();
  for (auto& [key, row] : order) table.rows.push_back(std::move(row));
  data::write_table_hdf5(training_path(workspace), table, workspace.study);
  data::write_table_csv(training_copy_path(workspace), table, workspace.study);
}

}  // namespace campaign
