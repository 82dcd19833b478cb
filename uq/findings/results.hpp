#pragma once
// The findings of a calibration as plain data: made by uq/calibrate/calibrate.cpp, kept by report_file.hpp, shown by
// uq/report. Values of parameters, controls and outputs are in the study's units (Parameter::unit and so on), not in
// SI: report.json is public in those units. Each subject has a file of its own, as its list of fields has.
#include <string>
#include <utility>
#include <vector>

#include "data/finding.hpp"
#include "uq/findings/case_results.hpp"
#include "uq/findings/surrogate_results.hpp"

namespace uq {

struct CalibrationReport {
  std::string study_name, study_description, study_file;
  bool warning = false;
  std::vector<std::string> warnings;
  std::vector<SurrogateReport> surrogates;
  std::vector<DesignReport> designs;
  std::vector<CaseReport> cases;
  std::vector<ErrorScan> error_scan;
  std::vector<std::pair<std::string, std::string>> thresholds;  ///< "contraction for identified" -> "0.9"
  std::vector<std::pair<std::string, std::string>>
      provenance;                       ///< version, hashes, instruction set, seeds, table, times
  std::vector<std::string> notes;       ///< choices the source does not give, shown beside the verdicts
  std::vector<data::Finding> findings;  ///< findings about rows and observations
  std::vector<std::string> cautions;    ///< said on the first screen, without making the status a warning
};

}  // namespace uq
