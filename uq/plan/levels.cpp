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

/// A candidate's readings: means and surrogate's variances at each draw, draws x readings, and the readings' variances.
struct Readings {
  MatrixXd mean, variance;
  VectorXd noise;
};

std::vector<Readings> readings_of(const Study& study, const std::vector<Emulator>& emulators, std::size_t case_index,
                                  const CaseModel& sampled, const std::vector<Candidate>& candidates,
                                  const MatrixXd& draws, const VectorXd& u) {
  const ExtendedCase extended = extend(study, emulators, case_index, sampled, candidates, u);
  const VectorXd noise = predict(extended.model, u).noise;
  std::vector<Readings> found;
  for (const std::vector<Index>& rows : extended.planned) {
    const auto count = static_cast<Index>(rows.size());
    found.push_back({MatrixXd(draws.rows(), count), MatrixXd(draws.rows(), count), noise(rows)});
  }
  for_each_law(extended.model, draws, [&](Index draw, const std::vector<GroupLaw>& laws) {
    const StackedPrediction prediction = stack(extended.model, laws, draws.row(draw).transpose());
    const VectorXd variance = prediction.covariance.diagonal();
    for (std::size_t i = 0; i < found.size(); ++i) {
      found[i].mean.row(draw) = prediction.mean(extended.planned[i]).transpose();
      found[i].variance.row(draw) = variance(extended.planned[i]).transpose();
    }
  });
  return found;
}

/// d at the worst of a candidate's readings.
double difference(const Readings& own, const Readings& other) {
  const Eigen::ArrayXXd square =
      (own.mean - other.mean).array().square() + own.variance.array() + other.variance.array();
  return (square.colwise().mean().transpose() / own.noise.array()).sqrt().maxCoeff();
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
    if (!candidates[i].model_only || levels == options.coarse_grained.end()) continue;
    for (const std::string& level : levels->second) {
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
  for (std::size_t i = 0; i < own.size(); ++i) {
    Candidate& candidate = candidates[of[i]];
    const double found = difference(here[i], there[i]);
    candidate.level_difference = std::min(candidate.level_difference.value_or(found), found);
    candidate.model_only = *candidate.level_difference > 1.0;
  }
}

}  // namespace uq::plan
