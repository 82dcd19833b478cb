#include "cli/calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "campaign/design.hpp"
#include "campaign/out_files.hpp"
#include "data/atomic_file.hpp"
#include "data/hash.hpp"
#include "data/provenance.hpp"
#include "data/terminal.hpp"
#include "dem/bed/derived.hpp"
#include "uq/calibrate/data_check.hpp"
#include "uq/calibrate/effort.hpp"
#include "uq/emulate/surrogate_file.hpp"
#include "uq/findings/report_file.hpp"
#include "uq/findings/wording.hpp"
#include "uq/report/html.hpp"
#include "uq/report/terminal.hpp"

namespace cli {
namespace fs = std::filesystem;
namespace {

/// A note on the size of the rig's attraction at the top of the calibrated range: a Hamaker constant alone says
/// nothing.
std::string attraction_note(const std::string& material, const dem::Case& c) {
  const dem::Derived derived = dem::derive(c);
  return fmt::format(
      "{}: minimum separation {:.3g} nm, L = {:.3g} mm; the largest Hamaker constant in range ({:.3g} J, {:.3g} J on "
      "the original grains) "
      "gives a pull-off force of {:.3g} uN, Bond number {:.3g}. Attraction depends on Hamaker constant / separation^2 "
      "alone.",
      material.empty() ? "simulation" : material, 1e9 * c.contact.minimum_separation, 1e3 * derived.length_scale,
      derived.hamaker, derived.original_hamaker, 1e6 * derived.pull_off, derived.bond);
}

}  // namespace

StudyRows rows_to_learn_from(const Common& common, const Workspace& workspace) {
  StudyRows rows = study_rows(workspace);
  for (const std::string& note : rows.notes) say(common, "note: " + note);
  require_rows(workspace, rows, common.study);
  std::vector<data::Finding> found =
      uq::check_data(workspace.study, rows.table, rows.low, workspace.surrogates->log_outputs);
  rows.findings.insert(rows.findings.end(), found.begin(), found.end());
  if (data::has(rows.findings, data::Severity::refusal))  // what is suspected beside it may be its cause
    for (const data::Finding& finding : rows.findings)
      if (finding.severity == data::Severity::warning) say(common, "warning: " + data::describe(finding));
  data::refuse(rows.findings);
  return rows;
}

std::vector<std::string> say_warnings(const Common& common, const StudyRows& rows,
                                      const std::vector<uq::FittedSurrogate>& fitted,
                                      const std::vector<std::string>& more) {
  std::vector<std::string> warnings, notes;
  for (const data::Finding& finding : rows.findings)
    (finding.severity == data::Severity::note ? notes : warnings).push_back(data::describe(finding));
  for (std::string& warning : uq::surrogate_warnings(fitted)) warnings.push_back(std::move(warning));
  warnings.insert(warnings.end(), more.begin(), more.end());
  for (std::string& caution : uq::surrogate_cautions(fitted)) notes.push_back(std::move(caution));
  for (const std::string& warning : warnings) say(common, "warning: " + warning);
  for (const std::string& note : notes) say(common, "note: " + note);
  return warnings;
}

void write_next_runs(const Workspace& workspace, const std::vector<uq::SupportReport>& supports) {
  const std::vector<data::Input> inputs = data::inputs_of(workspace.study);
  std::vector<Point> points;
  for (std::size_t i = 0, left = 1; left > 0; ++i) {  // the cases in turn
    left = 0;
    for (const uq::SupportReport& support : supports) {
      if (i >= support.next_runs.size()) continue;
      ++left;
      const uq::NextRun& run = support.next_runs[i];
      Point point{run.material, {}};
      for (const data::Input& input : inputs) point.inputs.push_back(input.unit.to_si(run.point.at(input.name)));
      points.push_back(std::move(point));
    }
  }
  if (!points.empty()) write_points(workspace, next_runs_path(workspace), points);
}

uq::SurrogateOptions surrogate_options(const Common& common, const Workspace& workspace, const StudyRows& rows) {
  uq::SurrogateOptions options = *workspace.surrogates;
  options.fit.seed = workspace.study.seed;
  options.low = rows.low;
  for (const std::string& note : uq::effort_notes(workspace.study, rows.table, options)) say(common, "note: " + note);
  uq::SavedSurrogates saved = uq::load_surrogates(surrogate_path(workspace), workspace.study, rows.table, options);
  if (!saved.stale.empty()) say(common, fmt::format("{} is fitted again: {}", surrogate_path(workspace), saved.stale));
  options.known = std::move(saved.fitted);
  return options;
}

void keep_surrogates(const Workspace& workspace, const StudyRows& rows, const uq::SurrogateOptions& options,
                     const std::vector<uq::FittedSurrogate>& fitted) {
  const bool nothing_new = std::all_of(fitted.begin(), fitted.end(), [&](const uq::FittedSurrogate& one) {
    return std::any_of(options.known.begin(), options.known.end(),
                       [&](const uq::FittedSurrogate& known) { return known.process == one.process; });
  });
  if (!nothing_new) uq::save_surrogates(surrogate_path(workspace), workspace.study, rows.table, options, fitted);
}

void say_surrogates(const Common& common, const std::vector<uq::FittedSurrogate>& fitted) {
  for (const uq::FittedSurrogate& one : fitted) {
    const uq::SurrogateReport& r = one.report;
    answer(common,
           fmt::format("surrogate of {}{}{}: {} (Q2 {:.4f} left out, {:.4f} held out; 95 % intervals cover {:.0f} "
                       "%; {} runs{}).{}",
                       r.material, r.material.empty() ? "" : " ", r.output, uq::to_text(r.verdict), r.q2, r.q2_held_out,
                       100.0 * r.coverage95, r.runs, r.low_runs > 0 ? fmt::format(" over {}", r.low_runs) : "",
                       r.verdict == uq::SurrogateWord::good ? "" : " " + r.remedy));
    for (const std::string& note : r.notes) answer(common, "  " + note);
  }
}

namespace {

/// The inputs that results rest on, each with its digest.
std::vector<std::pair<std::string, std::string>> inputs_of(const Workspace& workspace, const StudyRows& rows) {
  const data::Study& study = workspace.study;
  std::vector<std::pair<std::string, std::string>> found;
  const auto add = [&](const std::string& name, const std::string& value) { found.emplace_back(name, value); };
  const std::string changes = fmt::format("{}", fmt::join(workspace.changes, "\n"));
  add("study", fmt::format("{}{} (xxh3 {})", fs::path(study.file).filename().string(),
                           changes.empty() ? "" : " with what the command line set",
                           changes.empty() ? data::hash_file(study.file)
                                           : data::hash_text(data::read_file(study.file) + "\n" + changes)));
  if (!changes.empty()) add(uq::set_on_command_line, fmt::format("{}", fmt::join(workspace.changes, "; ")));
  add("training table", fmt::format("{} rows (xxh3 {})", data::used_rows(rows.table), uq::table_hash(rows.table)));
  if (rows.low)
    add("rows of the cheaper level", fmt::format("{} (xxh3 {})", rows.low->rows.size(), uq::table_hash(*rows.low)));
  for (const data::ObservationSet& set : study.observations)
    add("observations " + set.name,
        fmt::format("{} (xxh3 {})", fs::path(set.file).filename().string(), data::hash_file(set.file)));
  return found;
}

}  // namespace

std::vector<std::string> changed_since(const uq::CalibrationReport& report, const Workspace& workspace,
                                       const StudyRows& rows) {
  std::vector<std::string> changed;
  for (const auto& input : inputs_of(workspace, rows))
    if (std::find(report.provenance.begin(), report.provenance.end(), input) == report.provenance.end())
      changed.push_back(input.first);
  return changed;
}

void add_provenance(uq::CalibrationReport& report, const Workspace& workspace, const StudyRows& rows) {
  const data::Study& study = workspace.study;
  std::vector<std::pair<std::string, std::string>> program = data::provenance();
  report.provenance.insert(report.provenance.begin(), program.begin(), program.end());
  for (auto& input : inputs_of(workspace, rows)) report.provenance.push_back(std::move(input));
  for (const auto& [material, settings] : workspace.cases)
    report.provenance.emplace_back("simulation settings" + (material.empty() ? "" : " " + material),
                                   settings_hash(workspace, material));
  for (const std::string& note : study.notes) report.notes.push_back(note);
  for (const auto& [material, settings] : workspace.cases) {
    Point top{material, {}};
    const std::map<std::string, double>& fixed = study.material(material).fixed;
    for (const data::Input& input : data::inputs_of(study))
      top.inputs.push_back(fixed.contains(input.name) ? fixed.at(input.name) : input.axis.high);
    if (const dem::Case at_top = case_at(workspace, top); at_top.contact.hamaker > 0.0)
      report.notes.push_back(attraction_note(material, at_top));
  }
  for (const std::string& note : rows.notes) report.notes.push_back(note);
}

void keep_plans(const Common& common, const Workspace& workspace, const StudyRows& rows,
                uq::CalibrationReport& report) {
  if (!std::filesystem::exists(plan_path(workspace))) return;
  const std::string again = "run: demcal plan " + common.study;
  if (!std::filesystem::exists(results_path(workspace)))
    return say(common, fmt::format("note: {} was made before there was a report, and is not in it ({})",
                                   data::shown_path(plan_path(workspace)), again));
  try {
    const uq::CalibrationReport earlier = uq::load_report(results_path(workspace));
    const std::vector<std::string> changed = changed_since(earlier, workspace, rows);
    for (const uq::CaseReport& before : earlier.cases) {
      const auto now = std::find_if(report.cases.begin(), report.cases.end(),
                                    [&](const uq::CaseReport& one) { return one.name == before.name; });
      if (!before.plan || now == report.cases.end()) continue;
      if (changed.empty())
        now->plan = before.plan;
      else
        say(common,
            fmt::format("note: the plan of case {} is left out of the report, since these have changed: {} ({})",
                        before.name, fmt::join(changed, ", "), again));
    }
  } catch (const data::InputError&) {  // of an older version or damaged: it is replaced
  }
}

void write_report(const Workspace& workspace, const uq::CalibrationReport& report) {
  uq::save_report(report, results_path(workspace));
  uq::write_report_html(report, workspace.out);
}

data::ExitStatus say_report(const Common& common, const Workspace& workspace, const uq::CalibrationReport& report) {
  // Whoever redirects the answer, or wants none, would not see them.
  if (common.quiet || (!common.json && data::answers_go_elsewhere()))
    for (const std::string& warning : uq::first_lines(report)) say(common, "warning: " + warning);
  answer(common, uq::terminal_summary(report, {.report_file = page_path(workspace)}));
  print_json(common, uq::report_json(report));
  return uq::has_warning(report) ? data::ExitStatus::warning : data::ExitStatus::done;
}

std::shared_ptr<std::optional<data::Sampler>> add_sampler_option(CLI::App& command) {
  auto chosen = std::make_shared<std::optional<data::Sampler>>();
  command
      .add_option_function<std::string>(
          "--sampler",
          [chosen](const std::string& name) {
            *chosen = name == "nuts" ? data::Sampler::nuts : data::Sampler::mixture;
          },
          "instead of each case's own: mixture (no gradient) or nuts")
      ->check(one_of({"mixture", "nuts"}));
  return chosen;
}

}  // namespace cli
