#include "surrogate/levels.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace surrogate {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

}  // namespace

std::vector<LevelCheck> check_levels(const TrainingSet& training, const HeldOutModel& model) {
  std::vector<LevelCheck> checks;
  const Index runs = training.y.size();
  for (Index k = 0; k < training.x.cols(); ++k) {
    const std::vector<double> levels = levels_of(training.x.col(k));
    const auto count = static_cast<Index>(levels.size());
    if (count < 2 || count > levels_most || runs < 3 * count) continue;
    LevelCheck check{.input = training.name_of(k), .levels = static_cast<int>(count)};
    double squares = 0.0, about_mean = 0.0, inside = 0.0;
    for (std::size_t level = 1; level + 1 < levels.size(); ++level) {
      std::vector<int> kept, left;
      for (int i = 0; i < runs; ++i)
        (std::abs(training.x(i, k) - levels[level]) < same_level ? left : kept).push_back(i);
      const HeldOutPrediction found = model(kept, left);
      if (found.prediction.mean.size() == 0) continue;
      const VectorXd error = training.y(left) - found.prediction.mean;
      squares += error.squaredNorm();
      about_mean += (training.y(left).array() - training.y.mean()).square().sum();
      inside += static_cast<double>(
          (error.array().abs() <= 1.96 * found.prediction.covariance.diagonal().array().sqrt()).count());
      check.predicted += static_cast<int>(left.size());
    }
    if (check.predicted > 0) {
      check.q2 = about_mean > 0.0 ? 1.0 - squares / about_mean : 0.0;
      check.coverage95 = inside / check.predicted;
    }
    checks.push_back(check);
  }
  return checks;
}

std::vector<ApartPair> pairs_apart(const TrainingSet& training) {
  const Index inputs = training.x.cols();
  std::vector<std::optional<double>> usual;  // of each input that varies: the value of most runs
  for (Index k = 0; k < inputs; ++k) {
    const std::vector<double> levels = levels_of(training.x.col(k));
    const auto runs_at = [&](double level) { return ((training.x.col(k).array() - level).abs() < same_level).count(); };
    usual.emplace_back();
    if (levels.size() < 2) continue;
    usual.back() =
        *std::max_element(levels.begin(), levels.end(), [&](double a, double b) { return runs_at(a) < runs_at(b); });
  }
  std::vector<ApartPair> pairs;
  for (Index i = 0; i < inputs; ++i) {
    for (Index j = i + 1; j < inputs; ++j) {
      if (!usual[i] || !usual[j]) continue;
      const auto moved = [&](Index k) { return (training.x.col(k).array() - *usual[k]).abs() >= same_level; };
      if (!(moved(i) && moved(j)).any()) pairs.push_back({training.name_of(i), training.name_of(j)});
    }
  }
  return pairs;
}

std::vector<std::string> level_notes(const std::vector<LevelCheck>& checks) {
  std::vector<std::string> notes;
  for (const LevelCheck& check : checks) {
    if (check.levels == 2)
      notes.push_back(fmt::format("nothing is known between the 2 levels of {}: run values in between", check.input));
    else if (check.predicted > 0)
      notes.push_back(
          fmt::format("whole levels of {} left out, {} of {}: Q2 {:.4f}, {:.0f} % of their runs lie in the 95 % "
                      "interval",
                      check.input, check.levels - 2, check.levels, check.q2, 100.0 * check.coverage95));
  }
  return notes;
}

bool doubtful(const LevelCheck& check, const ValidationThresholds& thresholds) {
  if (check.levels == 2) return true;
  return check.predicted > 0 && (check.q2 < thresholds.q2_good || check.coverage95 < thresholds.coverage95_unusable);
}

}  // namespace surrogate
