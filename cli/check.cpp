// demcal check: reads everything, reports every problem at once, simulates nothing.
#include <fmt/core.h>

#include "cli/point.hpp"
#include "dem/derived.hpp"
#include "dem/rig.hpp"
#include "dem/target.hpp"
#include "uq/surrogates.hpp"

namespace cli {
namespace {

/// What a calibration would refuse of the runs that there are.
std::vector<std::string> too_few_runs(const data::Study& study, const TrainingRows& rows) {
  if (rows.table.rows.empty()) return {};
  try {
    uq::training_rows(study, rows.table, rows.low);
  } catch (const data::InputError& error) {
    return {error.what()};
  }
  return {};
}

}  // namespace

Action add_check(CLI::App& program) {
  const auto common = std::make_shared<Common>();
  add_study_command(program, "check", "read everything and report every problem, without simulating",
                    "demcal check data/developer", *common);
  return [common] {
    const Workspace workspace = open_workspace(*common);
    const data::Study& study = workspace.study;
    const TrainingRows rows = training_rows(workspace);
    std::vector<std::string> warnings = rows.notes;
    for (const data::Problem& problem : data::outside_training_range(study))
      warnings.push_back(data::describe({problem}));
    for (std::string& warning : too_few_runs(study, rows)) warnings.push_back(std::move(warning));
    for (const auto& [material, unused] : workspace.cases) {
      const dem::Case c = case_at(workspace, parse_point(workspace, material, {}));
      if (auto found = dem::problems(c); !found.empty())
        throw data::InputError(data::ExitStatus::bad_study, std::move(found));
      dem::build_rig(c, study.seed);  // whether the spheres fit
      say(*common, material.empty() ? "simulation, amid its ranges:" : material + ", amid its ranges:");
      for (const std::string& line : dem::describe(c, dem::derive(c))) say(*common, "  " + line);
      const std::vector<std::string> broken = dem::rig_warnings(c);
      if (material == workspace.cases.begin()->first) warnings.insert(warnings.end(), broken.begin(), broken.end());
    }
    if (study.cases.empty())
      warnings.push_back("there is no [[calibrate]] case yet: the study can train, not calibrate");
    for (const std::string& warning : warnings) say(*common, "warning: " + warning);
    say(*common, fmt::format("{}: {} parameters, {} controls, {} materials, {} observation sets, {} cases, {} training "
                             "runs: no problems",
                             study.name, study.parameters.size(), study.controls.size(), study.materials.size(),
                             study.observations.size(), study.cases.size(), rows.table.rows.size()));
    print_json(*common, {{"study", study.name}, {"rows", rows.table.rows.size()}, {"warnings", warnings}});
    return warnings.empty() ? data::ExitStatus::done : data::ExitStatus::warning;
  };
}

}  // namespace cli
