#include "uq/plan/levels.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <string>

#include "uq/plan/extended_case.hpp"
#include "uq/posterior/posterior.hpp"
#include "uq/posterior/predictive.hpp"

namespace uq::plan {
namespace {

using data::Study;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

std::set<std::size_t> varied_parameters(const Emulator& emulator) {
  std::set<std::size_t> found;
  for (const EmulatorInput& input : emulator.inputs)
    if (input.kind == InputKind::parameter) found.insert(input.index);
  return found;
}

/// Whether a level's runs have all that a candidate reads, over the same parameters.
bool comparable(const Study& study, const std::vector<Emulator>& emulators, const Candidate& candidate,
                const std::string& level) {
  return std::all_of(candidate.outputs.begin(), candidate.outputs.end(), [&](std::size_t output) {
    const Emulator* own = emulator_of(emulators, candidate.material, output);
    const Emulator* other = emulator_of(emulators, level, output);
    return own != nullptr && other != nullptr && varied_parameters(*own) == varied_parameters(*other) &&
           std::all_of(candidate.settings.begin(), candidate.settings.end(),
                       [&](const std::vector<double>& point) { return reaches(study, *other, point); });
  });
}

/// What the surrogates say of a candidate's readings, means and variances at each draw, draws x readings; and the
/// variance of each reading's own error.
struct Readings {
  MatrixXd mean, variance;
  VectorXd noise;
};

std::vector<Readings> readings_of(const Study& study, const std::vector<Emulator>& emulators, std::size_t case_index,
                                  const CaseModel& sampled, const std::vector<Candidate>& candidates,
                                  const MatrixXd& draws, const VectorXd& u) {
  const ExtendedCase extended = extend(study, emulators, case_index, sampled, candidates, u);
  const CaseModel& model = extended.model;
  const VectorXd noise = predict(model, u).noise;
  MatrixXd mean(draws.rows(), model.row_count()), variance = mean;
  Index first = 0;
  for (const RowGroup& group : model.groups) {
    const Index rows = group.observed.size();
    for (Index draw = 0; draw < draws.rows(); ++draw) {
      const VectorXd at = draws.row(draw).transpose();
      const surrogate::Prediction prediction = group.emulator.predict(rows_at(group, at).topRows(rows));
      for (Index i = 0; i < rows; ++i) {
        const double factor = meter_at(group.measurement, model.unknowns, at, i).factor;
        mean(draw, first + i) = factor * prediction.mean[i];
        variance(draw, first + i) = factor * factor * prediction.covariance(i, i);
      }
    }
    first += rows;
  }
  std::vector<Readings> found;
  for (const std::vector<Index>& rows : extended.planned)
    found.push_back({mean(Eigen::all, rows), variance(Eigen::all, rows), noise(rows)});
  return found;
}

/// At the worst of a candidate's readings.
void compare(const Readings& own, const Readings& other, PlanLevel& level) {
  const Eigen::ArrayXd noise = own.noise.array();
  const Eigen::ArrayXd apart = (own.mean - other.mean).array().square().colwise().mean().transpose() / noise;
  const Eigen::ArrayXd doubt = (own.variance + other.variance).array().colwise().mean().transpose() / noise;
  Index worst = 0;
  (apart + doubt).maxCoeff(&worst);
  level.difference = std::sqrt(apart[worst]);
  level.doubt = std::sqrt(doubt[worst]);
}

}  // namespace

void compare_levels(const Study& study, const std::vector<Emulator>& emulators, std::size_t case_index,
                    const CaseModel& sampled, const CandidateOptions& options, const MatrixXd& draws, const VectorXd& u,
                    std::vector<Candidate>& candidates) {
  constexpr Index asked = 200;
  std::vector<Candidate> own, other;
  std::vector<std::size_t> of;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const auto levels = options.coarse_grained.find(candidates[i].material);
    if (levels == options.coarse_grained.end()) continue;
    for (const std::string& level : levels->second) {
      candidates[i].levels.push_back({.material = level});
      if (!comparable(study, emulators, candidates[i], level)) continue;
      own.push_back(candidates[i]);
      other.push_back(candidates[i]);
      other.back().material = level;
      of.push_back(i);
    }
  }
  if (own.empty()) return;
  const MatrixXd used = thinned(draws, asked);
  const std::vector<Readings> here = readings_of(study, emulators, case_index, sampled, own, used, u);
  const std::vector<Readings> there = readings_of(study, emulators, case_index, sampled, other, used, u);
  for (std::size_t i = 0; i < own.size(); ++i)
    for (PlanLevel& level : candidates[of[i]].levels)
      if (level.material == other[i].material) compare(here[i], there[i], level);
  for (const std::size_t i : of) {
    const std::vector<PlanLevel>& levels = candidates[i].levels;
    candidates[i].model_only =
        candidates[i].model_only &&
        !std::all_of(levels.begin(), levels.end(), [](const PlanLevel& level) { return level.agrees(); });
  }
}

}  // namespace uq::plan
