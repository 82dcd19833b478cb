// The chains of a case: traces, ranks, and each parameter's own distribution, from the draws that the page keeps (chain
// after chain, evenly thinned).
//
// Ranks: of all draws together, counted per chain in bins. Chains that tell of one distribution have level counts (A.
// Vehtari, A. Gelman, D. Simpson, B. Carpenter, P.-C. Buerkner, Bayesian Analysis 16:667 (2021)).
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "uq/report/figures.hpp"
#include "uq/report/plot.hpp"

namespace uq {
namespace {

constexpr std::size_t trace_points = 200;  // of each chain
constexpr std::size_t bins = 20;

/// Values of one parameter, chain by chain.
std::vector<std::vector<double>> chains_of(const CaseReport& result, std::size_t parameter) {
  const auto count = static_cast<std::size_t>(std::max(result.chains, 1));
  const std::size_t each = result.draws_for_plot.size() / count;
  std::vector<std::vector<double>> chains(count);
  for (std::size_t c = 0; c < count; ++c)
    for (std::size_t i = c * each; i < (c + 1) * each; ++i)
      if (parameter < result.draws_for_plot[i].size()) chains[c].push_back(result.draws_for_plot[i][parameter]);
  return chains;
}

const char* colour_of(std::size_t chain) { return plot::colours[chain % plot::colours.size()]; }

}  // namespace

bool has_chains(const CaseReport& result) {
  return result.chains > 0 && result.draws_for_plot.size() >= 40 * static_cast<std::size_t>(result.chains);
}

Figure trace_figure(const CaseReport& result, std::size_t parameter, const std::string& stem) {
  const ParameterReport& of = result.parameters[parameter];
  plot::Extent up;
  Figure figure{.stem = stem, .script = {}, .data = {}, .alt = {}, .width = 420, .height = 260};
  std::string curves;
  const auto chains = chains_of(result, parameter);
  for (const auto& chain : chains)
    for (const double value : chain) up.include(value);
  const plot::Axis axis = plot::axis_for(of.name, of.unit, up.largest());
  for (std::size_t c = 0; c < chains.size(); ++c) {
    const std::size_t step = std::max<std::size_t>(1, chains[c].size() / trace_points);
    std::vector<double> at, value;
    for (std::size_t i = 0; i < chains[c].size(); i += step) {
      at.push_back(static_cast<double>(i) / static_cast<double>(chains[c].size()));
      value.push_back(chains[c][i]);
    }
    figure.data += plot::block(fmt::format("chain{}", c), {at, value});
    curves +=
        fmt::format("{}'{}.dat' index 'chain{}' using 1:($2*sy) with lines linecolor rgb '{}' linewidth 0.7 notitle",
                    c == 0 ? "plot " : ", \\\n  ", stem, c, colour_of(c));
  }
  const plot::Extent range = up.padded(0.05);
  figure.script = plot::common_style() + "set xlabel 'share of the chain'\n" + plot::label('y', axis) +
                  fmt::format("sy = {:.0e}\nset xrange [0:1]\nset yrange [{:.10g}*sy:{:.10g}*sy]\n", axis.scale,
                              range.low, range.high) +
                  curves;
  figure.alt = fmt::format("traces of the chains of {}", of.name);
  return figure;
}

Figure chain_rank_figure(const CaseReport& result, std::size_t parameter, const std::string& stem) {
  const ParameterReport& of = result.parameters[parameter];
  const auto chains = chains_of(result, parameter);
  std::vector<std::pair<double, std::size_t>> all;  // value, chain
  for (std::size_t c = 0; c < chains.size(); ++c)
    for (const double value : chains[c]) all.emplace_back(value, c);
  std::sort(all.begin(), all.end());
  std::vector<std::vector<double>> counts(chains.size(), std::vector<double>(bins, 0.0));
  for (std::size_t rank = 0; rank < all.size(); ++rank) counts[all[rank].second][rank * bins / all.size()] += 1.0;
  Figure figure{.stem = stem, .script = {}, .data = {}, .alt = {}, .width = 420, .height = 260};
  std::vector<double> centre(bins);
  for (std::size_t k = 0; k < bins; ++k) centre[k] = (static_cast<double>(k) + 0.5) / static_cast<double>(bins);
  double top = 0.0;
  std::string curves;
  for (std::size_t c = 0; c < chains.size(); ++c) {
    top = std::max(top, *std::max_element(counts[c].begin(), counts[c].end()));
    figure.data += plot::block(fmt::format("chain{}", c), {centre, counts[c]});
    curves += fmt::format("{}'{}.dat' index 'chain{}' using 1:2 with histeps linecolor rgb '{}' linewidth 1.2 notitle",
                          c == 0 ? "plot " : ", \\\n  ", stem, c, colour_of(c));
  }
  figure.script = plot::common_style() + plot::label('x', {1.0, of.name + ": rank among all draws"}) +
                  plot::label('y', {1.0, "draws of the chain"}) +
                  fmt::format("set xrange [0:1]\nset yrange [0:{:.10g}]\n", 1.15 * top) + curves;
  figure.alt = fmt::format("ranks of the draws of {} by chain", of.name);
  return figure;
}

Figure marginal_figure(const CaseReport& result, std::size_t parameter, const std::string& stem) {
  const ParameterReport& of = result.parameters[parameter];
  plot::Extent across;
  std::vector<double> values;
  for (const auto& chain : chains_of(result, parameter))
    for (const double value : chain) {
      values.push_back(value);
      across.include(value);
    }
  const plot::Axis axis = plot::axis_for(of.name, of.unit, across.largest());
  constexpr std::size_t bars = 30;
  const double width = (across.high - across.low) / static_cast<double>(bars);
  std::vector<double> centre(bars), density(bars, 0.0);
  for (std::size_t k = 0; k < bars; ++k) centre[k] = across.low + (static_cast<double>(k) + 0.5) * width;
  for (const double value : values) {
    const auto k = width > 0.0 ? static_cast<std::size_t>((value - across.low) / width) : 0;
    density[std::min(k, bars - 1)] += 1.0 / static_cast<double>(values.size());
  }
  Figure figure{.stem = stem,
                .script = {},
                .data = plot::block("bars", {centre, density}),
                .alt = {},
                .width = 420,
                .height = 260};
  const plot::Extent range = across.padded(0.05);
  figure.script =
      plot::common_style() + plot::label('x', axis) + plot::label('y', {1.0, "share of the draws"}) +
      fmt::format("sx = {:.0e}\nset boxwidth {:.10g}*sx\nset xrange [{:.10g}*sx:{:.10g}*sx]\nset yrange [0:*]\n",
                  axis.scale, 0.95 * width, range.low, range.high);
  const std::array marks{of.q05, of.q50, of.q95};
  for (std::size_t k = 0; k < marks.size(); ++k)
    figure.script += fmt::format(
        "set arrow {0} from first {1:.10g}*sx, graph 0 to first {1:.10g}*sx, graph 1 nohead dashtype {2} linecolor rgb "
        "'{3}'\n",
        k + 1, marks[k], k == 1 ? 1 : 2, plot::vermillion);
  figure.script += fmt::format(
      "plot '{}.dat' index 'bars' using ($1*sx):2 with boxes fillstyle solid noborder linecolor rgb '{}' notitle", stem,
      plot::sky);
  figure.alt = fmt::format("posterior distribution of {}", of.name);
  return figure;
}

}  // namespace uq
