#pragma once
// The runs of an emulator as the draws of a posterior meet them: along each input, in each plane of two inputs, and
// about each point. support.hpp says when a point is not supported by them.
#include <Eigen/Dense>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "uq/posterior/support.hpp"

namespace uq {

/// How the runs lie along one input, in the unit cube.
struct InputLine {
  double low = 0.0, high = 1.0, slack = 0.0, spacing = 0.0;
  std::vector<std::pair<double, double>> gaps;
};

InputLine line_of(const Eigen::VectorXd& column, const SupportThresholds& thresholds);

/// Two inputs' plane of runs.
struct Plane {
  Eigen::Index first = 0, second = 0;
  Eigen::MatrixXd points;  ///< distinct
  std::vector<Eigen::Vector2d> hull;
  double radius = 0.0;     ///< radius of the holes that this many runs leave
  Eigen::Array2d regular;  ///< half the mean spacing of each input's values: no hole is narrower than its levels
};

/// One emulator's runs as the posterior meets them.
struct Ground {
  const RowGroup* group = nullptr;
  std::vector<InputLine> lines;
  std::vector<Plane> planes;
  std::vector<Eigen::Index> rows;  ///< observed settings that are looked at
  Eigen::MatrixXd scaled;          ///< the runs on their learnt scales, in length scales
};

Ground ground_of(const RowGroup& group, const SupportThresholds& thresholds);

/// The points of the unit cube at which one draw was compared with the measurements.
Eigen::MatrixXd points_at(const Ground& ground, const Eigen::VectorXd& u);

/// The findings of one draw in one emulator.
struct RunsAround {
  std::vector<bool> outside;               ///< per input: at half of the rows or more
  std::vector<int> gap;                    ///< per input: which gap, or -1
  std::optional<std::size_t> empty_plane;  ///< the emptiest, where half of the rows lie in a hole of some plane
  bool uncertain = false, unsupported = false;
  double distance = 0.0, ratio = 0.0;  ///< means over the rows
};

RunsAround runs_around(const Ground& ground, const Eigen::VectorXd& u, const SupportThresholds& thresholds);

/// Name, unit and value of an input.
struct InputValue {
  std::string name;
  const data::Unit& unit;
  double value = 0.0;
};

InputValue input_value(const data::Study& study, const EmulatorInput& input, double u);

}  // namespace uq
