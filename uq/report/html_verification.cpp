// Runs of the simulation at points of the posterior, beside what the surrogate said before they were made.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "uq/report/figures.hpp"
#include "uq/report/page.hpp"
#include "uq/report/plot.hpp"

namespace uq::page {
namespace {

constexpr Typography pretty = Typography::unicode;

/// One output's values: simulated against predicted, with the identity line.
Figure verification_figure(const VerificationReport& round, const VerifiedValue& like, const std::string& stem) {
  std::vector<double> x, y, x_error, y_error;
  plot::Extent both;
  for (const VerifiedValue& value : round.values) {
    if (value.output != like.output || value.material != like.material) continue;
    x.push_back(value.predicted);
    y.push_back(value.simulated);
    x_error.push_back(value.predicted_sd);
    y_error.push_back(std::isfinite(value.standard_error) ? value.standard_error : 0.0);
    for (const double end :
         {x.back() - x_error.back(), x.back() + x_error.back(), y.back() - y_error.back(), y.back() + y_error.back()})
      both.include(end);
  }
  const plot::Extent range = both.padded(0.06);
  const plot::Axis horizontal = plot::axis_for("surrogate's " + like.output, like.unit, both.largest());
  const plot::Axis vertical = plot::axis_for("simulated " + like.output, like.unit, both.largest());
  Figure figure{.stem = stem, .script = {}, .data = {}, .alt = {}, .width = 420, .height = 410};
  figure.data = plot::block("runs", {x, y, x_error, y_error});
  figure.script =
      plot::look() + plot::label('x', horizontal) + plot::label('y', vertical) +
      fmt::format("s = {:.0e}\nset size ratio 1\nset xrange [{:.10g}*s:{:.10g}*s]\nset yrange [{:.10g}*s:{:.10g}*s]\n",
                  horizontal.scale, range.low, range.high, range.low, range.high) +
      fmt::format(
          "plot x with lines linecolor rgb '{0}' dashtype 2 title 'identity', \\\n"
          "  '{1}.dat' index 'runs' using ($1*s):($2*s):($3*s):($4*s) with xyerrorbars linecolor rgb '{2}' "
          "linewidth 1.2 pointtype 7 pointsize 0.4 title 'runs, ±1 sd'",
          plot::grey, stem, plot::blue);
  figure.alt = fmt::format("{} of {} runs against the surrogate's", like.output, x.size());
  return figure;
}

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
