// Runs of the simulation at points of the posterior, beside what the surrogate said before they were made.
#include <fmt/format.h>

#include <algorithm>

#include "uq/report/figures.hpp"
#include "uq/report/page.hpp"

namespace uq::page {
namespace {

constexpr Typography pretty = Typography::unicode;

std::string inputs_text(const VerifiedValue& value) {
  std::string at;
  for (const auto& [name, number] : value.inputs)
    at += fmt::format("{}{}\u00a0{}", at.empty() ? "" : ", ", text(name), significant(number, 4, pretty));
  return at;
}

std::string verification_table(const VerificationReport& round, std::size_t rows_shown_openly) {
  Table table{.caption = "Runs at points of the posterior. z is the difference over both errors.",
              .head = {{"Point"}, {"Inputs"}, {"Output"}, number("Surrogate"), number("Simulated"), number("z")},
              .rows = {}};
  for (const VerifiedValue& value : round.values)
    table.rows.push_back({{text(value.label)},
                          {inputs_text(value), "long"},
                          {text(name_in_unit(value.output, value.unit))},
                          number(format_with_error(value.predicted, value.predicted_sd, "", pretty)),
                          number(format_with_error(value.simulated, value.standard_error, "", pretty)),
                          number(fmt::format("{:+.1f}", value.z))});
  if (table.rows.size() <= rows_shown_openly) return html(table);
  return "<details><summary>The numbers behind the figure</summary>\n" + html(table) + "</details>\n";
}

}  // namespace

std::string verification_part(const CaseReport& result, const std::string& id, const Context& context) {
  if (result.verification.empty()) return {};
  const VerificationReport& last = result.verification.back();
  std::string out = "<h3>Surrogate against simulation</h3>\n";
  for (std::size_t i = 0; i < result.verification.size(); ++i)
    out +=
        fmt::format("<p>{}{}</p>\n", result.verification.size() > 1 ? fmt::format("Round {}. ", i + 1) : std::string(),
                    text(result.verification[i].sentence));
  std::vector<const VerifiedValue*> drawn;
  for (const VerifiedValue& value : last.values) {
    if (std::any_of(drawn.begin(), drawn.end(), [&](const VerifiedValue* other) {
          return other->output == value.output && other->material == value.material;
        }))
      continue;
    drawn.push_back(&value);
    out += figure(
        verification_figure(last, value, fmt::format("{}-verification-{}", id, drawn.size())),
        fmt::format("{} of runs that the surrogate had not seen, at points of the posterior.", text(value.output)),
        context);
  }
  return out + verification_table(last, static_cast<std::size_t>(context.options.rows_shown_openly));
}

}  // namespace uq::page
