// The joint posterior of two parameters. The regions are the smallest that hold 50 and 90 % of the density drawn from
// the posterior's draws (density.hpp); the prior box is the parameters' range.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "uq/report/density.hpp"
#include "uq/report/figures.hpp"
#include "uq/report/plot.hpp"

namespace uq {
namespace {

using plot::Axis;
using plot::Extent;

constexpr std::size_t points_drawn_wide = 600;  ///< beyond that the page only grows
constexpr double share_for_whole_box = 0.25;    ///< draws that span this much of the range: the whole range is shown

/// Axis limits: the whole prior range where the draws fill a good part of it, else the draws with a wide margin.
Extent limits(const Extent& draws, const ParameterReport& parameter) {
  const double width = parameter.prior_high - parameter.prior_low;
  if (!std::isfinite(width) || !(width > 0.0)) return draws.padded(0.25);
  if (draws.empty || draws.high - draws.low > share_for_whole_box * width) {
    Extent whole{.low = parameter.prior_low, .high = parameter.prior_high, .empty = false};
    if (!draws.empty) {
      whole.include(draws.low);
      whole.include(draws.high);
    }
    return whole.padded(0.04);
  }
  const Extent wide = draws.padded(0.6);
  const double margin = 0.05 * (wide.high - wide.low);
  return {.low = std::max(wide.low, parameter.prior_low - margin),
          .high = std::min(wide.high, parameter.prior_high + margin),
          .empty = false};
}

/// Where density is drawn: around the draws, so that the grid resolves a narrow ridge, and cut at the prior's bounds.
std::pair<double, double> support(const Extent& draws, const ParameterReport& parameter) {
  const Extent around = draws.padded(0.15);
  const double low = std::isfinite(parameter.prior_low) ? std::max(around.low, parameter.prior_low) : around.low;
  const double high = std::isfinite(parameter.prior_high) ? std::min(around.high, parameter.prior_high) : around.high;
  return {low, high};
}

bool shows_bound(const Extent& view, const ParameterReport& parameter) {
  return (parameter.prior_low >= view.low && parameter.prior_low <= view.high) ||
         (parameter.prior_high >= view.low && parameter.prior_high <= view.high);
}

/// The closed lines of a region, each a block of its own for "filledcurves".
std::string region_block(const char* name, const std::vector<Loop>& loops) {
  std::string text = fmt::format("# {}\n", name);
  for (const Loop& loop : loops) {
    for (std::size_t i = 0; i < loop.x.size(); ++i) text += fmt::format("{:.6g} {:.6g}\n", loop.x[i], loop.y[i]);
    text += "\n";
  }
  return text + "\n";
}

/// Points along the ridge in the order of the first parameter's values, numbered as in the page's table.
std::vector<std::vector<double>> equivalent_columns(const CaseReport& result, const ParameterReport& a,
                                                    const ParameterReport& b) {
  std::vector<std::vector<double>> columns(3);
  for (const TradedPair& traded : result.traded) {
    if (!(a.name == traded.first || a.name == traded.second) || !(b.name == traded.first || b.name == traded.second))
      continue;
    double number = 0.0;
    for (const auto& point : traded.equivalent) {
      number += 1.0;
      if (!point.contains(a.name) || !point.contains(b.name)) continue;
      columns[0].push_back(point.at(a.name));
      columns[1].push_back(point.at(b.name));
      columns[2].push_back(number);
    }
  }
  return columns;
}

/// The draws of two parameters.
struct PairDraws {
  std::vector<double> x, y;
  Extent across, up;
};

PairDraws draws_of(const CaseReport& result, std::pair<std::size_t, std::size_t> pair) {
  PairDraws draws;
  for (const auto& draw : result.draws_for_plot) {
    if (draw.size() <= std::max(pair.first, pair.second)) continue;
    if (!std::isfinite(draw[pair.first]) || !std::isfinite(draw[pair.second])) continue;
    draws.x.push_back(draw[pair.first]);
    draws.y.push_back(draw[pair.second]);
    draws.across.include(draws.x.back());
    draws.up.include(draws.y.back());
  }
  return draws;
}

/// About `most` of the draws, at even steps: their order does not matter to the eye.
std::vector<std::vector<double>> thinned_evenly(const PairDraws& draws, std::size_t most) {
  std::vector<std::vector<double>> shown(2);
  const double count = static_cast<double>(draws.x.size()), step = std::max(1.0, count / static_cast<double>(most));
  for (double at = 0.0; at < count; at += step) {
    shown[0].push_back(draws.x[static_cast<std::size_t>(at)]);
    shown[1].push_back(draws.y[static_cast<std::size_t>(at)]);
  }
  return shown;
}

/// The part of the plot command that draws the regions of 90 and 50 %.
std::string regions_script(const std::string& source) {
  return fmt::format(
      "{0} index 'region90' using ($1*sx):($2*sy) with filledcurves closed fillcolor rgb '{1}' title '90 %', \\\n"
      "  {0} index 'region50' using ($1*sx):($2*sy) with filledcurves closed fillcolor rgb '{2}' title '50 %', \\\n",
      source, plot::pale, "#8FC7EA");
}

/// The draws, the range of the prior with its title, and the mode.
std::string draws_script(const std::string& source, const char* range_title) {
  return fmt::format(
      "  {0} index 'draws' using ($1*sx):($2*sy) with points pointtype 7 pointsize 0.18 linecolor rgb '{1}' "
      "title 'draws', \\\n"
      "  {0} index 'prior' using ($1*sx):($2*sy) with lines dashtype 3 linewidth 1.2 linecolor rgb '{2}' "
      "{4}, \\\n"
      "  {0} index 'mode' using ($1*sx):($2*sy) with points pointtype 2 pointsize 1.1 linewidth 2 linecolor rgb '{3}' "
      "title 'mode'",
      source, plot::blue, plot::grey, plot::ink, range_title);
}

/// The equivalent points with their numbers.
std::string equivalent_script(const std::string& source) {
  return fmt::format(
      ", \\\n  {0} index 'equivalent' using ($1*sx):($2*sy) with linespoints pointtype 13 pointsize 1.1 linewidth "
      "1.2 "
      "dashtype 2 linecolor rgb '{1}' title 'equivalent points', \\\n"
      "  {0} index 'equivalent' using ($1*sx):($2*sy):(sprintf('%d', $3)) with labels offset 1.0,0.7 textcolor rgb "
      "'{2}' notitle",
      source, plot::vermillion, plot::ink);
}

}  // namespace

bool are_traded(const CaseReport& result, std::pair<std::size_t, std::size_t> pair) {
  const std::string& a = result.parameters[pair.first].name;
  const std::string& b = result.parameters[pair.second].name;
  return std::any_of(result.traded.begin(), result.traded.end(), [&](const TradedPair& traded) {
    return (traded.first == a && traded.second == b) || (traded.first == b && traded.second == a);
  });
}

Figure joint_figure(const CaseReport& result, std::pair<std::size_t, std::size_t> pair, FigureSize size,
                    const std::string& stem) {
  const ParameterReport& a = result.parameters[pair.first];
  const ParameterReport& b = result.parameters[pair.second];
  const PairDraws draws = draws_of(result, pair);
  const Extent x_view = limits(draws.across, a), y_view = limits(draws.up, b);
  const auto [x_low, x_high] = support(draws.across, a);
  const auto [y_low, y_high] = support(draws.up, b);
  const PlotBox box{.x_low = x_low, .x_high = x_high, .y_low = y_low, .y_high = y_high};
  const DensityGrid grid = joint_density(draws.x, draws.y, box);
  const auto equivalent = equivalent_columns(result, a, b);
  const Axis horizontal = plot::axis_for(a.name, a.unit, x_view.largest());
  const Axis vertical = plot::axis_for(b.name, b.unit, y_view.largest());

  Figure figure{.stem = stem, .script = {}, .data = {}, .alt = {}};
  figure.width = size == FigureSize::wide ? 700 : 420;
  figure.height = size == FigureSize::wide ? 520 : 380;
  figure.data = plot::block("draws", thinned_evenly(
                                         draws, size == FigureSize::wide ? points_drawn_wide : points_drawn_wide / 2)) +
                plot::block("equivalent", equivalent) +
                plot::block("prior", {{a.prior_low, a.prior_high, a.prior_high, a.prior_low, a.prior_low},
                                      {b.prior_low, b.prior_low, b.prior_high, b.prior_high, b.prior_low}}) +
                plot::block("mode", {{a.map}, {b.map}});
  if (!grid.density.empty())
    figure.data += region_block("region90", contour(grid, box, grid.level90)) +
                   region_block("region50", contour(grid, box, grid.level50));
  figure.script = plot::common_style() + plot::label('x', horizontal) + plot::label('y', vertical) +
                  fmt::format("sx = {:.0e}\nsy = {:.0e}\n", horizontal.scale, vertical.scale) + "set clip two\n" +
                  fmt::format("set xrange [{:.10g}*sx:{:.10g}*sx]\nset yrange [{:.10g}*sy:{:.10g}*sy]\nplot ",
                              x_view.low, x_view.high, y_view.low, y_view.high);
  const std::string source = fmt::format("'{}.dat'", stem);
  if (!grid.density.empty()) figure.script += regions_script(source);
  figure.script +=
      draws_script(source, shows_bound(x_view, a) || shows_bound(y_view, b) ? "title 'prior range'" : "notitle");
  if (!equivalent.front().empty()) figure.script += equivalent_script(source);
  figure.alt = fmt::format("joint posterior of {} and {} in case {}", a.name, b.name, result.name);
  return figure;
}

}  // namespace uq
