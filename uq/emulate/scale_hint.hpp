#pragma once
// Scales on which a surrogate might learn better than on those that it has chosen itself (surrogate/stretch.hpp).
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "data/study.hpp"
#include "uq/emulate/surrogates.hpp"

namespace uq {

/// The ratio of the runs' highest to their lowest value from which an input on the linear scale is named. A response
/// that goes with a power of the control bends most at the control's low end, where a stationary process goes wrong
/// first.
inline constexpr double wide_control = 5.0;

/// A sentence about what might let the surrogate bend at one end of an input. At the low end of an input that covers a
/// wide range on a linear scale it is a log scale, else more runs.
std::string bend_hint(const data::Study& study, const EmulatorInput& input, std::pair<double, double> covered,
                      bool low);

/// A scale on which the surrogate was fitted again.
struct TriedScale {
  std::string key;     ///< key that sets it: "[parameters.b] scale = \"log\""
  double error = 0.0;  ///< root of the sum of the squared leave-one-out errors, SI
};

/// The log scale that helps the surrogate most: it is tried on the inputs and the output whose values span a wide range
/// on a linear scale, and judged by the leave-one-out error. `accused`: indices of runs that must agree with all others
/// on the new scale. Good runs are accused where the model bends at the low end of a wide range and a stationary
/// process does not. None where no scale does that.
std::optional<TriedScale> best_log_scale(const data::Study& study, const TrainingRows& rows,
                                         const std::vector<int>& accused, const surrogate::FitOptions& fit);

/// Root of the sum of the squared leave-one-out errors, SI.
double left_out_error(const surrogate::GaussianProcess& process, const surrogate::TrainingSet& training);

}  // namespace uq
