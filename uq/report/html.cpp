#include "uq/report/html.hpp"

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
namespace page {
namespace {

Markup warnings_box(const CalibrationReport& report) {
  if (!has_warning(report)) return {};
  const auto lines = first_lines(report);
  const char* const words = lines.empty()      ? "! This result carries a warning."
                            : lines.size() > 1 ? "! Warnings"
                                               : "! Warning";
  return tag::div.is("warnings").with("role", "alert")(tag::p(words), tag::ul.unless_empty(each(lines, tag::li)));
}

Markup title_block(const CalibrationReport& report) {
  const auto line = [](const char* kind, const char* what, const std::string& words) {
    return words.empty() ? Markup() : tag::p.is(kind)(what, words);
  };
  return tag::header(tag::h1("Calibration report: ", report.study_name), line("lead", "", report.study_description),
                     line("note", "Study: ", report.study_file),
                     line("note", "Set on the command line: ", changes_of(report)));
}

Markup glance(const std::vector<CaseReport>& cases) {
  if (cases.empty()) return tag::p("No case was calibrated.");
  const bool all_synthetic = std::all_of(cases.begin(), cases.end(), is_synthetic);
  Markup answers;
  Table table{.columns = {{"Case"}, {"Parameter"}, {"Posterior mean \u00b1 sd", nowrap}, {"Verdict"}}};
  for (std::size_t i = 0; i < cases.size(); ++i) {
    const CaseReport& result = cases[i];
    const Markup name = link(case_id(i, result), result.name);
    answers += tag::dt(name) + tag::dd(headline(result, pretty),
                                       is_synthetic(result) && !all_synthetic ? " (Its data are synthetic.)" : "");
    for (const ParameterReport& parameter : result.parameters)
      table.rows.push_back({&parameter == &result.parameters.front() ? name : Markup(),
                            parameter.name,
                            {shown_value(result, parameter, pretty), parameter.intervals.size() > 1 ? plain : nowrap},
                            badge(shown_verdict(result, parameter))});
    for (const TradedPair& traded : result.traded)
      if (std::isfinite(traded.value))
        table.rows.push_back({"", traded.combination, with_error(traded.value, traded.error, traded.unit),
                              tag::span.is("soft")("known together")});
  }
  return tag::dl.is("answers")(answers) +
         (all_synthetic ? tag::p.is("soft")("The data are synthetic, not measured.") : Markup()) + table;
}

Markup error_scan_section(const CalibrationReport& report) {
  if (report.error_scan.empty()) return {};
  std::set<double> errors;
  for (const ErrorScan& scan : report.error_scan) errors.insert(scan.relative_error);
  Table table{.columns = {{"Case"}, {"Parameter"}}};
  for (const double error : errors) table.columns.push_back({fmt::format("{:.4g}\u00a0%", 100.0 * error)});
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
  std::map<std::pair<std::string, std::string>, std::map<double, Markup>> cells;
  for (const ErrorScan& scan : report.error_scan) {
    for (const ParameterAgain& parameter : scan.parameters) {
      const std::pair key{scan.case_name, parameter.name};
      if (std::find(rows.begin(), rows.end(), key) == rows.end()) rows.push_back(key);
      const std::string unit = unit_of(scan.case_name, parameter.name);
      cells[key][scan.relative_error] = format_verdict(parameter.verdict, parameter.reason, parameter.borderline) +
                                        tag::br() +
                                        tag::span.is("soft")(with_error(parameter.mean, parameter.sd, unit));
    }
  }
  std::string previous;
  for (const auto& key : rows) {
    table.rows.push_back({key.first == previous ? "" : key.first, key.second});
    for (const double error : errors) table.rows.back().push_back(cells[key][error]);
    previous = key.first;
  }
  return tag::p(
             "The verdicts for made-up data of the same kind: what the posterior predicts, with noise of another share "
             "of the value.") +
         table;
}

Markup findings_section(const std::vector<data::Finding>& findings) {
  if (findings.empty()) return {};
  Table table{.columns = {{"Kind"}, {"Where"}, {"What", lengthy}, {"What to do", lengthy}}};
  for (const data::Finding& one : findings) table.rows.push_back({to_text(one.kind), one.place, one.what, one.remedy});
  return tag::p("What is odd in the data, found before anything was fitted.") + table;
}

Markup notes_section(const std::vector<std::string>& notes) {
  if (notes.empty()) return {};
  return tag::p("Numbers in this report depend on them.") + tag::ul(each(notes, tag::li));
}

Markup pairs_section(const std::vector<std::pair<std::string, std::string>>& entries) {
  if (entries.empty()) return {};
  Table table{.columns = {{""}, {"", lengthy}}};
  for (const auto& [name, value] : entries) table.rows.push_back({name, value});
  return table;
}

struct Section {
  std::string id, heading;
  Markup content;
};

std::vector<Section> sections_of(const CalibrationReport& report, const Context& context) {
  std::vector<Section> sections;
  for (std::size_t i = 0; i < report.cases.size(); ++i) {
    const std::string id = case_id(i, report.cases[i]);
    sections.push_back({id, "Case " + report.cases[i].name, case_section(report.cases[i], id, context)});
  }
  for (const Section& section : {
           Section{"error-scan", "If the measurement were better or worse", error_scan_section(report)},
           Section{"data", "Runs and observations", findings_section(report.findings)},
           Section{"design", "Where the runs lie", design_section(report.designs, context)},
           Section{"surrogates", "Surrogate validation", surrogate_section(report.surrogates, context)},
           Section{"sampler", "Sampler diagnostics", sampler_section(report.cases, context)},
           Section{"glossary", "Words", glossary_section()},
           Section{"thresholds", "Thresholds behind the verdicts", pairs_section(report.thresholds)},
           Section{"notes", "Choices that the source does not give", notes_section(report.notes)},
           Section{"provenance", "Provenance", pairs_section(report.provenance)},
       })
    if (!section.content.empty()) sections.push_back(section);
  return sections;
}

Markup page_of(const CalibrationReport& report, const Context& context) {
  const std::vector<Section> sections = sections_of(report, context);
  return Raw("<!DOCTYPE html>\n") +
         tag::html.with("lang", "en")(
             tag::head(tag::meta.with("charset", "utf-8")(),
                       tag::meta.with("name", "viewport").with("content", "width=device-width, initial-scale=1")(),
                       tag::meta.with("name", "generator").with("content", "demcal " + program_version(report))(),
                       tag::title("Calibration report: ", report.study_name), tag::style(Raw(report_style))),
             tag::body(
                 warnings_box(report), title_block(report), glance(report.cases),
                 tag::ul.is("note").unless_empty(each(report.cautions, tag::li)),
                 tag::nav.with("aria-label", "Contents")(
                     tag::h3("Contents"),
                     tag::ol(each(sections, [](const Section& one) { return tag::li(link(one.id, one.heading)); }))),
                 tag::main(each(sections, [](const Section& one) {
                   return tag::section.with("id", one.id)(tag::h2(one.heading), one.content);
                 }))));
}

}  // namespace
}  // namespace page

void write_report_html(const CalibrationReport& report, const std::string& folder, const HtmlOptions& options) {
  namespace fs = std::filesystem;
  const page::Context context{.options = options, .figures = (fs::path(folder) / "figures").string()};
  data::write_atomically((fs::path(folder) / "report.html").string(), page::page_of(report, context).html());
}

}  // namespace uq
