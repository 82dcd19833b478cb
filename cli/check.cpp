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

/// The refusals of an action, one text per problem.
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

/// The runs that a calibration would refuse, and the candidates of [plan] that a plan would refuse.
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

/// The forecast of the rig in the middle of its ranges, and the cost of the missing runs.
struct MaterialsForetold {
  std::vector<std::string> warnings;
  nlohmann::json materials = nlohmann::json::array();
  std::size_t missing = 0;
  double seconds = 0.0;  ///< s of processor time, at most
};

/// Says it of each material that is simulated.
MaterialsForetold foretell_materials(const Common& common, const Workspace& workspace, const StudyRows& rows) {
  MaterialsForetold all;
  const std::vector<Point> missing =
      own_engine(workspace) ? plan_campaign(workspace, rows.all, 0).points : std::vector<Point>{};
  all.missing = missing.size();
  for (const auto& [material, unused] : workspace.cases) {
    const Point middle = parse_point(workspace, material, {});
    const Foretold told = foretell(workspace, middle);
    const dem::Case& c = told.prepared.given();
    const Cost cost = cost_of(told.prepared);
    const auto runs =
        std::count_if(missing.begin(), missing.end(), [&, of = material](const Point& p) { return p.material == of; });
    const double seconds = static_cast<double>(runs) * cost.seconds;
    all.seconds += seconds;
    answer(common, material.empty() ? "simulation, amid its ranges:" : material + ", amid its ranges:");
    for (const std::string& line : dem::describe(c, told.prepared.derived())) answer(common, "  " + line);
    for (const std::string& line : dem::describe(told.forecast)) answer(common, "  " + line);
    answer(common,
           fmt::format("  a run: at most {:.3g} steps, {} of processor time, {:.3g} MB; {} missing: {} (at {:.2g} "
                       "million particle-steps/s, measured on this machine just now)",
                       cost.steps, data::rough_duration_text(cost.seconds), 1e-6 * cost.bytes,
                       data::counted(static_cast<std::size_t>(runs), "run"), data::rough_duration_text(seconds),
                       1e-6 * cost.effort.rate));
    const std::string of = material.empty() ? "" : material + ": ";
    for (const auto& list : {told.forecast.warnings, cost.warnings, problems_at_ends(workspace, middle)})
      for (const std::string& warning : list) all.warnings.push_back(of + warning);
    if (material == workspace.cases.begin()->first)
      for (const std::string& note : dem::rig_warnings(c)) say(common, "note: " + note);
    nlohmann::json one = to_json(told, cost);
    one["name"] = material;
    one["missing_runs"] = runs;
    all.materials.push_back(std::move(one));
  }
  if (own_engine(workspace))
    answer(common, fmt::format("the campaign: {} missing, at most {} of processor time",
                               data::counted(all.missing, "run"), data::rough_duration_text(all.seconds)));
  return all;
}

/// What cannot be calibrated yet, which is no fault of a study that is only begun.
std::vector<std::string> case_notes(const data::Study& study) {
  if (study.parameters.empty())
    return {"there is no [parameters.NAME]: the study can simulate and train, and has nothing to calibrate"};
  if (study.cases.empty())
    return {"there is no [[calibrate]] case yet: the study can train and plan (demcal plan --prior), not calibrate"};
  std::vector<std::string> notes;
  for (const data::CalibrationCase& one : study.cases)
    if (one.observe.empty())
      notes.push_back(fmt::format(
          "case '{}' observes nothing yet: it can be planned (demcal plan --prior), not calibrated", one.name));
  return notes;
}

nlohmann::json to_json(const std::vector<data::Finding>& findings) {
  nlohmann::json all = nlohmann::json::array();
  for (const data::Finding& finding : findings)
    all.push_back({{"kind", to_text(finding.kind)},
                   {"place", finding.place},
                   {"severity", data::to_text(finding.severity)},
                   {"what", finding.what},
                   {"remedy", finding.remedy},
                   {"places", finding.places}});
  return all;
}

/// Adds what the data themselves show to what was found when they were read.
void look_at_data(const Workspace& workspace, StudyRows& rows) {
  const std::vector<data::Finding> found =
      uq::check_data(workspace.study, rows.table, rows.low, workspace.surrogates->log_outputs);
  rows.findings.insert(rows.findings.end(), found.begin(), found.end());
  // Before the runs are made there may be no measurement yet, so that its placeholder is no fault of the study.
  for (data::Finding& finding : rows.findings)
    if (finding.kind == data::FindingKind::placeholder) finding.severity = data::Severity::note;
}

data::ExitStatus check(const Common& common) {
  const Workspace workspace = open_workspace(common);
  const data::Study& study = workspace.study;
  StudyRows rows = study_rows(workspace);
  // Runs of one's own come later; those of another code are what the study rests on.
  if (!own_engine(workspace)) require_rows(workspace, rows, common.study);

  std::vector<std::string> warnings = rows.notes;
  const auto add = [&warnings](std::vector<std::string> more) {
    for (std::string& warning : more) warnings.push_back(std::move(warning));
  };
  look_at_data(workspace, rows);
  for (const data::Finding& finding : rows.findings) {
    if (finding.severity == data::Severity::warning) add({data::describe(finding)});
    if (finding.severity == data::Severity::note) say(common, "note: " + data::describe(finding));
  }
  for (const data::Problem& problem : data::outside_training_range(study)) add({data::describe({problem})});
  add(refusals([&] { coarse_levels(workspace); }));
  add(refused_later(workspace, rows));
  uq::SurrogateOptions surrogates = *workspace.surrogates;
  surrogates.low = rows.low;
  for (const std::string& note : uq::effort_notes(study, rows.table, surrogates)) say(common, "note: " + note);
  const MaterialsForetold foretold = foretell_materials(common, workspace, rows);
  add(foretold.warnings);
  for (const std::string& note : case_notes(study)) say(common, "note: " + note);

  for (const std::string& warning : warnings) say(common, "warning: " + warning);
  data::refuse(rows.findings);
  answer(
      common,
      fmt::format("{}: {}, {}, {}, {}, {}, {}: {}", study.name, data::counted(study.parameters.size(), "parameter"),
                  data::counted(study.controls.size(), "control"), data::counted(study.materials.size(), "material"),
                  data::counted(study.observations.size(), "observation set"),
                  data::counted(study.cases.size(), "case"), data::counted(data::used_rows(rows.table), "training run"),
                  warnings.empty() ? "no problems" : data::counted(warnings.size(), "warning")));
  print_json(common, {{"study", study.name},
                      {"rows", data::used_rows(rows.table)},
                      {"missing_runs", foretold.missing},
                      {"cpu_seconds_at_most", foretold.seconds},
                      {"materials", foretold.materials},
                      {"warnings", warnings},
                      {"findings", to_json(rows.findings)}});
  return warnings.empty() ? data::ExitStatus::done : data::ExitStatus::warning;
}

}  // namespace

Action add_check(CLI::App& program) {
  const auto common = std::make_shared<Common>();
  add_study_command(program, "check", "read everything and report every problem, without simulating",
                    "demcal check data/developer", *common);
  return [common] { return check(*common); };
}

}  // namespace cli
