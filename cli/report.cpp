// demcal report: writes the page again from report.json.
#include <fmt/format.h>

#include <filesystem>

#include "campaign/out_files.hpp"
#include "campaign/study_rows.hpp"
#include "cli/calibration.hpp"
#include "data/error.hpp"
#include "uq/findings/report_file.hpp"
#include "uq/report/html.hpp"

namespace cli {
namespace {

/// A sentence on what has changed since the results were made; empty where nothing has.
std::string stale_results(const uq::CalibrationReport& report, const Workspace& workspace) {
  std::vector<std::string> changed;
  try {
    changed = changed_since(report, workspace, campaign::study_rows(workspace));
  } catch (const data::InputError& error) {
    changed = {"what the results rest on can no longer be read: " + data::describe(error.problems)};
  }
  return changed.empty()
             ? std::string()
             : fmt::format("these results are not of what is there now. Changed since: {}", fmt::join(changed, ", "));
}

}  // namespace

Action add_report(CLI::App& program) {
  const auto common = std::make_shared<Common>();
  add_study_command(program, "report", "write the report again from the results of the last calibration",
                    "demcal report data/developer", *common);
  return [common] {
    const Workspace workspace = open_workspace(*common);
    const std::string report = results_path(workspace);
    if (!std::filesystem::exists(report))
      throw data::InputError(data::ExitStatus::missing_input, {report, "is not there: this study has no results yet",
                                                               "run: demcal calibrate " + common->study});
    const auto held = hold_out(workspace, Writes::results, "report");
    uq::CalibrationReport found = uq::load_report(report);
    if (const std::string stale = stale_results(found, workspace); !stale.empty()) {
      found.warnings.insert(found.warnings.begin(), stale + " (run: demcal calibrate " + common->study + ")");
      found.warning = true;
      uq::write_report_html(found, workspace.out);  // report.json stays that of its inputs
    } else {
      write_report(workspace, found);
    }
    return say_report(*common, workspace, found);
  };
}

}  // namespace cli
