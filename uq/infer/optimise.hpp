#pragma once
// Maximisation inside a box, some coordinates held: NLopt's SLSQP (Kraft 1994) from several starts. The best point seen
// is kept, whatever the optimiser's last word.
#include <Eigen/Dense>
#include <functional>
#include <utility>
#include <vector>

#include "uq/infer/log_density.hpp"

namespace uq {

struct Box {
  Eigen::VectorXd lower, upper;
};

/// One coordinate held at a value.
struct Held {
  int coordinate = 0;
  double value = 0.0;
};

struct Maximum {
  Eigen::VectorXd x;
  double value = nowhere;
  bool converged = false;  ///< the optimiser met its tolerance from the best start
  int evaluations = 0;
};

using Differentiable = std::function<Evaluation(const Eigen::VectorXd&)>;

/// The best maximum of all starts (rows of `starts`, moved into the box).
Maximum maximise(const Differentiable& function, const Box& box, const Eigen::MatrixXd& starts,
                 const std::vector<Held>& held = {});

/// Adds a gradient by central differences, one-sided at the box's faces.
Differentiable with_differences(std::function<double(const Eigen::VectorXd&)> function, const Box& box);

}  // namespace uq
