#include "dem/run/summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "dem/case/grains.hpp"
#include "dem/engine/order.hpp"
#include "dem/run/outputs.hpp"

namespace dem {
namespace {

/// Deviation of the window means; the error is that of independent windows.
data::SeriesMean fluctuation(std::span<const double> torque, std::size_t window) {
  std::vector<double> means;
  for (std::size_t at = 0; at + window <= torque.size(); at += window) {
    double sum = 0.0;
    for (std::size_t k = 0; k < window; ++k) sum += torque[at + k];
    means.push_back(sum / static_cast<double>(window));
  }
  data::SeriesMean result;
  const double n = static_cast<double>(means.size());
  result.effective_samples = n;
  result.reliable = means.size() >= 8;
  if (means.size() < 2) {
    result.mean = result.standard_error = std::numeric_limits<double>::quiet_NaN();
    return result;
  }
  double mean = 0.0, square = 0.0;
  for (const double m : means) mean += m / n;
  for (const double m : means) square += (m - mean) * (m - mean);
  result.mean = std::sqrt(square / (n - 1.0));
  result.standard_error = result.mean / std::sqrt(2.0 * (n - 1.0));
  result.sd = result.standard_error * std::sqrt(n);
  return result;
}

/// The mean and error of one output, reliable where it does not drift by itself: at a smaller level than a run's state
/// (drift_level), since a dozen outputs are tested.
data::SeriesMean mean_of(std::span<const double> values) {
  data::Steadiness s = data::steadiness(values);
  constexpr double level = 0.01;
  s.mean.drifts = s.drift_p < level;
  if (s.mean.drifts) s.mean.reliable = false;
  return s.mean;
}

/// The mean of a quantity that is measured on silhouettes. Windows in which it was not found are left out where they
/// are few.
data::SeriesMean mean_of_found(std::span<const double> values) {
  constexpr double most_missing = 0.05;
  std::vector<double> found;
  for (const double value : values)
    if (std::isfinite(value)) found.push_back(value);
  const double missing = static_cast<double>(values.size() - found.size());
  if (!found.empty() && missing <= most_missing * static_cast<double>(values.size())) return mean_of(found);
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  return {.mean = unknown, .standard_error = unknown, .reliable = false};
}

/// The mean of the values at times in [from, to).
double mean_between(const std::vector<double>& time, const std::vector<double>& values, double from, double to) {
  double sum = 0.0, count = 0.0;
  for (std::size_t k = 0; k < std::min(time.size(), values.size()); ++k) {
    if (!(time[k] >= from && time[k] < to)) continue;
    sum += values[k];
    count += 1.0;
  }
  return count > 0.0 ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

/// The changes between the first and the last quarter of all that comes after the start-up, where bonds align.
std::string ordering_of(const Series& s, double start_up) {
  const auto first = std::upper_bound(s.look_time.begin(), s.look_time.end(), start_up) - s.look_time.begin();
  const auto at = static_cast<std::size_t>(first);
  if (!(ordering_rise(std::span(s.look_time).subspan(at), std::span(s.bond_order).subspan(at)) > 0.0)) return {};
  const double end = s.time.back(), part = 0.25 * (end - start_up), far = std::numeric_limits<double>::infinity();
  // In a bed that loosens, the few bonds that are left agree more, without any order.
  constexpr double loosens = 0.8;
  if (mean_between(s.time, s.coordination, end - part, far) <
      loosens * mean_between(s.time, s.coordination, start_up, start_up + part))
    return {};
  const auto change = [&](const std::vector<double>& time, const std::vector<double>& values) {
    return fmt::format("{:.3g} -> {:.3g}", mean_between(time, values, start_up, start_up + part),
                       mean_between(time, values, end - part, far));
  };
  return fmt::format(
      "the bed orders: bond order {}, coordination {}, torque {} N m from the first to the last quarter of "
      "{:.3g} s",
      change(s.look_time, s.bond_order), change(s.time, s.coordination), change(s.time, s.torque), end - start_up);
}

std::string why_not(const Case& c, const Measured& m, double turns) {
  if (m.state == data::FlowState::steady) return {};
  if (m.state == data::FlowState::too_short) {
    if (turns > 0.0 && turns < c.run.shortest_turns * (1.0 - 1e-6))
      return fmt::format("by run.longest, {:g} s, it measured {:.3g} turns, fewer than run.shortest_turns, {:g}",
                         c.run.longest, turns, c.run.shortest_turns);
    return fmt::format("by run.longest, {:g} s, it measured {} sample{}, too few for how long they are correlated",
                       c.run.longest, m.count, m.count == 1 ? "" : "s");
  }
  static constexpr const char* names[]{"torque", "coordination", "kinetic energy"};
  std::string drifting;
  const double each = drift_level / static_cast<double>(m.drift_p.size());
  for (std::size_t k = 0; k < m.drift_p.size(); ++k) {
    if (m.drift_p[k] < each)
      drifting += fmt::format("{}{} (p {:.1g})", drifting.empty() ? "" : ", ", names[k], m.drift_p[k]);
  }
  if (m.bonds_rise > 0.0)
    drifting += fmt::format("{}bond order (by {:.2g})", drifting.empty() ? "" : ", ", m.bonds_rise);
  return fmt::format("by run.longest, {:g} s, still drift {}", c.run.longest, drifting);
}

}  // namespace

std::vector<data::SeriesMean> means_of(const Series& s, std::size_t first, std::size_t count, std::size_t window) {
  const auto measured = [&](const std::vector<double>& values) {
    const std::size_t from = std::min(first, values.size());
    return std::span(values).subspan(from, std::min(count, values.size() - from));
  };
  std::vector<data::SeriesMean> means;
  for (const MeanOutput& output : mean_outputs()) {
    means.push_back(mean_of(measured(s.*output.series)));
    if (means.size() == 1) means.push_back(fluctuation(measured(s.torque), window));
  }
  for (data::SeriesMean& mean : means) mean.dropped = first;
  const std::size_t first_window = (first + window - 1) / window;
  for (const CameraOutput& output : camera_outputs()) {
    const std::vector<double>& values = s.*output.series;
    const std::size_t last = std::min((first + count) / window, values.size()), from = std::min(first_window, last);
    means.push_back(mean_of_found(std::span(values).subspan(from, last - from)));
    means.back().dropped = from;
  }
  return means;
}

Summary summarise(const Case& c, double sample, double turn, const Series& s, const Looks& looks) {
  const Measured& m = looks.last;
  Summary summary;
  summary.mean = means_of(s, m.first, m.count, samples_in_window(c.run, sample));
  const data::SeriesMean& torque = summary.mean.front();
  summary.reached_target = torque.standard_error <= c.run.standard_error * std::abs(torque.mean);
  summary.state = m.state;
  summary.measured_from = m.first > 0 && m.first <= s.time.size() ? s.time[m.first - 1] : 0.0;
  summary.turns = turn > 0.0 ? static_cast<double>(m.count) * sample / turn : 0.0;
  summary.why = why_not(c, m, summary.turns);
  summary.drift_p = m.drift_p;
  summary.ordering = ordering_of(s, std::max(c.run.start_up, c.run.start_up_turns * turn));
  return summary;
}

std::string unsteady_warning(const Summary& summary) {
  if (summary.state == data::FlowState::drifting)
    return fmt::format("the flow is not steady: {}; raise run.longest", summary.why);
  if (summary.state == data::FlowState::too_short)
    return fmt::format("whether the flow is steady is not known: {}; raise run.longest", summary.why);
  return {};
}

std::vector<std::string> warnings_of(const Case& c, const Summary& summary) {
  std::vector<std::string> warnings;
  if (std::string unsteady = unsteady_warning(summary); !unsteady.empty()) warnings.push_back(std::move(unsteady));
  const data::SeriesMean& torque = summary.mean.front();
  const double error = torque.mean == 0.0 ? 0.0 : torque.standard_error / std::abs(torque.mean);
  if (summary.state == data::FlowState::steady && error > 1.5 * c.run.standard_error)
    warnings.push_back(
        fmt::format("the mean torque is known to {:.2g} %, where {:.2g} % were wanted: raise run.longest",
                    100.0 * error, 100.0 * c.run.standard_error));
  if (!summary.ordering.empty())
    warnings.push_back(summary.ordering + (summarise_bed(c).equal
                                               ? "; equal spheres do: give sizes that differ by a tenth"
                                               : "; give sizes that differ by more"));
  return warnings;
}

}  // namespace dem
