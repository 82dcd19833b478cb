#include "uq/posterior/support.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "uq/infer/diagnostics.hpp"
#include "uq/posterior/plane.hpp"
#include "uq/posterior/predictive.hpp"
#include "uq/posterior/prior.hpp"

namespace uq {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// How the runs lie along one input, in the unit cube.
struct InputLine {
  double low = 0.0, high = 1.0, slack = 0.0, spacing = 0.0;
  std::vector<std::pair<double, double>> gaps;
};

InputLine line_of(const VectorXd& column, const SupportThresholds& t) {
  std::vector<double> values(column.begin(), column.end());
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end(), [](double a, double b) { return b - a < 1e-6; }),
               values.end());
  InputLine line{.low = values.front(), .high = values.back(), .slack = t.slack_most, .gaps = {}};
  const std::size_t spacings = values.size() - 1;
  if (spacings == 0) return line;
  const double mean = (line.high - line.low) / static_cast<double>(spacings);
  if (spacings > 1) line.spacing = mean;  // two values are no regular levels: nothing shows what lies between
  line.slack = std::clamp(t.slack_gaps * mean, t.slack_least, t.slack_most);
  for (std::size_t i = 0; i < spacings && spacings > 1; ++i) {
    const double gap = values[i + 1] - values[i];
    const double others = (line.high - line.low - gap) / static_cast<double>(spacings - 1);
    if (gap > t.gap_least && gap > t.gap_factor * others) line.gaps.emplace_back(values[i], values[i + 1]);
  }
  return line;
}

bool in_gap(const std::pair<double, double>& gap, double value, double slack) {
  const double margin = std::min(slack, 0.25 * (gap.second - gap.first));
  return value > gap.first + margin && value < gap.second - margin;
}

/// Two inputs' plane of runs.
struct Plane {
  Index first = 0, second = 0;
  MatrixXd points;  ///< distinct
  std::vector<Eigen::Vector2d> hull;
  double radius = 0.0;     ///< radius of the holes that this many runs leave
  Eigen::Array2d regular;  ///< half the mean spacing of each input's values: no hole is narrower than its levels
};

std::vector<Plane> planes_of(const RunCloud& runs, const std::vector<EmulatorInput>& inputs,
                             const std::vector<InputLine>& lines) {
  std::vector<Plane> planes;
  for (Index a = 0; a < runs.points.cols(); ++a)
    for (Index b = a + 1; b < runs.points.cols(); ++b) {
      if (inputs[a].kind == InputKind::control && inputs[b].kind == InputKind::control) continue;
      std::set<std::pair<double, double>> distinct;
      for (Index i = 0; i < runs.points.rows(); ++i) distinct.emplace(runs.points(i, a), runs.points(i, b));
      Plane plane{.first = a,
                  .second = b,
                  .points = MatrixXd(static_cast<Index>(distinct.size()), 2),
                  .hull = {},
                  .regular = {0.5 * lines[a].spacing, 0.5 * lines[b].spacing}};
      Index row = 0;
      for (const auto& [x, y] : distinct) plane.points.row(row++) << x, y;
      const double count = static_cast<double>(std::max<std::size_t>(distinct.size(), 3));
      plane.radius = std::sqrt(std::log(count) / (std::numbers::pi * count));
      plane.hull = convex_hull(plane.points);
      planes.push_back(std::move(plane));
    }
  return planes;
}

bool is_empty(const Plane& plane, const Eigen::Vector2d& at, double factor) {
  const Eigen::ArrayXXd away = (plane.points.rowwise() - at.transpose()).array().abs();
  const Eigen::ArrayXXd beyond = (away.rowwise() - plane.regular.transpose()).max(0.0);
  const double nearest = std::sqrt(beyond.square().rowwise().sum().minCoeff());
  if (nearest > factor * plane.radius) return true;
  return nearest > plane.radius && distance_to_hull(plane.hull, at) > 0.1;
}

/// One emulator's runs as the posterior meets them.
struct Ground {
  const RowGroup* group = nullptr;
  std::vector<InputLine> lines;
  std::vector<Plane> planes;
  std::vector<Index> rows;  ///< observed settings that are looked at
};

Ground ground_of(const RowGroup& group, const SupportThresholds& t) {
  Ground ground{.group = &group, .lines = {}, .planes = {}, .rows = {}};
  for (Index k = 0; k < group.emulator.runs->points.cols(); ++k)
    ground.lines.push_back(line_of(group.emulator.runs->points.col(k), t));
  ground.planes = planes_of(*group.emulator.runs, group.emulator.inputs, ground.lines);
  constexpr Index most = 8;
  const Index rows = group.base.rows();
  for (Index i = 0; i < std::min(rows, most); ++i)
    ground.rows.push_back(rows <= most ? i : i * (rows - 1) / (most - 1));
  return ground;
}

/// The points of the unit cube at which one draw was compared with the measurements.
MatrixXd points_at(const Ground& ground, const VectorXd& u) {
  const RowGroup& group = *ground.group;
  MatrixXd points(static_cast<Index>(ground.rows.size()), group.base.cols());
  for (Index i = 0; i < points.rows(); ++i)
    for (Index k = 0; k < points.cols(); ++k) {
      const Index row = ground.rows[i];
      const int unknown = group.unknown(row, k);
      points(i, k) = unknown < 0 ? group.base(row, k) : u[unknown];
    }
  return points;
}

/// Variance of the function at each point over that without any runs.
VectorXd variance_ratio(const Emulator& emulator, const MatrixXd& points) {
  const surrogate::Prediction prediction = emulator.predict(points);
  Eigen::ArrayXd variance = prediction.covariance.diagonal().array().max(0.0);
  if (emulator.runs->logarithmic) variance = (variance / prediction.mean.array().square()).log1p();
  return (variance / emulator.runs->prior_variance).matrix();
}

/// The findings of one draw in one emulator.
struct RunsAround {
  std::vector<bool> outside;               ///< per input: at half of the rows or more
  std::vector<int> gap;                    ///< per input: which gap, or -1
  std::optional<std::size_t> empty_plane;  ///< the emptiest, where half of the rows lie in a hole of some plane
  bool uncertain = false, unsupported = false;
  double distance = 0.0, ratio = 0.0;  ///< means over the rows
};

RunsAround runs_around(const Ground& ground, const VectorXd& u, const SupportThresholds& t) {
  const Emulator& emulator = ground.group->emulator;
  const MatrixXd points = points_at(ground, u), learnt = learnt_points(emulator.inputs, points);
  const VectorXd ratios = variance_ratio(emulator, points);
  const MatrixXd scaled = emulator.runs->learnt.array().rowwise() / emulator.runs->length_scales.transpose().array();
  const Index rows = points.rows(), inputs = points.cols();
  std::vector<Index> outside(static_cast<std::size_t>(inputs), 0), gap(outside);
  RunsAround met{.outside = {}, .gap = std::vector<int>(static_cast<std::size_t>(inputs), -1)};
  std::vector<Index> holes(ground.planes.size(), 0);
  Index empty = 0, uncertain = 0, any = 0;
  for (Index i = 0; i < rows; ++i) {
    bool bad = false;
    for (Index k = 0; k < inputs; ++k) {
      const auto at = static_cast<std::size_t>(k);
      const InputLine& line = ground.lines[at];
      const double value = points(i, k);
      const bool beyond = value < line.low - line.slack || value > line.high + line.slack;
      bool inside_gap = false;
      for (std::size_t g = 0; g < line.gaps.size(); ++g)
        if (in_gap(line.gaps[g], value, line.slack)) {
          inside_gap = true;
          met.gap[at] = static_cast<int>(g);
        }
      outside[at] += beyond;
      gap[at] += inside_gap;
      bad = bad || beyond || inside_gap;
    }
    bool hole = false;
    for (std::size_t p = 0; p < ground.planes.size(); ++p) {
      const Plane& plane = ground.planes[p];
      if (!is_empty(plane, {points(i, plane.first), points(i, plane.second)}, t.empty_factor)) continue;
      hole = true;
      ++holes[p];
    }
    empty += hole;
    uncertain += ratios[i] > t.uncertain;
    any += bad || hole || ratios[i] > t.uncertain;
    const VectorXd here = learnt.row(i).transpose().array() / emulator.runs->length_scales.array();
    met.distance += std::sqrt((scaled.rowwise() - here.transpose()).rowwise().squaredNorm().minCoeff());
  }
  for (Index k = 0; k < inputs; ++k) {
    const auto at = static_cast<std::size_t>(k);
    met.outside.push_back(2 * outside[at] >= rows);
    if (2 * gap[at] < rows) met.gap[at] = -1;
  }
  if (2 * empty >= rows)
    met.empty_plane = static_cast<std::size_t>(std::max_element(holes.begin(), holes.end()) - holes.begin());
  met.uncertain = 2 * uncertain >= rows;
  met.unsupported = 2 * any >= rows;
  met.distance /= static_cast<double>(rows);
  met.ratio = ratios.mean();
  return met;
}

/// Name, unit and value of an input.
struct Shown {
  std::string name;
  const data::Unit& unit;
  double value = 0.0;
};

Shown shown(const data::Study& study, const EmulatorInput& input, double u) {
  const data::Input named = input_of(study, input);
  return {named.name, named.unit, named.unit.from_si(named.axis.from_unit(u))};
}

std::string percent(double share) { return fmt::format("{:.0f} %", 100.0 * share); }

std::string interval(double low, double high, const std::string& unit) {
  return fmt::format("{:.3g} to {:.3g}{}{}", low, high, unit.empty() ? "" : " ", unit);
}

/// A sentence on what is not supported, the greatest share first. `empty`: the inputs in whose plane there are no runs,
/// "friction and rpm".
std::string sentence_of(const SupportReport& report, const SupportThresholds& t, const std::string& empty) {
  std::vector<std::pair<double, std::string>> reasons;
  const bool several = std::any_of(report.inputs.begin(), report.inputs.end(), [&](const InputSupport& input) {
    return input.material != report.inputs.front().material;
  });
  const auto add = [&](double share, std::string text) {
    if (std::none_of(reasons.begin(), reasons.end(), [&](const auto& known) { return known.second == text; }))
      reasons.emplace_back(share, std::move(text));  // surrogates of several outputs mostly have the same runs
  };
  for (const InputSupport& input : report.inputs) {
    const std::string name = input.name + (several ? " of " + input.material : "");
    if (input.outside > 0.5 * t.share)
      add(input.outside, fmt::format("{} beyond the runs' {}, {}", percent(input.outside), name,
                                     interval(input.runs_low, input.runs_high, input.unit)));
    if (input.gap > 0.5 * t.share)
      add(input.gap, fmt::format("{} in a gap of the runs' {}, {}", percent(input.gap), name,
                                 interval(input.gap_low, input.gap_high, input.unit)));
  }
  if (report.empty > 0.5 * t.share)
    reasons.emplace_back(report.empty,
                         fmt::format("{} in an empty part of the runs' plane of {}", percent(report.empty), empty));
  if (report.uncertain > 0.5 * t.share)
    reasons.emplace_back(report.uncertain, fmt::format("{} where the surrogate knows little more than without any runs",
                                                       percent(report.uncertain)));
  std::stable_sort(reasons.begin(), reasons.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::string text = fmt::format("{} of the posterior lies where no run speaks", percent(report.unsupported));
  for (std::size_t i = 0; i < std::min<std::size_t>(reasons.size(), 2); ++i)
    text += (i == 0 ? ": " : "; ") + reasons[i].second;
  return text;
}

/// A candidate for the next run: a draw at an observed setting.
struct Candidate {
  VectorXd point;  ///< point in the emulator's inputs
  Index row = 0;
};

NextRun next_run(const data::Study& study, const Ground& ground, const Candidate& candidate) {
  const Emulator& emulator = ground.group->emulator;
  NextRun run{.material = emulator.material, .point = {}};
  for (const auto& [parameter, value] : emulator.constants)
    run.point[study.parameters[parameter].name] = study.parameters[parameter].unit.from_si(value);
  const RowOrigin& origin = ground.group->origin[candidate.row];
  const data::Observation& measured = study.observations[origin.set].points[origin.point];
  for (std::size_t c = 0; c < study.controls.size(); ++c)
    run.point[study.controls[c].name] = study.controls[c].unit.from_si(measured.controls[c]);
  for (std::size_t k = 0; k < emulator.inputs.size(); ++k) {
    const Shown value = shown(study, emulator.inputs[k], candidate.point[k]);
    run.point[value.name] = value.value;
  }
  return run;
}

/// A point proposed for a run, which gives all outputs of its material.
struct Proposed {
  std::string material;
  VectorXd point;
};

/// Maximin among the candidates, given the runs and what is proposed already; joins `proposed`.
std::vector<NextRun> next_runs(const data::Study& study, const Ground& ground, const MatrixXd& draws, int count,
                               std::vector<Proposed>& proposed) {
  std::vector<Candidate> candidates;
  for (Index d = 0; d < draws.rows(); ++d) {
    const MatrixXd points = points_at(ground, draws.row(d).transpose());
    for (Index i = 0; i < points.rows(); ++i) candidates.push_back({points.row(i).transpose(), ground.rows[i]});
  }
  const MatrixXd& runs = ground.group->emulator.runs->points;
  VectorXd nearest(static_cast<Index>(candidates.size()));
  for (Index i = 0; i < nearest.size(); ++i)
    nearest[i] = (runs.rowwise() - candidates[i].point.transpose()).rowwise().squaredNorm().minCoeff();
  const auto keep_away_from = [&](const VectorXd& point) {
    for (Index k = 0; k < nearest.size(); ++k)
      nearest[k] = std::min(nearest[k], (candidates[k].point - point).squaredNorm());
  };
  const std::string& material = ground.group->emulator.material;
  for (const Proposed& other : proposed)
    if (other.material == material && other.point.size() == runs.cols()) keep_away_from(other.point);
  std::vector<NextRun> chosen;
  for (int i = 0; i < count && i < nearest.size(); ++i) {
    Index best = 0;
    if (!(nearest.maxCoeff(&best) > 1e-12)) break;
    const Candidate& candidate = candidates[best];
    chosen.push_back(next_run(study, ground, candidate));
    keep_away_from(candidate.point);
    proposed.push_back({material, candidate.point});
  }
  return chosen;
}

}  // namespace

SupportReport find_support(const data::Study& study, const CaseModel& model, const MatrixXd& draws,
                           const SupportThresholds& t) {
  SupportReport report;
  std::vector<Ground> grounds;
  for (const RowGroup& group : model.groups)
    if (group.emulator.runs && group.emulator.runs->points.rows() > 0 && group.base.rows() > 0)
      grounds.push_back(ground_of(group, t));
  if (grounds.empty() || draws.rows() == 0) return report;
  report.known = true;
  const MatrixXd some = thinned(draws, t.draws);
  const double each = 1.0 / static_cast<double>(some.rows());
  VectorXd distance = VectorXd::Zero(some.rows()), ratio = distance;
  std::vector<bool> unsupported(static_cast<std::size_t>(some.rows()), false), empty(unsupported),
      uncertain(unsupported), outside(unsupported), gap(unsupported);
  std::map<std::string, int> planes;  // draws in a hole of each
  std::vector<Proposed> proposed;
  for (const Ground& ground : grounds) {
    const std::size_t first = report.inputs.size();
    for (std::size_t k = 0; k < ground.lines.size(); ++k) {
      const EmulatorInput& input = ground.group->emulator.inputs[k];
      const Shown low = shown(study, input, ground.lines[k].low), high = shown(study, input, ground.lines[k].high);
      report.inputs.push_back({.name = low.name,
                               .unit = low.unit.symbol,
                               .material = ground.group->emulator.material,
                               .runs_low = low.value,
                               .runs_high = high.value});
    }
    for (Index d = 0; d < some.rows(); ++d) {
      const auto at = static_cast<std::size_t>(d);
      const RunsAround met = runs_around(ground, some.row(d).transpose(), t);
      unsupported[at] = unsupported[at] || met.unsupported;
      empty[at] = empty[at] || met.empty_plane;
      if (met.empty_plane) {
        const Plane& plane = ground.planes[*met.empty_plane];
        const auto name = [&](Index k) { return shown(study, ground.group->emulator.inputs[k], 0.0).name; };
        ++planes[name(plane.first) + " and " + name(plane.second)];
      }
      uncertain[at] = uncertain[at] || met.uncertain;
      distance[d] = std::max(distance[d], met.distance);
      ratio[d] = std::max(ratio[d], met.ratio);
      for (std::size_t k = 0; k < met.outside.size(); ++k) {
        InputSupport& input = report.inputs[first + k];
        if (met.outside[k]) input.outside += each;
        outside[at] = outside[at] || met.outside[k];
        if (met.gap[k] < 0) continue;
        input.gap += each;
        gap[at] = true;
        const auto& [from, to] = ground.lines[k].gaps[met.gap[k]];
        input.gap_low = shown(study, ground.group->emulator.inputs[k], from).value;
        input.gap_high = shown(study, ground.group->emulator.inputs[k], to).value;
      }
    }
    const auto share = std::max<int>(1, t.next_runs / static_cast<int>(grounds.size()));
    for (NextRun& run : next_runs(study, ground, thinned(draws, 60), share, proposed))
      report.next_runs.push_back(std::move(run));
  }
  const auto share = [each](const std::vector<bool>& flags) {
    return each * static_cast<double>(std::count(flags.begin(), flags.end(), true));
  };
  report.unsupported = share(unsupported);
  report.outside = share(outside);
  report.gap = share(gap);
  report.empty = share(empty);
  report.uncertain = share(uncertain);
  report.distance = quantile(distance, 0.5);
  report.variance_ratio = quantile(ratio, 0.5);
  report.supported = report.unsupported <= t.share;
  if (report.supported) return report;
  const auto emptiest =
      std::max_element(planes.begin(), planes.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  report.sentence = sentence_of(report, t, emptiest == planes.end() ? std::string() : emptiest->first);
  return report;
}

std::string doubt_of(const CaseModel& model) {
  for (const RowGroup& group : model.groups)
    if (!group.emulator.doubt.empty()) return group.emulator.doubt;
  return "";
}

RunsReach runs_reach(const CaseModel& model, int unknown, const SupportThresholds& thresholds) {
  const ScaledPrior& prior = model.unknowns[unknown].prior;
  RunsReach reach{prior.low(), prior.high()};
  for (const RowGroup& group : model.groups) {
    if (!group.emulator.runs || group.emulator.runs->points.rows() == 0) continue;
    for (Index k = 0; k < group.base.cols(); ++k) {
      if (!(group.unknown.col(k).array() == unknown).any()) continue;
      const InputLine line = line_of(group.emulator.runs->points.col(k), thresholds);
      if (line.low - line.slack > prior.low()) reach.low = std::max(reach.low, line.low);
      if (line.high + line.slack < prior.high()) reach.high = std::min(reach.high, line.high);
    }
  }
  return reach;
}

std::vector<std::string> unsupported_parameters(const CaseModel& model, const SupportReport& support) {
  std::string why = doubt_of(model);
  if (why.empty() && support.known && !support.supported) why = support.sentence;
  if (why.empty()) return {};
  return std::vector<std::string>(static_cast<std::size_t>(model.own_count()), why);
}

std::vector<std::pair<std::string, std::string>> describe(const SupportThresholds& t) {
  return {{"unsupported share of a posterior", fmt::format("at most {:g} of the draws", t.share)},
          {"a draw beyond the runs",
           fmt::format("by more than {:g} mean spacings of their values, {:g} to {:g} of the range", t.slack_gaps,
                       t.slack_least, t.slack_most)},
          {"a gap in the runs", fmt::format("{:g} times the mean of the other spacings, and at least {:g} of the range",
                                            t.gap_factor, t.gap_least)},
          {"surrogate without support",
           fmt::format("its variance is at least {:.2g} of what it would be without runs", t.uncertain)}};
}

}  // namespace uq
