// Validation of the high level: every run held out in turn (in twenty folds where there are more), the low level kept.
#include <algorithm>

#include "surrogate/held_out.hpp"
#include "surrogate/judgement.hpp"
#include "surrogate/two_level.hpp"

namespace surrogate {
Validation validate(const TwoLevelProcess& process, const TwoLevelOptions& options,
                    const ValidationOptions& validation_options) {
  constexpr int most_folds = 20;
  const TrainingSet& training = process.high().runs;
  const HeldOutModel model = [&](const std::vector<int>& kept, const std::vector<int>& left) -> HeldOutPrediction {
    if (kept.size() < 3) return {};
    const TwoLevelProcess part = fit_two_level(
        process.low(), {training.x(kept, Eigen::all), training.y(kept), training.noise_variance(kept)}, options);
    HeldOutPrediction found{part.predict(training.x(left, Eigen::all)), basis_size(options.discrepancy_mean, 0),
                            part.high().diagnostics.converged};
    found.prediction.covariance.diagonal() += training.noise_variance(left);
    found.prediction.covariance.diagonal().array() += part.parameters().nugget_sd * part.parameters().nugget_sd;
    return found;
  };
  const std::vector<int> point_of_run = points_of_rows(training.x);
  const int points = *std::max_element(point_of_run.begin(), point_of_run.end()) + 1;
  const int replicates = static_cast<int>(point_of_run.size()) - points;
  const double nugget = replicates >= 5 ? process.parameters().nugget_sd : 0.0;  // else it may be unresolved structure

  Validation result;
  result.runs = static_cast<int>(training.y.size());
  result.notes = fit_notes(process.high().diagnostics);
  const int predicted =
      hold_out(result, {training, nugget * nugget}, deal(point_of_run, std::min(points, most_folds), 0), model);
  result.leave_one_out = {.mean = result.held_out_mean, .standardised = result.held_out_standardised};
  result.q2_leave_one_out = result.q2_held_out;
  result.coverage_leave_one_out = result.coverage_held_out;
  result.verdict = judge(result, predicted, process.high().diagnostics, validation_options.thresholds);
  explain(result, training, model, validation_options.thresholds);
  return result;
}

}  // namespace surrogate
