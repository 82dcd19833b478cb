#pragma once
// Controls that a surrogate might learn better on a log scale.
#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "data/study.hpp"
#include "uq/emulate/surrogates.hpp"

namespace uq {

/// The highest over the lowest value of the runs, from which an input on the linear scale is named. A response that
/// goes with a power of the control bends most at its low end, and there a stationary process is wrong first.
inline constexpr double wide_control = 5.0;

/// A sentence that says for which controls, by what the runs cover of each [SI], a log scale is worth a try; empty where
/// there is none.
std::string scale_hint(const data::Study& study, const std::map<std::size_t, std::pair<double, double>>& covered);

/// What might let the surrogate bend at one end of an input: its log scale, if that is its low end and it covers a wide
/// range on the linear one; else more runs. A sentence.
std::string bend_hint(const data::Study& study, const EmulatorInput& input, std::pair<double, double> covered,
                      bool low);

/// A scale on which the surrogate was fitted again.
struct TriedScale {
  std::string key;     ///< that sets it: "[parameters.b] scale = \"log\""
  double error = 0.0;  ///< root of the sum of the squared leave-one-out errors, SI
};

/// Of the inputs and the output whose values span a wide range on a linear scale, the one whose logarithm the surrogate
/// learns best. `accused`: indices of runs that must agree with all others there; good runs are accused where the model
/// bends at the low end of a wide range and a stationary process does not. None where no scale does that.
std::optional<TriedScale> best_log_scale(const data::Study& study, const TrainingRows& rows,
                                         const std::vector<int>& accused, const surrogate::FitOptions& fit);

/// Root of the sum of the squared leave-one-out errors, SI.
double left_out_error(const surrogate::GaussianProcess& process, const surrogate::TrainingSet& training);

}  // namespace uq
