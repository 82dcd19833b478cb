#include "uq/posterior/farthest_runs.hpp"

#include <algorithm>

namespace uq {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// A candidate for the next run: a draw at an observed setting.
struct RunCandidate {
  VectorXd point;  ///< point in the emulator's inputs
  Index row = 0;
};

NextRun run_at(const data::Study& study, const Ground& ground, const RunCandidate& candidate) {
  const Emulator& emulator = ground.group->emulator;
  NextRun run{.material = emulator.material, .point = {}};
  for (const auto& [parameter, value] : emulator.constants)
    run.point[study.parameters[parameter].name] = study.parameters[parameter].unit.from_si(value);
  const RowOrigin& origin = ground.group->origin[candidate.row];
  const data::Observation& measured = study.observations[origin.set].points[origin.point];
  for (std::size_t c = 0; c < study.controls.size(); ++c)
    run.point[study.controls[c].name] = study.controls[c].unit.from_si(measured.controls[c]);
  for (std::size_t k = 0; k < emulator.inputs.size(); ++k) {
    const InputValue value = input_value(study, emulator.inputs[k], candidate.point[k]);
    run.point[value.name] = value.value;
  }
  return run;
}

/// The draws at the observed settings.
std::vector<RunCandidate> run_candidates(const Ground& ground, const MatrixXd& draws) {
  std::vector<RunCandidate> candidates;
  for (Index d = 0; d < draws.rows(); ++d) {
    const MatrixXd points = points_at(ground, draws.row(d).transpose());
    for (Index i = 0; i < points.rows(); ++i) candidates.push_back({points.row(i).transpose(), ground.rows[i]});
  }
  return candidates;
}

}  // namespace

std::vector<ProposedRun> farthest_runs(const data::Study& study, const Ground& ground, const MatrixXd& draws, int count,
                                       const std::vector<ProposedRun>& proposed) {
  const std::vector<RunCandidate> candidates = run_candidates(ground, draws);
  const MatrixXd& runs = ground.group->emulator.runs->points;
  VectorXd nearest(static_cast<Index>(candidates.size()));  // squared distance of each to what there is
  for (Index i = 0; i < nearest.size(); ++i)
    nearest[i] = (runs.rowwise() - candidates[i].point.transpose()).rowwise().squaredNorm().minCoeff();
  const auto keep_away_from = [&](const VectorXd& point) {
    for (Index k = 0; k < nearest.size(); ++k)
      nearest[k] = std::min(nearest[k], (candidates[k].point - point).squaredNorm());
  };
  for (const ProposedRun& other : proposed)
    if (other.run.material == ground.group->emulator.material && other.point.size() == runs.cols())
      keep_away_from(other.point);
  std::vector<ProposedRun> chosen;
  for (int i = 0; i < count && i < nearest.size(); ++i) {
    Index best = 0;
    if (!(nearest.maxCoeff(&best) > 1e-12)) break;
    const RunCandidate& candidate = candidates[best];
    chosen.push_back({run_at(study, ground, candidate), candidate.point});
    keep_away_from(candidate.point);
  }
  return chosen;
}

}  // namespace uq
