// What to measure next: the answer, information against the first control, the outputs' directions, the candidates.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>

#include "uq/findings/wording.hpp"
#include "uq/report/page.hpp"
#include "uq/report/plan.hpp"
#include "uq/report/plot.hpp"

namespace uq::page {
namespace {

constexpr Typography pretty = Typography::unicode;
constexpr std::array colours = {plot::blue, plot::vermillion, plot::green, plot::sky, plot::ink, plot::grey};

/// Single settings of single outputs: what a picture against one control can show.
std::vector<const PlanCandidate*> simple(const PlanReport& plan) {
  std::vector<const PlanCandidate*> found;
  for (const PlanCandidate& one : plan.candidates)
    if (one.settings.size() == 1 && one.outputs.size() == 1) found.push_back(&one);
  return found;
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

Figure information_figure(const PlanReport& plan, const std::vector<const PlanCandidate*>& candidates,
                          const std::string& control, const std::string& stem) {
  struct Series {
    std::string title;
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
      Series series{.title = output + " about " + parameter, .points = {}};
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
  if (all.size() > colours.size()) all.resize(colours.size());
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
        i == 0 ? "plot " : ", \\\n  ", stem, i, colours[i], 4 + i, gnuplot_text(all[i].title));
  }
  const plot::Extent range = across.padded(0.05);
  figure.script = plot::look() + plot::label('x', {1.0, control}) + plot::label('y', {1.0, "information (nats)"}) +
                  fmt::format("set xrange [{:.10g}:{:.10g}]\nset yrange [0:{:.10g}]\n", range.low, range.high,
                              std::max(1.08 * top, 0.05)) +
                  curves;
  figure.alt = fmt::format("information that a reading is expected to give, against {}", control);
  return figure;
}

/// Arrows from the origin: what each candidate's reading does when either of two parameters changes.
Figure arrow_figure(const PlanReport& plan, const std::pair<std::string, std::string>& parameters,
                    const std::string& stem) {
  std::map<std::string, std::map<std::string, std::vector<double>>> change;  // output, parameter
  for (const PlanArrow& arrow : plan.arrows) change[arrow.output][arrow.parameter].push_back(arrow.change);
  Figure figure{.stem = stem, .script = {}, .data = {}, .alt = {}, .width = 420, .height = 410};
  plot::Extent both;
  both.include(0.0);
  std::string curves;
  std::size_t i = 0;
  for (auto& [output, of] : change) {
    if (i == colours.size()) break;
    auto &x = of[parameters.first], &y = of[parameters.second];
    for (const double value : x) both.include(value);
    for (const double value : y) both.include(value);
    const std::vector<double> origin(x.size(), 0.0);
    figure.data += plot::block(fmt::format("s{}", i), {origin, origin, x, y});
    curves += fmt::format(
        "{}'{}.dat' index 's{}' using 1:2:3:4 with vectors head filled size graph 0.02,20 linecolor rgb '{}' "
        "linewidth 1.3 title {}",
        i == 0 ? "plot " : ", \\\n  ", stem, i, colours[i], gnuplot_text(output));
    ++i;
  }
  const plot::Extent range = both.padded(0.08);
  figure.script =
      plot::look() + plot::label('x', {1.0, parameters.first + " (errors per prior sd)"}) +
      plot::label('y', {1.0, parameters.second + " (errors per prior sd)"}) +
      fmt::format("set xrange [{0:.10g}:{1:.10g}]\nset yrange [{0:.10g}:{1:.10g}]\n", range.low, range.high) + curves;
  figure.alt = fmt::format("directions in which readings change with {} and {}", parameters.first, parameters.second);
  return figure;
}

std::string candidate_table(const PlanReport& plan) {
  const PlannedParameter& now = asked(plan, plan.candidates.front().parameters);
  Table table{
      .caption = fmt::format(
          "Candidates by what they are expected to teach of {} per cost. Its posterior sd is {} now.", text(plan.about),
          text(format_value(now.sd_now, rounding_of(now.sd_now, 0.1 * now.sd_now), now.unit, pretty))),
      .head = {{"Measurement"},
               {"Error"},
               number("Information (nats)"),
               number("sd after"),
               {"Verdict then"},
               {"Readings needed"},
               number("Cost")},
      .rows = {}};
  for (const PlanCandidate& one : plan.candidates) {
    const PlannedParameter& about = asked(plan, one.parameters);
    std::string name = text(one.name);
    if (one.kind == CandidateKind::repeat) name += " <span class=\"soft\">(measured already)</span>";
    if (one.model_only) name += " <span class=\"soft\">(model only)</span>";
    if (!one.teaches) name += " <span class=\"soft\">(teaches nothing)</span>";
    table.rows.push_back({{name, "long"},
                          {text(one.error) + (one.assumed_error ? " assumed" : "")},
                          number(fmt::format("{:.2f} \u00b1 {:.2f}", about.information, about.information_error)),
                          number(significant(about.sd_after, 2, pretty)),
                          {text(words_text(about)), "long"},
                          {text(readings_text(about)), "long"},
                          number(fmt::format("{:g}", one.cost))});
  }
  return html(table);
}

}  // namespace

std::string plan_part(const CaseReport& result, const std::string& id, const Context& context) {
  if (!result.plan) return {};
  const PlanReport& plan = *result.plan;
  std::string out = "<h3>What to measure next</h3>\n<p>" + text(plan.sentence) + "</p>\n";
  if (plan.candidates.empty()) return out;
  const std::vector<const PlanCandidate*> candidates = simple(plan);
  if (const std::string control = candidates.empty() ? "" : control_of(candidates); !control.empty())
    out += figure(
        information_figure(plan, candidates, control, id + "-plan"),
        "Information that one reading is expected to give of a parameter, all others integrated out. One nat narrows a "
        "normal posterior to 37\u00a0% of its width.",
        context);
  const auto& parameters = plan.candidates.front().parameters;
  if (parameters.size() > 1 && !plan.arrows.empty()) {
    std::string other;
    for (const PlannedParameter& one : parameters)
      if (one.name != plan.about && other.empty()) other = one.name;
    out += figure(arrow_figure(plan, {plan.about, other}, id + "-arrows"),
                  "How each reading changes when a parameter changes by its prior's standard deviation, in errors of "
                  "one reading. Parallel "
                  "arrows leave the two parameters traded; crossing ones part them.",
                  context);
  }
  out += candidate_table(plan);
  std::string more;
  for (const PlanBatch& batch : plan.batches)
    more += fmt::format("<li>Together, {}: {:.2f} \u00b1 {:.2f} nats ({:.2f} when picked one after the other).</li>\n",
                        text(fmt::format("{}", fmt::join(batch.candidates, " + "))), batch.information,
                        batch.information_error, batch.greedy);
  if (!plan.runs.parameters.empty()) {
    const PlannedParameter& exact = asked(plan, plan.runs.parameters);
    more += fmt::format(
        "<li>Training runs instead can at most give {:.2f} nats: with an exact surrogate the sd is {}.</li>\n",
        exact.information, text(significant(exact.sd_after, 2, pretty)));
  }
  for (const std::string& note : plan.notes) more += "<li>" + text(note) + "</li>\n";
  return out + (more.empty() ? "" : "<ul>\n" + more + "</ul>\n");
}

}  // namespace uq::page
