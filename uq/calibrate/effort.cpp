#include "uq/calibrate/effort.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "data/error.hpp"
#include "data/observations.hpp"
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

/// The sizes that each evaluation of a case's likelihood works on.
class Load {
 public:
  void add(double readings, double runs) { parts_.push_back({readings, runs}); }
  /// The time of a sampling with these shares of the runs and of the readings.
  double seconds(double of_runs, double of_readings) const {
    double operations = 0.0;
    for (const Part& part : parts_) {
      const double n = of_runs * part.runs, r = of_readings * part.readings;
      operations += r * n * n + r * r * n + r * r * r / 3.0;
    }
    return evaluations * operations / operations_per_second;
  }
  double readings() const {
    double sum = 0.0;
    for (const Part& part : parts_) sum += part.readings;
    return sum;
  }
  double most_runs() const {
    double most = 0.0;
    for (const Part& part : parts_) most = std::max(most, part.runs);
    return most;
  }

 private:
  struct Part {
    double readings = 0.0, runs = 0.0;
  };
  std::vector<Part> parts_;
};

Load load_of(const data::Study& study, const data::CalibrationCase& one, const data::RunTable& table,
             const SurrogateOptions& options) {
  // A setting that was read again costs nothing more (uq/posterior/distinct.hpp).
  std::map<std::pair<std::string, std::size_t>, std::set<std::vector<double>>> settings;
  for (const data::ObservationSet& set : study.observations) {
    if (std::find(one.observe.begin(), one.observe.end(), set.name) == one.observe.end()) continue;
    for (std::size_t column = 0; column < set.outputs.size(); ++column)
      for (const std::size_t i : data::points_with(set, column))
        settings[{set.material, set.outputs[column]}].insert(set.points[i].controls);
  }
  Load load;
  for (const auto& [of, different] : settings)
    load.add(static_cast<double>(different.size()), training_runs(table, of.first, options));
  return load;
}

}  // namespace

double sampling_seconds(const data::Study& study, const data::CalibrationCase& one, const data::RunTable& table,
                        const SurrogateOptions& options) {
  return load_of(study, one, table, options).seconds(1.0, 1.0);
}

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
    const Load load = load_of(study, one, table, options);
    const double seconds = load.seconds(1.0, 1.0);
    if (seconds < limits.seconds) continue;
    const auto share = [&](double of) { return 100.0 * of / seconds; };
    notes.push_back(fmt::format(
        "case '{}': {:.0f} different readings, each predicted from {:.0f} runs some hundred thousand times: sampling "
        "takes about {} of processor time. A third of the runs take {:.0f} % of it ([surrogate] runs_most = {:.0f}), a "
        "third of the readings {:.0f} % (the means of neighbours in [[observe]] file)",
        one.name, load.readings(), load.most_runs(), data::rough_duration_text(seconds),
        share(load.seconds(1.0 / 3.0, 1.0)), std::floor(load.most_runs() / 3.0), share(load.seconds(1.0, 1.0 / 3.0))));
  }
  return notes;
}

}  // namespace uq
