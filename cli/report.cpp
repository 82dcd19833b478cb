// demcal report: writes the page and report.json again from the saved results.
#include <filesystem>

#include "cli/calibration.hpp"
#include "uq/findings/results_file.hpp"

namespace cli {

Action add_report(CLI::App& program) {
  const auto common = std::make_shared<Common>();
  add_study_command(program, "report", "write the report again from the results of the last calibration",
                    "demcal report data/developer", *common);
  return [common] {
    const Workspace workspace = open_workspace(*common);
    const std::string results = (std::filesystem::path(workspace.out) / "results.json").string();
    if (!std::filesystem::exists(results))
      throw data::InputError(data::ExitStatus::missing_input, {results, "is not there: this study has no results yet",
                                                               "run: demcal calibrate " + common->study});
    const auto held = hold_out(workspace, Writes::results, "report");
    return write_report(*common, workspace, uq::load_results(results));
  };
}

}  // namespace cli
