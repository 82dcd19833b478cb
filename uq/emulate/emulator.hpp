#pragma once
// An emulator predicts one output of one material: a Gaussian process over the inputs that the material's runs vary, or
// any other function. Inputs are in the unit cube: parameters by uq/posterior/prior.hpp's u, controls by (x - low) /
// (high - low).
#include <Eigen/Dense>
#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "data/study.hpp"
#include "surrogate/gaussian_process.hpp"
#include "surrogate/stretch.hpp"

namespace uq {

enum class InputKind { parameter, control };

struct EmulatorInput {
  InputKind kind = InputKind::parameter;
  std::size_t index = 0;            ///< index into Study::parameters or Study::controls
  surrogate::Stretch stretch = {};  ///< from the study's unit interval to that on which the runs are learnt
};

/// Points of the unit cube on the scales on which the runs are learnt.
Eigen::MatrixXd learnt_points(const std::vector<EmulatorInput>& inputs, Eigen::MatrixXd points);

/// The study's input; it refers to the study.
inline data::Input input_of(const data::Study& study, const EmulatorInput& input) {
  if (input.kind == InputKind::parameter) {
    const data::Parameter& p = study.parameters[input.index];
    return {p.name, p.target, p.unit, p.axis()};
  }
  const data::Control& c = study.controls[input.index];
  return {c.name, c.target, c.unit, c.axis()};
}

/// The runs that an emulator has learnt from, as far as uq/posterior/support.hpp needs them.
struct RunCloud {
  Eigen::MatrixXd points;         ///< unit cube, one per row, both levels where there are two
  Eigen::VectorXd length_scales;  ///< of learnt_points
  double prior_variance = 0.0;    ///< variance of the process without any runs: SI^2, or of the logarithm
  bool logarithmic = false;       ///< the output is learnt as a logarithm
};

struct Emulator {
  std::string material;
  std::size_t output = 0;                   ///< index into Study::outputs
  std::vector<EmulatorInput> inputs;        ///< columns of the points
  std::map<std::size_t, double> constants;  ///< parameters that the material's runs hold at one value, SI
  std::map<std::size_t, std::pair<double, double>> control_range;  ///< SI, range of each control over the runs
  std::function<surrogate::Prediction(const Eigen::MatrixXd& points)> predict;
  /// The means of `predict` alone. Empty where that is not cheaper.
  std::function<Eigen::VectorXd(const Eigen::MatrixXd& points)> predict_mean = {};
  /// Slopes of mean and covariance along inputs. For each k of `coordinates`: the derivative when input k of all rows
  /// moves by the same amount (unit cube). Empty: the caller takes differences.
  std::function<surrogate::PredictionGradient(const Eigen::MatrixXd& points, std::span<const int> coordinates)>
      predict_with_gradient = {};
  /// Predicts points stacked in groups of `group` rows. Empty where there is no such function.
  std::function<std::vector<surrogate::Prediction>(const Eigen::MatrixXd& points, int group)> predict_batch = {};
  std::shared_ptr<const RunCloud> runs = {};  ///< none: a function that no runs stand behind
  std::string doubt = {};                     ///< why no verdict can rest on the emulator; empty: one can
};

/// An emulator of points of the unit cube, from one whose functions take learnt points.
Emulator on_study_scales(Emulator emulator);

/// A process of the surrogate layer as an emulator of the unit cube; it is shared, not copied.
template <class Process>
Emulator make_emulator(std::shared_ptr<const Process> process, std::string material, std::size_t output,
                       std::vector<EmulatorInput> inputs) {
  Emulator emulator{.material = std::move(material),
                    .output = output,
                    .inputs = std::move(inputs),
                    .constants = {},
                    .control_range = {},
                    .predict = {}};
  emulator.predict = [process](const Eigen::MatrixXd& points) -> surrogate::Prediction {
    return process->predict(points);
  };
  emulator.predict_mean = [process](const Eigen::MatrixXd& points) -> Eigen::VectorXd {
    return process->predict_mean(points);
  };
  emulator.predict_with_gradient = [process](const Eigen::MatrixXd& points,
                                             std::span<const int> coordinates) -> surrogate::PredictionGradient {
    return process->predict_with_gradient(points, coordinates);
  };
  emulator.predict_batch = [process](const Eigen::MatrixXd& points, int group) -> std::vector<surrogate::Prediction> {
    return process->predict_batch(points, group);
  };
  return on_study_scales(std::move(emulator));
}

}  // namespace uq
