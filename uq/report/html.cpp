#include "uq/report/html.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include "data/atomic_file.hpp"
#include "uq/findings/headline.hpp"
#include "uq/report/page.hpp"
#include "uq/report/style.hpp"

namespace uq {
namespace {

using page::Cell;
using page::number;
using page::Table;
using page::text;

constexpr Typography pretty = Typography::unicode;

std::string warnings_box(const CalibrationReport& report) {
  const auto lines = first_lines(report);
  if (lines.empty()) {
    return report.warning ? "<div class=\"warnings\" role=\"alert\"><p>! This result carries a warning.</p></div>\n"
                          : "";
  }
  std::string out =
      fmt::format("<div class=\"warnings\" role=\"alert\"><p>! Warning{}</p>\n<ul>\n", lines.size() > 1 ? "s" : "");
  for (const std::string& line : lines) out += "<li>" + text(line) + "</li>\n";
  return out + "</ul></div>\n";
}

std::string cautions_list(const CalibrationReport& report) {
  if (report.cautions.empty()) return {};
  std::string out = "<ul class=\"note\">\n";
  for (const std::string& line : report.cautions) out += "<li>" + text(line) + "</li>\n";
  return out + "</ul>\n";
}

std::string findings_section(const CalibrationReport& report) {
  if (report.findings.empty()) return {};
  Table table{.caption = {}, .head = {{"Kind"}, {"Where"}, {"What"}, {"What to do"}}, .rows = {}};
  for (const DataFinding& finding : report.findings)
    table.rows.push_back(
        {{text(finding.kind)}, {text(finding.place)}, {text(finding.what), "long"}, {text(finding.remedy), "long"}});
  return "<section id=\"data\">\n<h2>Runs and observations</h2>\n<p>What is odd in the data, found before anything was "
         "fitted.</p>\n" +
         page::html(table) + "</section>\n";
}

std::string glance(const CalibrationReport& report) {
  if (report.cases.empty()) return "<p>No case was calibrated.</p>\n";
  const bool all_synthetic = std::all_of(report.cases.begin(), report.cases.end(), is_synthetic);
  std::string answers = "<dl class=\"answers\">\n";
  for (std::size_t i = 0; i < report.cases.size(); ++i)
    answers += fmt::format("<dt><a href=\"#{}\">{}</a></dt><dd>{}{}</dd>\n", page::case_id(i, report.cases[i]),
                           text(report.cases[i].name), text(headline(report.cases[i], pretty)),
                           is_synthetic(report.cases[i]) && !all_synthetic ? " (Its data are synthetic.)" : "");
  answers += "</dl>\n";
  if (all_synthetic) answers += "<p class=\"soft\">The data are synthetic, not measured.</p>\n";
  Table table{.caption = {}, .head = {{"Case"}, {"Parameter"}, {"Posterior mean \u00b1 sd"}, {"Verdict"}}, .rows = {}};
  for (std::size_t i = 0; i < report.cases.size(); ++i) {
    const CaseReport& result = report.cases[i];
    bool first = true;
    for (const ParameterReport& parameter : result.parameters) {
      const std::string link =
          first ? fmt::format("<a href=\"#{}\">{}</a>", page::case_id(i, result), text(result.name)) : "";
      table.rows.push_back(
          {{link},
           {text(parameter.name)},
           {text(shown_value(result, parameter, pretty)), parameter.intervals.size() > 1 ? "" : "nowrap"},
           {page::badge(shown_verdict(result, parameter))}});
      first = false;
    }
    for (const TradedPair& traded : result.traded)
      if (std::isfinite(traded.value))
        table.rows.push_back({{""},
                              {text(traded.combination)},
                              {text(format_with_error(traded.value, traded.error, traded.unit, pretty)), "nowrap"},
                              {"<span class=\"soft\">known together</span>"}});
  }
  return answers + page::html(table);
}

/// The sections in their order: id and heading.
std::string contents(const std::vector<std::pair<std::string, std::string>>& sections) {
  std::string out = "<nav aria-label=\"Contents\"><h3>Contents</h3>\n<ol>\n";
  for (const auto& [id, heading] : sections) out += fmt::format("<li><a href=\"#{}\">{}</a></li>\n", id, text(heading));
  return out + "</ol></nav>\n";
}

std::string percent(double share) { return fmt::format("{:.4g}\u00a0%", 100.0 * share); }

std::string error_scan_section(const CalibrationReport& report) {
  if (report.error_scan.empty()) return {};
  std::set<double> errors;
  for (const ErrorScan& scan : report.error_scan) errors.insert(scan.relative_error);
  Table table{.caption = {}, .head = {{"Case"}, {"Parameter"}}, .rows = {}};
  for (const double error : errors) table.head.push_back({percent(error)});
  const auto unit_of = [&report](const std::string& case_name, const std::string& parameter_name) {
    for (const CaseReport& result : report.cases) {
      for (const ParameterReport& parameter : result.parameters) {
        if (result.name == case_name && parameter.name == parameter_name) return parameter.unit;
      }
    }
    return std::string();
  };
  // One row per case and parameter, in the order in which they come.
  std::vector<std::pair<std::string, std::string>> rows;
  std::map<std::pair<std::string, std::string>, std::map<double, std::string>> cells;
  for (const ErrorScan& scan : report.error_scan) {
    for (const ParameterAgain& parameter : scan.parameters) {
      const std::pair key{scan.case_name, parameter.name};
      if (std::find(rows.begin(), rows.end(), key) == rows.end()) rows.push_back(key);
      cells[key][scan.relative_error] =
          text(format_verdict(parameter.verdict, parameter.reason, parameter.borderline)) +
          "<br><span class=\"soft\">" +
          text(format_with_error(parameter.mean, parameter.sd, unit_of(scan.case_name, parameter.name), pretty)) +
          "</span>";
    }
  }
  std::string previous;
  for (const auto& key : rows) {
    std::vector<Cell> row{{key.first == previous ? "" : text(key.first)}, {text(key.second)}};
    for (const double error : errors) row.push_back({cells[key].contains(error) ? cells[key][error] : ""});
    table.rows.push_back(std::move(row));
    previous = key.first;
  }
  return "<section id=\"error-scan\">\n<h2>If the measurement were better or worse</h2>\n<p>The verdicts for "
         "made-up data of the same kind: what the posterior predicts, with noise of another share of the value.</p>\n" +
         page::html(table) + "</section>\n";
}

std::string sampler_section(const CalibrationReport& report, const page::Context& context) {
  if (report.cases.empty()) return {};
  Table cases{.caption = "By case.",
              .head = {{"Case"},
                       number("Chains \u00d7 draws"),
                       {"Converged"},
                       {"Sampler"},
                       number("Divergences"),
                       number("E-BFMI"),
                       number("Difference to quadrature")},
              .rows = {}};
  Table shape{.caption = "Evidence, and how nearly the parameters' effects are the same.",
              .head = {{"Case"}, number("Log evidence"), number("Collinearity"), number("Fisher condition")},
              .rows = {}};
  Table parameters{.caption = "By parameter.",
                   .head = {{"Case"},
                            {"Parameter"},
                            number("R\u0302"),
                            number("ESS, bulk"),
                            number("ESS, tail"),
                            number("MCSE of the mean"),
                            number("MCSE / sd")},
                   .rows = {}};
  std::string chains;
  for (std::size_t i = 0; i < report.cases.size(); ++i)
    chains += page::chains_part(report.cases[i], page::case_id(i, report.cases[i]), context);
  for (const CaseReport& result : report.cases) {
    const std::string difference =
        result.grid_difference ? significant(*result.grid_difference, 2, pretty) + "\u00a0sd" : "\u2013";
    cases.rows.push_back(
        {{text(result.name)},
         number(fmt::format("{}\u00a0\u00d7\u00a0{}", result.chains, result.draws)),
         {result.converged ? "yes" : "<strong>no</strong>"},
         {text(result.sampler)},
         number(std::to_string(result.divergences)),
         number(std::isfinite(result.energy_fraction) ? significant(result.energy_fraction, 2, pretty) : "\u2013"),
         number(difference)});
    shape.rows.push_back({{text(result.name)},
                          number(std::isfinite(result.log_evidence)
                                     ? format_with_error(result.log_evidence, result.log_evidence_error, "", pretty)
                                     : "\u2013"),
                          number(significant(result.collinearity, 3, pretty)),
                          number(significant(result.fisher_condition, 3, pretty))});
    bool first = true;
    for (const ParameterReport& parameter : result.parameters) {
      const auto count = [](double ess) { return std::isfinite(ess) ? fmt::format("{:.0f}", ess) : "not available"; };
      parameters.rows.push_back(
          {{first ? text(result.name) : ""},
           {text(parameter.name)},
           number(format_value(parameter.rhat, {.exponent = 0, .decimals = 3}, "", pretty)),
           number(count(parameter.ess_bulk)),
           number(count(parameter.ess_tail)),
           number(text(significant(parameter.mcse, 2, pretty) +
                       (parameter.unit.empty() ? "" : "\u00a0" + parameter.unit))),
           number(significant(parameter.sd > 0.0 ? parameter.mcse / parameter.sd : NAN, 2, pretty))});
      first = false;
    }
  }
  return "<section id=\"sampler\">\n<h2>Sampler diagnostics</h2>\n<p>R\u0302 near 1 says that independent chains "
         "agree; the "
         "effective sample sizes (ESS) say how many independent draws the chains are worth; MCSE is the sampler's own "
         "error "
         "of the mean. The difference to quadrature is the largest in mean or sd, in posterior sd, where a grid is "
         "feasible.</p>\n" +
         page::html(parameters) + page::html(cases) + page::html(shape) + chains + "</section>\n";
}

std::string pairs_section(const std::string& id, const char* heading, const char* lead,
                          const std::vector<std::pair<std::string, std::string>>& entries) {
  if (entries.empty()) return {};
  Table table{.caption = {}, .head = {}, .rows = {}};
  for (const auto& [name, value] : entries) table.rows.push_back({{text(name)}, {text(value), "long"}});
  return fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n{}{}</section>\n", id, heading, lead, page::html(table));
}

std::string notes_section(const CalibrationReport& report) {
  if (report.notes.empty()) return {};
  std::string out =
      "<section id=\"notes\">\n<h2>Choices that the source does not give</h2>\n<p>Numbers in this report depend on "
      "them.</p>\n<ul>\n";
  for (const std::string& note : report.notes) out += "<li>" + text(note) + "</li>\n";
  return out + "</ul>\n</section>\n";
}

}  // namespace

void write_report_html(const CalibrationReport& report, const std::string& folder, const HtmlOptions& options) {
  namespace fs = std::filesystem;
  const page::Context context{.options = options, .figures = (fs::path(folder) / "figures").string()};
  std::vector<std::pair<std::string, std::string>> sections;
  std::string body;
  for (std::size_t i = 0; i < report.cases.size(); ++i) {
    sections.emplace_back(page::case_id(i, report.cases[i]), "Case " + report.cases[i].name);
    body += page::case_section(report.cases[i], i, context);
  }
  const auto add = [&](const char* id, const char* heading, const std::string& section) {
    if (section.empty()) return;
    sections.emplace_back(id, heading);
    body += section;
  };
  add("error-scan", "If the measurement were better or worse", error_scan_section(report));
  add("data", "Runs and observations", findings_section(report));
  add("design", "Where the runs lie", page::design_section(report.designs, context));
  add("surrogates", "Surrogate validation", page::surrogate_section(report.surrogates, context));
  add("sampler", "Sampler diagnostics", sampler_section(report, context));
  add("glossary", "Words", page::glossary_section());
  add("thresholds", "Thresholds behind the verdicts",
      pairs_section("thresholds", "Thresholds behind the verdicts", "", report.thresholds));
  add("notes", "Choices that the source does not give", notes_section(report));
  add("provenance", "Provenance", pairs_section("provenance", "Provenance", "", report.provenance));

  const std::string name = text(report.study_name);
  std::string head = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<meta name=\"generator\" content=\"demcal {}\">\n<title>Calibration report: "
      "{}</title>\n<style>{}</style>\n</head>\n"
      "<body>\n",
      text(program_version(report)), name, report_style);
  head += warnings_box(report);
  head += fmt::format("<header>\n<h1>Calibration report: {}</h1>\n", name);
  if (!report.study_description.empty()) head += "<p class=\"lead\">" + text(report.study_description) + "</p>\n";
  if (!report.study_file.empty()) head += "<p class=\"note\">Study: " + text(report.study_file) + "</p>\n";
  if (const std::string changes = changes_of(report); !changes.empty())
    head += "<p class=\"note\">Set on the command line: " + text(changes) + "</p>\n";
  head += "</header>\n" + glance(report) + cautions_list(report) + contents(sections);
  data::write_atomically((fs::path(folder) / "report.html").string(),
                         head + "<main>\n" + body + "</main>\n</body>\n</html>\n");
}

}  // namespace uq
