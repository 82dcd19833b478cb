// A case of the page, model against data: the measurement's unknowns, the fit, the observed points, data not used, and
// what no parameter explains.
#include <algorithm>

#include "uq/report/figures.hpp"
#include "uq/report/page.hpp"

namespace uq::page {
namespace {

std::string joined(const std::vector<std::string>& names) { return fmt::format("{}", fmt::join(names, ", ")); }

Markup nuisance_table(const CaseReport& result) {
  if (result.nuisances.empty()) return {};
  Table table{
      .caption =
          "Unknowns of the measurement, sampled with the parameters and integrated out; no verdict is "
          "asked of them. Their priors count as calibrations of the meter.",
      .columns = {
          {"Unknown"}, {"Prior mean \u00b1 sd", nowrap}, {"Mean \u00b1 sd", nowrap}, {"90\u00a0% interval", nowrap}}};
  for (const NuisanceReport& one : result.nuisances)
    table.rows.push_back({one.name, with_error(one.prior_mean, one.prior_sd, one.unit),
                          with_error(one.mean, one.sd, one.unit),
                          interval(one.q05, one.q95, rounding_of(one.mean, one.sd), one.unit)});
  return table;
}

Markup fit_and_data(const CaseReport& result) {
  Markup all = tag::p(fmt::format("Fit: \u03c7\u00b2 = {} for {} degree{} of freedom; posterior predictive p = {}{}.",
                                  digits(result.chi2, 3), result.dof, result.dof == 1 ? "" : "s", digits(result.ppp, 2),
                                  result.fits ? "" : ": the model does not fit"));
  if (!result.observed_sets.empty()) all += tag::p("Observations: ", joined(result.observed_sets), ".");
  all += tag::ul.is("note").unless_empty(
      each(result.observed_notes, [](const std::string& note) { return note.empty() ? Markup() : tag::li(note); }));
  if (!result.linked.empty())
    all += tag::p("Sampled jointly with ", tag::strong(joined(result.linked)), ": ",
                  result.linked.size() == 1 ? "its" : "their",
                  " observations also inform the parameters shared with this case.");
  if (!result.cuts.empty())
    all += tag::p("Cut: ", tag::strong(joined(result.cuts)),
                  ". That posterior is taken as it is: the observations of this case do not change it.");
  return all;
}

Markup predictive_table(const CaseReport& result, const Context& context) {
  if (result.predictive.empty()) return {};
  std::vector<std::string> controls;
  bool several_sets = false;
  for (const PredictivePoint& point : result.predictive) {
    for (const auto& [name, value] : point.controls) {
      if (std::find(controls.begin(), controls.end(), name) == controls.end()) controls.push_back(name);
    }
    several_sets = several_sets || point.observation_set != result.predictive.front().observation_set;
  }
  const auto unit_of = [&result](const std::string& control) {
    for (const PredictiveCurve& curve : result.curves) {
      if (curve.control == control) return curve.control_unit;
    }
    return std::string();
  };
  Table table{.caption =
                  "Observed and modelled at the observed points. The interval is that of a new measurement with the "
                  "same error."};
  if (several_sets) table.columns.push_back({"Observations"});
  for (const std::string& control : controls)
    table.columns.push_back({name_in_unit(control, unit_of(control)), number});
  table.columns.push_back({"Output"});
  for (const char* const heading :
       {"Observed \u00b1 standard error", "Model, mean", "Predicted measurement, 90\u00a0%"})
    table.columns.push_back({heading, number});
  for (const PredictivePoint& point : result.predictive) {
    const Rounding rounding = rounding_of(point.observed, point.standard_error);
    std::vector<Cell> row;
    if (several_sets) row.push_back(point.observation_set);
    for (const std::string& control : controls) {
      const auto found = point.controls.find(control);
      row.push_back(found == point.controls.end() ? "" : setting(found->second));
    }
    row.push_back(name_in_unit(point.output, point.unit));
    row.push_back(with_error(point.observed, point.standard_error));
    row.push_back(rounded(point.mean, rounding));
    row.push_back(interval(point.q05, point.q95, rounding));
    table.rows.push_back(std::move(row));
  }
  return behind_figure(table, context);
}

Markup predictive_part(const CaseReport& result, const std::string& id, const Context& context) {
  const auto curves = curves_to_draw(result);
  if (curves.empty() && result.predictive.empty()) return {};
  // Curves made of the predictive points carry those points' measurement error.
  const bool made_of_points = std::all_of(result.curves.begin(), result.curves.end(),
                                          [](const PredictiveCurve& curve) { return curve.x.empty(); });
  Markup figures;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const std::string& set = curves[i].observation_set;
    figures += figure(
        predictive_figure(result, curves[i], fmt::format("{}-predictive-{}", id, i + 1)),
        fmt::format(
            "{} against {}{}. Points: observed, bars of one standard error{}. Line and band: the model's mean and "
            "90\u00a0% of its posterior, surrogate uncertainty included, measurement error {}.",
            curves[i].output, curves[i].control, set.empty() ? "" : " (" + set + ")",
            result.predictions.empty() ? "" : "; open: not used by the case", made_of_points ? "too" : "not"),
        context);
  }
  return tag::h3("Model against observation") + figures + predictive_table(result, context);
}

/// What the case predicts of data that it has not used.
Markup prediction(const PredictionReport& made) {
  Table table{.caption = "Predicted from the other data; the interval is that of a measurement with the same error.",
              .columns = {{"Setting"},
                          {"Output"},
                          {"Observed \u00b1 standard error", number},
                          {"Predicted, 90\u00a0%", number},
                          {"z", number}}};
  for (const auto& [point, z] : made.points) {
    std::vector<std::string> at;
    for (const auto& [name, value] : point.controls) at.push_back(name + " " + setting(value));
    table.rows.push_back(
        {joined(at), name_in_unit(point.output, point.unit), with_error(point.observed, point.standard_error),
         interval(point.q05, point.q95, rounding_of(point.observed, point.standard_error)), decimals(z, 1)});
  }
  return tag::h3("Prediction: ", made.name) + tag::p(made.sentence) + table;
}

Markup discrepancy_part(const CaseReport& result, const std::string& id, const Context& context) {
  if (result.discrepancies.empty()) return {};
  Markup figures;
  for (std::size_t i = 0; i < result.discrepancies.size(); ++i) {
    const DiscrepancyBand& band = result.discrepancies[i];
    figures += figure(
        discrepancy_figure(result, band, fmt::format("{}-discrepancy-{}", id, i + 1)),
        fmt::format("{} ({}): {} of the spread of the observations about the model is put down to the discrepancy.",
                    band.output, band.observation_set, percent(band.share)),
        context);
  }
  return tag::h3("Discrepancy") +
         tag::p(
             "A process over the controls that stands for what no parameter value explains. It competes with the "
             "parameters: what it takes, they need not explain, and they become less certain.") +
         figures;
}

}  // namespace

Markup data_part(const CaseReport& result, const std::string& id, const Context& context) {
  Markup all = nuisance_table(result) + fit_and_data(result) + predictive_part(result, id, context);
  return all + each(result.predictions, prediction) + discrepancy_part(result, id, context);
}

}  // namespace uq::page
