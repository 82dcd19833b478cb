#pragma once
// What simulation-based calibration found (uq/calibrate/simulation_calibration.hpp), as plain data.
#include <string>
#include <vector>

namespace uq {

struct RankCheck {
  std::string name;
  std::vector<int> ranks;       ///< of the replicates that converged
  bool inside = true;           ///< the bands, everywhere
  double coverage = 0.0;        ///< share of replicates whose central interval holds the truth
  double coverage_error = 0.0;  ///< its standard error, if it is what it should be
};

struct SimulationCalibration {
  std::string case_name;
  int replicates = 0;
  int failed = 0;                         ///< that did not converge: left out
  std::vector<std::string> reasons = {};  ///< of each of them
  int rank_max = 0;
  double interval = 0.0;
  std::vector<double> z, band_low, band_high;  ///< bands of the empirical distribution function
  std::vector<RankCheck> unknowns;
  bool calibrated() const;  ///< all ranks inside their bands, and at most one replicate in 100 failed
};

/// As JSON, for OUT/sbc-CASE.json.
std::string to_json_text(const SimulationCalibration& found);

}  // namespace uq
