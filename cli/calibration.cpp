#include "cli/calibration.hpp"

#include <fmt/core.h>

#include <filesystem>

#include "cli/point.hpp"
#include "data/hash.hpp"
#include "data/provenance.hpp"
#include "dem/derived.hpp"
#include "surrogate/storage.hpp"
#include "uq/report_html.hpp"
#include "uq/report_json.hpp"
#include "uq/report_results.hpp"
#include "uq/report_terminal.hpp"
#include "uq/report_text.hpp"

namespace cli {
namespace fs = std::filesystem;
namespace {

/// Hash of what the rows say, in their order.
std::string table_hash(const data::RunTable& table) {
  std::string text;
  for (const data::RunRow& row : table.rows) {
    text += data::row_key(row);
    for (std::size_t i = 0; i < row.outputs.size(); ++i)
      text += fmt::format(" {} {}", row.outputs[i], row.standard_errors[i]);
    text += "\n";
  }
  return data::hash_text(text);
}

/// Hash of what in the study decides a surrogate.
std::string surrogate_hash(const data::Study& study) {
  std::string text = fmt::format("{}\n", study.seed);
  for (const data::Parameter& p : study.parameters)
    text += fmt::format("{} {} {} {}\n", p.name, p.low, p.high, p.scale == data::Scale::log);
  for (const data::Control& c : study.controls) text += fmt::format("{} {} {}\n", c.name, c.low, c.high);
  for (const data::Output& output : study.outputs) text += output.name + "\n";
  return data::hash_text(text);
}

/// What the rig's attraction amounts to at the top of the calibrated range: a Hamaker constant alone says nothing.
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

TrainingRows rows_to_learn_from(const Common& common, const Workspace& workspace) {
  data::require_cases(workspace.study);
  TrainingRows rows = training_rows(workspace);
  for (const std::string& note : rows.notes) say(common, "note: " + note);
  if (rows.table.rows.empty())
    throw data::InputError(data::ExitStatus::missing_input,
                           {workspace.study.file, "has no usable training runs",
                            workspace.cases.empty() ? "name a table of runs under [training] table"
                                                    : "make them: demcal train " + common.study});
  return rows;
}

void save_surrogates(const Workspace& workspace, const data::RunTable& table,
                     const std::vector<uq::FittedSurrogate>& fitted) {
  surrogate::ProcessSet processes;
  for (const uq::FittedSurrogate& one : fitted) {
    const std::string& output = workspace.study.outputs[one.rows.output].name;
    processes.emplace(one.rows.material.empty() ? output : one.rows.material + " " + output, *one.process);
  }
  surrogate::save_processes((fs::path(workspace.out) / "surrogate.h5").string(), processes,
                            {.study_hash = surrogate_hash(workspace.study), .table_hash = table_hash(table)});
}

void add_provenance(uq::CalibrationReport& report, const Workspace& workspace, const TrainingRows& rows) {
  const data::Study& study = workspace.study;
  std::vector<std::pair<std::string, std::string>> program = data::provenance();
  report.provenance.insert(report.provenance.begin(), program.begin(), program.end());
  const auto add = [&](const std::string& name, const std::string& value) {
    report.provenance.emplace_back(name, value);
  };
  add("study", fmt::format("{} (xxh3 {})", fs::path(study.file).filename().string(), data::hash_file(study.file)));
  add("training table", fmt::format("{} rows (xxh3 {})", rows.table.rows.size(), table_hash(rows.table)));
  for (const data::ObservationSet& set : study.observations)
    add("observations " + set.name,
        fmt::format("{} (xxh3 {})", fs::path(set.file).filename().string(), data::hash_file(set.file)));
  for (const auto& [material, settings] : workspace.cases)
    add("simulation settings" + (material.empty() ? "" : " " + material), settings_hash(workspace, material));
  for (const std::string& note : study.notes) report.notes.push_back(note);
  for (const auto& [material, settings] : workspace.cases) {
    Point top{material, {}};
    const data::Material& rows_of = study.material(material);
    for (const data::Parameter& p : study.parameters)
      top.inputs.push_back(rows_of.fixed.contains(p.name) ? rows_of.fixed.at(p.name) : p.high);
    for (const data::Control& c : study.controls) top.inputs.push_back(c.high);
    if (const dem::Case at_top = case_at(workspace, top); at_top.contact.hamaker > 0.0)
      report.notes.push_back(attraction_note(material, at_top));
  }
  for (const std::string& note : rows.notes) report.notes.push_back(note);
}

data::ExitStatus write_report(const Common& common, const Workspace& workspace, const uq::CalibrationReport& report) {
  const fs::path out = workspace.out;
  uq::write_report_json(report, (out / "report.json").string());
  uq::write_report_html(report, workspace.out);
  say(common, uq::terminal_summary(report, {.report_file = (out / "report.html").string()}));
  print_json(common, uq::report_json(report));
  return uq::has_warning(report) ? data::ExitStatus::warning : data::ExitStatus::done;
}

std::string posterior_path(const Workspace& workspace, const std::string& case_name) {
  return (fs::path(workspace.out) / ("posterior-" + case_name + ".nc")).string();
}

}  // namespace cli
