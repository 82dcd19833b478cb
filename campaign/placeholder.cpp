#include "campaign/placeholder.hpp"

#include <fmt/core.h>

#include <filesystem>
#include <sstream>

#include "data/atomic_file.hpp"

namespace campaign {
namespace {

/// The text without comments, blanks and empty lines.
std::string rows_of(std::string_view text) {
  std::istringstream lines{std::string(text)};
  std::string rows;
  for (std::string line; std::getline(lines, line);) {
    std::erase_if(line, [](char c) { return c == ' ' || c == '\t' || c == '\r'; });
    if (!line.empty() && line.front() != '#') rows += line + '\n';
  }
  return rows;
}

}  // namespace

std::string_view placeholder_torque() {
  return "# An example that demcal wrote, not a measurement: replace all lines by yours. Torque of the powder alone "
         "(idle\n"
         "# torque taken off) in uN m, the unit of [outputs.torque], and its standard error. Another unit: torque [mN "
         "m].\n"
         "rpm,torque,torque_se\n50,100,3\n150,98,3\n300,95,3\n";
}

std::vector<data::Finding> placeholders(const data::Study& study) {
  std::vector<data::Finding> found;
  for (const data::ObservationSet& set : study.observations) {
    if (rows_of(data::read_file(set.file)) != rows_of(placeholder_torque())) continue;
    found.push_back(
        {.kind = data::FindingKind::placeholder,
         .place = std::filesystem::path(set.file).filename().string(),
         .severity = data::Severity::warning,
         .what = fmt::format("'{}' still holds the example that demcal new wrote, and no measurement", set.name),
         .remedy = "replace its rows by your torque (demcal observe makes them from a log)",
         .places = {}});
  }
  return found;
}

}  // namespace campaign
