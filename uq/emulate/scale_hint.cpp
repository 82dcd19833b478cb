#include "uq/emulate/scale_hint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "data/error.hpp"
#include "uq/emulate/outlying_runs.hpp"

namespace uq {
namespace {

bool log_is_worth_a_try(data::Scale scale, std::pair<double, double> covered) {
  return scale != data::Scale::log && covered.first > 0.0 && covered.second >= wide_control * covered.first;
}

/// Whether none of the accused is outlying for a process that learns these data; its leave-one-out error, if so.
std::optional<double> clears(const surrogate::TrainingSet& training, const std::vector<int>& accused,
                             const surrogate::FitOptions& fit) {
  try {
    const surrogate::GaussianProcess process = surrogate::fit(training, quick(fit));
    const OutlyingRuns found = find_outlying(training, process, fit);
    for (const int run : accused)
      if (std::find(found.runs.begin(), found.runs.end(), run) != found.runs.end()) return {};
    return left_out_error(process, training);
  } catch (const data::InputError&) {
    return {};
  }
}

}  // namespace

double left_out_error(const surrogate::GaussianProcess& process, const surrogate::TrainingSet& training) {
  return (process.leave_one_out().mean - training.y).norm();
}

std::optional<TriedScale> best_log_scale(const data::Study& study, const TrainingRows& rows,
                                         const std::vector<int>& accused, const surrogate::FitOptions& fit) {
  std::optional<TriedScale> best;
  for (std::size_t k = 0; k < rows.inputs.size(); ++k) {
    if (!rows.inputs[k].stretch.is_none()) continue;
    const data::Input input = input_of(study, rows.inputs[k]);
    surrogate::TrainingSet other = rows.set;
    auto column = other.x.col(k);
    for (double& u : column) u = input.axis.from_unit(u);
    const double low = column.minCoeff(), high = column.maxCoeff();
    if (!(input.axis.low > 0.0) || !log_is_worth_a_try(input.axis.scale, {low, high})) continue;
    for (double& value : column) value = std::log(value / low) / std::log(high / low);
    const std::optional<double> error = clears(other, accused, fit);
    if (!error || (best && *error >= best->error)) continue;
    const bool control = rows.inputs[k].kind == InputKind::control;
    best = TriedScale{fmt::format("[{}.{}] scale = \"log\"", control ? "controls" : "parameters", input.name), *error};
  }
  const Eigen::VectorXd& y = rows.set.y;
  if (fit.scale == surrogate::OutputScale::linear &&
      log_is_worth_a_try(data::Scale::linear, {y.minCoeff(), y.maxCoeff()})) {
    surrogate::FitOptions log = fit;
    log.scale = surrogate::OutputScale::log;
    const std::optional<double> error = clears(rows.set, accused, log);
    // An input's scale first: the output's changes how runs scatter, too.
    constexpr double clearly = 0.7;
    if (error && (!best || *error < clearly * best->error))
      best = TriedScale{fmt::format("[surrogate] log_outputs = [\"{}\"]", study.outputs[rows.output].name), *error};
  }
  return best;
}

std::string bend_hint(const data::Study& study, const EmulatorInput& input, std::pair<double, double> covered,
                      bool low) {
  const bool control = input.kind == InputKind::control;
  const std::string& name = control ? study.controls[input.index].name : study.parameters[input.index].name;
  const data::Axis axis = input_of(study, input).axis;
  if (low && input.stretch.is_none() && axis.low > 0.0 && log_is_worth_a_try(axis.scale, covered))
    return fmt::format("Try [{}.{}] scale = \"log\" first.", control ? "controls" : "parameters", name);
  return fmt::format("Make more runs at {} {} first.", low ? "low" : "high", name);
}

}  // namespace uq
