#pragma once
// Predictions of runs by a model that was fitted without them, and what their errors say (validation.hpp). Any kind of
// model will do.
#include <functional>

#include "surrogate/validation.hpp"

namespace surrogate {

/// The prediction of the left-out runs by a model fitted to the kept ones.
struct HeldOutPrediction {
  Prediction prediction;  ///< prediction of the runs: function, nugget and known noise
  int coefficients = 0;   ///< coefficients of the model's mean
  bool converged = false;
};
using HeldOutModel = std::function<HeldOutPrediction(const std::vector<int>& kept, const std::vector<int>& left)>;

/// Distinct points dealt into folds in a random order, replicates together; the runs of each fold.
std::vector<std::vector<int>> deal(const std::vector<int>& point_of_run, int folds, std::uint64_t seed);

struct HeldOutData {
  const TrainingSet& training;  ///< on the model's own scale, noise variances given
  double scatter_variance;      ///< run-to-run scatter, counted as noise that no surrogate can predict
};

/// Fills the held-out numbers of `validation` from the folds; returns how many runs were predicted.
int hold_out(Validation& validation, const HeldOutData& data, const std::vector<std::vector<int>>& folds,
             const HeldOutModel& model);

}  // namespace surrogate
