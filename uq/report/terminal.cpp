#include "uq/report/terminal.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <sstream>

#include "uq/findings/wording.hpp"

namespace uq {
namespace {

/// Characters on the screen, for UTF-8 text without wide characters.
std::size_t width_of(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

/// Text that cannot steer the terminal: control characters become spaces.
std::string harmless(std::string_view text) {
  std::string plain(text);
  for (char& c : plain) {
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
  }
  return plain;
}

/// Words folded at `columns`; the first line starts with `lead`, the others are indented as far.
std::string fold(const std::string& lead, const std::string& text, int columns) {
  if (text.empty()) return {};
  const std::string indent(width_of(lead), ' ');
  std::string folded = lead;
  std::size_t used = indent.size();
  std::istringstream words(harmless(text));
  bool first = true;
  for (std::string word; words >> word; first = false) {
    const std::size_t width = width_of(word);
    if (!first && used + 1 + width > static_cast<std::size_t>(columns)) {
      folded += "\n" + indent;
      used = indent.size();
    } else if (!first) {
      folded += ' ';
      used += 1;
    }
    folded += word;
    used += width;
  }
  return folded + "\n";
}

std::string pad(const std::string& text, std::size_t width) {
  return text + std::string(width > width_of(text) ? width - width_of(text) : 0, ' ');
}

std::string parameter_lines(const CaseReport& result, int columns) {
  std::size_t names = 0, values = 0, verdicts = 0;
  struct Row {
    std::string name, value, verdict, profile;
  };
  std::vector<Row> rows;
  for (const ParameterReport& parameter : result.parameters) {
    const Verdict verdict = shown_verdict(result, parameter);
    const std::string said = format_verdict(verdict, verdict == parameter.verdict ? parameter.reason : std::nullopt,
                                            parameter.borderline && result.fits);
    rows.push_back(
        {harmless(parameter.name), harmless(shown_value(result, parameter, Typography::ascii)), said,
         result.doubt.empty() ? "95 % profile: " + format_profile_interval(parameter, Typography::ascii) : ""});
    names = std::max(names, width_of(rows.back().name));
    values = std::max(values, width_of(rows.back().value));
    verdicts = std::max(verdicts, width_of(rows.back().verdict));
  }
  std::string text;
  for (const Row& row : rows) {
    const std::string start = "  " + pad(row.name, names) + "  " + pad(row.value, values) + "  ";
    const std::string whole =
        row.profile.empty() ? start + row.verdict : start + pad(row.verdict, verdicts) + "  " + row.profile;
    if (width_of(whole) <= static_cast<std::size_t>(columns)) {
      text += whole + "\n";
    } else {
      text += start + row.verdict + "\n" + fold(std::string(4 + names, ' '), row.profile, columns);
    }
  }
  return text;
}

std::string case_text(const CaseReport& result, int columns) {
  std::string text = harmless(result.name) + "\n";
  if (!result.fits && result.doubt.empty()) {
    text += fold("  ! ",
                 fmt::format("The model does not fit (posterior predictive p = {}).",
                             significant(result.ppp, 2, Typography::ascii)),
                 columns);
  }
  if (!result.converged) text += fold("  ! ", "The sampler has not converged.", columns);
  text += parameter_lines(result, columns);
  for (const NuisanceReport& nuisance : result.nuisances)
    text +=
        fold("  integrated out: ",
             fmt::format("{} {} (prior {})", nuisance.name,
                         format_with_error(nuisance.mean, nuisance.sd, nuisance.unit, Typography::ascii),
                         format_with_error(nuisance.prior_mean, nuisance.prior_sd, nuisance.unit, Typography::ascii)),
             columns);
  for (const ModeReport& mode : result.modes) {
    std::string values;
    for (const auto& [name, mean] : mode.mean)
      values +=
          fmt::format("{}{} {}", values.empty() ? "" : ", ", name,
                      format_with_error(mean, mode.sd.contains(name) ? mode.sd.at(name) : 0.0, "", Typography::ascii));
    text += fold("  together: ", fmt::format("{:.0f} %: {}", 100.0 * mode.weight, values), columns);
  }
  // The finding states every combination, and of a curve only that it is one.
  for (const TradedPair& traded : result.traded)
    if (traded.form == CombinationForm::curved)
      text += fold("  known together: ",
                   fmt::format("{} (correlation {:.3f})",
                               traded.statement.empty() ? traded.combination : traded.statement, traded.correlation),
                   columns);
  for (const ModelComparison& comparison : result.comparisons) text += fold("  ", comparison.sentence, columns);
  text += fold("  ", result.finding, columns);
  text += fold("  ", without_sentence(result), columns);
  if (!result.verification.empty()) text += fold("  ", result.verification.back().sentence, columns);
  for (const PredictionReport& prediction : result.predictions) text += fold("  ", prediction.sentence, columns);
  text += fold("  ", result.consequence, columns);
  text += fold("  -> ", result.remedy, columns);
  return text;
}

}  // namespace

std::string terminal_summary(const CalibrationReport& report, const TerminalOptions& options) {
  std::string text;
  for (const std::string& line : first_lines(report)) text += fold("warning: ", line, options.columns);
  for (const std::string& caution : report.cautions) text += fold("note: ", caution, options.columns);
  if (!text.empty()) text += "\n";
  for (const CaseReport& result : report.cases) text += case_text(result, options.columns) + "\n";
  if (report.cases.empty()) text += "No case was calibrated.\n";
  text += fold("Set on the command line: ", changes_of(report), options.columns);
  if (!options.report_file.empty()) text += "Report: " + harmless(options.report_file) + "\n";
  return text;
}

}  // namespace uq
