// Where the runs lie, two inputs at a time; those that were left out marked.
#include <fmt/format.h>

#include <algorithm>

#include "uq/report/figures.hpp"
#include "uq/report/plot.hpp"

namespace uq {

Figure design_figure(const DesignReport& design, std::pair<std::size_t, std::size_t> inputs, const std::string& stem) {
  const auto [first, second] = inputs;
  plot::Extent across, up;
  const auto column = [](const std::vector<std::vector<double>>& runs, std::size_t input, plot::Extent& extent) {
    std::vector<double> values;
    for (const auto& run : runs) {
      values.push_back(run[input]);
      extent.include(values.back());
    }
    return values;
  };
  Figure figure{.stem = stem, .script = {}, .data = {}, .alt = {}, .width = 420, .height = 330};
  figure.data = plot::block("runs", {column(design.runs, first, across), column(design.runs, second, up)});
  if (!design.left_out.empty())
    figure.data +=
        plot::block("left_out", {column(design.left_out, first, across), column(design.left_out, second, up)});
  const plot::Axis x = plot::axis_for(design.inputs[first], design.units[first], across.largest());
  const plot::Axis y = plot::axis_for(design.inputs[second], design.units[second], up.largest());
  const plot::Extent x_range = across.padded(0.05), y_range = up.padded(0.05);
  figure.script =
      plot::common_style() + plot::label('x', x) + plot::label('y', y) +
      fmt::format("sx = {:.0e}\nsy = {:.0e}\nset xrange [{:.10g}*sx:{:.10g}*sx]\nset yrange [{:.10g}*sy:{:.10g}*sy]\n",
                  x.scale, y.scale, x_range.low, x_range.high, y_range.low, y_range.high) +
      fmt::format(
          "plot '{}.dat' index 'runs' using ($1*sx):($2*sy) with points pointtype 7 pointsize 0.45 "
          "linecolor rgb '{}' title 'learnt from'",
          stem, plot::blue);
  if (!design.left_out.empty())
    figure.script += fmt::format(
        ", \\\n  '' index 'left_out' using ($1*sx):($2*sy) with points pointtype 2 pointsize 0.9 "
        "linecolor rgb '{}' title 'left out'",
        plot::vermillion);
  figure.alt = fmt::format("runs over {} and {}", design.inputs[first], design.inputs[second]);
  return figure;
}

}  // namespace uq
