// Figures of a plan: information against the first control, and the directions in which readings change.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <set>

#include "uq/findings/study_units.hpp"
#include "uq/report/figures.hpp"
#include "uq/report/plot.hpp"

namespace uq {
namespace {

/// Single settings of single outputs: what a picture against one control can show.
std::vector<const PlanCandidate*> simple(const PlanReport& plan) {
  std::vector<const PlanCandidate*> found;
  for (const PlanCandidate& one : plan.candidates)
    if (one.settings.size() == 1 && one.outputs.size() == 1) found.push_back(&one);
  return found;
}

using Setting = std::map<std::string, double>;

/// The setting without one of its controls.
Setting without(Setting setting, const std::string& control) {
  setting.erase(control);
  return setting;
}

/// Those at the setting of the other controls that most have: a curve over one control holds the others.
std::vector<const PlanCandidate*> along(const std::string& control, const std::vector<const PlanCandidate*>& all) {
  std::map<Setting, std::size_t> count;
  for (const PlanCandidate* one : all) ++count[without(one->settings.front(), control)];
  const auto most =
      std::max_element(count.begin(), count.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  std::vector<const PlanCandidate*> found;
  for (const PlanCandidate* one : all)
    if (without(one->settings.front(), control) == most->first) found.push_back(one);
  return found;
}

/// "rpm (rpm)", and at which values the other controls stand.
std::string axis_of(const PlanReport& plan, const std::string& control, const Setting& others) {
  const auto unit_of = [&](const std::string& name) {
    for (const auto& [known, unit] : plan.control_units)
      if (known == name) return unit;
    return std::string();
  };
  std::string text = control + (unit_of(control).empty() ? "" : fmt::format(" ({})", unit_of(control)));
  for (const auto& [name, value] : others)
    text += fmt::format(", at {} {:.4g}{}", name, value, behind_number(unit_of(name)));
  return text;
}

/// The control with the most values among them; empty where none varies.
std::string control_of(const std::vector<const PlanCandidate*>& candidates) {
  std::map<std::string, std::set<double>> values;
  for (const PlanCandidate* one : candidates)
    for (const auto& [name, value] : one->settings.front()) values[name].insert(value);
  std::string best;
  std::size_t most = 1;
  for (const auto& [name, seen] : values)
    if (seen.size() > most) {
      most = seen.size();
      best = name;
    }
  return best;
}

}  // namespace

std::optional<Figure> information_figure(const PlanReport& plan, const std::string& stem) {
  const std::vector<const PlanCandidate*> of_one = simple(plan);
  const std::string control = control_of(of_one);
  if (control.empty()) return {};
  const std::vector<const PlanCandidate*> candidates = along(control, of_one);
  struct Series {
    std::string title;
    bool asked = false;  ///< of the parameter that the plan is about
    std::vector<std::array<double, 3>> points;
  };
  std::vector<Series> all;
  std::vector<std::string> outputs;
  for (const PlanCandidate* one : candidates)
    if (std::find(outputs.begin(), outputs.end(), one->outputs.front()) == outputs.end())
      outputs.push_back(one->outputs.front());
  for (const std::string& output : outputs)
    for (std::size_t k = 0; k < candidates.front()->parameters.size(); ++k) {
      const std::string& parameter = candidates.front()->parameters[k].name;
      // Every parameter for what is measured, the one asked for everywhere.
      Series series{.title = output + " about " + parameter, .asked = parameter == plan.about, .points = {}};
      bool measured = false;
      for (const PlanCandidate* one : candidates)
        if (one->outputs.front() == output) {
          measured = measured || one->kind != CandidateKind::output;
          series.points.push_back({one->settings.front().at(control), one->parameters[k].information,
                                   one->parameters[k].information_error});
        }
      if (!measured && parameter != plan.about) continue;
      std::sort(series.points.begin(), series.points.end());
      all.push_back(std::move(series));
    }
  // Colours are few: what is asked for comes first, of every output.
  std::stable_partition(all.begin(), all.end(), [](const Series& one) { return one.asked; });
  if (all.size() > plot::colours.size()) all.resize(plot::colours.size());
  plot::Extent across;
  double top = 0.0;
  Figure figure{.stem = stem, .script = {}, .data = {}, .alt = {}, .height = 360};
  std::string curves;
  for (std::size_t i = 0; i < all.size(); ++i) {
    std::vector<double> x, y, error;
    for (const auto& [at, value, half] : all[i].points) {
      x.push_back(at);
      y.push_back(value);
      error.push_back(half);
      across.include(at);
      top = std::max(top, value + half);
    }
    figure.data += plot::block(fmt::format("s{}", i), {x, y, error});
    curves += fmt::format(
        "{}'{}.dat' index 's{}' using 1:2:3 with yerrorlines linecolor rgb '{}' linewidth 1.4 "
        "pointtype {} pointsize 0.6 title {}",
        i == 0 ? "plot " : ", \\\n  ", stem, i, plot::colours[i], 4 + i, gnuplot_text(all[i].title));
  }
  const plot::Extent range = across.padded(0.05);
  figure.script =
      plot::common_style() +
      plot::label('x', {1.0, axis_of(plan, control, without(candidates.front()->settings.front(), control))}) +
      plot::label('y', {1.0, "information (nats)"}) +
      fmt::format("set xrange [{:.10g}:{:.10g}]\nset yrange [0:{:.10g}]\n", range.low, range.high,
                  std::max(1.08 * top, 0.05)) +
      curves;
  figure.alt = fmt::format("information that a reading is expected to give, against {}", control);
  return figure;
}

std::optional<Figure> arrow_figure(const PlanReport& plan, const std::string& stem) {
  const auto& parameters = plan.candidates.front().parameters;
  const auto other = std::find_if(parameters.begin(), parameters.end(),
                                  [&](const PlannedParameter& one) { return one.name != plan.about; });
  if (other == parameters.end() || plan.arrows.empty()) return {};
  std::map<std::string, std::map<std::string, std::vector<double>>> change;  // output, parameter
  for (const PlanArrow& arrow : plan.arrows) change[arrow.output][arrow.parameter].push_back(arrow.change);
  Figure figure{.stem = stem, .script = {}, .data = {}, .alt = {}, .width = 420, .height = 410};
  plot::Extent both;
  both.include(0.0);
  std::string curves;
  std::size_t i = 0;
  for (auto& [output, of] : change) {
    if (i == plot::colours.size()) break;
    auto &x = of[plan.about], &y = of[other->name];
    for (const double value : x) both.include(value);
    for (const double value : y) both.include(value);
    const std::vector<double> origin(x.size(), 0.0);
    figure.data += plot::block(fmt::format("s{}", i), {origin, origin, x, y});
    curves += fmt::format(
        "{}'{}.dat' index 's{}' using 1:2:3:4 with vectors head filled size graph 0.02,20 linecolor rgb '{}' "
        "linewidth 1.3 title {}",
        i == 0 ? "plot " : ", \\\n  ", stem, i, plot::colours[i], gnuplot_text(output));
    ++i;
  }
  const plot::Extent range = both.padded(0.08);
  figure.script =
      plot::common_style() + plot::label('x', {1.0, plan.about + " (errors per prior sd)"}) +
      plot::label('y', {1.0, other->name + " (errors per prior sd)"}) +
      fmt::format("set xrange [{0:.10g}:{1:.10g}]\nset yrange [{0:.10g}:{1:.10g}]\n", range.low, range.high) + curves;
  figure.alt = fmt::format("directions in which readings change with {} and {}", plan.about, other->name);
  return figure;
}

}  // namespace uq
