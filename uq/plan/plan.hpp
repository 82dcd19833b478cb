#pragma once
// What to measure next: candidates ranked by what they are expected to teach of one parameter, per cost; what becomes
// of the verdict; how many readings it takes; several candidates together.
//   candidates (candidates.hpp) -> laws of their readings (outlook.hpp) -> information (information.hpp)
//   -> words afterwards (forecast.hpp) -> ranking and batches -> PlanReport (uq/findings/plan_results.hpp)
// All numbers are averaged over the posterior, or, before any measurement, over the prior; never taken at a point.
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "data/plan.hpp"
#include "uq/calibrate/calibrate.hpp"
#include "uq/plan/candidates.hpp"

namespace uq::plan {

struct PlanOptions {
  std::string about;             ///< parameter; empty: that of [plan], or the one that is known least
  std::optional<double> budget;  ///< total cost
  int batch = 1;                 ///< candidates together, at most
  bool prior = false;            ///< as if nothing had been measured
  int draws = 2000;
  std::uint64_t seed = 1;
  int threads = 0;  ///< 0: as many as the machine has
  CandidateOptions candidates = {};
  VerdictThresholds thresholds = {};
  std::function<void(double share)> progress = {};
};

/// Makes the plan of a case. Throws data::InputError: 65 where the case does not fit its data, or has no draws; 78 for
/// an unknown parameter or a candidate that cannot be.
PlanReport make_plan(const data::Study& study, const std::vector<Emulator>& emulators, std::size_t case_index,
                     const SampledCase& sampled, const data::PlanSection& section, const PlanOptions& options);

}  // namespace uq::plan
