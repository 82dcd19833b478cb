// demcal sample: posterior draws of every case, for ArviZ and others.
#include <fmt/core.h>

#include "cli/calibration.hpp"
#include "uq/posterior_nc.hpp"

namespace cli {

Action add_sample(CLI::App& program) {
  const auto common = std::make_shared<Common>();
  add_study_command(program, "sample", "draw from the posterior of every case (posterior-CASE.nc)",
                    "demcal sample data/developer", *common);
  return [common] {
    const Workspace workspace = open_workspace(*common);
    const data::Study& study = workspace.study;
    const TrainingRows rows = rows_to_learn_from(*common, workspace);
    make_out(workspace);
    const uq::CalibrateOptions options{.seed = study.seed};
    const std::vector<uq::FittedSurrogate> fitted = uq::fit_surrogates(study, rows.table, options.surrogates);
    save_surrogates(workspace, rows.table, fitted);
    nlohmann::json json = nlohmann::json::array();
    bool converged = true;
    for (std::size_t i = 0; i < study.cases.size(); ++i) {
      const uq::SampledCase sampled = uq::sample_case(study, uq::emulators_of(fitted), i, options);
      const std::string path = posterior_path(workspace, study.cases[i].name);
      const uq::Draws& draws = sampled.draws;
      converged = converged && draws.converged;
      if (!draws.chains.empty()) uq::write_posterior(path, study, sampled, study.seed);
      const std::string found =
          draws.chains.empty()
              ? draws.reason
              : fmt::format("{} chains of {} draws, R-hat at most {:.3f}, bulk ESS at least {:.0f}{}: {}",
                            draws.chains.size(), draws.chains.front().x.rows(), draws.rhat.maxCoeff(),
                            draws.ess_bulk.minCoeff(), draws.converged ? "" : ", NOT CONVERGED (" + draws.reason + ")",
                            path);
      say(*common, study.cases[i].name + ": " + found);
      json.push_back({{"case", study.cases[i].name}, {"converged", draws.converged}, {"file", path}});
    }
    print_json(*common, {{"cases", json}});
    return converged ? data::ExitStatus::done : data::ExitStatus::warning;
  };
}

}  // namespace cli
