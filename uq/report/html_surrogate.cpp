// The surrogates' part of the page: how well each predicts runs that it has not seen.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "uq/report/figures.hpp"
#include "uq/report/page.hpp"

namespace uq::page {
namespace {

constexpr Typography pretty = Typography::unicode;

std::string name_of(const SurrogateReport& surrogate) {
  return surrogate.material.empty() ? surrogate.output : surrogate.output + ", " + surrogate.material;
}

std::string two_digits(double share) { return format_value(share, {.exponent = 0, .decimals = 3}, "", pretty); }

/// Coverage at three levels, and the held-out folds by Bastos & O'Hagan.
std::string held_out_tables(const SurrogateReport& surrogate) {
  std::string out;
  if (surrogate.coverage_left_out.size() == 3 && surrogate.coverage_held_out.size() == 3) {
    Table table{.caption = "Share of the runs inside the central intervals.",
                .head = {{"Runs"}, number("50\u00a0%"), number("90\u00a0%"), number("95\u00a0%")},
                .rows = {}};
    for (const auto& [name, shares] : {std::pair{"left out one by one", &surrogate.coverage_left_out},
                                       std::pair{"held out in folds", &surrogate.coverage_held_out}}) {
      table.rows.push_back({{name}});
      for (const double share : *shares) table.rows.back().push_back(number(two_digits(share)));
    }
    out += html(table);
  }
  if (surrogate.fold_distance.empty()) return out;
  const auto large = std::count_if(surrogate.pivoted_errors.begin(), surrogate.pivoted_errors.end(),
                                   [](double error) { return std::abs(error) > 2.0; });
  Table table{
      .caption = fmt::format("Folds predicted by the others, hyper-parameters fitted again: Mahalanobis distance of "
                             "the errors, about the number of runs if the covariance is right, and the chance of "
                             "one as far off. {} of {} uncorrelated (pivoted Cholesky) errors lie beyond "
                             "\u00b12; about one in twenty should.",
                             large, surrogate.pivoted_errors.size()),
      .head = {{"Fold"}, number("Runs"), number("Mahalanobis distance"), number("Probability")},
      .rows = {}};
  for (std::size_t i = 0; i < surrogate.fold_distance.size(); ++i)
    table.rows.push_back({{std::to_string(i + 1)},
                          number(fmt::format("{:.0f}", surrogate.fold_runs.at(i))),
                          number(significant(surrogate.fold_distance[i], 3, pretty)),
                          number(significant(surrogate.fold_probability.at(i), 2, pretty))});
  return out + "<details><summary>Held-out folds</summary>\n" + html(table) + "</details>\n";
}

std::string one_surrogate(const SurrogateReport& surrogate, std::size_t index, const Context& context) {
  std::string out = fmt::format("<h3>{}</h3>\n<div class=\"verdict\"><dl>\n", text(name_of(surrogate)));
  const std::pair<const char*, const std::string*> entries[] = {
      {"Finding", &surrogate.finding}, {"Consequence", &surrogate.consequence}, {"Remedy", &surrogate.remedy}};
  for (const auto& [heading, words] : entries) {
    if (!words->empty()) out += fmt::format("<dt>{}</dt><dd>{}</dd>\n", heading, text(*words));
  }
  out += fmt::format("<dt>Verdict</dt><dd>{}</dd>\n</dl></div>\n", badge(surrogate.verdict));
  const std::string stem = fmt::format("surrogate-{}-{}", index + 1, slug(name_of(surrogate)));
  std::string figures;
  if (!surrogate.observed.empty() && surrogate.observed.size() == surrogate.predicted.size()) {
    figures +=
        figure(leave_one_out_figure(surrogate, stem + "-loo"),
               "Each run predicted by the surrogate fitted without it. Across: the run and its standard error; up: "
               "the prediction and its standard deviation. On the dashed line they agree.",
               context);
    if (surrogate.standardised.size() == surrogate.observed.size()) {
      figures +=
          figure(standardised_figure(surrogate, stem + "-standardised"),
                 "The same errors in units of their predicted standard deviation; about one in twenty should lie "
                 "beyond \u00b12, without a trend.",
                 context);
    }
  }
  if (!figures.empty()) out += "<div class=\"pair\">\n" + figures + "</div>\n";
  if (!surrogate.inputs.empty() && surrogate.inputs.size() == surrogate.length_scales.size()) {
    const bool shares = surrogate.first_order.size() == surrogate.inputs.size();
    Table table{.caption = "Length scales, in units of each input's range: the shorter, the faster the output changes.",
                .head = {{"Input"}, number("Length scale")},
                .rows = {}};
    if (shares) {
      table.caption +=
          " Sobol indices: the share of the output's variance over the ranges that an input makes on its own (first "
          "order), and alone or together with others (total), with their uncertainty from the surrogate.";
      table.head.push_back(number("First order"));
      table.head.push_back(number("Total"));
    }
    for (std::size_t i = 0; i < surrogate.inputs.size(); ++i) {
      table.rows.push_back({{text(surrogate.inputs[i])}, number(significant(surrogate.length_scales[i], 3, pretty))});
      if (!shares) continue;
      const auto share = [&](double value, double sd) {
        return number(text(format_with_error(value, std::max(sd, 0.001), "", pretty)));
      };
      table.rows.back().push_back(share(surrogate.first_order[i], surrogate.first_order_sd[i]));
      table.rows.back().push_back(share(surrogate.total_order[i], surrogate.total_order_sd[i]));
    }
    out += html(table);
  }
  out += held_out_tables(surrogate);
  if (!surrogate.notes.empty()) {
    out += "<ul class=\"note\">\n";
    for (const std::string& note : surrogate.notes) out += "<li>" + text(note) + "</li>\n";
    out += "</ul>\n";
  }
  return out;
}

}  // namespace

std::string surrogate_section(const std::vector<SurrogateReport>& surrogates, const Context& context) {
  if (surrogates.empty()) return {};
  std::string out =
      "<section id=\"surrogates\">\n<h2>Surrogate validation</h2>\n<p>The surrogate stands in for the simulation "
      "between "
      "its training runs. Q\u00b2 is the share of the runs' variance that it predicts without having seen them (1 is "
      "perfect); coverage is the share of runs inside its 95\u00a0% intervals (0.95 is right).</p>\n";
  Table table{.caption = {},
              .head = {{"Output"},
                       {"Material"},
                       number("Runs"),
                       number("Q\u00b2, leave-one-out"),
                       number("Q\u00b2, held out"),
                       number("Coverage"),
                       number("Nugget sd"),
                       {"Verdict"}},
              .rows = {}};
  for (const SurrogateReport& surrogate : surrogates) {
    table.rows.push_back(
        {{text(surrogate.output)},
         {surrogate.material.empty() ? "\u2013" : text(surrogate.material)},
         number(std::to_string(surrogate.runs)),
         number(two_digits(surrogate.q2)),
         number(two_digits(surrogate.q2_held_out)),
         number(format_value(surrogate.coverage95, {.exponent = 0, .decimals = 2}, "", pretty)),
         number(text(format_value(surrogate.nugget_sd, rounding_of(0.0, surrogate.nugget_sd), surrogate.unit, pretty))),
         {badge(surrogate.verdict)}});
  }
  out += html(table);
  for (std::size_t i = 0; i < surrogates.size(); ++i) out += one_surrogate(surrogates[i], i, context);
  return out + "</section>\n";
}

std::string design_section(const std::vector<DesignReport>& designs, const Context& context) {
  constexpr std::size_t inputs_most = 4;  // pairs of the first four are six figures
  std::string out;
  for (std::size_t i = 0; i < designs.size(); ++i) {
    const DesignReport& design = designs[i];
    const std::size_t inputs = std::min(design.inputs.size(), inputs_most);
    if (inputs < 2 || design.runs.size() + design.left_out.size() == 0) continue;
    std::string figures;
    for (std::size_t a = 0; a < inputs; ++a)
      for (std::size_t b = a + 1; b < inputs; ++b)
        figures += figure(design_figure(design, {a, b}, fmt::format("design-{}-{}-{}", i + 1, a + 1, b + 1)),
                          text(design.inputs[a]) + " and " + text(design.inputs[b]) + ".", context);
    std::map<std::string, int> reasons;
    for (const std::string& reason : design.reasons) ++reasons[reason];
    std::string left_out;
    for (const auto& [reason, count] : reasons)
      left_out += fmt::format("{}{} ({})", left_out.empty() ? "" : ", ", count, reason);
    out += fmt::format("<h3>{}</h3>\n<p>{} runs are learnt from{}.</p>\n<div class=\"pair\">\n{}</div>\n",
                       design.material.empty() ? "Runs" : text(design.material), design.runs.size(),
                       left_out.empty() ? ", none is left out" : "; left out: " + text(left_out), figures);
  }
  return out.empty() ? out : "<section id=\"design\">\n<h2>Where the runs lie</h2>\n" + out + "</section>\n";
}

}  // namespace uq::page
