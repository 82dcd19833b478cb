#include "uq/findings/rank_check.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

namespace uq {

bool SimulationCalibration::calibrated() const {
  return 100 * failed <= replicates &&
         std::all_of(unknowns.begin(), unknowns.end(), [](const RankCheck& one) { return one.inside; });
}

std::string to_json_text(const SimulationCalibration& found) {
  nlohmann::ordered_json json = {{"format", 1},
                                 {"case", found.case_name},
                                 {"calibrated", found.calibrated()},
                                 {"replicates", found.replicates},
                                 {"not_converged", found.failed},
                                 {"not_converged_why", found.reasons},
                                 {"rank_max", found.rank_max},
                                 {"interval", found.interval},
                                 {"unknowns", nlohmann::ordered_json::array()},
                                 {"z", found.z},
                                 {"band_low", found.band_low},
                                 {"band_high", found.band_high}};
  for (const RankCheck& one : found.unknowns)
    json["unknowns"].push_back({{"name", one.name},
                                {"inside_bands", one.inside},
                                {"coverage", one.coverage},
                                {"coverage_error", one.coverage_error},
                                {"ranks", one.ranks}});
  return json.dump(1) + "\n";
}

}  // namespace uq
