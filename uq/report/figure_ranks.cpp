#include "uq/report/figure_ranks.hpp"

#include <fmt/format.h>

#include "uq/report/plot.hpp"

namespace uq {

Figure rank_figure(const SimulationCalibration& found, const std::string& stem) {
  static constexpr const char* colours[] = {plot::blue, plot::vermillion, plot::green, plot::ink, plot::sky};
  std::vector<double> low, high;
  plot::Extent up;
  for (std::size_t i = 0; i < found.z.size(); ++i) {
    low.push_back(found.band_low[i] - found.z[i]);
    high.push_back(found.band_high[i] - found.z[i]);
    up.include(low.back());
    up.include(high.back());
  }
  Figure figure{.stem = stem, .script = {}, .data = plot::block("band", {found.z, low, high}), .alt = {}};
  std::string curves;
  for (std::size_t k = 0; k < found.unknowns.size(); ++k) {
    const RankCheck& one = found.unknowns[k];
    std::vector<double> away(found.z.size(), 0.0);
    for (std::size_t i = 0; i < found.z.size(); ++i) {
      int below = 0;
      for (const int rank : one.ranks) below += rank <= static_cast<int>(i) ? 1 : 0;
      away[i] = below / static_cast<double>(one.ranks.size()) - found.z[i];
      up.include(away[i]);
    }
    const std::string name = fmt::format("unknown{}", k);
    figure.data += plot::block(name, {found.z, away});
    curves +=
        fmt::format(", \\\n  '' index '{}' using 1:2 with steps linecolor rgb '{}' linewidth 1.6 dashtype {} title {}",
                    name, colours[k % std::size(colours)], 1 + k / std::size(colours), gnuplot_text(one.name));
  }
  const plot::Extent range = up.padded(0.1);
  figure.script =
      plot::common_style() +
      fmt::format(
          "set xlabel 'rank of the truth among the draws, as a share' textcolor rgb '{0}'\n"
          "set ylabel 'share of ranks below, minus the uniform share' textcolor rgb '{0}'\n"
          "set xrange [0:1]\nset yrange [{1:.10g}:{2:.10g}]\n",
          plot::ink, range.low, range.high) +
      fmt::format(
          "plot '{}.dat' index 'band' using 1:2:3 with filledcurves linecolor rgb '{}' title 'uniform ranks, 95 %'",
          stem, plot::pale) +
      curves;
  figure.alt = fmt::format("ranks of the truth in case {} against the bands of uniform ranks", found.case_name);
  return figure;
}

}  // namespace uq
