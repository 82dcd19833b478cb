#include "uq/refine/next_runs.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "data/random.hpp"
#include "surrogate/design.hpp"
#include "uq/infer/resample.hpp"
#include "uq/posterior/posterior.hpp"

namespace uq {
namespace {

using Eigen::Index;

/// Sets the controls that the emulator has as inputs to shares of [0, 1].
void set_controls(RunPoint& point, const Emulator& emulator, const Eigen::VectorXd& shares) {
  for (const EmulatorInput& input : emulator.inputs)
    if (input.kind == InputKind::control) point.controls[input.index] = shares[input.index];
}

/// Controls of the study that some emulator of the case has as an input: the largest index and one.
int controls_of(const CaseModel& model) {
  std::size_t controls = 0;
  for (const RowGroup& group : model.groups)
    for (const EmulatorInput& input : group.emulator.inputs)
      if (input.kind == InputKind::control) controls = std::max(controls, input.index + 1);
  return static_cast<int>(controls);
}

Eigen::VectorXd prior_point(const CaseModel& model, const Eigen::VectorXd& cube) {
  Eigen::VectorXd u(model.dimension());
  for (Index k = 0; k < u.size(); ++k) u[k] = model.unknowns[k].prior.inverse_cdf(cube[k]);
  return u;
}

/// Points of the prior, kept with probability proportional to likelihood^(1/4).
Eigen::MatrixXd tempered_points(const CaseModel& model, int count, std::uint64_t seed) {
  constexpr int tried = 1024;
  const Eigen::MatrixXd cube = surrogate::scrambled_sobol(tried, model.dimension(), seed);
  Eigen::MatrixXd points(tried, model.dimension());
  for (Index i = 0; i < tried; ++i) points.row(i) = prior_point(model, cube.row(i).transpose()).transpose();
  const Eigen::VectorXd logs = 0.25 * log_likelihoods(model, points);
  if (!std::isfinite(logs.maxCoeff())) return points.topRows(std::min(count, tried));
  const std::vector<Index> rows = resample((logs.array() - logs.maxCoeff()).exp(), count, 0.5);
  Eigen::MatrixXd kept(static_cast<Index>(rows.size()), points.cols());
  for (std::size_t i = 0; i < rows.size(); ++i) kept.row(i) = points.row(rows[i]);
  return kept;
}

/// Equal up to what one of the two leaves out, which is 0.
bool same_values(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  const Index both = std::min(a.size(), b.size());
  return a.head(both) == b.head(both) && (a.tail(a.size() - both).array() == 0.0).all() &&
         (b.tail(b.size() - both).array() == 0.0).all();
}

/// Candidates of one case that are not replicates, appended.
void add_candidates(const CaseState& state, const NextRunsOptions& options, std::vector<RunPoint>& all) {
  const CaseModel& model = *state.model;
  std::vector<std::string> materials;
  for (const RowGroup& group : model.groups)
    if (std::find(materials.begin(), materials.end(), group.emulator.material) == materials.end())
      materials.push_back(group.emulator.material);
  const Eigen::MatrixXd tempered = tempered_points(model, options.candidates.tempered, options.seed + 1);
  const int unknowns = model.dimension();
  const int controls = controls_of(model);
  const int dimension = std::min(unknowns + std::max(controls, 1), surrogate::sobol_max_dimension);
  const int count = options.candidates.posterior + options.candidates.tempered + options.candidates.filling;
  const Eigen::MatrixXd cube = surrogate::scrambled_sobol(count, dimension, options.seed + 2);
  for (const std::string& material : materials) {
    std::vector<const RowGroup*> groups;
    for (const RowGroup& group : model.groups)
      if (group.emulator.material == material) groups.push_back(&group);
    // The rows of the cube are used up one after the other: every fourth of them would see half of a range only.
    int index = 0, row = 0;  // of the candidate, of the cube
    const auto add = [&](const Eigen::VectorXd& u, bool anywhere) {
      const RowGroup& group = *groups[static_cast<std::size_t>(index) % groups.size()];
      const Index turn = index / static_cast<int>(groups.size());
      RunPoint point = run_at(group, turn % group.base.rows(), u);
      if (anywhere && controls > 0 && unknowns + controls <= dimension)
        set_controls(point, group.emulator, cube.row(row).tail(controls).transpose());
      all.push_back(std::move(point));
      row += anywhere ? 1 : 0;
      ++index;
    };
    const int from_draws = std::min(options.candidates.posterior, static_cast<int>(state.draws.rows()));
    for (int i = 0; i < from_draws; ++i)
      add(state.draws.row(i * state.draws.rows() / from_draws).transpose(), index % 4 == 3);
    for (Index i = 0; i < tempered.rows(); ++i) add(tempered.row(i).transpose(), index % 4 == 3);
    for (int i = 0; i < options.candidates.filling; ++i)
      if (unknowns <= dimension) add(prior_point(model, cube.row(row).head(unknowns).transpose()), true);
  }
}

/// Candidates, those that have runs first.
struct Candidates {
  std::vector<RunPoint> points;
  std::size_t with_runs = 0;
};

Candidates candidates_of(const Acquisition& acquisition, const NextRunsOptions& options) {
  std::vector<RunPoint> distinct;
  for (const RunPoint& run : acquisition.existing)
    if (std::none_of(distinct.begin(), distinct.end(), [&](const RunPoint& known) { return same_run(known, run); }))
      distinct.push_back(run);
  Candidates found;
  // As many points with runs are taken of each material as are asked for, spread over all of them.
  std::vector<std::string> materials;
  for (const RunPoint& point : distinct)
    if (std::find(materials.begin(), materials.end(), point.material) == materials.end())
      materials.push_back(point.material);
  for (const std::string& material : materials) {
    std::vector<const RunPoint*> own;
    for (const RunPoint& point : distinct)
      if (point.material == material) own.push_back(&point);
    const std::size_t count =
        std::min(own.size(), static_cast<std::size_t>(std::max(options.candidates.replicates, 0)));
    for (std::size_t i = 0; i < count; ++i) found.points.push_back(*own[i * own.size() / count]);
  }
  found.with_runs = found.points.size();
  std::vector<RunPoint> fresh;
  for (const CaseState& state : acquisition.cases) add_candidates(state, options, fresh);
  for (RunPoint& point : fresh) {
    if (acquisition.rounded) point = acquisition.rounded(point);
    const auto same = [&](const RunPoint& known) { return same_run(known, point); };
    if (std::none_of(found.points.begin(), found.points.end(), same) &&
        std::none_of(distinct.begin(), distinct.end(), same))
      found.points.push_back(std::move(point));
  }
  return found;
}

}  // namespace

RunPoint run_at(const RowGroup& group, Index row, const Eigen::VectorXd& u) {
  Index parameters = 0, controls = 0;
  for (const EmulatorInput& input : group.emulator.inputs) {
    Index& size = input.kind == InputKind::parameter ? parameters : controls;
    size = std::max(size, static_cast<Index>(input.index) + 1);
  }
  RunPoint point{group.emulator.material, Eigen::VectorXd::Zero(parameters), Eigen::VectorXd::Zero(controls)};
  for (std::size_t k = 0; k < group.emulator.inputs.size(); ++k) {
    const EmulatorInput& input = group.emulator.inputs[k];
    (input.kind == InputKind::parameter ? point.parameters : point.controls)[input.index] = group.input(row, k, u);
  }
  return point;
}

bool same_run(const RunPoint& a, const RunPoint& b) {
  return a.material == b.material && same_values(a.parameters, b.parameters) && same_values(a.controls, b.controls);
}

Batch next_batch(const Acquisition& acquisition, const NextRunsOptions& options) {
  const Candidates candidates = candidates_of(acquisition, options);
  std::vector<IntegratedVariance> integrals;
  Batch batch;
  for (const CaseState& state : acquisition.cases) {
    ReferenceOptions reference = options.reference;
    reference.seed = options.seed;
    std::vector<RunNoise> noise;
    for (const RowGroup& group : state.model->groups) noise.push_back(acquisition.noise(group.emulator));
    integrals.emplace_back(*state.model, reference_points(*state.model, state.draws, state.log_evidence, reference),
                           candidates.points, noise);
    batch.variance_before.push_back(integrals.back().variance());
  }
  std::vector<bool> picked(candidates.points.size(), false);
  for (int run = 0; run < options.runs && !candidates.points.empty(); ++run) {
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(static_cast<Index>(candidates.points.size()));
    for (const IntegratedVariance& integral : integrals) sum += integral.reductions();
    Index best = 0;
    const double reduction = sum.maxCoeff(&best);
    if (!(reduction > 0.0)) break;  // nothing more to learn
    const auto index = static_cast<std::size_t>(best);
    batch.runs.push_back({.point = candidates.points[index],
                          .replicate = index < candidates.with_runs || picked[index],
                          .reduction = reduction});
    picked[index] = true;
    for (IntegratedVariance& integral : integrals) integral.add(static_cast<int>(best));
  }
  for (const IntegratedVariance& integral : integrals) batch.variance_after.push_back(integral.variance());
  return batch;
}

}  // namespace uq
