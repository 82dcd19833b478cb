#include "tests/cli/table.hpp"

#include <catch2/catch.hpp>
#include <fstream>
#include <sstream>

#include "tests/cli/program.hpp"

namespace test {
namespace {

std::map<std::string, std::string> torque_by_point(const Folder& folder, const std::vector<std::string>& point) {
  std::map<std::string, std::string> torque;
  for (const Row& row : read_rows(folder.path / "quick-results" / "training.csv")) {
    std::string at;
    for (const std::string& column : point) at += row.at(column) + " ";
    torque[at] = row.at("torque");
  }
  return torque;
}

}  // namespace

std::vector<Row> read_rows(const std::filesystem::path& table) {
  std::ifstream file(table);
  std::vector<Row> rows;
  std::vector<std::string> head;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] == '#') continue;
    std::vector<std::string> fields;
    std::istringstream cells(line);
    for (std::string cell; std::getline(cells, cell, ',');) fields.push_back(cell);
    if (head.empty()) {
      head = fields;
      continue;
    }
    Row row;
    for (std::size_t i = 0; i < head.size(); ++i) row[head[i]] = i < fields.size() ? fields[i] : "";
    rows.push_back(row);
  }
  return rows;
}

double number(const Row& row, const std::string& column) { return std::stod(row.at(column)); }

void check_interruption_changes_nothing(const std::vector<std::string>& words, const std::vector<std::string>& point,
                                        std::size_t runs) {
  std::vector<std::string> arguments{"train", DEMCAL_SOURCE_DIR "/data/quick"};
  arguments.insert(arguments.end(), words.begin(), words.end());
  const Folder whole, halted;
  whole.says(arguments, 0);
  CHECK(halted.demcal(arguments, "quick-results/runs").status == 75);
  halted.says(arguments, 0);
  CHECK(torque_by_point(whole, point).size() == runs);
  CHECK(torque_by_point(halted, point) == torque_by_point(whole, point));
}

}  // namespace test
