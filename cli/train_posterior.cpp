#include "cli/train_posterior.hpp"

#include <fmt/core.h>

#include <chrono>
#include <cmath>
#include <filesystem>

#include "campaign/design.hpp"
#include "campaign/posterior_runs.hpp"
#include "cli/command.hpp"
#include "cli/train_slurm.hpp"
#include "data/interrupt.hpp"
#include "data/number_text.hpp"
#include "data/progress.hpp"

namespace cli {
namespace {

/// The worst case's share after each batch of this start.
struct Trail {
  std::vector<std::pair<std::size_t, double>> rows_and_share;
};

/// Runs that the share's fall so far, taken as exponential in the number of runs, asks for; 0 when it did not fall.
int runs_to_go(const Trail& trail, double target) {
  if (trail.rows_and_share.size() < 2) return 0;
  const auto& [first_rows, first] = trail.rows_and_share.front();
  const auto& [last_rows, last] = trail.rows_and_share.back();
  if (!(last < first) || last_rows <= first_rows || last <= 0.0) return 0;
  const double rate = std::log(first / last) / static_cast<double>(last_rows - first_rows);
  return std::max(1, static_cast<int>(std::ceil(std::log(last / target) / rate)));
}

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
std::string cost_text(const Trail& trail, const data::RunTable& table, const PosteriorTraining& options) {
  const int more = runs_to_go(trail, options.share);
  const double each = median_run_time(table);
  const std::string time =
      each > 0.0 ? fmt::format(", a run takes {} of CPU time", data::duration_text(each)) : std::string();
  if (more == 0) return "how many more runs it takes cannot be told yet" + time;
  std::string text = fmt::format("about {} more runs at the pace so far", more);
  if (each > 0.0) text += fmt::format(", {} on {} jobs", data::duration_text(each * more / options.jobs), options.jobs);
  return text;
}

/// Runs of the study's own design, all materials.
int design_size(const data::Study& study) {
  int runs = 0;
  for (const data::Material& material : study.materials) runs += material.runs.value_or(study.training.runs);
  return runs;
}

nlohmann::json shares_json(const data::Study& study, const Assessment& assessment) {
  nlohmann::json all = nlohmann::json::array();
  for (std::size_t i = 0; i < assessment.shares.size(); ++i)
    all.push_back({{"case", study.cases[i].name},
                   {"surrogate_share", assessment.shares[i].share},
                   {"parameter", assessment.shares[i].parameter}});
  return all;
}

/// For another code's runs: the points, in a file.
data::ExitStatus list_points(const Common& common, const Workspace& workspace, const PosteriorTraining& options) {
  const TrainingRows rows = training_rows(workspace);
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

}  // namespace

double parse_duration(const std::string& text, const std::string& place) {
  try {
    std::size_t used = 0;
    static_cast<void>(std::stod(text, &used));
    std::string unit = text.substr(used);
    unit.erase(0, unit.find_first_not_of(' '));
    const double seconds = data::parse_unit(unit.empty() ? "s" : unit).to_si(text.substr(0, used));
    if (data::convertible(unit.empty() ? "s" : unit, "s") && seconds > 0.0) return seconds;
  } catch (const std::exception&) {
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
  if (workspace.cases.empty()) {
    const auto held = hold_out(workspace, Writes::results, "train");
    return list_points(common, workspace, options);
  }
  make_out(workspace, "runs");
  const auto held = hold_out(workspace, Writes::training, "train");
  TrainingRows rows = training_rows(workspace);
  for (const std::string& note : rows.notes) say(common, "note: " + note);

  // What an interrupted batch left, then what a surrogate needs at the least, then the posterior's runs.
  std::vector<PlannedRun> pending;
  std::optional<int> most;  // new runs
  if (options.runs > 0) most = options.runs;
  // Without a limit of the user's it ends where a new design would.
  if (!most && !options.seconds) most = design_size(workspace.study);
  if (const std::optional<PosteriorRuns> before = read_posterior_runs(workspace)) {
    pending = without_rows(workspace, before->runs, rows.all);
    const auto finished = static_cast<int>(before->runs.size() - pending.size());
    if (before->left && most) most = *before->left - finished;
    if (before->left && most && *most <= 0) pending.clear();
    say(common, fmt::format("an unfinished campaign goes on{}",
                            before->left && most
                                ? fmt::format(": {} left to it",
                                              data::counted(static_cast<std::size_t>(std::max(0, *most)), "run"))
                                : ""));
  }
  std::size_t made = 0;
  std::size_t unsteady = 0;
  int failed = 0;
  Trail trail;
  Assessment assessment;
  std::vector<std::string> failures, warnings;
  std::string ending;
  std::optional<SlurmResult> left_there;
  for (;;) {
    if (pending.empty()) pending = starting_runs(workspace, rows.all);
    if (pending.empty()) {
      assessment = assess(workspace, rows);
      trail.rows_and_share.emplace_back(rows.table.rows.size(), assessment.share());
      say(common,
          fmt::format("{}: {}", data::counted(rows.table.rows.size(), "run"), share_text(workspace.study, assessment)));
      if (assessment.settled(options.share)) {
        ending = fmt::format("enough: no more than {:.0f} % is the surrogate's", 100.0 * options.share);
        break;
      }
    }
    int count = options.jobs;
    const std::optional<int> left = most ? std::optional(*most - static_cast<int>(made)) : std::nullopt;
    if (left) count = std::min(count, *left);
    if (count <= 0) {
      ending = options.runs > 0 ? "the runs asked for are made"
                                : "as many runs as the study's design has are made (--runs N for more)";
      break;
    }
    if (options.seconds && elapsed() + median_run_time(rows.table) > *options.seconds) {
      ending = "the time is up";
      break;
    }
    if (interrupt.interrupted()) break;
    if (pending.empty()) {
      const ChosenRuns chosen = choose_runs(workspace, rows, assessment, count, failed);
      pending = chosen.runs;
      if (pending.empty()) {
        ending = "no run is expected to tell more";
        break;
      }
      for (const PlannedRun& run : pending)
        say(common, fmt::format("  next: {} {}", run.point.material, describe(workspace.study, run.point)));
    }
    if (left && static_cast<int>(pending.size()) > *left) pending.resize(static_cast<std::size_t>(*left));
    write_posterior_runs(workspace, {.runs = pending, .left = left});
    SlurmResult batch;
    {
      data::Progress progress("training runs", pending.size(),
                              {.style = common.quiet ? data::ProgressStyle::quiet : data::ProgressStyle::automatic});
      const BatchOptions how{.jobs = options.jobs, .kept = rows.kept, .stop = interrupt.token(), .progress = &progress};
      if (options.slurm)
        batch = run_on_slurm(workspace, pending, std::move(rows.all), how, *options.slurm);
      else
        static_cast<BatchResult&>(batch) = run_batch(workspace, pending, std::move(rows.all), how);
    }
    rows = training_rows(workspace);  // what run_batch kept, without the runs that are not of the steady flow
    made += batch.finished;
    unsteady += batch.unsteady;
    failed += static_cast<int>(batch.failures.size());
    failures.insert(failures.end(), batch.failures.begin(), batch.failures.end());
    warnings.insert(warnings.end(), batch.warnings.begin(), batch.warnings.end());
    std::vector<PlannedRun> unfinished;
    for (std::size_t i = 0; i < pending.size(); ++i)
      if (!batch.ended[i]) unfinished.push_back(pending[i]);
    pending = std::move(unfinished);
    write_posterior_runs(
        workspace, {.runs = pending, .left = most ? std::optional(*most - static_cast<int>(made)) : std::nullopt});
    if (batch.error) std::rethrow_exception(batch.error);
    if (batch.with_slurm + batch.cancelled + batch.refused > 0) {
      left_there = std::move(batch);
      break;
    }
    if (interrupt.interrupted()) break;
    if (batch.finished == 0 && failed > 20) {
      ending = "too many runs failed";
      break;
    }
  }

  for (const std::string& warning : warnings) say(common, "warning: " + warning);
  for (const std::string& failure : failures) say(common, "failed: " + failure);
  if (workspace.unsteady == Unsteady::use) unsteady = 0;  // they were asked for
  if (unsteady > 0)
    say(common, fmt::format("warning: {} of the new runs are not of the steady flow and train nothing", unsteady));
  nlohmann::json json = {{"finished", made},
                         {"failed", failures},
                         {"warnings", warnings},
                         {"unsteady", unsteady},
                         {"rows", rows.table.rows.size()},
                         {"share_wanted", options.share}};
  if (!assessment.shares.empty()) json["cases"] = shares_json(workspace.study, assessment);
  if (left_there) json["slurm"] = slurm_json(*left_there);
  print_json(common, json);
  if (left_there) return *tell_left(common, *left_there, options.slurm->detach);
  if (interrupt.interrupted()) {
    say(common, fmt::format("interrupted after {}; the same command goes on", data::counted(made, "run")));
    return data::ExitStatus::interrupted;
  }
  std::error_code ignored;
  std::filesystem::remove(posterior_runs_path(workspace), ignored);
  answer(common, fmt::format("{} new runs, {} in all; {}", made, rows.table.rows.size(), ending));
  const bool open = !assessment.shares.empty() && !assessment.settled(options.share);
  if (open)
    answer(common, fmt::format("{}; to go on: {}", share_text(workspace.study, assessment),
                               cost_text(trail, rows.table, options)));
  return failures.empty() && unsteady == 0 ? data::ExitStatus::done : data::ExitStatus::warning;
}

}  // namespace cli
