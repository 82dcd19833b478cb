// demcal calibrate: the main job. Surrogates, posteriors, verdicts, report.
#include <filesystem>

#include "cli/calibration.hpp"
#include "uq/posterior_nc.hpp"
#include "uq/report_results.hpp"

namespace cli {

Action add_calibrate(CLI::App& program) {
  const auto common = std::make_shared<Common>();
  add_study_command(program, "calibrate", "fit, sample, identify, report: what the torque determines and what not",
                    "demcal calibrate data/developer", *common);
  return [common] {
    const Workspace workspace = open_workspace(*common);
    const TrainingRows rows = rows_to_learn_from(*common, workspace);
    make_out(workspace);
    uq::Calibration result;
    {
      JobProgress progress(*common, "calibrating");
      result = uq::calibrate_all(workspace.study, rows.table,
                                 {.seed = workspace.study.seed, .progress = std::ref(progress)});
    }
    save_surrogates(workspace, rows.table, result.surrogates);
    for (const uq::SampledCase& sampled : result.cases)
      if (!sampled.draws.chains.empty())
        uq::write_posterior(posterior_path(workspace, sampled.model->name), workspace.study, sampled,
                            workspace.study.seed);
    add_provenance(result.report, workspace, rows);
    uq::save_results(result.report, (std::filesystem::path(workspace.out) / "results.json").string());
    return write_report(*common, workspace, result.report);
  };
}

}  // namespace cli
