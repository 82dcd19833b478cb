// demcal sample: posterior draws of every case, for ArviZ and others.
#include <fmt/core.h>

#include <algorithm>
#include <filesystem>

#include "campaign/out_files.hpp"
#include "cli/calibration.hpp"
#include "data/atomic_file.hpp"
#include "data/random.hpp"
#include "uq/calibrate/posterior_nc.hpp"
#include "uq/calibrate/simulation_calibration.hpp"
#include "uq/findings/wording.hpp"
#include "uq/posterior/support.hpp"
#include "uq/report/figure_ranks.hpp"

namespace cli {
namespace {

/// Simulation-based calibration of every case: sbc-CASE.json and a figure.
data::ExitStatus check_width(const Common& common, const Workspace& workspace,
                             const std::vector<uq::Emulator>& emulators, int replicates) {
  const std::filesystem::path out = workspace.out;
  nlohmann::json json = nlohmann::json::array();
  std::vector<std::string> warnings;
  make_out(workspace, "figures");
  for (std::size_t i = 0; i < workspace.study.cases.size(); ++i) {
    const uq::CaseModel model = uq::build_case(workspace.study, emulators, i);
    if (std::any_of(model.unknowns.begin(), model.unknowns.end(),
                    [](const uq::Unknown& unknown) { return !unknown.cut_from.empty(); })) {
      say(common, model.name + ": a cut posterior is not that of its own data, so its ranks are not checked");
      continue;
    }
    uq::SimulationCalibration found;
    {
      JobProgress progress(common, "simulating " + model.name);
      found = uq::simulate_calibration(
          model, {.replicates = replicates,
                  .seed = data::child_seed(workspace.study.seed, data::Purpose::simulation_case_seed,
                                           static_cast<std::uint32_t>(i)),
                  .progress = [&](double share) { progress("", share); }});
    }
    const std::string path = (out / ("sbc-" + model.name + ".json")).string();
    data::write_atomically(path, uq::to_json_text(found));
    uq::draw(uq::rank_figure(found, uq::slug("sbc-" + model.name)), (out / "figures").string(), {});
    if (!found.calibrated())
      warnings.push_back(
          fmt::format("{}: ranks lie outside the 95 % bands: intervals do not cover what they state", model.name));
    for (const uq::RankCheck& one : found.unknowns) {
      answer(common, fmt::format("{}: {}: ranks {} the 95 % bands; {:.0f} % intervals cover {:.1f} +- {:.1f} %",
                                 model.name, one.name, one.inside ? "inside" : "OUTSIDE", 100.0 * found.interval,
                                 100.0 * one.coverage, 100.0 * one.coverage_error));
    }
    if (found.failed > 0)
      say(common, fmt::format("{}: {} of {} replicates did not converge and are left out", model.name, found.failed,
                              replicates));
    json.push_back({{"case", model.name}, {"calibrated", found.calibrated()}, {"file", path}});
  }
  for (const std::string& warning : warnings) say(common, "warning: " + warning);
  print_json(common, {{"cases", json}, {"warnings", warnings}, {"status", warnings.empty() ? "ok" : "warning"}});
  return warnings.empty() ? data::ExitStatus::done : data::ExitStatus::warning;
}

/// A line for each unknown: mean, sd, central interval, and how well the draws know it.
std::string summary_line(const uq::NuisanceReport& unknown) {
  const uq::Rounding rounding = uq::rounding_of(unknown.mean, unknown.sd);
  constexpr uq::Typography ascii = uq::Typography::ascii;
  return fmt::format("  {}: {}, 90 % {}, R-hat {:.3f}, bulk ESS {:.0f}", unknown.name,
                     uq::format_with_error(unknown.mean, unknown.sd, unknown.unit, ascii),
                     uq::format_interval(unknown.q05, unknown.q95, rounding, unknown.unit, ascii), unknown.rhat,
                     unknown.ess_bulk);
}

nlohmann::json to_json(const uq::NuisanceReport& unknown) {
  return {{"name", unknown.name},         {"unit", unknown.unit},        {"mean", unknown.mean}, {"sd", unknown.sd},
          {"q05", unknown.q05},           {"q50", unknown.q50},          {"q95", unknown.q95},   {"rhat", unknown.rhat},
          {"ess_bulk", unknown.ess_bulk}, {"ess_tail", unknown.ess_tail}};
}

struct SampleCommand {
  Common common;
  std::shared_ptr<std::optional<data::Sampler>> sampler;
  int replicates = 0;  ///< of simulation-based calibration, instead of the draws; 0: none
  bool csv = false;
};

/// What is said of a case that was sampled.
struct Told {
  std::vector<std::string> lines, warnings;
  nlohmann::json json;
};

Told told_of(const uq::SampledCase& sampled, const std::string& name, const std::string& path) {
  Told told;
  const uq::Draws& draws = sampled.draws;
  if (!draws.converged) told.warnings.push_back(fmt::format("case {}: not converged ({})", name, draws.reason));
  const std::vector<std::string> doubts = uq::unsupported_parameters(*sampled.model, sampled.support);
  if (!doubts.empty()) told.warnings.push_back(fmt::format("case {}: {}", name, doubts.front()));
  told.lines.push_back(name + ": " +
                       (draws.chains.empty()
                            ? draws.reason
                            : fmt::format("{} chains of {} draws, R-hat at most {:.3f}, bulk ESS at least {:.0f}{}: {}",
                                          draws.chains.size(), draws.chains.front().x.rows(), draws.rhat.maxCoeff(),
                                          draws.ess_bulk.minCoeff(),
                                          draws.converged ? "" : ", NOT CONVERGED (" + draws.reason + ")", path)));
  nlohmann::json unknowns = nlohmann::json::array();
  for (int k = 0; k < sampled.model->dimension() && !draws.chains.empty(); ++k) {
    const uq::NuisanceReport unknown = uq::summary_of(sampled, k);
    told.lines.push_back(summary_line(unknown));
    unknowns.push_back(to_json(unknown));
  }
  told.json = {{"case", name},
               {"converged", draws.converged},
               {"file", path},
               {"unknowns", unknowns},
               {"usable", draws.converged && doubts.empty()}};
  return told;
}

data::ExitStatus sample(const SampleCommand& command) {
  const Common& common = command.common;
  const Workspace workspace = open_workspace(common);
  const data::Study& study = workspace.study;
  data::require_cases(study);
  const StudyRows rows = rows_to_learn_from(common, workspace);
  const auto held = hold_out(workspace, Writes::results, "sample");
  const uq::CalibrateOptions options{
      .surrogates = surrogate_options(common, workspace, rows), .sampler = *command.sampler, .seed = study.seed};
  const std::vector<uq::FittedSurrogate> fitted = uq::fit_surrogates(study, rows.table, options.surrogates);
  keep_surrogates(workspace, rows, options.surrogates, fitted);
  if (command.replicates > 0) {
    const bool warned = !say_warnings(common, rows, fitted).empty();
    const data::ExitStatus status = check_width(common, workspace, uq::emulators_of(fitted), command.replicates);
    return warned ? data::ExitStatus::warning : status;
  }
  nlohmann::json json = nlohmann::json::array();
  std::vector<std::string> lines, more;
  std::vector<uq::SupportReport> supports;
  for (std::size_t i = 0; i < study.cases.size(); ++i) {
    const std::string& name = study.cases[i].name;
    const uq::SampledCase sampled = [&] {
      JobProgress progress(common, "sampling " + name);
      uq::CalibrateOptions own = options;
      own.sampling_progress = [&](double share) { progress("", share); };
      return uq::sample_case(study, uq::emulators_of(fitted), i, own);
    }();
    const std::string path = posterior_path(workspace, name);
    const bool drawn = !sampled.draws.chains.empty();
    if (drawn) uq::write_posterior(path, study, sampled, study.seed);
    if (drawn && command.csv)
      data::write_atomically(std::filesystem::path(path).replace_extension(".csv"), uq::draws_csv(sampled));
    Told told = told_of(sampled, name, path);
    lines.insert(lines.end(), told.lines.begin(), told.lines.end());
    more.insert(more.end(), told.warnings.begin(), told.warnings.end());
    json.push_back(std::move(told.json));
    supports.push_back(sampled.support);
  }
  write_next_runs(workspace, supports);
  const std::vector<std::string> warnings = say_warnings(common, rows, fitted, more);
  for (const std::string& line : lines) answer(common, line);
  print_json(common, {{"cases", json}, {"status", warnings.empty() ? "ok" : "warning"}, {"warnings", warnings}});
  return warnings.empty() ? data::ExitStatus::done : data::ExitStatus::warning;
}

}  // namespace

Action add_sample(CLI::App& program) {
  const auto options = std::make_shared<SampleCommand>();
  CLI::App* command = add_study_command(program, "sample", "draw from the posterior of every case (posterior-CASE.nc)",
                                        "demcal sample data/developer", options->common);
  options->sampler = add_sampler_option(*command);
  command
      ->add_option("--sbc", options->replicates,
                   "instead: simulation-based calibration of every case with N synthetic data sets (sbc-CASE.json)")
      ->check(CLI::Range(20, 100000))
      ->type_name("N");
  command->add_flag("--csv", options->csv, "the draws as posterior-CASE.csv, too");
  return [options] { return sample(*options); };
}

}  // namespace cli
