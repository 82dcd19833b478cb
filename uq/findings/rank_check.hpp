#pragma once
// The findings of simulation-based calibration (uq/calibrate/simulation_calibration.hpp), as plain data.
#include <string>
#include <vector>

namespace uq {

struct RankCheck {
  std::string name;
  std::vector<int> ranks;       ///< ranks of the replicates that converged
  bool inside = true;           ///< whether the ranks stay inside the bands everywhere
  double coverage = 0.0;        ///< share of replicates whose central interval holds the truth
  double coverage_error = 0.0;  ///< standard error that the share has if it is what it should be
};

struct SimulationCalibration {
  std::string case_name;
  int replicates = 0;
  int failed = 0;                         ///< replicates that did not converge: left out
  std::vector<std::string> reasons = {};  ///< reason of each failed replicate
  int rank_max = 0;
  double interval = 0.0;
  std::vector<double> z, band_low, band_high;  ///< bands of the empirical distribution function
  std::vector<RankCheck> unknowns;
  bool calibrated() const;  ///< all ranks inside their bands, and at most one replicate in 100 failed
};

/// The findings as JSON, for OUT/sbc-CASE.json.
std::string to_json_text(const SimulationCalibration& found);

}  // namespace uq
