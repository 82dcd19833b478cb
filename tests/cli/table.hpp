#pragma once
// Tables of runs, read as text by the tests alone, and that of a campaign that was interrupted.
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace test {

using Row = std::map<std::string, std::string>;  ///< a cell by its column

/// The rows below the header; lines that begin with # are none.
std::vector<Row> read_rows(const std::filesystem::path& table);
double number(const Row& row, const std::string& column);

/// Starts `demcal train data/quick` with these words: in one folder to its end, in another interrupted as soon as it
/// has runs, and again. Checks that both have as many runs as wanted, with the same torques at the same `point`s
/// (columns).
void check_interruption_changes_nothing(const std::vector<std::string>& words, const std::vector<std::string>& point,
                                        std::size_t runs);

}  // namespace test
