// A log has more samples than a picture has columns: each of some 1,500 equal stretches of time is drawn as the bar
// from its smallest to its largest value, so that no spike is lost.
#include "cli/observe_figure.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "uq/report/plot.hpp"

namespace cli {
namespace {

namespace plot = uq::plot;

constexpr std::size_t columns = 1500;

struct Bars {
  std::vector<double> time, low, high;
};

/// Smallest and largest of values[first ... last) in stretches of `width` seconds.
Bars bars(const data::TorqueLog& log, const std::vector<double>& values, std::size_t first, std::size_t last,
          double width) {
  Bars found;
  for (std::size_t i = first; i < last;) {
    double low = values[i], high = values[i];
    const double start = log.time[i];
    for (; i < last && log.time[i] - start <= width; ++i) {
      low = std::min(low, values[i]);
      high = std::max(high, values[i]);
    }
    found.time.push_back(start + 0.5 * std::min(width, log.time[i - 1] - start));
    found.low.push_back(low);
    found.high.push_back(high);
  }
  return found;
}

void append(Bars& to, const Bars& more) {
  to.time.insert(to.time.end(), more.time.begin(), more.time.end());
  to.low.insert(to.low.end(), more.low.begin(), more.low.end());
  to.high.insert(to.high.end(), more.high.begin(), more.high.end());
}

}  // namespace

uq::Figure log_figure(const data::TorqueLog& log, const std::vector<data::Plateau>& plateaus,
                      const std::vector<double>& idle, const data::Unit& torque_unit, const std::string& stem) {
  const auto in_unit = [](const std::vector<double>& si, const data::Unit& unit) {
    std::vector<double> values(si.size());
    std::transform(si.begin(), si.end(), values.begin(), [&](double value) { return unit.from_si(value); });
    return values;
  };
  const std::vector<double> torque = in_unit(log.torque, torque_unit), speed = in_unit(log.speed, log.speed_unit);
  const double width = (log.time.back() - log.time.front()) / static_cast<double>(columns);

  Bars between, dropped, used;
  std::vector<double> from, to, mean, low, high, off, middle;
  std::size_t reached = 0;
  for (std::size_t p = 0; p < plateaus.size(); ++p) {
    const data::Plateau& plateau = plateaus[p];
    const std::size_t end = plateau.first + plateau.count;
    append(between, bars(log, torque, reached, plateau.first, width));
    append(dropped, bars(log, torque, plateau.first, plateau.used_from, width));
    append(used, bars(log, torque, plateau.used_from, end, width));
    reached = end;
    const double error = 2.0 * plateau.torque.standard_error;
    from.push_back(log.time[plateau.used_from]);
    to.push_back(log.time[end - 1]);
    middle.push_back(0.5 * (from.back() + to.back()));
    mean.push_back(torque_unit.from_si(plateau.torque.mean));
    low.push_back(torque_unit.from_si(plateau.torque.mean - error));
    high.push_back(torque_unit.from_si(plateau.torque.mean + error));
    off.push_back(idle.empty() ? NAN : torque_unit.from_si(idle[p]));
  }
  append(between, bars(log, torque, reached, torque.size(), width));
  const Bars turning = bars(log, speed, 0, speed.size(), width);

  uq::Figure figure{.stem = stem, .script = {}, .data = {}, .alt = {}, .width = 900, .height = 560};
  figure.data =
      plot::block("between", {between.time, between.low, between.high}) +
      plot::block("dropped", {dropped.time, dropped.low, dropped.high}) +
      plot::block("used", {used.time, used.low, used.high}) + plot::block("mean", {middle, mean, from, to, low, high}) +
      plot::block("idle", {middle, off, from, to}) + plot::block("speed", {turning.time, turning.low, turning.high});
  // Bars as vertical vectors: stretches that do not touch stay apart, as a filled curve would not leave them.
  const auto stretch = [&](const char* name, const char* colour, const std::string& title) {
    return fmt::format(
        "'{}.dat' index '{}' using 1:2:(0):($3-$2) with vectors nohead linewidth 1 linecolor rgb '{}' {}", stem, name,
        colour, title.empty() ? "notitle" : fmt::format("title '{}'", title));
  };
  figure.script =
      plot::common_style() + "set multiplot\nset lmargin 11\nset rmargin 3\n" +
      fmt::format("set xrange [{:.10g}:{:.10g}]\n", log.time.front(), log.time.back()) +
      "set size 1, 0.68\nset origin 0, 0.32\nset format x ''\nset bmargin 0.6\n" +
      plot::label('y', {.scale = 1.0, .label = fmt::format("torque ({})", torque_unit.symbol)}) + "plot " +
      stretch("between", plot::grey, "not used: ramps, standstill") + ", \\\n  " +
      stretch("dropped", plot::vermillion, "dropped: dead time and start-up") + ", \\\n  " +
      stretch("used", plot::sky, "used") + ", \\\n  " +
      fmt::format(
          "'{}.dat' index 'mean' using 1:2:3:4:5:6 with boxxyerror fillstyle transparent solid 0.6 noborder linecolor "
          "rgb '{}' title 'mean, two standard errors'",
          stem, plot::ink) +
      (idle.empty() ? std::string()
                    : fmt::format(", \\\n  '{}.dat' index 'idle' using 3:2:($4-$3):(0) with vectors nohead linewidth 2 "
                                  "dashtype 2 linecolor rgb '{}' title 'idle torque, taken off'",
                                  stem, plot::green)) +
      "\nset size 1, 0.32\nset origin 0, 0\nset format x '%g'\nset bmargin 3.4\nset tmargin 0.4\n" +
      plot::label('x', {.scale = 1.0, .label = "time (s)"}) +
      plot::label('y', {.scale = 1.0, .label = log.speed_unit.symbol}) + "plot " + stretch("speed", plot::ink, "") +
      "\nunset multiplot\n";
  figure.alt = fmt::format("torque and speed against time: {} plateaus with their means", plateaus.size());
  return figure;
}

}  // namespace cli
