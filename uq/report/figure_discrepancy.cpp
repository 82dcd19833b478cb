// How much of the data a case's discrepancy process takes: its 90 % band about zero.
#include <fmt/format.h>

#include "uq/report/figures.hpp"
#include "uq/report/plot.hpp"

namespace uq {

Figure discrepancy_figure(const CaseReport& result, const DiscrepancyBand& band, const std::string& stem) {
  plot::Extent across, up;
  up.include(0.0);
  for (const double value : band.x) across.include(value);
  for (const auto* column : {&band.mean, &band.q05, &band.q95})
    for (const double value : *column) up.include(value);
  const plot::Axis horizontal = plot::axis_for(band.control, band.control_unit, across.largest());
  const plot::Axis vertical = plot::axis_for("discrepancy of " + band.output, band.unit, up.largest());
  const plot::Extent x_range = across.padded(0.04), y_range = up.padded(0.12);
  Figure figure{.stem = stem, .script = {}, .data = {}, .alt = {}, .height = 330};
  figure.data = plot::block("band", {band.x, band.mean, band.q05, band.q95});
  figure.script =
      plot::common_style() + plot::label('x', horizontal) + plot::label('y', vertical) +
      fmt::format("sx = {:.0e}\nsy = {:.0e}\nset xrange [{:.10g}*sx:{:.10g}*sx]\nset yrange [{:.10g}*sy:{:.10g}*sy]\n",
                  horizontal.scale, vertical.scale, x_range.low, x_range.high, y_range.low, y_range.high) +
      fmt::format(
          "plot '{0}.dat' index 'band' using ($1*sx):($3*sy):($4*sy) with filledcurves linecolor rgb '{1}' "
          "title 'discrepancy, 90 %', \\\n"
          "  '' index 'band' using ($1*sx):($2*sy) with lines linecolor rgb '{2}' linewidth 2 title 'its mean', \\\n"
          "  0 with lines dashtype 2 linecolor rgb '{3}' title 'no discrepancy'",
          stem, plot::pale, plot::blue, plot::grey);
  figure.alt = fmt::format("discrepancy of {} against {} in case {}: 90 % band about zero", band.output, band.control,
                           result.name);
  return figure;
}

}  // namespace uq
