// Emulators whose runs are learnt on stretched scales (surrogate/stretch.hpp), as functions of the study's unit cube.
#include <algorithm>
#include <tuple>
#include <utility>

#include "uq/emulate/emulator.hpp"

namespace uq {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using surrogate::Prediction;
using surrogate::PredictionGradient;

using Predict = std::function<Prediction(const MatrixXd& points)>;
using PredictWithGradient = std::function<PredictionGradient(const MatrixXd& points, std::span<const int> coordinates)>;

/// The derivative along one coordinate of rows that stand at different places of it, so that each has a slope of its
/// own: central differences.
std::pair<Eigen::VectorXd, MatrixXd> difference(const Predict& predict, const std::vector<EmulatorInput>& inputs,
                                                const MatrixXd& points, int coordinate) {
  constexpr double step = 1e-4;  // unit cube
  MatrixXd before = points, after = points;
  before.col(coordinate).array() -= step;
  after.col(coordinate).array() += step;
  const Prediction low = predict(learnt_points(inputs, std::move(before)));
  const Prediction high = predict(learnt_points(inputs, std::move(after)));
  return {(high.mean - low.mean) / (2.0 * step), (high.covariance - low.covariance) / (2.0 * step)};
}

/// The chain rule: derivatives along the study's unit interval from those along the learnt scale.
PredictWithGradient with_chain_rule(PredictWithGradient learnt, Predict predict, std::vector<EmulatorInput> inputs) {
  return [learnt = std::move(learnt), predict = std::move(predict), inputs = std::move(inputs)](
             const MatrixXd& points, std::span<const int> coordinates) -> PredictionGradient {
    PredictionGradient found = learnt(learnt_points(inputs, points), coordinates);
    for (std::size_t i = 0; i < coordinates.size(); ++i) {
      const surrogate::Stretch& stretch = inputs[coordinates[i]].stretch;
      if (stretch.is_none() || points.rows() == 0) continue;
      const auto column = points.col(coordinates[i]);
      if (column.maxCoeff() > column.minCoeff()) {
        std::tie(found.mean_gradient[i], found.covariance_gradient[i]) =
            difference(predict, inputs, points, coordinates[i]);
        continue;
      }
      const double slope = stretch.slope(column[0]);
      found.mean_gradient[i] *= slope;
      found.covariance_gradient[i] *= slope;
    }
    return found;
  };
}

}  // namespace

MatrixXd learnt_points(const std::vector<EmulatorInput>& inputs, MatrixXd points) {
  for (std::size_t k = 0; k < inputs.size(); ++k)
    if (!inputs[k].stretch.is_none())
      for (double& u : points.col(static_cast<Index>(k))) u = inputs[k].stretch.place(u);
  return points;
}

Emulator on_study_scales(Emulator emulator) {
  const std::vector<EmulatorInput> inputs = emulator.inputs;
  if (std::all_of(inputs.begin(), inputs.end(), [](const EmulatorInput& one) { return one.stretch.is_none(); }))
    return emulator;
  if (emulator.predict_with_gradient)
    emulator.predict_with_gradient = with_chain_rule(emulator.predict_with_gradient, emulator.predict, inputs);
  emulator.predict = [inputs, predict = emulator.predict](const MatrixXd& points) -> Prediction {
    return predict(learnt_points(inputs, points));
  };
  if (emulator.predict_mean)
    emulator.predict_mean = [inputs, mean = emulator.predict_mean](const MatrixXd& points) -> Eigen::VectorXd {
      return mean(learnt_points(inputs, points));
    };
  if (emulator.predict_batch)
    emulator.predict_batch = [inputs, batch = emulator.predict_batch](const MatrixXd& points,
                                                                      int group) -> std::vector<Prediction> {
      return batch(learnt_points(inputs, points), group);
    };
  return emulator;
}

}  // namespace uq
