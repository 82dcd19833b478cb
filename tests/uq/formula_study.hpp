#pragma once
// Studies whose model is a formula with a known error: a torque that trades `a` against `b` along a line,
// and an angle that parts them. No file, no run. For tests of plans and predictions.
#include <Eigen/Dense>
#include <functional>
#include <vector>

#include "data/study.hpp"
#include "uq/emulate/emulator.hpp"

namespace formula {

/// Value at (a, b, speed), all on [0, 1].
using Formula = std::function<double(double a, double b, double x)>;

inline double torque(double a, double b, double x) { return 10.0 + 5.0 * a + 4.0 * b + 0.3 * x * (a - b); }
inline double angle(double a, double b, double x) { return 10.0 + 3.0 * a - 3.0 * b + 2.0 * x; }

struct Pair {
  Formula torque, angle;
};

/// Two parameters, a control `speed`, outputs torque and angle; torque measured at the speeds given.
inline data::Study study(const std::vector<double>& speeds, const std::vector<double>& values, double sd) {
  data::Study made;
  made.name = "formula";
  made.file = "study.toml";
  for (const char* name : {"a", "b"}) {
    data::Parameter parameter;
    parameter.name = parameter.target = name;
    parameter.prior.low = 0.0;
    parameter.prior.high = 1.0;
    made.parameters.push_back(parameter);
  }
  data::Control speed;
  speed.name = speed.target = "speed";
  made.controls.push_back(speed);
  for (const char* name : {"torque", "angle"}) {
    data::Output output;
    output.name = name;
    made.outputs.push_back(output);
  }
  made.materials.emplace_back();
  data::ObservationSet bench{.name = "bench", .file = "bench.csv", .outputs = {0}};
  for (std::size_t i = 0; i < speeds.size(); ++i)
    bench.points.push_back(
        {.controls = {speeds[i]}, .values = {values[i]}, .standard_errors = {sd}, .line = static_cast<int>(i) + 2});
  made.observations.push_back(bench);
  data::CalibrationCase one;
  one.name = "powder";
  one.observe = {"bench"};
  one.free = {"a", "b"};
  made.cases.push_back(one);
  return made;
}

/// Emulators of both outputs, with an error of sd `shared` that is the same at every speed.
inline std::vector<uq::Emulator> emulators(double shared = 0.0, const Pair& formulas = {torque, angle}) {
  std::vector<uq::Emulator> all;
  for (std::size_t output = 0; output < 2; ++output) {
    const Formula formula = output == 0 ? formulas.torque : formulas.angle;
    uq::Emulator one{
        .material = "",
        .output = output,
        .inputs = {{uq::InputKind::parameter, 0}, {uq::InputKind::parameter, 1}, {uq::InputKind::control, 0}},
        .constants = {},
        .control_range = {{0, {0.0, 1.0}}},
        .predict = {}};
    one.predict = [formula, shared](const Eigen::MatrixXd& points) {
      surrogate::Prediction found{
          .mean = Eigen::VectorXd(points.rows()),
          .covariance = Eigen::MatrixXd::Constant(points.rows(), points.rows(), shared * shared)};
      for (Eigen::Index i = 0; i < points.rows(); ++i)
        found.mean[i] = formula(points(i, 0), points(i, 1), points(i, 2));
      return found;
    };
    all.push_back(std::move(one));
  }
  return all;
}

}  // namespace formula
