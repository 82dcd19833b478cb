// The sampler's diagnostics in the page, with traces and ranks of the chains folded away.
#include <cmath>

#include "uq/report/figures.hpp"
#include "uq/report/page.hpp"

namespace uq::page {
namespace {

Markup chains_part(const CaseReport& result, const std::string& id, const Context& context) {
  if (!has_chains(result)) return {};
  Markup figures;
  for (std::size_t k = 0; k < result.parameters.size(); ++k) {
    const std::string& name = result.parameters[k].name;
    figures += figure(trace_figure(result, k, fmt::format("{}-trace-{}", id, k + 1)),
                      name + ": traces, a line per chain. They should cross all the time.", context);
    figures += figure(chain_rank_figure(result, k, fmt::format("{}-ranks-{}", id, k + 1)),
                      name + ": ranks of each chain's draws among all. They should be level.", context);
  }
  return tag::details(tag::summary("Traces and ranks of ", result.name), side_by_side(figures));
}

Table parameter_table(const std::vector<CaseReport>& cases) {
  Table table{.caption = "By parameter.",
              .columns = {{"Case"},
                          {"Parameter"},
                          {"R\u0302", number},
                          {"ESS, bulk", number},
                          {"ESS, tail", number},
                          {"MCSE of the mean", number},
                          {"MCSE / sd", number}}};
  const auto count = [](double ess) { return std::isfinite(ess) ? fmt::format("{:.0f}", ess) : "not available"; };
  for (const CaseReport& result : cases)
    for (const ParameterReport& parameter : result.parameters)
      table.rows.push_back({&parameter == &result.parameters.front() ? result.name : "", parameter.name,
                            decimals(parameter.rhat, 3), count(parameter.ess_bulk), count(parameter.ess_tail),
                            digits(parameter.mcse, 2) + (parameter.unit.empty() ? "" : "\u00a0" + parameter.unit),
                            digits(parameter.sd > 0.0 ? parameter.mcse / parameter.sd : NAN, 2)});
  return table;
}

Table case_table(const std::vector<CaseReport>& cases) {
  Table table{.caption = "By case.",
              .columns = {{"Case"},
                          {"Chains \u00d7 draws", number},
                          {"Converged"},
                          {"Sampler"},
                          {"Divergences", number},
                          {"E-BFMI", number},
                          {"Difference to quadrature", number}}};
  for (const CaseReport& result : cases)
    table.rows.push_back({result.name, fmt::format("{}\u00a0\u00d7\u00a0{}", result.chains, result.draws),
                          result.converged ? "yes" : tag::strong("no"), result.sampler,
                          std::to_string(result.divergences),
                          std::isfinite(result.energy_fraction) ? digits(result.energy_fraction, 2) : nothing,
                          result.grid_difference ? digits(*result.grid_difference, 2) + "\u00a0sd" : nothing});
  return table;
}

Table shape_table(const std::vector<CaseReport>& cases) {
  Table table{.caption = "Evidence, and how nearly the parameters' effects are the same.",
              .columns = {{"Case"}, {"Log evidence", number}, {"Collinearity", number}, {"Fisher condition", number}}};
  for (const CaseReport& result : cases) {
    const bool known = std::isfinite(result.log_evidence);
    table.rows.push_back({result.name, known ? with_error(result.log_evidence, result.log_evidence_error) : nothing,
                          digits(result.collinearity, 3), digits(result.fisher_condition, 3)});
  }
  return table;
}

}  // namespace

Markup sampler_section(const std::vector<CaseReport>& cases, const Context& context) {
  if (cases.empty()) return {};
  Markup chains;
  for (std::size_t i = 0; i < cases.size(); ++i) chains += chains_part(cases[i], case_id(i, cases[i]), context);
  return tag::p(
             "R\u0302 near 1 says that independent chains agree; the effective sample sizes (ESS) say how many "
             "independent draws the chains are worth; MCSE is the sampler's own error of the mean. The difference to "
             "quadrature is the largest in mean or sd, in posterior sd, where a grid is feasible.") +
         parameter_table(cases) + case_table(cases) + shape_table(cases) + chains;
}

}  // namespace uq::page
