#pragma once
// Measurements that could be made next, for one case of a study. They are those of [plan], or the usual ones: every
// observed setting again, all of these together, the observed outputs over the range of every control, and every other
// output of the run table.
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "data/plan.hpp"
#include "data/study.hpp"
#include "uq/findings/kinds.hpp"
#include "uq/findings/plan_results.hpp"
#include "uq/posterior/case_model.hpp"

namespace uq::plan {

struct Candidate {
  std::string name;  ///< "torque at 300 rpm"
  CandidateKind kind = CandidateKind::setting;
  std::string material;
  std::vector<std::size_t> outputs;           ///< indices into Study::outputs
  std::vector<std::vector<double>> settings;  ///< points x controls, SI
  std::vector<data::Spread> error;            ///< error of one reading, per output
  std::optional<data::Spread> common_error;   ///< common error of a meter that has not measured yet
  std::string meter;                          ///< candidates of one name share its error; may be one that has measured
  bool stated_error = false;                  ///< the plan states its error
  bool assumed_error = false;                 ///< nobody stated one
  bool model_only = false;                    ///< the output need not mean the same in the real powder
  bool no_runs = false;                       ///< no run speaks there (plan_basis.cpp)
  std::vector<PlanLevel> levels = {};         ///< other levels of the powder's coarse graining (levels.hpp)
  int readings = 1;
  double cost = 1.0;

  bool doubtful() const { return model_only || no_runs; }
};

struct CandidateOptions {
  int settings = 9;             ///< settings of each control over its range
  int settings_other = 5;       ///< settings for outputs that the case has not measured
  double assumed_error = 0.05;  ///< relative error of a reading of those outputs
  /// Materials simulated with larger grains than the powder's, each with the materials that are the same powder at
  /// other sizes.
  std::map<std::string, std::vector<std::string>> coarse_grained = {};
};

/// The candidates of a case. Throws data::InputError (78): a candidate outside the runs, an output without an emulator
/// or without error.
std::vector<Candidate> candidates_of(const data::Study& study, const std::vector<Emulator>& emulators,
                                     std::size_t case_index, const data::PlanSection& plan,
                                     const CandidateOptions& options = {});

/// The emulator of a material's output; none where there are no runs of it.
const Emulator* emulator_of(const std::vector<Emulator>& emulators, const std::string& material, std::size_t output);

/// Whether an emulator's runs reach a setting of all controls, SI.
bool reaches(const data::Study& study, const Emulator& emulator, const std::vector<double>& setting);

/// The sets that a case observes, as indices into Study::observations.
std::vector<std::size_t> own_sets(const data::Study& study, std::size_t case_index);

}  // namespace uq::plan
