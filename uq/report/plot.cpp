#include "uq/report/plot.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "uq/findings/study_units.hpp"
#include "uq/report/gnuplot.hpp"

namespace uq::plot {

Axis axis_for(std::string_view name, std::string_view unit, double largest) {
  Axis axis{.scale = 1.0, .label = std::string(name)};
  int exponent = 0;
  if (std::isfinite(largest) && largest > 0.0 && (largest >= 1e5 || largest < 1e-2)) {
    exponent = 3 * static_cast<int>(std::floor(std::log10(largest) / 3.0));
    axis.scale = std::pow(10.0, -exponent);
  }
  const bool bare = is_bare(unit) || unit == name;
  if (exponent != 0) {
    static const char* const digits[] = {"\u2070", "\u00b9", "\u00b2", "\u00b3", "\u2074",
                                         "\u2075", "\u2076", "\u2077", "\u2078", "\u2079"};
    std::string power = exponent < 0 ? "10\u207b" : "10";
    for (const char digit : std::to_string(std::abs(exponent))) power += digits[digit - '0'];
    axis.label += bare ? fmt::format(" ({})", power) : fmt::format(" ({} {})", power, unit);
  } else if (!bare) {
    axis.label += fmt::format(" ({})", unit);
  }
  return axis;
}

std::string block(std::string_view name, const std::vector<std::vector<double>>& columns) {
  std::string text = fmt::format("# {}\n", name);
  std::size_t rows = columns.empty() ? 0 : columns.front().size();
  for (const auto& column : columns) rows = std::min(rows, column.size());
  bool any = false;
  for (std::size_t row = 0; row < rows; ++row) {
    const bool finite =
        std::all_of(columns.begin(), columns.end(), [row](const auto& column) { return std::isfinite(column[row]); });
    if (!finite) continue;
    any = true;
    for (const auto& column : columns) text += fmt::format("{:.10g} ", column[row]);
    text.back() = '\n';
  }
  // An empty block would shift gnuplot's indices: it holds one row that is not drawn.
  if (!any) {
    for (std::size_t i = 0; i < std::max<std::size_t>(columns.size(), 1); ++i) text += "NaN ";
    text.back() = '\n';
  }
  return text + "\n\n";
}

std::string common_style() {
  return fmt::format(
      "set border 3 linecolor rgb '{0}' linewidth 1\n"
      "set tics nomirror out scale 0.6 textcolor rgb '{1}'\n"
      "set grid linetype 1 linecolor rgb '#E6E6E6' linewidth 0.8\n"
      "set key outside top left horizontal Left reverse samplen 2.2 width 1 height 0.3 textcolor rgb '{1}'\n"
      "set datafile missing 'NaN'\n"
      "set errorbars 0.8\n",
      grey, ink);
}

std::string label(char which, const Axis& axis) {
  return fmt::format("set {}label {} textcolor rgb '{}'\n", which, gnuplot_text(axis.label), ink);
}

void Extent::include(double value) {
  if (!std::isfinite(value)) return;
  low = empty ? value : std::min(low, value);
  high = empty ? value : std::max(high, value);
  empty = false;
}

Extent Extent::padded(double share) const {
  double width = high - low;
  if (!(width > 0.0)) width = std::abs(high) > 0.0 ? std::abs(high) : 1.0;
  return {.low = low - share * width, .high = high + share * width, .empty = false};
}

double Extent::largest() const { return std::max(std::abs(low), std::abs(high)); }

}  // namespace uq::plot
