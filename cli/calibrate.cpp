// demcal calibrate: the main job. Surrogates, posteriors, verdicts, report.
#include <filesystem>

#include "cli/calibration.hpp"
#include "uq/posterior_nc.hpp"
#include "uq/report_results.hpp"

namespace cli {

Action add_calibrate(CLI::App& program) {
  const auto common = std::make_shared<Common>();
  CLI::App* command =
      add_study_command(program, "calibrate", "fit, sample, identify, report: what the torque determines and what not",
                        "demcal calibrate data/developer", *common);
  const auto sampler = add_sampler_option(*command);
  return [common, sampler] {
    const Workspace workspace = open_workspace(*common);
    const TrainingRows rows = rows_to_learn_from(*common, workspace);
    const auto held = hold_out(workspace, Writes::results, "calibrate");
    const uq::SurrogateOptions surrogates = surrogate_options(*common, workspace, rows);
    uq::Calibration result;
    {
      JobProgress progress(*common, "calibrating");
      result = uq::calibrate_all(workspace.study, rows.table,
                                 {.surrogates = surrogates,
                                  .sampler = *sampler,
                                  .seed = workspace.study.seed,
                                  .findings = rows.findings,
                                  .progress = std::ref(progress)});
    }
    keep_surrogates(workspace, rows, surrogates, result.surrogates);
    for (const uq::SampledCase& sampled : result.cases)
      if (!sampled.draws.chains.empty())
        uq::write_posterior(posterior_path(workspace, sampled.model->name), workspace.study, sampled,
                            workspace.study.seed);
    std::vector<uq::SupportReport> supports;
    for (const uq::CaseReport& one : result.report.cases) supports.push_back(one.support);
    write_next_runs(workspace, supports);
    add_provenance(result.report, workspace, rows);
    uq::save_results(result.report, (std::filesystem::path(workspace.out) / "results.json").string());
    say_surrogates(*common, result.surrogates);  // after everything is saved: saying may fail
    return write_report(*common, workspace, result.report);
  };
}

}  // namespace cli
