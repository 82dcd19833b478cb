#include "cli/train_posterior.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <chrono>

#include "campaign/design.hpp"
#include "campaign/out_files.hpp"
#include "campaign/posterior_campaign.hpp"
#include "cli/make_runs.hpp"
#include "cli/train_slurm.hpp"
#include "data/interrupt.hpp"
#include "data/number_text.hpp"

namespace cli {
namespace {

std::string share_text(const data::Study& study, const Assessment& assessment) {
  const uq::SurrogateShare& worst = assessment.shares[assessment.worst];
  const std::string& name = study.cases[assessment.worst].name;
  if (worst.effective_draws < uq::least_effective)
    return fmt::format("the surrogate's error rules the posterior of case {}", name);
  const bool converged = assessment.cases[assessment.worst].draws.converged;
  return fmt::format("{:.0f} % of the posterior variance of {} (case {}) is the surrogate's{}", 100.0 * worst.share,
                     worst.parameter, name, converged ? "" : "; the sampler has not converged");
}

/// "about 40 more runs, 12 min on 2 jobs", as far as it can be told.
std::string cost_text(const PosteriorCampaign& campaign, int jobs) {
  const int more = campaign.runs_to_go();
  const double each = median_run_time(campaign.rows().table);
  const std::string time =
      each > 0.0 ? fmt::format(", a run takes {} of CPU time", data::duration_text(each)) : std::string();
  if (more == 0) return "how many more runs it takes cannot be told yet" + time;
  std::string text =
      fmt::format("about {} more at the pace so far", data::counted(static_cast<std::size_t>(more), "run"));
  if (each > 0.0)
    text += fmt::format(", {} on {}", data::duration_text(each * more / jobs),
                        data::counted(static_cast<std::size_t>(jobs), "job"));
  return text;
}

std::string ending_text(CampaignEnding ending, double share) {
  switch (ending) {
    case CampaignEnding::enough:
      return fmt::format("enough: no more than {:.0f} % is the surrogate's", 100.0 * share);
    case CampaignEnding::runs_made:
      return "the runs asked for are made";
    case CampaignEnding::design_made:
      return "as many runs as the study's design has are made (--runs N for more)";
    case CampaignEnding::time_up:
      return "the time is up";
    case CampaignEnding::nothing_to_learn:
      return "no run is expected to tell more";
    case CampaignEnding::too_many_failed:
      break;
  }
  return "too many runs failed";
}

nlohmann::json shares_json(const data::Study& study, const Assessment& assessment) {
  nlohmann::json all = nlohmann::json::array();
  for (std::size_t i = 0; i < assessment.shares.size(); ++i)
    all.push_back({{"case", study.cases[i].name},
                   {"surrogate_share", assessment.shares[i].share},
                   {"parameter", assessment.shares[i].parameter}});
  return all;
}

/// Lists the points for another code's runs in a file.
data::ExitStatus list_points(const Common& common, const Workspace& workspace, const PosteriorTraining& options) {
  const StudyRows rows = study_rows(workspace);
  for (const std::string& note : rows.notes) say(common, "note: " + note);
  const Assessment assessment = assess(workspace, rows);
  answer(common, share_text(workspace.study, assessment));
  const bool enough = assessment.settled(options.share);
  ChosenRuns chosen;
  if (!enough) chosen = choose_runs(workspace, rows, assessment, options.runs > 0 ? options.runs : 8);
  const std::string path = next_runs_path(workspace);
  std::vector<Point> points;
  for (const PlannedRun& run : chosen.runs) points.push_back(run.point);
  write_points(workspace, path, points);
  print_json(common, {{"cases", shares_json(workspace.study, assessment)},
                      {"points", chosen.runs.size()},
                      {"share_wanted", options.share},
                      {"next_runs", path}});
  if (enough) {
    answer(common, fmt::format("no runs are needed: that is no more than {:.0f} %", 100.0 * options.share));
  } else {
    answer(common, fmt::format("{} to run with your code: {}. Add what they give to {}, and give this command again",
                               data::counted(chosen.runs.size(), "point"), path, workspace.study.training.table));
  }
  return data::ExitStatus::done;
}

/// Tells the outcome of the campaign, in words and as JSON.
data::ExitStatus tell(const Common& common, const Workspace& workspace, const PosteriorCampaign& campaign,
                      const PosteriorTraining& options, const std::optional<BatchResult>& left_there,
                      bool interrupted) {
  const CampaignTotals& totals = campaign.totals();
  const std::size_t rows = campaign.rows().table.rows.size();
  say_faults(common, totals.warnings, totals.failures);
  const std::size_t unsteady = workspace.unsteady == Unsteady::use ? 0 : totals.unsteady;  // else they were asked for
  if (unsteady > 0)
    say(common, fmt::format("warning: {} of the new runs are not of the steady flow and train nothing", unsteady));
  nlohmann::json json = {{"finished", totals.finished},
                         {"failed", totals.failures},
                         {"warnings", totals.warnings},
                         {"unsteady", unsteady},
                         {"rows", rows},
                         {"share_wanted", options.share}};
  if (campaign.assessed()) json["cases"] = shares_json(workspace.study, campaign.assessment());
  if (left_there) json["slurm"] = slurm_json(left_there->left);
  print_json(common, json);
  if (left_there) return *tell_left(common, *left_there, options.slurm->detach);
  if (interrupted) {
    say(common, fmt::format("interrupted after {}; the same command goes on", data::counted(totals.finished, "run")));
    return data::ExitStatus::interrupted;
  }
  campaign.finish();
  answer(common, fmt::format("{}, {} in all; {}", data::counted(totals.finished, "new run"), rows,
                             ending_text(*campaign.ending(), options.share)));
  if (campaign.assessed() && !campaign.assessment().settled(options.share))
    answer(common, fmt::format("{}; to go on: {}", share_text(workspace.study, campaign.assessment()),
                               cost_text(campaign, options.jobs)));
  return totals.failures.empty() && (workspace.unsteady == Unsteady::use || totals.warnings.empty()) && unsteady == 0
             ? data::ExitStatus::done
             : data::ExitStatus::warning;
}

}  // namespace

double parse_duration(const std::string& text, const std::string& place) {
  try {
    if (const auto number = data::number_with_unit(text);
        number && !number->unit.empty() && data::convertible(number->unit, "s"))
      if (const double seconds = data::parse_unit(number->unit).to_si(number->digits); seconds > 0.0) return seconds;
  } catch (const std::invalid_argument&) {  // an unknown unit
  }
  throw data::InputError(data::ExitStatus::usage,
                         {place, fmt::format("'{}' is not a time", text), "write a number and a unit: 2h, 90min"});
}

data::ExitStatus train_until_posterior(const Common& common, const PosteriorTraining& options) {
  const data::InterruptGuard interrupt;
  const auto begin = std::chrono::steady_clock::now();
  const auto elapsed = [&] { return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count(); };
  const Workspace workspace = open_workspace(common);
  data::require_cases(workspace.study);
  if (!own_engine(workspace)) {
    const auto held = hold_out(workspace, Writes::results, "train");
    return list_points(common, workspace, options);
  }
  make_out(workspace, "runs");
  const auto held = hold_out(workspace, Writes::training, "train");
  StudyRows rows = study_rows(workspace);
  for (const std::string& note : rows.notes) say(common, "note: " + note);
  PosteriorCampaign campaign(
      workspace, {.share = options.share, .batch = options.jobs, .runs = options.runs, .seconds = options.seconds},
      std::move(rows));
  if (campaign.continued()) {
    const std::optional<int> left = campaign.runs_left();
    say(common, fmt::format("an unfinished campaign goes on{}",
                            left ? fmt::format(": {} left to it",
                                               data::counted(static_cast<std::size_t>(std::max(0, *left)), "run"))
                                 : ""));
  }

  std::optional<BatchResult> left_there;
  while (!campaign.ending() && !left_there && !interrupt.interrupted()) {
    if (campaign.look())
      say(common, fmt::format("{}: {}", data::counted(campaign.rows().table.rows.size(), "run"),
                              share_text(workspace.study, campaign.assessment())));
    if (!campaign.choose(elapsed())) break;
    if (campaign.chosen())
      for (const PlannedRun& run : campaign.batch())
        say(common, fmt::format("  next: {} {}", run.point.material, describe(workspace.study, run.point)));
    BatchResult made = make_runs(common, workspace, campaign.batch(), campaign.hand_over_rows(), campaign.rows().kept,
                                 {.jobs = options.jobs, .slurm = options.slurm}, interrupt.token());
    campaign.take(made);
    if (made.error) std::rethrow_exception(made.error);
    if (made.left.any()) left_there = std::move(made);
  }
  return tell(common, workspace, campaign, options, left_there, interrupt.interrupted());
}

}  // namespace cli
