#include "campaign/posterior_campaign.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "campaign/out_files.hpp"

namespace campaign {
namespace {

constexpr std::size_t failures_most = 20;

/// Runs of the study's own design, all materials.
int design_size(const data::Study& study) {
  int runs = 0;
  for (const data::Material& material : study.materials) runs += material.runs.value_or(study.training.runs);
  return runs;
}

void append(std::vector<std::string>& all, const std::vector<std::string>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

}  // namespace

PosteriorCampaign::PosteriorCampaign(const Workspace& workspace, const PosteriorLimits& limits, StudyRows rows)
    : workspace_(workspace), limits_(limits), rows_(std::move(rows)) {
  if (limits.runs > 0)
    most_ = limits.runs;
  else if (!limits.seconds)
    most_ = design_size(workspace.study);  // without a limit of the user's it ends where a new design would
  const std::optional<PosteriorRuns> before = read_posterior_runs(workspace);
  if (!before) return;
  continued_ = true;
  pending_ = without_rows(workspace, before->runs, rows_.all);
  if (!before->left || !most_) return;
  most_ = *before->left - static_cast<int>(before->runs.size() - pending_.size());
  if (*most_ <= 0) pending_.clear();
}

std::optional<int> PosteriorCampaign::runs_left() const {
  if (!most_) return {};
  return *most_ - static_cast<int>(totals_.finished);
}

bool PosteriorCampaign::end(CampaignEnding ending) {
  ending_ = ending;
  return false;
}

bool PosteriorCampaign::look() {
  if (pending_.empty()) pending_ = starting_runs(workspace_, rows_.all);
  if (!pending_.empty()) return false;
  assessment_ = assess(workspace_, rows_);
  shares_.emplace_back(rows_.table.rows.size(), assessment_.share());
  return true;
}

bool PosteriorCampaign::choose(double elapsed) {
  chosen_ = false;
  if (pending_.empty() && assessment_.settled(limits_.share)) return end(CampaignEnding::enough);
  const std::optional<int> left = runs_left();
  const int count = left ? std::min(limits_.batch, *left) : limits_.batch;
  if (count <= 0) return end(limits_.runs > 0 ? CampaignEnding::runs_made : CampaignEnding::design_made);
  if (limits_.seconds && elapsed + median_run_time(rows_.table) > *limits_.seconds) return end(CampaignEnding::time_up);
  if (pending_.empty()) {
    pending_ = choose_runs(workspace_, rows_, assessment_, count, static_cast<int>(totals_.failures.size())).runs;
    if (pending_.empty()) return end(CampaignEnding::nothing_to_learn);
    chosen_ = true;
  }
  if (left && static_cast<int>(pending_.size()) > *left) pending_.resize(static_cast<std::size_t>(*left));
  write_posterior_runs(workspace_, {.runs = pending_, .left = left});
  return true;
}

void PosteriorCampaign::take(const BatchResult& result) {
  rows_ = study_rows(workspace_);  // what the batch kept, without the runs that are not of the steady flow
  totals_.finished += result.finished;
  totals_.unsteady += result.unsteady;
  append(totals_.failures, result.failures);
  append(totals_.warnings, result.warnings);
  std::vector<PlannedRun> unfinished;
  for (std::size_t i = 0; i < pending_.size(); ++i)
    if (!result.ended[i]) unfinished.push_back(pending_[i]);
  pending_ = std::move(unfinished);
  write_posterior_runs(workspace_, {.runs = pending_, .left = runs_left()});
  if (result.finished == 0 && totals_.failures.size() > failures_most) end(CampaignEnding::too_many_failed);
}

void PosteriorCampaign::finish() const {
  std::error_code ignored;
  std::filesystem::remove(posterior_runs_path(workspace_), ignored);
}

int PosteriorCampaign::runs_to_go() const {
  if (shares_.size() < 2) return 0;
  const auto& [first_rows, first] = shares_.front();
  const auto& [last_rows, last] = shares_.back();
  if (!(last < first) || last_rows <= first_rows || last <= 0.0) return 0;
  const double rate = std::log(first / last) / static_cast<double>(last_rows - first_rows);
  return std::max(1, static_cast<int>(std::ceil(std::log(last / limits_.share) / rate)));
}

}  // namespace campaign
