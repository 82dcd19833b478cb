#include "dem/run/looks.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "dem/engine/order.hpp"
#include "dem/run/outputs.hpp"
#include "dem/run/run.hpp"
#include "dem/run/summary.hpp"

namespace dem {
namespace {

constexpr double growth = 1.5;  // of the measurement from look to look
constexpr int cuts = 6;         // 0, 10 ... 50 % of the front

std::size_t samples_in(double duration, double time) {
  return static_cast<std::size_t>(std::llround(std::ceil(duration / time - 1e-6)));
}

std::size_t grown(std::size_t count, double by) {
  return static_cast<std::size_t>(std::llround(std::ceil(static_cast<double>(count) * by)));
}

/// Over the looks at the bed while these samples were taken.
double bonds_rise(const Series& s, std::size_t first, std::size_t count) {
  if (count == 0 || first + count > s.time.size()) return 0.0;
  const auto from = std::lower_bound(s.look_time.begin(), s.look_time.end(), s.time[first]) - s.look_time.begin();
  const auto to =
      std::upper_bound(s.look_time.begin(), s.look_time.end(), s.time[first + count - 1]) - s.look_time.begin();
  if (to <= from) return 0.0;
  const auto at = static_cast<std::size_t>(from), looks = static_cast<std::size_t>(to - from);
  return ordering_rise(std::span(s.look_time).subspan(at, looks), std::span(s.bond_order).subspan(at, looks));
}

}  // namespace

LookRule look_rule(const RunControl& run, double time, double turn) {
  LookRule rule;
  rule.longest = std::max<std::size_t>(1, samples_in(run.longest, time));
  // Where the start-up does not end in time one sample is left, by which the run is too short.
  rule.start_up = std::min(samples_in(std::max(run.start_up, run.start_up_turns * turn), time), rule.longest - 1);
  rule.shortest = std::max<std::size_t>(1, samples_in(std::max(run.shortest, run.shortest_turns * turn), time));
  rule.standard_error = run.standard_error;
  rule.window = samples_in_window(run, time);
  for (std::size_t k = 0; k < outputs().size(); ++k)
    if (std::find(run.known.begin(), run.known.end(), outputs()[k].name) != run.known.end()) rule.known.push_back(k);
  return rule;
}

double turning_missed(const RunControl& run, double turn) {
  const double wanted =
      std::max(run.start_up, run.start_up_turns * turn) + std::max(run.shortest, run.shortest_turns * turn);
  return wanted > run.longest * (1.0 + 1e-9) ? wanted : 0.0;
}

Measured measure(const LookRule& rule, const Series& series, std::size_t samples) {
  const std::size_t usable = samples - std::min(samples, rule.start_up);
  Measured found;
  for (int cut = 0; cut < cuts; ++cut) {
    const std::size_t dropped = usable * static_cast<std::size_t>(cut) / 10, count = usable - dropped;
    if (cut > 0 && count < rule.shortest) break;
    Measured here{.first = samples - count, .count = count};
    std::vector<double> known;  // of the series long enough to say that they drift
    for (const std::vector<double>* values : {&series.torque, &series.coordination, &series.kinetic_energy}) {
      const data::Steadiness s = data::steadiness(std::span(*values).subspan(here.first, count));
      if (values == &series.torque) here.torque = s.mean;
      here.drift_p.push_back(s.drift_p);
      known.push_back(s.mean.reliable ? s.drift_p : 1.0);
    }
    here.bonds_rise = bonds_rise(series, here.first, count);
    const bool moves = data::drifts(here.drift_p, drift_level) || here.bonds_rise > 0.0;
    if (!here.torque.reliable || count < rule.shortest)
      here.state = data::FlowState::too_short;
    else if (!moves)
      here.state = data::FlowState::steady;
    else
      here.state = data::drifts(known, drift_level) || here.bonds_rise > 0.0 ? data::FlowState::drifting
                                                                             : data::FlowState::too_short;
    if (cut == 0 || here.state == data::FlowState::steady) found = std::move(here);
    if (found.state == data::FlowState::steady || !moves) break;
  }
  if (rule.known.empty()) return found;
  const std::vector<data::SeriesMean> means = means_of(series, found.first, found.count, rule.window);
  found.known = std::all_of(rule.known.begin(), rule.known.end(), [&](std::size_t output) {
    return means[output].reliable || !std::isfinite(means[output].mean);
  });
  return found;
}

Looks begin_looks(const LookRule& rule) { return {.next = std::min(rule.longest, rule.start_up + rule.shortest)}; }

void take_looks(const LookRule& rule, const Series& series, Looks& looks) {
  while (!looks.ended && series.torque.size() >= looks.next) {
    const Measured m = looks.last = measure(rule, series, looks.next);
    const bool enough = m.state == data::FlowState::steady && m.known;
    const double wanted = rule.standard_error * std::abs(m.torque.mean),
                 ratio = m.torque.standard_error > 0.0 ? m.torque.standard_error / wanted : 0.0;
    looks.ended = looks.next >= rule.longest || (enough && (looks.planned || ratio <= 1.0));
    if (looks.ended) return;
    const double by = enough ? std::min(ratio * ratio, 1e6) : growth;
    const std::size_t from = enough ? m.first : rule.start_up;
    looks.planned = enough;
    looks.next = std::clamp(from + grown(looks.next - from, by), looks.next + 1, rule.longest);
  }
}

}  // namespace dem
