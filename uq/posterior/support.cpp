#include "uq/posterior/support.hpp"

#include <algorithm>
#include <map>

#include "uq/infer/diagnostics.hpp"
#include "uq/posterior/farthest_runs.hpp"
#include "uq/posterior/predictive.hpp"
#include "uq/posterior/prior.hpp"
#include "uq/posterior/support_words.hpp"

namespace uq {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The inputs of an emulator with the range that its runs cover.
std::vector<InputSupport> inputs_of(const data::Study& study, const Ground& ground) {
  std::vector<InputSupport> inputs;
  for (std::size_t k = 0; k < ground.lines.size(); ++k) {
    const EmulatorInput& input = ground.group->emulator.inputs[k];
    const InputValue low = input_value(study, input, ground.lines[k].low);
    const InputValue high = input_value(study, input, ground.lines[k].high);
    inputs.push_back({.name = low.name,
                      .unit = low.unit.symbol,
                      .material = ground.group->emulator.material,
                      .runs_low = low.value,
                      .runs_high = high.value});
  }
  return inputs;
}

/// "friction and rpm".
std::string name_of(const data::Study& study, const Ground& ground, const Plane& plane) {
  const auto name = [&](Index k) { return input_value(study, ground.group->emulator.inputs[k], 0.0).name; };
  return name(plane.first) + " and " + name(plane.second);
}

/// The inputs of an emulator with the shares of the draws that its runs do not cover. `around`: per draw.
std::vector<InputSupport> inputs_beside(const data::Study& study, const Ground& ground,
                                        const std::vector<RunsAround>& around) {
  std::vector<InputSupport> inputs = inputs_of(study, ground);
  const double each = 1.0 / static_cast<double>(around.size());
  for (const RunsAround& met : around)
    for (std::size_t k = 0; k < inputs.size(); ++k) {
      if (met.outside[k]) inputs[k].outside += each;
      if (met.gap[k] < 0) continue;
      inputs[k].gap += each;
      const auto& [from, to] = ground.lines[k].gaps[met.gap[k]];
      inputs[k].gap_low = input_value(study, ground.group->emulator.inputs[k], from).value;
      inputs[k].gap_high = input_value(study, ground.group->emulator.inputs[k], to).value;
    }
  return inputs;
}

/// What the tests say of each draw, over all emulators.
class DrawsMet {
 public:
  explicit DrawsMet(Index draws)
      : unsupported_(static_cast<std::size_t>(draws), false),
        outside_(unsupported_),
        gap_(unsupported_),
        empty_(unsupported_),
        uncertain_(unsupported_),
        distance_(VectorXd::Zero(draws)),
        ratio_(distance_) {}

  /// Counts an emulator in. `around`: per draw.
  void add(const data::Study& study, const Ground& ground, const std::vector<RunsAround>& around) {
    for (std::size_t d = 0; d < around.size(); ++d) {
      const RunsAround& met = around[d];
      unsupported_[d] = unsupported_[d] || met.unsupported;
      outside_[d] = outside_[d] || std::find(met.outside.begin(), met.outside.end(), true) != met.outside.end();
      gap_[d] = gap_[d] || std::any_of(met.gap.begin(), met.gap.end(), [](int gap) { return gap >= 0; });
      empty_[d] = empty_[d] || met.empty_plane;
      uncertain_[d] = uncertain_[d] || met.uncertain;
      distance_[d] = std::max(distance_[d], met.distance);
      ratio_[d] = std::max(ratio_[d], met.ratio);
      if (met.empty_plane) ++in_hole_[name_of(study, ground, ground.planes[*met.empty_plane])];
    }
  }

  /// The report with the shares of the draws that each test rejects.
  SupportReport counted(SupportReport report) const {
    report.unsupported = share(unsupported_);
    report.outside = share(outside_);
    report.gap = share(gap_);
    report.empty = share(empty_);
    report.uncertain = share(uncertain_);
    report.distance = quantile(distance_, 0.5);
    report.variance_ratio = quantile(ratio_, 0.5);
    return report;
  }

  /// The plane in whose holes most draws lie; empty where none does.
  std::string emptiest() const {
    const auto most = std::max_element(in_hole_.begin(), in_hole_.end(),
                                       [](const auto& a, const auto& b) { return a.second < b.second; });
    return most == in_hole_.end() ? std::string() : most->first;
  }

 private:
  static double share(const std::vector<bool>& flags) {
    const double each = 1.0 / static_cast<double>(flags.size());
    return each * static_cast<double>(std::count(flags.begin(), flags.end(), true));
  }

  std::vector<bool> unsupported_, outside_, gap_, empty_, uncertain_;
  VectorXd distance_, ratio_;           ///< largest of the emulators
  std::map<std::string, int> in_hole_;  ///< draws, by plane
};

/// Runs to make next, an equal number for each emulator.
std::vector<NextRun> next_runs(const data::Study& study, const std::vector<Ground>& grounds, const MatrixXd& draws,
                               const SupportThresholds& t) {
  const int share = std::max<int>(1, t.next_runs / static_cast<int>(grounds.size()));
  std::vector<ProposedRun> proposed;
  for (const Ground& ground : grounds) {
    const std::vector<ProposedRun> more = farthest_runs(study, ground, thinned(draws, 60), share, proposed);
    proposed.insert(proposed.end(), more.begin(), more.end());
  }
  std::vector<NextRun> runs;
  for (ProposedRun& one : proposed) runs.push_back(std::move(one.run));
  return runs;
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
  DrawsMet met(some.rows());
  for (const Ground& ground : grounds) {
    std::vector<RunsAround> around;
    for (Index d = 0; d < some.rows(); ++d) around.push_back(runs_around(ground, some.row(d).transpose(), t));
    met.add(study, ground, around);
    for (InputSupport& input : inputs_beside(study, ground, around)) report.inputs.push_back(std::move(input));
  }
  report = met.counted(std::move(report));
  report.next_runs = next_runs(study, grounds, draws, t);
  report.supported = report.unsupported <= t.share;
  if (!report.supported) report.sentence = support_sentence(report, t, met.emptiest());
  return report;
}

VectorXd unsupported_at(const CaseModel& model, const std::vector<Index>& rows, const MatrixXd& draws,
                        const SupportThresholds& t) {
  constexpr int asked = 100;
  const MatrixXd some = thinned(draws, std::min(asked, t.draws));
  const double each = 1.0 / static_cast<double>(std::max<Index>(some.rows(), 1));
  VectorXd shares = VectorXd::Zero(static_cast<Index>(rows.size()));
  Index first = 0;
  for (const RowGroup& group : model.groups) {
    const Index count = group.base.rows();
    if (group.emulator.runs && group.emulator.runs->points.rows() > 0 && count > 0) {
      Ground ground = ground_of(group, t);
      for (std::size_t i = 0; i < rows.size(); ++i) {
        if (rows[i] < first || rows[i] >= first + count) continue;
        ground.rows = {rows[i] - first};
        for (Index d = 0; d < some.rows(); ++d)
          if (runs_around(ground, some.row(d).transpose(), t).unsupported) shares[static_cast<Index>(i)] += each;
      }
    }
    first += count;
  }
  return shares;
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

}  // namespace uq
