#pragma once
// [plan]: measurements that could be made next, and what each costs (`demcal plan`).
//
//   [plan]
//   about = "friction"                 # the parameter to learn of; by default the one that is known least
//   cost_unit = "h"                    # what costs count; by default plain numbers
//   [[plan.candidates]]
//   name = "fast"                      # by default made from outputs and settings
//   material = "carrier"               # by default that of the case's observations
//   outputs = ["torque"]               # by default the first output
//   settings = { rpm = ["250 rpm", "300 rpm"] }   # lists of several controls are multiplied with each other
//   together = false                   # true: all its settings are one measurement with one cost
//   readings = 1                       # of each setting, averaged
//   error = "3 %"                      # of one reading; by default as the case's observations of that output have it
//   meter = "torque-cell-1"            # a meter of the observations, whose common error the readings have, too
//   common_error = "1 %"               # of a meter that has not measured yet, shared by all readings of the entry
//   cost = 1.0                         # of one measurement
#include <optional>
#include <string>
#include <vector>

#include "data/study.hpp"
#include "data/study_file.hpp"

namespace data {

struct PlanEntry {
  std::string name;                           ///< empty: to be made up
  std::string material;                       ///< empty: that of the case's observations
  std::vector<std::size_t> outputs;           ///< indices into Study::outputs
  std::vector<std::vector<double>> settings;  ///< per control, SI; empty: not stated
  bool together = false;
  int readings = 1;
  std::optional<Spread> error, common_error;
  std::string meter;  ///< a meter of the observations; empty: the one that has read the output, or a new one
  double cost = 1.0;
  std::string place;
};

struct PlanSection {
  std::string about;  ///< empty: not stated
  std::string cost_unit;
  std::vector<PlanEntry> candidates;  ///< empty: the usual ones
};

/// Reads the section. Problems are recorded in `file`.
PlanSection read_plan(const StudyFile& file, const Study& study);

}  // namespace data
