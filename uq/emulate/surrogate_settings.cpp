#include "uq/emulate/surrogate_settings.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace uq {
namespace {

/// One of the named values, the first by default.
template <class Value>
Value choose(const data::Section& section, const char* key, const std::vector<std::pair<std::string, Value>>& options) {
  std::vector<std::string> names;
  for (const auto& [name, value] : options) names.push_back(name);
  const std::string chosen = section.choice(key, names, names.front());
  return std::find_if(options.begin(), options.end(), [&](const auto& option) { return option.first == chosen; })
      ->second;
}

}  // namespace

SurrogateOptions read_surrogate_options(const data::StudyFile& file, const data::Study& study) {
  using namespace surrogate;
  const data::Section section = file.root().child("surrogate");
  SurrogateOptions options;
  FitOptions& fit = options.fit;
  fit.seed = study.seed;
  fit.kernel = choose<Kernel>(section, "kernel",
                              {{"matern 5/2", Kernel::matern52},
                               {"matern 3/2", Kernel::matern32},
                               {"squared exponential", Kernel::squared_exponential}});
  fit.mean = choose<MeanBasis>(section, "mean",
                               {{"constant", MeanBasis::constant},
                                {"zero", MeanBasis::zero},
                                {"linear", MeanBasis::linear},
                                {"quadratic", MeanBasis::quadratic},
                                {"trend", MeanBasis::trend}});
  fit.estimate = choose<Estimate>(
      section, "estimate",
      {{"maximum a posteriori", Estimate::maximum_a_posteriori}, {"maximum likelihood", Estimate::maximum_likelihood}});
  fit.hyper_uncertainty = choose<HyperUncertainty>(section, "hyper_parameters",
                                                   {{"integrated if few", HyperUncertainty::integrated_if_few},
                                                    {"plugged in", HyperUncertainty::plug_in},
                                                    {"integrated", HyperUncertainty::integrated}});
  fit.between_runs = choose<BetweenRuns>(section, "between_runs",
                                         {{"doubted", BetweenRuns::doubted}, {"trusted", BetweenRuns::trusted}});
  fit.nugget = section.flag("nugget", fit.nugget);
  fit.starts = static_cast<int>(section.integer("starts", {.low = 1, .high = 1000}, fit.starts));
  options.runs_most = static_cast<int>(section.integer("runs_most", {.low = 20, .high = 100000}, options.runs_most));
  options.log_outputs = section.texts("log_outputs");
  for (const std::string& name : options.log_outputs) {
    if (std::none_of(study.outputs.begin(), study.outputs.end(), [&](const auto& o) { return o.name == name; }))
      section.problem("log_outputs", fmt::format("'{}' is not an output of the study", name), "name one of [outputs]");
    else if (!study.training.low.empty())
      section.problem("log_outputs",
                      fmt::format("'{}' has a cheaper level ([training] low), which needs a linear scale", name),
                      "leave the output out of log_outputs, or leave out [training] low");
  }
  return options;
}

}  // namespace uq
