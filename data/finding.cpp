#include "data/finding.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "data/error.hpp"

namespace data {

Finding about_rows(FindingKind kind, Severity severity, const std::vector<std::string>& places) {
  return {.kind = kind, .place = list_places(places), .severity = severity, .what = {}, .remedy = {}, .places = places};
}

std::string describe(const Finding& finding) {
  return describe({Problem{finding.place, finding.what, finding.remedy}});
}

std::string list_places(const std::vector<std::string>& places, std::size_t most) {
  std::string text, file;
  const std::size_t shown = places.size() > most + 1 ? most : places.size();
  for (std::size_t i = 0; i < shown; ++i) {
    const std::size_t colon = places[i].rfind(':');
    const std::string own = colon == std::string::npos ? "" : places[i].substr(0, colon);
    const bool same_file = i > 0 && !own.empty() && own == file;
    text += (i > 0 ? ", " : "") + (same_file ? places[i].substr(colon + 1) : places[i]);
    file = own;
  }
  if (shown < places.size()) text += fmt::format(" and {} more", places.size() - shown);
  return text;
}

bool has(const std::vector<Finding>& findings, Severity severity) {
  return std::any_of(findings.begin(), findings.end(), [&](const Finding& f) { return f.severity == severity; });
}

void refuse(const std::vector<Finding>& findings) {
  std::vector<Problem> problems;
  bool of_study = true;
  for (const Finding& finding : findings) {
    if (finding.severity != Severity::refusal) continue;
    problems.push_back({finding.place, finding.what, finding.remedy});
    of_study = of_study && finding.kind == FindingKind::contradicted_case;
  }
  if (!problems.empty()) throw InputError(of_study ? ExitStatus::bad_study : ExitStatus::bad_data, std::move(problems));
}

}  // namespace data
