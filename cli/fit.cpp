// demcal fit: the surrogates and how well they predict.
#include "cli/calibration.hpp"

namespace cli {

Action add_fit(CLI::App& program) {
  const auto common = std::make_shared<Common>();
  add_study_command(program, "fit", "fit the surrogates to the training runs and validate them",
                    "demcal fit data/developer", *common);
  return [common] {
    const Workspace workspace = open_workspace(*common);
    const StudyRows rows = rows_to_learn_from(*common, workspace);
    const auto held = hold_out(workspace, Writes::results, "fit");
    const uq::SurrogateOptions options = surrogate_options(*common, workspace, rows);
    const std::vector<uq::FittedSurrogate> fitted = uq::fit_surrogates(workspace.study, rows.table, options);
    keep_surrogates(workspace, rows, options, fitted);
    const std::vector<std::string> warnings = say_warnings(*common, rows, fitted);
    say_surrogates(*common, fitted);
    nlohmann::json json = nlohmann::json::array();
    for (const uq::FittedSurrogate& one : fitted) {
      const uq::SurrogateReport& r = one.report;
      json.push_back({{"output", r.output},
                      {"material", r.material},
                      {"q2", r.q2},
                      {"q2_held_out", r.q2_held_out},
                      {"coverage95", r.coverage95},
                      {"runs", r.runs},
                      {"verdict", uq::to_text(r.verdict)},
                      {"low_runs", r.low_runs},
                      {"rho", r.rho},
                      {"notes", r.notes}});
    }
    print_json(*common,
               {{"surrogates", json}, {"status", warnings.empty() ? "ok" : "warning"}, {"warnings", warnings}});
    return !warnings.empty() ? data::ExitStatus::warning : data::ExitStatus::done;
  };
}

}  // namespace cli
