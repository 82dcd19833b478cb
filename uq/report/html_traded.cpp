// What a case's parameters are traded for: their joint posterior, the combination that is known, points that fit alike.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "uq/findings/listed.hpp"
#include "uq/report/figures.hpp"
#include "uq/report/page.hpp"
#include "uq/report/plot.hpp"

namespace uq::page {
namespace {

constexpr Typography pretty = Typography::unicode;

std::string equivalent_figures(const CaseReport& result, const TradedPair& traded, const std::string& stem,
                               const Context& context) {
  std::vector<const PredictiveCurve*> drawn;
  std::string out;
  for (const PredictiveCurve& curve : traded.curves) {
    const bool known = std::any_of(drawn.begin(), drawn.end(), [&](const PredictiveCurve* other) {
      return other->observation_set == curve.observation_set && other->output == curve.output;
    });
    if (known) continue;
    drawn.push_back(&curve);
    out += figure(equivalent_figure(result, traded, curve, fmt::format("{}-{}", stem, drawn.size())),
                  fmt::format("{} at the equivalent points ({}): where the curves part, a measurement would tell them "
                              "apart.",
                              text(curve.output), text(curve.observation_set)),
                  context);
  }
  return out;
}

std::string equivalent_table(const CaseReport& result, const TradedPair& traded) {
  if (traded.equivalent.empty()) return {};
  Table table{
      .caption = "Equivalent points: the observations cannot tell these apart.", .head = {{"Point"}}, .rows = {}};
  std::vector<const ParameterReport*> columns;
  std::vector<plot::Axis> axes;
  for (const ParameterReport& parameter : result.parameters) {
    const bool given = std::any_of(traded.equivalent.begin(), traded.equivalent.end(),
                                   [&](const auto& point) { return point.contains(parameter.name); });
    if (!given) continue;
    columns.push_back(&parameter);
    double largest = 0.0;
    for (const auto& point : traded.equivalent) {
      if (const auto found = point.find(parameter.name); found != point.end())
        largest = std::max(largest, std::abs(found->second));
    }
    axes.push_back(plot::axis_for(parameter.name, parameter.unit, largest));
    table.head.push_back(number(text(axes.back().label)));
  }
  int index = 0;
  for (const auto& point : traded.equivalent) {
    std::vector<Cell> row{{std::to_string(++index)}};
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const auto found = point.find(columns[i]->name);
      row.push_back(number(found == point.end() ? "" : significant(found->second * axes[i].scale, 3, pretty)));
    }
    table.rows.push_back(std::move(row));
  }
  return html(table);
}

}  // namespace

std::string chains_part(const CaseReport& result, const std::string& id, const Context& context) {
  if (!has_chains(result)) return {};
  std::string figures;
  for (std::size_t k = 0; k < result.parameters.size(); ++k) {
    const std::string name = text(result.parameters[k].name);
    figures += figure(trace_figure(result, k, fmt::format("{}-trace-{}", id, k + 1)),
                      name + ": traces, a line per chain. They should cross all the time.", context) +
               figure(chain_rank_figure(result, k, fmt::format("{}-ranks-{}", id, k + 1)),
                      name + ": ranks of each chain's draws among all. They should be level.", context);
  }
  return fmt::format("<details><summary>Traces and ranks of {}</summary>\n<div class=\"pair\">\n{}</div>\n</details>\n",
                     text(result.name), figures);
}

std::string joint_part(const CaseReport& result, const std::string& id, const Context& context) {
  if (result.parameters.size() < 2) return {};
  std::string out = "<h3>What is known together</h3>\n";
  if (result.parameters.size() > 2 && has_chains(result)) {
    std::string figures;
    for (std::size_t k = 0; k < result.parameters.size(); ++k)
      figures += figure(marginal_figure(result, k, fmt::format("{}-marginal-{}", id, k + 1)),
                        text(result.parameters[k].name) + ": posterior, its median and 90\u00a0% interval.", context);
    out += "<div class=\"pair\">\n" + figures + "</div>\n";
  }
  for (const TradedPair& traded : result.traded) {
    const std::vector<std::string> members =
        traded.parameters.empty() ? std::vector{traded.first, traded.second} : traded.parameters;
    std::vector<std::string> strong;
    for (const std::string& member : members) strong.push_back("<strong>" + text(member) + "</strong>");
    const std::string names = listed(strong);
    const std::string value = std::isfinite(traded.value)
                                  ? " = " + text(format_with_error(traded.value, traded.error, traded.unit, pretty))
                                  : "";
    out += fmt::format(
        "<p>{} are traded against each other ({}correlation {}): known together is <strong>{}{}</strong>.</p>\n", names,
        members.size() > 2 ? "largest " : "",
        format_value(traded.correlation, {.exponent = 0, .decimals = 3}, "", pretty), text(traded.combination), value);
  }
  if (result.traded.empty()) out += "<p>No parameters are traded against each other.</p>\n";
  if (!result.draws_for_plot.empty()) {
    const auto pairs = pairs_to_draw(result, context.options.joint_figures);
    std::string small;
    for (const auto& pair : pairs) {
      const std::string names =
          text(result.parameters[pair.first].name) + " and " + text(result.parameters[pair.second].name);
      const std::string stem = fmt::format("{}-joint-{}-{}", id, pair.first + 1, pair.second + 1);
      if (pairs.size() == 1 || are_traded(result, pair)) {
        out += figure(
            joint_figure(result, pair, FigureSize::wide, stem),
            fmt::format("Joint posterior of {}: draws, the smallest regions that hold 50 and 90\u00a0% of them, and "
                        "the prior's range. Numbered points, if any, fit alike.",
                        names),
            context);
      } else {
        small +=
            figure(joint_figure(result, pair, FigureSize::half, stem), "Joint posterior of " + names + ".", context);
      }
    }
    if (!small.empty()) out += "<div class=\"pair\">\n" + small + "</div>\n";
  }
  for (std::size_t i = 0; i < result.traded.size(); ++i)
    out += equivalent_table(result, result.traded[i]) +
           equivalent_figures(result, result.traded[i], fmt::format("{}-equivalent-{}", id, i + 1), context);
  if (result.correlation.size() == result.parameters.size()) {
    Table table{.caption = "Posterior correlation.", .head = {{""}}, .rows = {}};
    for (std::size_t i = 0; i < result.parameters.size(); ++i) {
      table.head.push_back(number(text(result.parameters[i].name)));
      std::vector<Cell> row{{text(result.parameters[i].name)}};
      for (const double r : result.correlation[i]) {
        row.push_back(number(format_value(r, {.exponent = 0, .decimals = 3}, "", pretty)));
      }
      table.rows.push_back(std::move(row));
    }
    out += html(table);
  }
  return out;
}

}  // namespace uq::page
