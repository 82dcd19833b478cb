// What a case's parameters are traded for: their joint posterior, the combination that is known, points that fit alike.
#include <algorithm>
#include <cmath>

#include "uq/findings/listed.hpp"
#include "uq/report/figures.hpp"
#include "uq/report/page.hpp"
#include "uq/report/plot.hpp"

namespace uq::page {
namespace {

Markup equivalent_figures(const CaseReport& result, const TradedPair& traded, const std::string& stem,
                          const Context& context) {
  std::vector<const PredictiveCurve*> drawn;
  Markup figures;
  for (const PredictiveCurve& curve : traded.curves) {
    const bool known = std::any_of(drawn.begin(), drawn.end(), [&](const PredictiveCurve* other) {
      return other->observation_set == curve.observation_set && other->output == curve.output;
    });
    if (known) continue;
    drawn.push_back(&curve);
    figures += figure(equivalent_figure(result, traded, curve, fmt::format("{}-{}", stem, drawn.size())),
                      fmt::format("{} at the equivalent points ({}): where the curves part, a measurement would tell "
                                  "them apart.",
                                  curve.output, curve.observation_set),
                      context);
  }
  return figures;
}

Markup equivalent_table(const CaseReport& result, const TradedPair& traded) {
  if (traded.equivalent.empty()) return {};
  Table table{.caption = "Equivalent points: the observations cannot tell these apart.", .columns = {{"Point"}}};
  std::vector<const ParameterReport*> given;
  std::vector<plot::Axis> axes;
  for (const ParameterReport& parameter : result.parameters) {
    const bool is_given = std::any_of(traded.equivalent.begin(), traded.equivalent.end(),
                                      [&](const auto& point) { return point.contains(parameter.name); });
    if (!is_given) continue;
    given.push_back(&parameter);
    double largest = 0.0;
    for (const auto& point : traded.equivalent) {
      if (const auto found = point.find(parameter.name); found != point.end())
        largest = std::max(largest, std::abs(found->second));
    }
    axes.push_back(plot::axis_for(parameter.name, parameter.unit, largest));
    table.columns.push_back({axes.back().label, number});
  }
  for (const auto& point : traded.equivalent) {
    table.rows.push_back({std::to_string(table.rows.size() + 1)});
    for (std::size_t i = 0; i < given.size(); ++i) {
      const auto found = point.find(given[i]->name);
      table.rows.back().push_back(found == point.end() ? "" : digits(found->second * axes[i].scale, 3));
    }
  }
  return table;
}

Markup marginal_figures(const CaseReport& result, const std::string& id, const Context& context) {
  if (result.parameters.size() <= 2 || !has_chains(result)) return {};
  Markup figures;
  for (std::size_t k = 0; k < result.parameters.size(); ++k)
    figures += figure(marginal_figure(result, k, fmt::format("{}-marginal-{}", id, k + 1)),
                      result.parameters[k].name + ": posterior, its median and 90\u00a0% interval.", context);
  return side_by_side(figures);
}

/// What a group of parameters is traded for, in words.
Markup trade(const TradedPair& traded) {
  const std::vector<std::string> members =
      traded.parameters.empty() ? std::vector{traded.first, traded.second} : traded.parameters;
  std::vector<Markup> strong;
  for (const std::string& member : members) strong.push_back(tag::strong(member));
  const bool known = std::isfinite(traded.value);
  const std::string value = known ? " = " + with_error(traded.value, traded.error, traded.unit) : "";
  return tag::p(listed(strong), " are traded against each other (", members.size() > 2 ? "largest " : "",
                "correlation ", decimals(traded.correlation, 3), "): known together is ",
                tag::strong(traded.combination, value), ".");
}

/// Traded pairs one by one, the others side by side behind them.
Markup joint_figures(const CaseReport& result, const std::string& id, const Context& context) {
  if (result.draws_for_plot.empty()) return {};
  const auto pairs = pairs_to_draw(result, context.options.joint_figures);
  Markup wide, small;
  for (const auto& pair : pairs) {
    const std::string names = result.parameters[pair.first].name + " and " + result.parameters[pair.second].name;
    const std::string stem = fmt::format("{}-joint-{}-{}", id, pair.first + 1, pair.second + 1);
    if (pairs.size() == 1 || are_traded(result, pair)) {
      wide +=
          figure(joint_figure(result, pair, FigureSize::wide, stem),
                 fmt::format("Joint posterior of {}: draws, the smallest regions that hold 50 and 90\u00a0% of them, "
                             "and the prior's range. Numbered points, if any, fit alike.",
                             names),
                 context);
    } else {
      small += figure(joint_figure(result, pair, FigureSize::half, stem), "Joint posterior of " + names + ".", context);
    }
  }
  return wide + side_by_side(small);
}

/// The remark beside "not traded" where a pair's errors are strongly correlated all the same.
std::string correlated(const CaseReport& result) {
  constexpr double much = 0.8;
  std::string text;
  for (std::size_t i = 0; i < result.correlation.size(); ++i)
    for (std::size_t j = 0; j < i && j < result.correlation[i].size(); ++j)
      if (const double r = result.correlation[i][j]; std::abs(r) > much)
        text += " The errors of " + result.parameters[j].name + " and " + result.parameters[i].name +
                " hang together all the same (correlation " + decimals(r, 2) +
                "): if one is wrong, so is the other. Values of both for a simulation must come from one draw.";
  return text;
}

Markup correlation_table(const CaseReport& result) {
  if (result.correlation.size() != result.parameters.size()) return {};
  Table table{.caption = "Posterior correlation.", .columns = {{""}}};
  for (std::size_t i = 0; i < result.parameters.size(); ++i) {
    table.columns.push_back({result.parameters[i].name, number});
    table.rows.push_back({result.parameters[i].name});
    for (const double r : result.correlation[i]) table.rows.back().push_back(decimals(r, 3));
  }
  return table;
}

}  // namespace

Markup joint_part(const CaseReport& result, const std::string& id, const Context& context) {
  if (result.parameters.size() < 2) return {};
  Markup all = tag::h3("What is known together") + marginal_figures(result, id, context);
  all += result.traded.empty() ? tag::p("No parameters are traded against each other." + correlated(result))
                               : each(result.traded, trade);
  all += joint_figures(result, id, context);
  for (std::size_t i = 0; i < result.traded.size(); ++i) {
    all += equivalent_table(result, result.traded[i]);
    all += equivalent_figures(result, result.traded[i], fmt::format("{}-equivalent-{}", id, i + 1), context);
  }
  return all + correlation_table(result);
}

}  // namespace uq::page
