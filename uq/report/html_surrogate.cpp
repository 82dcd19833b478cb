// The surrogates' part of the page: how well each predicts runs that it has not seen; and where the runs lie.
#include <algorithm>
#include <cmath>
#include <map>

#include "uq/report/figures.hpp"
#include "uq/report/page.hpp"

namespace uq::page {
namespace {

std::string name_of(const SurrogateReport& surrogate) {
  return surrogate.material.empty() ? surrogate.output : surrogate.output + ", " + surrogate.material;
}

/// How often central intervals hold the runs.
Markup coverage_table(const SurrogateReport& surrogate) {
  if (surrogate.coverage_left_out.size() != 3 || surrogate.coverage_held_out.size() != 3) return {};
  const auto row = [](const char* name, const std::vector<double>& shares) {
    return std::vector<Cell>{name, decimals(shares[0], 3), decimals(shares[1], 3), decimals(shares[2], 3)};
  };
  return Table{.caption = "Share of the runs inside the central intervals.",
               .columns = {{"Runs"}, {"50\u00a0%", number}, {"90\u00a0%", number}, {"95\u00a0%", number}},
               .rows = {row("left out one by one", surrogate.coverage_left_out),
                        row("held out in folds", surrogate.coverage_held_out)}};
}

/// The held-out folds by Bastos & O'Hagan.
Markup folds_table(const SurrogateReport& surrogate) {
  if (surrogate.fold_distance.empty()) return {};
  const auto large = std::count_if(surrogate.pivoted_errors.begin(), surrogate.pivoted_errors.end(),
                                   [](double error) { return std::abs(error) > 2.0; });
  Table table{
      .caption = fmt::format("Folds predicted by the others, hyper-parameters fitted again: Mahalanobis distance of "
                             "the errors, about the number of runs if the covariance is right, and the chance of "
                             "one as far off. {} of {} uncorrelated (pivoted Cholesky) errors lie beyond "
                             "\u00b12; about one in twenty should.",
                             large, surrogate.pivoted_errors.size()),
      .columns = {{"Fold"}, {"Runs", number}, {"Mahalanobis distance", number}, {"Probability", number}}};
  for (std::size_t i = 0; i < surrogate.fold_distance.size(); ++i)
    table.rows.push_back({std::to_string(i + 1), fmt::format("{:.0f}", surrogate.fold_runs.at(i)),
                          digits(surrogate.fold_distance[i], 3), digits(surrogate.fold_probability.at(i), 2)});
  return tag::details(tag::summary("Held-out folds"), table);
}

Markup left_out_figures(const SurrogateReport& surrogate, const std::string& stem, const Context& context) {
  if (surrogate.observed.empty() || surrogate.observed.size() != surrogate.predicted.size()) return {};
  Markup figures =
      figure(leave_one_out_figure(surrogate, stem + "-loo"),
             "Each run predicted by the surrogate fitted without it. Across: the run and its standard error; up: "
             "the prediction and its standard deviation. On the dashed line they agree.",
             context);
  if (surrogate.standardised.size() == surrogate.observed.size())
    figures += figure(standardised_figure(surrogate, stem + "-standardised"),
                      "The same errors in units of their predicted standard deviation; about one in twenty should lie "
                      "beyond \u00b12, without a trend.",
                      context);
  return side_by_side(figures);
}

Markup inputs_table(const SurrogateReport& surrogate) {
  if (surrogate.inputs.empty() || surrogate.inputs.size() != surrogate.length_scales.size()) return {};
  Table table{.caption = "Length scales, in units of each input's range: the shorter, the faster the output changes.",
              .columns = {{"Input"}, {"Length scale", number}}};
  const bool shares = surrogate.first_order.size() == surrogate.inputs.size();
  if (shares) {
    table.caption +=
        " Sobol indices: the share of the output's variance over the ranges that an input makes on its own (first "
        "order), and alone or together with others (total), with their uncertainty from the surrogate.";
    table.columns.push_back({"First order", number});
    table.columns.push_back({"Total", number});
  }
  for (std::size_t i = 0; i < surrogate.inputs.size(); ++i) {
    table.rows.push_back({surrogate.inputs[i], digits(surrogate.length_scales[i], 3)});
    if (!shares) continue;
    const auto share = [](double value, double sd) { return with_error(value, std::max(sd, 0.001)); };
    table.rows.back().push_back(share(surrogate.first_order[i], surrogate.first_order_sd[i]));
    table.rows.back().push_back(share(surrogate.total_order[i], surrogate.total_order_sd[i]));
  }
  return table;
}

Markup one_surrogate(const SurrogateReport& surrogate, std::size_t index, const Context& context) {
  const std::string name = name_of(surrogate), stem = fmt::format("surrogate-{}-{}", index + 1, slug(name));
  std::vector<std::string> notes = surrogate.notes;
  if (!surrogate.errors_in_doubt.empty()) notes.insert(notes.begin(), surrogate.errors_in_doubt);
  return tag::h3(name) +
         tag::div.is("verdict")(tag::dl(entry("Finding", surrogate.finding),
                                        entry("Consequence", surrogate.consequence), entry("Remedy", surrogate.remedy),
                                        tag::dt("Verdict"), tag::dd(badge(surrogate.verdict)))) +
         left_out_figures(surrogate, stem, context) + inputs_table(surrogate) + coverage_table(surrogate) +
         folds_table(surrogate) + tag::ul.is("note").unless_empty(each(notes, tag::li));
}

/// One material's runs over pairs of its inputs.
Markup design_part(const DesignReport& design, std::size_t index, const Context& context) {
  constexpr std::size_t inputs_most = 4;  // pairs of the first four are six figures
  const std::size_t inputs = std::min(design.inputs.size(), inputs_most);
  if (inputs < 2 || design.runs.size() + design.left_out.size() == 0) return {};
  Markup figures;
  for (std::size_t a = 0; a < inputs; ++a)
    for (std::size_t b = a + 1; b < inputs; ++b)
      figures += figure(design_figure(design, {a, b}, fmt::format("design-{}-{}-{}", index + 1, a + 1, b + 1)),
                        design.inputs[a] + " and " + design.inputs[b] + ".", context);
  std::map<std::string, int> reasons;
  for (const std::string& reason : design.reasons) ++reasons[reason];
  std::vector<std::string> left_out;
  for (const auto& [reason, count] : reasons) left_out.push_back(fmt::format("{} ({})", count, reason));
  return tag::h3(design.material.empty() ? "Runs" : design.material) +
         tag::p(fmt::format("{} runs are learnt from", design.runs.size()),
                left_out.empty() ? ", none is left out" : "; left out: ", fmt::format("{}", fmt::join(left_out, ", ")),
                ".") +
         side_by_side(figures);
}

}  // namespace

Markup surrogate_section(const std::vector<SurrogateReport>& surrogates, const Context& context) {
  if (surrogates.empty()) return {};
  Table table{.columns = {{"Output"},
                          {"Material"},
                          {"Runs", number},
                          {"Q\u00b2, leave-one-out", number},
                          {"Q\u00b2, held out", number},
                          {"Coverage", number},
                          {"Nugget sd", number},
                          {"Verdict"}}};
  Markup one_by_one;
  for (std::size_t i = 0; i < surrogates.size(); ++i) {
    const SurrogateReport& one = surrogates[i];
    table.rows.push_back({one.output, one.material.empty() ? nothing : one.material, std::to_string(one.runs),
                          decimals(one.q2, 3), decimals(one.q2_held_out, 3), decimals(one.coverage95, 2),
                          rounded(one.nugget_sd, rounding_of(0.0, one.nugget_sd), one.unit), badge(one.verdict)});
    one_by_one += one_surrogate(one, i, context);
  }
  return tag::p(
             "The surrogate stands in for the simulation between its training runs. Q\u00b2 is the share of the runs' "
             "variance that it predicts without having seen them (1 is perfect); coverage is the share of runs inside "
             "its 95\u00a0% intervals (0.95 is right).") +
         table + one_by_one;
}

Markup design_section(const std::vector<DesignReport>& designs, const Context& context) {
  Markup all;
  for (std::size_t i = 0; i < designs.size(); ++i) all += design_part(designs[i], i, context);
  return all;
}

}  // namespace uq::page
