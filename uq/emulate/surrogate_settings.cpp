#include "uq/emulate/surrogate_settings.hpp"

#include <fmt/core.h>

#include <algorithm>

namespace uq {

SurrogateOptions read_surrogate_options(const data::StudyFile& file, const data::Study& study) {
  const data::Section section = file.root().child("surrogate");
  SurrogateOptions options;
  surrogate::FitOptions& fit = options.fit;
  fit.seed = study.seed;
  fit.kernel = section.choice("kernel", fit.kernel);
  fit.mean = section.choice("mean", fit.mean);
  fit.estimate = section.choice("estimate", fit.estimate);
  fit.hyper_uncertainty = section.choice("hyper_parameters", fit.hyper_uncertainty);
  fit.between_runs = section.choice("between_runs", fit.between_runs);
  fit.nugget = section.flag("nugget", fit.nugget);
  fit.starts = static_cast<int>(section.integer("starts", {.low = 1, .high = 1000}, fit.starts));
  options.runs_most = static_cast<int>(section.integer("runs_most", {.low = 20, .high = 100000}, options.runs_most));
  options.stretch = section.flag("stretch", options.stretch);
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
