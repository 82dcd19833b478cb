#include "uq/report/figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "uq/findings/thresholds.hpp"
#include "uq/report/plot.hpp"

namespace uq {
namespace {

using plot::Axis;
using plot::Extent;

bool belongs(const PredictivePoint& point, const PredictiveCurve& curve) {
  if (point.output != curve.output) return false;
  if (point.observation_set.empty() || curve.observation_set.empty()) return point.controls.contains(curve.control);
  return point.observation_set == curve.observation_set && point.controls.contains(curve.control);
}

/// The control that takes the most values in these points; empty when they have none.
std::string varying_control(const std::vector<const PredictivePoint*>& points) {
  std::map<std::string, std::set<double>> values;
  for (const PredictivePoint* point : points) {
    for (const auto& [name, value] : point->controls) values[name].insert(value);
  }
  const auto most = std::max_element(values.begin(), values.end(),
                                     [](const auto& a, const auto& b) { return a.second.size() < b.second.size(); });
  return most == values.end() ? std::string() : most->first;
}

/// The observed points of a curve's set and output.
struct Observed {
  std::vector<double> x, value, error;
};

void add(Observed& observed, const PredictivePoint& point, const std::string& control) {
  observed.x.push_back(point.controls.at(control));
  observed.value.push_back(point.observed);
  observed.error.push_back(std::isfinite(point.standard_error) ? point.standard_error : 0.0);
}

Observed observed_beside(const CaseReport& result, const PredictiveCurve& curve) {
  Observed observed;
  for (const PredictivePoint& point : result.predictive)
    if (belongs(point, curve)) add(observed, point, curve.control);
  return observed;
}

/// The points of data that the case has not used. With a second control they need not lie on the curve.
Observed unused_beside(const CaseReport& result, const PredictiveCurve& curve) {
  Observed unused;
  for (const PredictionReport& made : result.predictions)
    for (const PredictedPoint& one : made.points)
      if (one.point.output == curve.output && one.point.controls.size() == 1 &&
          one.point.controls.contains(curve.control))
        add(unused, one.point, curve.control);
  return unused;
}

/// Axes, labels and ranges around observed points and some curves against the same control.
std::string frame(const std::vector<const Observed*>& points, const std::vector<const PredictiveCurve*>& curves) {
  Extent across, up;
  for (const Observed* observed : points) {
    for (std::size_t i = 0; i < observed->x.size(); ++i) {
      across.include(observed->x[i]);
      up.include(observed->value[i] - observed->error[i]);
      up.include(observed->value[i] + observed->error[i]);
    }
  }
  for (const PredictiveCurve* curve : curves) {
    for (const double value : curve->x) across.include(value);
    for (const auto* column : {&curve->mean, &curve->q05, &curve->q95})
      for (const double value : *column) up.include(value);
  }
  const PredictiveCurve& one = *curves.front();
  const Axis horizontal = plot::axis_for(one.control, one.control_unit, across.largest());
  const Axis vertical = plot::axis_for(one.output, one.unit, up.largest());
  const Extent x_range = across.padded(0.04);
  const Extent y_range = up.padded(0.12);
  return plot::common_style() + plot::label('x', horizontal) + plot::label('y', vertical) +
         fmt::format("sx = {:.0e}\nsy = {:.0e}\n", horizontal.scale, vertical.scale) +
         fmt::format("set xrange [{:.10g}*sx:{:.10g}*sx]\nset yrange [{:.10g}*sy:{:.10g}*sy]\n", x_range.low,
                     x_range.high, y_range.low, y_range.high);
}

std::string observed_marks() {
  return fmt::format(
      "'' index 'observed' using ($1*sx):($2*sy):($3*sy) with yerrorbars linecolor rgb '{}' linewidth 1.3 pointtype 7 "
      "pointsize 0.6 title 'observed, ±1 standard error'",
      plot::vermillion);
}

}  // namespace

std::vector<PredictiveCurve> curves_to_draw(const CaseReport& result) {
  std::vector<PredictiveCurve> curves;
  for (const PredictiveCurve& curve : result.curves) {
    if (!curve.x.empty()) curves.push_back(curve);
  }
  if (!curves.empty()) return curves;
  std::map<std::pair<std::string, std::string>, std::vector<const PredictivePoint*>> groups;
  for (const PredictivePoint& point : result.predictive) {
    groups[{point.output, point.observation_set}].push_back(&point);
  }
  for (auto& [key, points] : groups) {
    PredictiveCurve curve{.output = key.first,
                          .unit = points.front()->unit,
                          .control = varying_control(points),
                          .control_unit = {},
                          .observation_set = key.second,
                          .x = {},
                          .mean = {},
                          .q05 = {},
                          .q95 = {}};
    if (curve.control.empty()) continue;
    std::erase_if(points, [&](const PredictivePoint* point) { return !point->controls.contains(curve.control); });
    std::stable_sort(points.begin(), points.end(), [&](const PredictivePoint* a, const PredictivePoint* b) {
      return a->controls.at(curve.control) < b->controls.at(curve.control);
    });
    for (const PredictivePoint* point : points) {
      curve.x.push_back(point->controls.at(curve.control));
      curve.mean.push_back(point->mean);
      curve.q05.push_back(point->q05);
      curve.q95.push_back(point->q95);
    }
    curves.push_back(std::move(curve));
  }
  return curves;
}

Figure predictive_figure(const CaseReport& result, const PredictiveCurve& curve, const std::string& stem) {
  const Observed observed = observed_beside(result, curve), unused = unused_beside(result, curve);
  Figure figure{.stem = stem, .script = {}, .data = {}, .alt = {}};
  figure.data = plot::block("band", {curve.x, curve.mean, curve.q05, curve.q95}) +
                plot::block("observed", {observed.x, observed.value, observed.error});
  figure.script = frame({&observed, &unused}, {&curve}) +
                  fmt::format(
                      "plot '{0}.dat' index 'band' using ($1*sx):($3*sy):($4*sy) with filledcurves "
                      "linecolor rgb '{1}' title 'model, 90 %', \\\n"
                      "  '' index 'band' using ($1*sx):($2*sy) with lines linecolor rgb '{2}' linewidth 2 "
                      "title 'model, mean', \\\n  ",
                      stem, plot::pale, plot::blue) +
                  observed_marks();
  if (!unused.x.empty()) {
    figure.data += plot::block("unused", {unused.x, unused.value, unused.error});
    figure.script += fmt::format(
        ", \\\n  '' index 'unused' using ($1*sx):($2*sy):($3*sy) with yerrorbars linecolor rgb '{}' linewidth 1.3 "
        "pointtype 6 pointsize 0.8 title 'observed, not used'",
        plot::ink);
  }
  figure.alt = fmt::format("{} against {} in case {}: observed points with their errors{} and the model's 90 % band",
                           curve.output, curve.control, result.name,
                           unused.x.empty() ? "" : ", those that the case has not used among them,");
  return figure;
}

Figure equivalent_figure(const CaseReport& result, const TradedPair& traded, const PredictiveCurve& like,
                         const std::string& stem) {
  static constexpr const char* colours[] = {plot::blue, plot::green, plot::ink, plot::sky, plot::grey};
  const Observed observed = observed_beside(result, like);
  std::vector<const PredictiveCurve*> curves;
  for (const PredictiveCurve& curve : traded.curves)
    if (curve.observation_set == like.observation_set && curve.output == like.output) curves.push_back(&curve);
  Figure figure{.stem = stem, .script = {}, .data = {}, .alt = {}};
  figure.data = plot::block("observed", {observed.x, observed.value, observed.error});
  figure.script = frame({&observed}, curves) + "plot ";
  for (std::size_t i = 0; i < curves.size(); ++i) {
    figure.data += plot::block(fmt::format("point{}", i + 1), {curves[i]->x, curves[i]->mean});
    figure.script += fmt::format(
        "'{}.dat' index 'point{}' using ($1*sx):($2*sy) with lines linecolor rgb '{}' linewidth 1.8 dashtype {} title "
        "'point {}', \\\n  ",
        stem, i + 1, colours[i % std::size(colours)], i + 1, i + 1);
  }
  figure.script += observed_marks();
  figure.alt = fmt::format("{} against {} in case {} at {} equivalent points, with the observed points", like.output,
                           like.control, result.name, curves.size());
  return figure;
}

std::vector<std::pair<std::size_t, std::size_t>> pairs_to_draw(const CaseReport& result, std::size_t limit) {
  const auto index_of = [&](const std::string& name) {
    const auto found = std::find_if(result.parameters.begin(), result.parameters.end(),
                                    [&](const ParameterReport& parameter) { return parameter.name == name; });
    return static_cast<std::size_t>(found - result.parameters.begin());
  };
  const std::size_t n = result.parameters.size();
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const TradedPair& traded : result.traded) {
    const std::size_t a = index_of(traded.first), b = index_of(traded.second);
    if (a >= n || b >= n || a == b) continue;
    const std::pair<std::size_t, std::size_t> pair = std::minmax(a, b);
    if (std::find(pairs.begin(), pairs.end(), pair) == pairs.end()) pairs.push_back(pair);
  }
  std::vector<std::pair<double, std::pair<std::size_t, std::size_t>>> rest;
  for (std::size_t a = 0; a < n; ++a) {
    for (std::size_t b = a + 1; b < n; ++b) {
      if (std::find(pairs.begin(), pairs.end(), std::pair{a, b}) != pairs.end()) continue;
      const bool known = a < result.correlation.size() && b < result.correlation[a].size();
      const double correlation = known ? std::abs(result.correlation[a][b]) : 0.0;
      rest.push_back({std::isfinite(correlation) ? correlation : 0.0, {a, b}});
    }
  }
  std::stable_sort(rest.begin(), rest.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  for (const auto& [correlation, pair] : rest) pairs.push_back(pair);
  if (pairs.size() > limit) pairs.resize(limit);
  return pairs;
}

Figure profile_figure(const ParameterReport& parameter, const std::string& stem) {
  Extent across, up;
  for (const double x : parameter.profile_x) across.include(x);
  for (const double deviance : parameter.profile_deviance) up.include(deviance);
  const Axis horizontal = plot::axis_for(parameter.name, parameter.unit, across.largest());
  const double top = std::clamp(up.empty ? 0.0 : up.high, 6.0, 12.0);
  // Each part of the interval, up to where the curve crosses the line.
  std::vector<std::pair<double, double>> shaded;
  for (const ValueRange& part : parameter.intervals) shaded.emplace_back(part.low, part.high);
  if (shaded.empty())
    shaded.emplace_back(parameter.profile_low.value_or(across.low), parameter.profile_high.value_or(across.high));

  Figure figure{.stem = stem, .script = {}, .data = {}, .alt = {}, .width = 420, .height = 310};
  figure.data = plot::block("profile", {parameter.profile_x, parameter.profile_deviance});
  const Extent range = across.padded(0.02);
  figure.script = plot::common_style() + plot::label('x', horizontal) +
                  fmt::format("set ylabel '−2 Δ ln L' textcolor rgb '{}'\n", plot::ink) +
                  fmt::format("sx = {:.0e}\nset xrange [{:.10g}*sx:{:.10g}*sx]\nset yrange [0:{:.10g}]\n",
                              horizontal.scale, range.low, range.high, top);
  for (std::size_t i = 0; i < shaded.size(); ++i)
    figure.script += fmt::format(
        "set object {} rectangle from first {:.10g}*sx, graph 0 to first {:.10g}*sx, graph 1 behind "
        "fillcolor rgb '{}' fillstyle solid noborder\n",
        i + 1, shaded[i].first, shaded[i].second, "#EAF4FB");
  figure.script += fmt::format(
      "plot {0:.3g} with lines linecolor rgb '{1}' linewidth 1.2 dashtype 2 "
      "title '95 % ({0:.3g})', \\\n"
      "  '{2}.dat' index 'profile' using ($1*sx):2 with lines linecolor rgb '{3}' linewidth 2 "
      "title 'profile'",
      parameter.profile_drop, plot::vermillion, stem, plot::blue);
  if (std::isfinite(parameter.map)) {
    figure.data += plot::block("map", {{parameter.map}, {0.0}});
    figure.script += fmt::format(
        ", \\\n  '' index 'map' using ($1*sx):2 with points pointtype 9 pointsize 0.9 linecolor rgb '{}' "
        "title 'mode'",
        plot::ink);
  }
  figure.alt = fmt::format("profile likelihood of {}", parameter.name);
  return figure;
}

}  // namespace uq
