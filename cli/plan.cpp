// demcal plan: which measurement to make next, or which training runs, for the parameter that is known least.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "campaign/levels.hpp"
#include "campaign/out_files.hpp"
#include "campaign/posterior_runs.hpp"
#include "cli/calibration.hpp"
#include "data/atomic_file.hpp"
#include "data/provenance.hpp"
#include "uq/findings/report_file.hpp"
#include "uq/plan/plan.hpp"
#include "uq/plan/unmeasured.hpp"
#include "uq/posterior/support.hpp"
#include "uq/report/html.hpp"
#include "uq/report/plan.hpp"

namespace cli {
namespace {

namespace fs = std::filesystem;

constexpr int runs_listed = 4;  // training runs shown beside the measurements

struct PlanCommand {
  Common common;
  std::string about, only;
  double budget = 0.0;
  int batch = 1;
  bool prior = false;
};

/// Indices of the cases that are asked for.
std::vector<std::size_t> chosen_cases(const PlanCommand& options, const Workspace& workspace) {
  std::vector<std::size_t> chosen;
  std::vector<std::string> names;
  for (std::size_t i = 0; i < workspace.study.cases.size(); ++i) {
    names.push_back(workspace.study.cases[i].name);
    if (options.only.empty() || options.only == names.back()) chosen.push_back(i);
  }
  if (names.empty())
    throw data::InputError(data::ExitStatus::bad_study, {data::shown_path(workspace.study.file),
                                                         "names no parameter that is free: nothing can be planned",
                                                         "add a section like [parameters.friction]"});
  if (chosen.empty())
    throw data::InputError(data::ExitStatus::usage, {"--case", fmt::format("the study has no case '{}'", options.only),
                                                     fmt::format("choose one of: {}", fmt::join(names, ", "))});
  // A parameter is free in some cases only: those that do not know it have nothing to plan.
  const std::string& about = options.about.empty() ? workspace.plan.about : options.about;
  if (about.empty() || !options.only.empty()) return chosen;
  std::vector<std::size_t> knowing;
  for (const std::size_t i : chosen) {
    const std::vector<std::string>& free = workspace.study.cases[i].free;
    if (std::find(free.begin(), free.end(), about) != free.end()) knowing.push_back(i);
  }
  if (!knowing.empty()) return knowing;
  std::vector<std::string> parameters;
  for (const data::Parameter& one : workspace.study.parameters) parameters.push_back(one.name);
  throw data::InputError(data::ExitStatus::usage, {"--about", fmt::format("no case frees a parameter '{}'", about),
                                                   fmt::format("choose one of: {}", fmt::join(parameters, ", "))});
}

/// A plan on a posterior needs one; the error says that a plan on the prior needs none.
void require_measurements(const Workspace& workspace) {
  try {
    data::require_cases(workspace.study);
  } catch (const data::InputError& error) {
    std::vector<data::Problem> problems = error.problems;
    for (data::Problem& problem : problems) problem.remedy += "; before any measurement: demcal plan --prior";
    throw data::InputError(error.status, std::move(problems));
  }
}

std::string text_of(const Workspace& workspace, const Point& point) {
  return point.material + (point.material.empty() ? "" : ": ") + describe(workspace.study, point);
}

/// The training runs that would sharpen the posterior most, and their cost, beside the measurements.
void add_runs(const Workspace& workspace, const StudyRows& rows, const Assessment& of_case, uq::PlanReport& plan) {
  const ChosenRuns runs = choose_runs(workspace, rows, of_case, runs_listed);
  constexpr double seen = 5e-4;  // of the mean square: below, runs change nothing
  plan.runs.variance_before = runs.variance_before;
  plan.runs.variance_after = runs.variance_after_expected;
  if (runs.variance_before < seen) return;
  for (const PlannedRun& run : runs.runs) {
    const std::string text = text_of(workspace, run.point);
    const bool again = std::find(plan.runs.points.begin(), plan.runs.points.end(), text) != plan.runs.points.end();
    plan.runs.points.push_back(text + (again ? ", once more with another seed" : ""));
  }
  plan.runs.seconds = median_run_time(rows.all) * static_cast<double>(runs.runs.size());
}

/// A case's plan, and the unknowns of the posterior that it was made on; none of a plan on the prior.
struct Planned {
  uq::CaseReport plan;
  std::vector<uq::NuisanceReport> known;
};

/// Whether the report's posterior is the plan's: the same mean and sd of each parameter, but for the draws' own error.
bool is_of_posterior(const Planned& planned, const uq::CaseReport& report) {
  constexpr double share = 0.15;  // of an sd
  return std::all_of(planned.known.begin(), planned.known.end(), [&](const uq::NuisanceReport& known) {
    const auto found = std::find_if(report.parameters.begin(), report.parameters.end(),
                                    [&](const uq::ParameterReport& one) { return one.name == known.name; });
    return found == report.parameters.end() || (std::abs(found->mean - known.mean) <= share * found->sd &&
                                                std::abs(found->sd - known.sd) <= share * found->sd);
  });
}

/// Puts the plans into the report of the last calibration, where there is one of this study. Says of which cases the
/// report has another posterior: their plans are left out.
std::vector<std::string> add_to_report(const Workspace& workspace, const std::vector<Planned>& all) {
  std::vector<std::string> other;
  const std::string path = results_path(workspace);
  if (!fs::exists(path)) return other;
  uq::CalibrationReport report = uq::load_report(path);
  bool any = false;
  for (const Planned& planned : all)
    for (uq::CaseReport& one : report.cases) {
      if (one.name != planned.plan.name) continue;
      if (!is_of_posterior(planned, one)) {
        other.push_back(
            fmt::format("case {}: report.json holds the posterior of other data, runs or priors: this plan is "
                        "not put into it (run demcal calibrate again)",
                        one.name));
        continue;
      }
      one.plan = planned.plan.plan;
      any = true;
    }
  if (!any) return other;
  uq::save_report(report, path);
  uq::write_report_html(report, workspace.out);
  return other;
}

/// The doubts about a posterior that is planned on.
std::vector<std::string> doubts_about(const std::string& name, const uq::SampledCase& sampled) {
  std::vector<std::string> doubts;
  if (!sampled.draws.converged)
    doubts.push_back(fmt::format("case {}: the chains have not converged: {}", name, sampled.draws.reason));
  const std::vector<std::string> unsupported = uq::unsupported_parameters(*sampled.model, sampled.support);
  const auto why = std::find_if(unsupported.begin(), unsupported.end(), [](const auto& text) { return !text.empty(); });
  if (why != unsupported.end())
    doubts.push_back(
        fmt::format("case {}: {}. The plan rests on what the surrogate makes of that: make runs there "
                    "first (demcal train STUDY --until posterior, or next-runs.csv of calibrate)",
                    name, *why));
  return doubts;
}

struct Plans {
  std::vector<Planned> planned;
  std::vector<std::string> doubts;  ///< doubts about what is planned on, and cases that cannot be planned
};

/// One plan a case; fits the surrogates of `assessment`. A case that observes nothing is given a reading in the study
/// (uq/plan/unmeasured.hpp).
Plans make_plans(const PlanCommand& options, Workspace& workspace, const std::vector<std::size_t>& cases,
                 const StudyRows& rows, Assessment& assessment) {
  data::Study& study = workspace.study;
  const Common& common = options.common;
  const uq::CalibrateOptions calibrate{.surrogates = surrogate_options(common, workspace, rows), .seed = study.seed};
  JobProgress progress(common, "planning");
  assessment.surrogates = uq::fit_surrogates(study, rows.table, calibrate.surrogates);
  keep_surrogates(workspace, rows, calibrate.surrogates, assessment.surrogates);
  progress("", 0.2);
  const std::vector<uq::Emulator> emulators = uq::emulators_of(assessment.surrogates);
  uq::plan::PlanOptions how{.about = options.about,
                            .budget = options.budget > 0.0 ? std::optional(options.budget) : std::nullopt,
                            .batch = options.batch,
                            .prior = options.prior,
                            .seed = study.seed};
  how.candidates.coarse_grained = coarse_levels(workspace);
  Plans made;
  const double span = 0.8 / static_cast<double>(cases.size());
  for (std::size_t n = 0; n < cases.size(); ++n) {
    const double from = 0.2 + span * static_cast<double>(n);
    how.progress = [&](double share) { progress("", from + span * (0.3 + 0.7 * share)); };
    const uq::SampledCase sampled = options.prior ? uq::plan::unmeasured_case(study, emulators, cases[n])
                                                  : uq::sample_case(study, emulators, cases[n], calibrate);
    assessment.cases = {sampled};
    Planned one;
    one.plan.name = study.cases[cases[n]].name;
    try {
      one.plan.plan = uq::plan::make_plan(study, emulators, cases[n], sampled, workspace.plan, how);
      if (!options.prior) {
        add_runs(workspace, rows, assessment, *one.plan.plan);
        for (int k = 0; k < sampled.model->dimension(); ++k) one.known.push_back(uq::summary_of(sampled, k));
        for (std::string& doubt : doubts_about(one.plan.name, sampled)) made.doubts.push_back(std::move(doubt));
      }
      made.planned.push_back(std::move(one));
    } catch (const data::InputError& error) {
      if (error.status != data::ExitStatus::bad_data || cases.size() == 1) throw;
      made.doubts.push_back(data::describe(error.problems));
    }
  }
  return made;
}

data::ExitStatus plan(const PlanCommand& options) {
  const Common& common = options.common;
  Workspace workspace = open_workspace(common);
  if (options.prior)
    workspace.study = uq::plan::with_cases(workspace.study);
  else
    require_measurements(workspace);
  const data::Study& study = workspace.study;
  const std::vector<std::size_t> cases = chosen_cases(options, workspace);
  const StudyRows rows = rows_to_learn_from(common, workspace);
  const auto held = hold_out(workspace, Writes::results, "plan");
  Assessment assessment;
  auto [planned, doubts] = make_plans(options, workspace, cases, rows, assessment);
  if (planned.empty())
    throw data::InputError(data::ExitStatus::bad_data,
                           {study.file, "no case can be planned on: " + doubts.front(), "see demcal calibrate"});

  std::vector<uq::CaseReport> plans;
  for (const Planned& one : planned) plans.push_back(one.plan);
  const nlohmann::ordered_json json = {
      {"format", 1}, {"demcal", data::program_version()}, {"study", study.name}, {"plans", uq::plans_json(plans)}};
  const std::string path = plan_path(workspace);
  data::write_atomically(path, uq::text_of(json));
  for (std::string& other : add_to_report(workspace, planned)) doubts.push_back(std::move(other));
  const std::vector<std::string> warnings = say_warnings(common, rows, assessment.surrogates, doubts);
  for (const uq::CaseReport& one : plans) answer(common, uq::plan_text(one.name, *one.plan));
  answer(common, "Plan: " + path);
  print_json(common, nlohmann::json::parse(json.dump()));
  return warnings.empty() ? data::ExitStatus::done : data::ExitStatus::warning;
}

}  // namespace

Action add_plan(CLI::App& program) {
  const auto options = std::make_shared<PlanCommand>();
  CLI::App* command =
      add_study_command(program, "plan", "what to measure next: which reading teaches most of a parameter, per cost",
                        "demcal plan data/developer --about friction --batch 2", options->common);
  command->add_option("--about", options->about, "parameter to learn of (default: the one that is known least)");
  command->add_option("--case", options->only, "this case alone");
  command->add_option("--budget", options->budget, "total cost at most, as [plan] counts it")
      ->check(number_in(1e-300, 1e300, "a cost above 0"));
  command->add_option("--batch", options->batch, "the best sets of up to so many readings, too")
      ->check(CLI::Range(1, 4));
  command->add_flag("--prior", options->prior,
                    "as if nothing had been measured yet; a study needs neither [[observe]] nor [[calibrate]] for it");
  return [options] { return plan(*options); };
}

}  // namespace cli
