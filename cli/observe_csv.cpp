#include "cli/observe_csv.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "data/csv.hpp"
#include "data/hash.hpp"
#include "data/observations.hpp"
#include "data/origin.hpp"
#include "data/unit_text.hpp"

namespace cli {
namespace fs = std::filesystem;
namespace {

/// A unit that a study reads, too: the log's own, or N m where that is a spelling of instruments.
data::Unit unit_of_studies(const data::Unit& unit) {
  try {
    if (data::convertible(unit.symbol, "N m")) return data::parse_unit(unit.symbol);
  } catch (const std::invalid_argument&) {
  }
  return data::parse_unit("N m");
}

/// A name within a line of comment.
std::string in_comment(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20; }, ' ');
  return text;
}

}  // namespace

std::string observations_csv(const ObserveOptions& options, const data::TorqueLog& log,
                             const std::vector<data::Plateau>& plateaus, const Idle& idle, const data::Unit& unit) {
  std::string text = fmt::format("# {}\n# from {} (XXH3 {}), by demcal observe\n", data::blank_mark(),
                                 in_comment(fs::path(options.log).filename().string()), data::hash_file(options.log));
  text += fmt::format(
      "# units: {} [{}], {} [{}]; seconds: length of the part used; independent: its uncorrelated samples\n",
      options.control, log.speed_unit.symbol, options.output, unit.symbol);
  if (idle.kind == Idle::Kind::value) {
    text +=
        fmt::format("# idle torque {:.6g} {} taken off every row", unit.from_si(idle.at.front().value), unit.symbol);
    text += options.idle_error
                ? fmt::format("; {}common_error = \"{:.3g} {}\" in [[observe]]\n", data::idle_error_mark,
                              idle.at.front().error / unit_of_studies(unit).factor, unit_of_studies(unit).symbol)
                : std::string("\n");
  } else if (idle.kind == Idle::Kind::log) {
    text +=
        fmt::format("# idle torque of the empty machine taken off at each speed ({}); its error is in {}_se\n",
                    options.idle_log.empty() ? "same log" : in_comment(fs::path(options.idle_log).filename().string()),
                    options.output);
  }
  text += fmt::format("{},{},{},{},{}\n", data::csv_field(options.control), data::csv_field(options.output),
                      data::csv_field(options.output + "_se"), fmt::join(data::columns_of_observe, ","),
                      data::csv_field(options.control + "_sd"));
  for (std::size_t i = 0; i < plateaus.size(); ++i) {
    const data::Plateau& plateau = plateaus[i];
    const data::MeanTorque found = observed_torque(plateau, idle, i);
    const double off = idle.kind == Idle::Kind::none ? 0.0 : idle.at[i].value;
    text += fmt::format("{:.6g},{:.6g},{:.3g},{:.6g},{:.6g},{:.6g},{:.0f},{:.3g}\n",
                        log.speed_unit.from_si(plateau.speed), found.value / unit.factor, found.error / unit.factor,
                        off / unit.factor, log.time[plateau.used_from],
                        log.time[plateau.first + plateau.count - 1] - log.time[plateau.used_from],
                        plateau.independent_samples(), plateau.speed_sd / log.speed_unit.factor);
  }
  return text;
}

}  // namespace cli
