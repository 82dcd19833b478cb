// demcal report: writes the page again from report.json.
#include <filesystem>

#include "cli/calibration.hpp"
#include "uq/findings/report_file.hpp"

namespace cli {

Action add_report(CLI::App& program) {
  const auto common = std::make_shared<Common>();
  add_study_command(program, "report", "write the report again from the results of the last calibration",
                    "demcal report data/developer", *common);
  return [common] {
    const Workspace workspace = open_workspace(*common);
    const std::string report = (std::filesystem::path(workspace.out) / "report.json").string();
    if (!std::filesystem::exists(report))
      throw data::InputError(data::ExitStatus::missing_input, {report, "is not there: this study has no results yet",
                                                               "run: demcal calibrate " + common->study});
    const auto held = hold_out(workspace, Writes::results, "report");
    const uq::CalibrationReport found = uq::load_report(report);
    write_report(workspace, found);
    return say_report(*common, workspace, found);
  };
}

}  // namespace cli
