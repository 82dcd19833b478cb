// demcal check: reads everything, reports every problem at once, simulates nothing.
#include <fmt/core.h>

#include <algorithm>

#include "campaign/design.hpp"
#include "campaign/foretell.hpp"
#include "campaign/levels.hpp"
#include "cli/command.hpp"
#include "data/progress.hpp"
#include "dem/rig/rig.hpp"
#include "uq/calibrate/data_check.hpp"
#include "uq/calibrate/effort.hpp"
#include "uq/emulate/surrogates.hpp"
#include "uq/plan/candidates.hpp"

namespace cli {
namespace {

/// What something refuses, one text per problem.
template <class Action>
std::vector<std::string> refusals(const Action& action) {
  std::vector<std::string> texts;
  try {
    action();
  } catch (const data::InputError& error) {
    for (const data::Problem& problem : error.problems) texts.push_back(data::describe({problem}));
  }
  return texts;
}

/// What a calibration would refuse of the runs that there are, and a plan of the candidates that [plan] lists.
std::vector<std::string> refused_later(const Workspace& workspace, const StudyRows& rows) {
  const data::Study& study = workspace.study;
  if (data::used_rows(rows.table) == 0) return {};
  std::vector<uq::Emulator> outlines;  // what there are runs of; nothing is fitted
  std::vector<std::string> found = refusals([&] { outlines = uq::outlines_of(study, rows.table, rows.low); });
  if (!found.empty() || workspace.plan.candidates.empty()) return found;
  for (std::size_t i = 0; i < study.cases.size(); ++i)
    for (std::string& text : refusals([&] { uq::plan::candidates_of(study, outlines, i, workspace.plan); }))
      if (std::find(found.begin(), found.end(), text) == found.end()) found.push_back(std::move(text));
  return found;
}

}  // namespace

Action add_check(CLI::App& program) {
  const auto common = std::make_shared<Common>();
  add_study_command(program, "check", "read everything and report every problem, without simulating",
                    "demcal check data/developer", *common);
  return [common] {
    const Workspace workspace = open_workspace(*common);
    const data::Study& study = workspace.study;
    StudyRows rows = study_rows(workspace);
    // Runs of one's own come later; those of another code are what the study rests on.
    if (workspace.cases.empty() && !study.training.table.empty()) require_rows(workspace, rows, common->study);
    std::vector<std::string> warnings = rows.notes;
    const std::vector<data::Finding> found =
        uq::check_data(study, rows.table, rows.low, workspace.surrogates->log_outputs);
    rows.findings.insert(rows.findings.end(), found.begin(), found.end());
    for (data::Finding& finding : rows.findings) {
      // Before the runs are made there may be no measurement yet, so that its placeholder is no fault of the study.
      if (finding.kind == data::FindingKind::placeholder) finding.severity = data::Severity::note;
      if (finding.severity == data::Severity::warning) warnings.push_back(data::describe(finding));
      if (finding.severity == data::Severity::note) say(*common, "note: " + data::describe(finding));
    }
    for (const data::Problem& problem : data::outside_training_range(study))
      warnings.push_back(data::describe({problem}));
    for (std::string& warning : refusals([&] { coarse_levels(workspace); })) warnings.push_back(std::move(warning));
    for (std::string& warning : refused_later(workspace, rows)) warnings.push_back(std::move(warning));
    uq::SurrogateOptions surrogates = *workspace.surrogates;
    surrogates.low = rows.low;
    for (const std::string& note : uq::effort_notes(study, rows.table, surrogates)) say(*common, "note: " + note);
    nlohmann::json materials = nlohmann::json::array();
    const std::vector<Point> missing =
        workspace.cases.empty() ? std::vector<Point>{} : plan_campaign(workspace, rows.all, 0).points;
    double campaign_seconds = 0.0;
    for (const auto& [material, unused] : workspace.cases) {
      const Point middle = parse_point(workspace, material, {});
      const Foretold told = foretell(workspace, middle);
      const dem::Case& c = told.prepared.given();
      const Cost cost = cost_of(told.prepared);
      const auto runs = std::count_if(missing.begin(), missing.end(),
                                      [&, of = material](const Point& p) { return p.material == of; });
      campaign_seconds += static_cast<double>(runs) * cost.seconds;
      answer(*common, material.empty() ? "simulation, amid its ranges:" : material + ", amid its ranges:");
      for (const std::string& line : dem::describe(c, told.prepared.derived())) answer(*common, "  " + line);
      for (const std::string& line : dem::describe(told.forecast)) answer(*common, "  " + line);
      answer(*common,
             fmt::format("  a run: at most {:.3g} steps, {} of processor time, {:.2g} MB; {} missing: {} "
                         "(at {:.2g} million particle-steps/s, measured on this machine just now)",
                         cost.steps, data::rough_duration_text(cost.seconds), 1e-6 * cost.bytes,
                         data::counted(static_cast<std::size_t>(runs), "run"),
                         data::rough_duration_text(static_cast<double>(runs) * cost.seconds), 1e-6 * cost.effort.rate));
      const std::string of = material.empty() ? "" : material + ": ";
      for (const auto& list : {told.forecast.warnings, cost.warnings, problems_at_ends(workspace, middle)})
        for (const std::string& warning : list) warnings.push_back(of + warning);
      nlohmann::json one = to_json(told, cost);
      one["name"] = material;
      one["missing_runs"] = runs;
      materials.push_back(std::move(one));
      const std::vector<std::string> broken = dem::rig_warnings(c);
      if (material == workspace.cases.begin()->first) warnings.insert(warnings.end(), broken.begin(), broken.end());
    }
    if (!workspace.cases.empty())
      answer(*common, fmt::format("the campaign: {} missing, at most {} of processor time",
                                  data::counted(missing.size(), "run"), data::rough_duration_text(campaign_seconds)));
    if (study.cases.empty())
      warnings.push_back(
          "there is no [[calibrate]] case yet: the study can train and plan (demcal plan --prior), not calibrate");
    for (const data::CalibrationCase& one : study.cases)
      if (one.observe.empty())
        warnings.push_back(fmt::format(
            "case '{}' observes nothing yet: it can be planned (demcal plan --prior), not calibrated", one.name));
    for (const std::string& warning : warnings) say(*common, "warning: " + warning);
    data::refuse(rows.findings);
    answer(*common,
           fmt::format(
               "{}: {}, {}, {}, {}, {}, {}: {}", study.name, data::counted(study.parameters.size(), "parameter"),
               data::counted(study.controls.size(), "control"), data::counted(study.materials.size(), "material"),
               data::counted(study.observations.size(), "observation set"), data::counted(study.cases.size(), "case"),
               data::counted(data::used_rows(rows.table), "training run"),
               warnings.empty() ? "no problems" : data::counted(warnings.size(), "warning")));
    nlohmann::json findings = nlohmann::json::array();
    for (const data::Finding& finding : rows.findings)
      findings.push_back({{"kind", to_text(finding.kind)},
                          {"place", finding.place},
                          {"severity", data::to_text(finding.severity)},
                          {"what", finding.what},
                          {"remedy", finding.remedy},
                          {"places", finding.places}});
    print_json(*common, {{"study", study.name},
                         {"rows", data::used_rows(rows.table)},
                         {"missing_runs", missing.size()},
                         {"cpu_seconds_at_most", campaign_seconds},
                         {"materials", materials},
                         {"warnings", warnings},
                         {"findings", findings}});
    return warnings.empty() ? data::ExitStatus::done : data::ExitStatus::warning;
  };
}

}  // namespace cli
