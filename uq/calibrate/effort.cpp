#include "uq/calibrate/effort.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "data/error.hpp"
#include "data/progress.hpp"
#include "data/provenance.hpp"

namespace uq {
namespace {

constexpr double bytes_per_pair = 56.0;
constexpr double evaluations = 2e5, operations_per_second = 5e9;

/// Runs that train the surrogate of a material.
double training_runs(const data::RunTable& table, const std::string& material, const SurrogateOptions& options) {
  const data::RunTable& many = options.low ? *options.low : table;
  const auto all = std::count_if(many.rows.begin(), many.rows.end(),
                                 [&](const data::RunRow& row) { return row.material == material; });
  return std::min(static_cast<double>(all), static_cast<double>(options.runs_most));
}

}  // namespace

std::vector<std::string> effort_notes(const data::Study& study, const data::RunTable& table,
                                      const SurrogateOptions& options, const EffortLimits& limits) {
  const double machine = limits.memory > 0.0 ? limits.memory : data::machine_memory();
  for (const data::Material& material : study.materials) {
    const double runs = training_runs(table, material.name, options), bytes = bytes_per_pair * runs * runs;
    if (bytes > 0.8 * machine)
      throw data::InputError(
          data::ExitStatus::bad_study,
          {study.file + ": [surrogate] runs_most",
           fmt::format(
               "is {}: a surrogate of {:.0f} runs needs about {:.2g} GB of memory, and this machine has {:.2g} GB",
               options.runs_most, runs, 1e-9 * bytes, 1e-9 * machine),
           fmt::format("lower it to {:.0f} or less: so many of the runs are then chosen at random",
                       std::floor(std::sqrt(0.8 * machine / bytes_per_pair) / 100.0) * 100.0)});
  }
  std::vector<std::string> notes;
  for (const data::CalibrationCase& one : study.cases) {
    double work = 0.0, most_runs = 0.0;
    std::size_t readings = 0;
    for (const data::ObservationSet& set : study.observations) {
      if (std::find(one.observe.begin(), one.observe.end(), set.name) == one.observe.end()) continue;
      const double runs = training_runs(table, set.material, options);
      const std::size_t here = set.points.size() * std::max<std::size_t>(1, set.outputs.size());
      work += static_cast<double>(here) * runs * runs;
      readings += here;
      most_runs = std::max(most_runs, runs);
    }
    const double seconds = evaluations * work / operations_per_second;
    if (seconds < limits.seconds) continue;
    notes.push_back(fmt::format(
        "case '{}': {} readings, each predicted from {:.0f} runs some hundred thousand times: sampling takes about {} "
        "of processor time or more. A third of the runs take a ninth of it ([surrogate] runs_most = {:.0f}), a third "
        "of the readings a third (the means of neighbours in [[observe]] file)",
        one.name, readings, most_runs, data::rough_duration_text(seconds), std::floor(most_runs / 3.0)));
  }
  return notes;
}

}  // namespace uq
