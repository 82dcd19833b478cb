#include "campaign/slurm_record.hpp"

#include <fmt/core.h>
#include <unistd.h>

#include <cctype>
#include <chrono>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

#include "data/atomic_file.hpp"
#include "data/error.hpp"
#include "data/folder_lock.hpp"
#include "data/hash.hpp"
#include "data/origin.hpp"

namespace campaign {
namespace {
namespace fs = std::filesystem;

constexpr int format = 1;

std::string record_path(const std::string& out) { return (fs::path(slurm_folder(out)) / "campaign.json").string(); }

/// Begins with what a person knows the study by; the digits are those of this campaign alone.
std::string new_prefix(const std::string& out, const std::string& study) {
  std::string known;
  for (const char c : study.substr(0, 20))
    known += std::isalnum(static_cast<unsigned char>(c)) != 0 ? std::string(1, c) : std::string("-");
  const auto now = std::chrono::system_clock::now().time_since_epoch().count();
  return fmt::format(
      "demcal-{}-{}", known,
      data::hash_text(fmt::format("{} {} {} {}", out, data::machine_name(), ::getpid(), now)).substr(0, 8));
}

SlurmRecord from_json(const nlohmann::json& json) {
  SlurmRecord record{.prefix = json.at("prefix"), .next = json.at("next"), .jobs = {}, .runs = {}};
  for (const auto& [name, job] : json.at("jobs").items())
    record.jobs[name] = {.id = job.at("id"), .tasks = job.at("tasks")};
  for (const auto& [name, run] : json.at("runs").items())
    record.runs[name] = {
        .job = run.at("job"), .task = run.at("task"), .tries = run.at("tries"), .steps = run.at("steps")};
  std::erase_if(record.runs, [&](const auto& run) { return !record.jobs.contains(run.second.job); });
  return record;
}

void drop_ended_jobs(SlurmRecord& record) {
  std::set<std::string> used;
  for (const auto& [name, run] : record.runs) used.insert(run.job);
  std::erase_if(record.jobs, [&](const auto& job) { return !used.contains(job.first); });
}

}  // namespace

std::string slurm_folder(const std::string& out) { return (fs::path(out) / "slurm").string(); }

SlurmRecord load_slurm_record(const std::string& out, const std::string& study) {
  const std::string path = record_path(out);
  if (data::origin_of(path) != data::Origin::changed && fs::exists(path)) {
    try {
      const nlohmann::json json = nlohmann::json::parse(data::read_file(path));
      if (json.at("format") == format) return from_json(json);
    } catch (const nlohmann::json::exception&) {
      // Damaged: the runs are submitted again, and those that are made twice give the same bits.
    }
  }
  return {.prefix = new_prefix(out, study), .next = 1, .jobs = {}, .runs = {}, .saved = {}};
}

void save_slurm_record(const std::string& out, SlurmRecord& record) {
  drop_ended_jobs(record);
  nlohmann::json json{{"format", format},
                      {"prefix", record.prefix},
                      {"next", record.next},
                      {"jobs", nlohmann::json::object()},
                      {"runs", nlohmann::json::object()}};
  for (const auto& [name, job] : record.jobs) json["jobs"][name] = {{"id", job.id}, {"tasks", job.tasks}};
  for (const auto& [name, run] : record.runs)
    json["runs"][name] = {{"job", run.job}, {"task", run.task}, {"tries", run.tries}, {"steps", run.steps}};
  std::string text = json.dump(1);
  if (text == record.saved) return;
  data::write_atomically(record_path(out), text);
  record.saved = std::move(text);
}

std::vector<std::string> job_ids(const SlurmRecord& record) {
  std::vector<std::string> ids;
  for (const auto& [name, job] : record.jobs)
    if (!job.id.empty()) ids.push_back(job.id);
  return ids;
}

}  // namespace campaign
