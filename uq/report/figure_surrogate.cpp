// Figures of surrogates: predictions beside runs that they had not seen.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "uq/report/figures.hpp"
#include "uq/report/plot.hpp"

namespace uq {

using plot::Axis;
using plot::Extent;

Figure leave_one_out_figure(const SurrogateReport& surrogate, const std::string& stem) {
  const std::size_t n = std::min(surrogate.observed.size(), surrogate.predicted.size());
  std::vector<double> x, y, x_error, y_error;
  Extent both;
  for (std::size_t i = 0; i < n; ++i) {
    const double residual = surrogate.observed[i] - surrogate.predicted[i];
    const double z = i < surrogate.standardised.size() ? surrogate.standardised[i] : 0.0;
    // The leave-one-out standard deviation is the residual over its standardised value.
    const double sd = std::abs(z) > 1e-6 ? std::abs(residual / z) : 0.0;
    const double se = i < surrogate.observed_se.size() ? surrogate.observed_se[i] : 0.0;
    x.push_back(surrogate.observed[i]);
    y.push_back(surrogate.predicted[i]);
    x_error.push_back(std::isfinite(se) ? se : 0.0);
    y_error.push_back(std::isfinite(sd) ? sd : 0.0);
    for (const double value :
         {x.back() - x_error.back(), x.back() + x_error.back(), y.back() - y_error.back(), y.back() + y_error.back()}) {
      both.include(value);
    }
  }
  const Extent range = both.padded(0.04);
  const Axis horizontal = plot::axis_for("simulated " + surrogate.output, surrogate.unit, both.largest());
  const Axis vertical = plot::axis_for("predicted without that run", surrogate.unit, both.largest());

  Figure figure{.stem = stem, .script = {}, .data = {}, .alt = {}, .width = 420, .height = 410};
  figure.data = plot::block("runs", {x, y, x_error, y_error});
  figure.script =
      plot::common_style() + plot::label('x', horizontal) + plot::label('y', vertical) +
      fmt::format("s = {:.0e}\nset size ratio 1\nset xrange [{:.10g}*s:{:.10g}*s]\n", horizontal.scale, range.low,
                  range.high) +
      fmt::format("set yrange [{:.10g}*s:{:.10g}*s]\n", range.low, range.high) +
      fmt::format(
          "plot x with lines linecolor rgb '{0}' dashtype 2 title 'identity', \\\n"
          "  '{1}.dat' index 'runs' using ($1*s):($2*s):($3*s):($4*s) with xyerrorbars linecolor rgb "
          "'{3}' linewidth 0.9 pointtype 7 pointsize 0.05 title 'runs, ±1 sd', \\\n"
          "  '' index 'runs' using ($1*s):($2*s) with points linecolor rgb '{2}' pointtype 7 pointsize 0.35 "
          "notitle",
          plot::grey, stem, plot::blue, plot::sky);
  figure.alt = fmt::format("leave-one-out predictions of {} against the {} runs", surrogate.output, n);
  return figure;
}

Figure standardised_figure(const SurrogateReport& surrogate, const std::string& stem) {
  std::vector<double> x, inside, x_beyond, beyond;
  Extent across, up;
  up.include(-3.0);
  up.include(3.0);
  for (std::size_t i = 0; i < std::min(surrogate.predicted.size(), surrogate.standardised.size()); ++i) {
    const double z = surrogate.standardised[i];
    across.include(surrogate.predicted[i]);
    up.include(z);
    (std::abs(z) > 2.0 ? x_beyond : x).push_back(surrogate.predicted[i]);
    (std::abs(z) > 2.0 ? beyond : inside).push_back(z);
  }
  const Axis horizontal = plot::axis_for("predicted " + surrogate.output, surrogate.unit, across.largest());
  const Extent range = across.padded(0.05);
  const Extent y_range = up.padded(0.05);

  Figure figure{.stem = stem, .script = {}, .data = {}, .alt = {}, .width = 420, .height = 410};
  figure.data = plot::block("inside", {x, inside}) + plot::block("beyond", {x_beyond, beyond});
  figure.script = plot::common_style() + plot::label('x', horizontal) +
                  fmt::format("set ylabel 'standardised leave-one-out error' textcolor rgb '{}'\n", plot::ink) +
                  fmt::format("sx = {:.0e}\nset xrange [{:.10g}*sx:{:.10g}*sx]\nset yrange [{:.10g}:{:.10g}]\n",
                              horizontal.scale, range.low, range.high, y_range.low, y_range.high) +
                  fmt::format(
                      "plot 2 with lines dashtype 2 linecolor rgb '{3}' notitle, \\\n"
                      "  -2 with lines dashtype 2 linecolor rgb '{3}' notitle, \\\n"
                      "  '{0}.dat' index 'inside' using ($1*sx):2 with points pointtype 7 pointsize 0.5 "
                      "linecolor rgb '{1}' title 'within ±2', \\\n"
                      "  '' index 'beyond' using ($1*sx):2 with points pointtype 9 pointsize 0.9 linecolor rgb "
                      "'{2}' title 'beyond ±2'",
                      stem, plot::blue, plot::vermillion, plot::grey);
  figure.alt = fmt::format("standardised leave-one-out errors of {}", surrogate.output);
  return figure;
}

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
      plot::common_style() + plot::label('x', horizontal) + plot::label('y', vertical) +
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

}  // namespace uq
