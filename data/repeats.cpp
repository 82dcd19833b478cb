#include "data/repeats.hpp"

#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace data {
namespace {

/// The rows of each setting, by their first row.
std::vector<std::vector<std::size_t>> rows_of_settings(const ObservationSet& set) {
  std::map<std::vector<double>, std::size_t> known;
  std::vector<std::vector<std::size_t>> settings;
  for (std::size_t i = 0; i < set.points.size(); ++i) {
    const auto [at, is_new] = known.emplace(set.points[i].controls, settings.size());
    if (is_new) settings.emplace_back();
    settings[at->second].push_back(i);
  }
  return settings;
}

struct Mean {
  double value = std::numeric_limits<double>::quiet_NaN(), error = value;
  double chi_squared = 0.0;  ///< squares about the mean over the squared errors
  std::size_t count = 0;
};

/// The mean of what the rows have of an output, weighted by the errors; its error is that of one reading where they
/// share it, else that of independent ones.
Mean mean_of(const ObservationSet& set, const std::vector<std::size_t>& rows, std::size_t column, bool shared) {
  Mean mean;
  double weight = 0.0, sum = 0.0, squares = 0.0;
  for (const std::size_t row : rows) {
    const Observation& point = set.points[row];
    if (!point.has(column)) continue;
    const double variance = std::pow(point.standard_errors[column], 2);
    weight += 1.0 / variance;
    sum += point.values[column] / variance;
    squares += variance;
    ++mean.count;
  }
  if (mean.count == 0) return mean;
  mean.value = sum / weight;
  mean.error = std::sqrt(shared ? squares / static_cast<double>(mean.count) : 1.0 / weight);
  for (const std::size_t row : rows)
    if (const Observation& point = set.points[row]; point.has(column))
      mean.chi_squared += std::pow((point.values[column] - mean.value) / point.standard_errors[column], 2);
  return mean;
}

/// Whether a case that reads the set estimates the errors of the output, or what multiplies them.
bool is_estimated(const Study& study, const ObservationSet& set, std::size_t output) {
  return std::any_of(study.cases.begin(), study.cases.end(), [&](const CalibrationCase& one) {
    return std::find(one.observe.begin(), one.observe.end(), set.name) != one.observe.end() &&
           std::any_of(one.nuisances.begin(), one.nuisances.end(), [&](const Nuisance& nuisance) {
             return (nuisance.kind == NuisanceKind::noise_sd || nuisance.kind == NuisanceKind::noise_scale) &&
                    nuisance.output.value_or(output) == output;
           });
  });
}

}  // namespace

void Agreement::add(double chi_squared, std::size_t degrees) {
  chi_squared_ += chi_squared;
  degrees_ += degrees;
}

double Agreement::scatter() const {
  return degrees_ == 0 ? 1.0 : std::sqrt(chi_squared_ / static_cast<double>(degrees_));
}

bool Agreement::too_good(const RepeatThresholds& thresholds) const {
  return degrees_ > 0 && scatter() < thresholds.share &&
         gsl_cdf_chisq_P(chi_squared_, static_cast<double>(degrees_)) < thresholds.unlikely;
}

void average_shared_errors(ObservationSet& set, const Study& study, const RepeatThresholds& thresholds) {
  const std::vector<std::vector<std::size_t>> settings = rows_of_settings(set);
  if (settings.size() == set.points.size()) return;
  std::vector<bool> shared(set.outputs.size(), false);
  for (std::size_t column = 0; column < set.outputs.size(); ++column) {
    if (is_estimated(study, set, set.outputs[column])) continue;
    Agreement agreement;
    SharedErrors found{.output = set.outputs[column]};
    for (const std::vector<std::size_t>& rows : settings) {
      const Mean mean = mean_of(set, rows, column, false);
      if (mean.count < 2) continue;
      agreement.add(mean.chi_squared, mean.count - 1);
      found.readings += mean.count;
      ++found.settings;
    }
    if (!agreement.too_good(thresholds)) continue;
    shared[column] = true;
    found.scatter = agreement.scatter();
    set.repeats.push_back(found);
  }
  if (set.repeats.empty()) return;
  std::vector<Observation> averaged;
  for (const std::vector<std::size_t>& rows : settings) {
    Observation point = set.points[rows.front()];
    for (std::size_t column = 0; column < set.outputs.size(); ++column) {
      const Mean mean = mean_of(set, rows, column, shared[column]);
      point.values[column] = mean.value;
      point.standard_errors[column] = mean.error;
    }
    averaged.push_back(std::move(point));
  }
  set.points = std::move(averaged);
}

}  // namespace data
