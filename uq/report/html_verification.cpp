// Runs of the simulation at points of the posterior, beside what the surrogate said before they were made.
#include <algorithm>

#include "uq/report/figures.hpp"
#include "uq/report/page.hpp"

namespace uq::page {
namespace {

std::string inputs_text(const VerifiedValue& value) {
  std::vector<std::string> at;
  for (const auto& [name, input] : value.inputs) at.push_back(name + "\u00a0" + digits(input, 4));
  return fmt::format("{}", fmt::join(at, ", "));
}

Table verification_table(const VerificationReport& round) {
  Table table{
      .caption = "Runs at points of the posterior. z is the difference over both errors.",
      .columns = {
          {"Point"}, {"Inputs", lengthy}, {"Output"}, {"Surrogate", number}, {"Simulated", number}, {"z", number}}};
  for (const VerifiedValue& value : round.values)
    table.rows.push_back({value.label, inputs_text(value), name_in_unit(value.output, value.unit),
                          with_error(value.predicted, value.predicted_sd),
                          with_error(value.simulated, value.standard_error), fmt::format("{:+.1f}", value.z)});
  return table;
}

}  // namespace

Markup verification_part(const CaseReport& result, const std::string& id, const Context& context) {
  if (result.verification.empty()) return {};
  const VerificationReport& last = result.verification.back();
  Markup all = tag::h3("Surrogate against simulation");
  for (std::size_t i = 0; i < result.verification.size(); ++i)
    all +=
        tag::p(result.verification.size() > 1 ? fmt::format("Round {}. ", i + 1) : "", result.verification[i].sentence);
  std::vector<const VerifiedValue*> drawn;
  for (const VerifiedValue& value : last.values) {
    const bool known = std::any_of(drawn.begin(), drawn.end(), [&](const VerifiedValue* other) {
      return other->output == value.output && other->material == value.material;
    });
    if (known) continue;
    drawn.push_back(&value);
    all += figure(verification_figure(last, value, fmt::format("{}-verification-{}", id, drawn.size())),
                  value.output + " of runs that the surrogate had not seen, at points of the posterior.", context);
  }
  return all + behind_figure(verification_table(last), context);
}

}  // namespace uq::page
