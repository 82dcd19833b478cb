#include "campaign/slurm_jobs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <set>
#include <string_view>

#include "data/file_name.hpp"
#include "data/origin.hpp"

namespace campaign {
namespace {

std::optional<int> whole_number(std::string_view text) {
  int value = 0;
  const auto [rest, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || rest != text.data() + text.size() || text.empty()) return {};
  return value;
}

std::vector<std::string_view> parted(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t at = 0;;) {
    const std::size_t end = text.find(separator, at);
    parts.push_back(text.substr(at, end - at));
    if (end == std::string_view::npos) return parts;
    at = end + 1;
  }
}

bool has_one_of(const std::string& text, std::initializer_list<std::string_view> parts) {
  return std::any_of(parts.begin(), parts.end(),
                     [&](std::string_view part) { return text.find(part) != std::string::npos; });
}

/// squeue's compact states (its manual, JOB STATE CODES).
TaskState state_of(std::string_view word, std::string_view reason) {
  constexpr std::array<std::string_view, 9> over{"CD", "F", "TO", "NF", "BF", "DL", "OOM", "PR", "RV"};
  if (word == "CA") return TaskState::cancelled;
  if (std::find(over.begin(), over.end(), word) != over.end()) return TaskState::ended;
  if (word == "RH" || word == "SE") return TaskState::held;
  if (word == "PD")
    return reason.find("Held") != std::string_view::npos || reason.find("held") != std::string_view::npos
               ? TaskState::held
               : TaskState::waiting;
  if (word == "RQ" || word == "RF" || word == "RD") return TaskState::waiting;
  return TaskState::running;  // also completing, suspended, stopped, staging out
}

}  // namespace

std::vector<ArrayJob> split_runs(std::size_t runs, int runs_per_task, int max_array_size) {
  const auto per_task = static_cast<std::size_t>(std::max(1, runs_per_task));
  const std::size_t per_job = per_task * static_cast<std::size_t>(std::max(1, max_array_size));
  std::vector<ArrayJob> jobs;
  for (std::size_t first = 0; first < runs; first += per_job) {
    const std::size_t own = std::min(per_job, runs - first);
    jobs.push_back({.first = first,
                    .runs = own,
                    .tasks = static_cast<int>((own + per_task - 1) / per_task),
                    .runs_per_task = static_cast<int>(per_task)});
  }
  return jobs;
}

int usual_runs_per_task(double seconds, std::size_t runs) {
  constexpr double task_seconds = 600.0, most = 1000.0, fewest_tasks = 8.0;
  const double spread = std::clamp(std::ceil(static_cast<double>(runs) / fewest_tasks), 1.0, most);
  return seconds > 0.0 ? static_cast<int>(std::clamp(std::floor(task_seconds / seconds), 1.0, spread)) : 1;
}

TaskRuns runs_of_task(int task, int runs_per_task, std::size_t runs) {
  const auto per_task = static_cast<std::size_t>(std::max(1, runs_per_task));
  const std::size_t first = std::min(runs, static_cast<std::size_t>(std::max(0, task)) * per_task);
  return {first, std::min(runs, first + per_task)};
}

int parse_max_array_size(const std::string& config) {
  constexpr int slurms_default = 1001;
  constexpr std::string_view key = "MaxArraySize";
  for (const std::string_view line : parted(config, '\n')) {
    if (!line.starts_with(key)) continue;
    const std::size_t digits = line.find_first_of("0123456789");
    if (digits == std::string_view::npos) break;
    const std::size_t end = line.find_first_not_of("0123456789", digits);
    if (const auto value = whole_number(line.substr(digits, end - digits)); value && *value > 0) return *value;
  }
  return slurms_default;
}

std::optional<std::string> parse_job_id(const std::string& out) {
  const std::size_t end = out.find_first_not_of("0123456789");
  const std::string id = out.substr(0, end);
  const std::string_view rest = end == std::string::npos ? std::string_view() : std::string_view(out).substr(end);
  if (id.empty() || !(rest.empty() || rest.front() == ';' || rest.front() == '\n')) return {};
  return id;
}

Refusal refusal_of(const std::string& error) {
  if (has_one_of(error, {"SubmitJob", "SubmitLimit", "temporarily unable", "Job violates accounting/QOS policy",
                         "MaxJobCount", "Resource temporarily unavailable"}))
    return Refusal::limit;
  if (has_one_of(error, {"ontact slurm controller", "timed out", "onnection refused", "nable to connect",
                         "ommunication", "Zero Bytes", "Transport", "Unable to establish", "backup controller",
                         "standby mode", "Unspecified error"}))
    return Refusal::silence;
  return Refusal::other;
}

std::string forbidden_option(const std::string& option) {
  const std::string word = option.substr(0, option.find_first_of("= "));
  const bool joined = word.size() > 2 && word[0] == '-' && word[1] != '-';  // -a0-3
  const std::string name = joined ? word.substr(0, 2) : word;
  for (const auto& [forbidden, why] : {std::pair{"--array", "demcal numbers the tasks"},
                                       {"-a", "demcal numbers the tasks"},
                                       {"--job-name", "demcal finds its jobs by their names"},
                                       {"-J", "demcal finds its jobs by their names"},
                                       {"--clusters", "demcal would look for the jobs elsewhere; set SLURM_CLUSTERS"},
                                       {"-M", "demcal would look for the jobs elsewhere; set SLURM_CLUSTERS"},
                                       {"--wrap", "demcal writes the script"},
                                       {"--wait", "demcal waits itself"},
                                       {"-W", "demcal waits itself"},
                                       {"--test-only", "nothing would be submitted"},
                                       {"--parsable", "demcal gives it"},
                                       {"--output", "demcal reads the tasks' output"},
                                       {"-o", "demcal reads the tasks' output"},
                                       {"--error", "demcal reads the tasks' output"},
                                       {"-e", "demcal reads the tasks' output"}})
    if (name == forbidden) return why;
  return option.starts_with("-") ? "" : "it does not begin with a hyphen";
}

std::vector<std::string> sbatch_words(const Submission& s) {
  // In the name of a file Slurm replaces what follows a '%'.
  std::string log;
  for (const char c : s.log) log += c == '%' ? std::string("%%") : std::string(1, c);
  std::vector<std::string> words{
      "sbatch",
      "--parsable",
      "--job-name=" + s.name,
      fmt::format("--array=0-{}{}", s.tasks - 1, s.at_once > 0 ? fmt::format("%{}", s.at_once) : std::string()),
      fmt::format("--output={}/%x-%a.txt", log),
      "--open-mode=append",
      "--requeue"};
  words.insert(words.end(), s.options.begin(), s.options.end());
  words.push_back(s.script);
  return words;
}

std::string job_script(const std::string& name, const std::vector<std::string>& program) {
  std::string command;
  for (const std::string& word : program) command += data::shell_word(word) + " ";
  return fmt::format(
      "#!/bin/sh\n# {}\n# {}: a task makes its runs and keeps each in its file\n"
      "exec {}--task \"$SLURM_ARRAY_TASK_ID\"\n",
      data::blank_mark(), name, command);
}

std::vector<std::string> squeue_words(const std::vector<std::string>& names) {
  return {"squeue",
          "--noheader",
          "--all",
          "--array",
          "--states=all",
          fmt::format("--name={}", fmt::join(names, ",")),
          "--format=%j|%F|%K|%t|%r"};
}

Queue parse_queue(const std::string& lines) {
  Queue queue;
  for (const std::string_view line : parted(lines, '\n')) {
    const std::vector<std::string_view> fields = parted(line, '|');
    if (fields.size() != 5) continue;
    const auto index = whole_number(fields[2]);
    if (!index) continue;
    queue[{std::string(fields[0]), *index}] = {.id = std::string(fields[1]),
                                               .state = state_of(fields[3], fields[4]),
                                               .word = std::string(fields[3]),
                                               .reason = std::string(fields[4])};
  }
  return queue;
}

Fate fate_of(const QueuedTask* task, const RunHistory& history, int most_tries) {
  if (task != nullptr && task->state == TaskState::cancelled) return Fate::left;
  if (task != nullptr && task->state != TaskState::ended) return Fate::wait;
  if (history.looks_without < 2) return Fate::wait;
  return history.advanced || history.tries < most_tries ? Fate::submit_again : Fate::failed;
}

std::string ending_text(const QueuedTask* task) {
  if (task == nullptr) return "left the queue without a result";
  if (task->word == "OOM") return "ran out of memory (--mem asks for more)";
  if (task->word == "TO") return "ran out of time before it could keep anything (--time asks for more)";
  if (task->word == "NF" || task->word == "BF") return "lost its node";
  if (task->word == "PR") return "was pre-empted";
  return "ended without a result";
}

std::string queue_text(const Queue& queue) {
  int running = 0, waiting = 0, held = 0;
  std::set<std::string> reasons;
  for (const auto& [key, task] : queue) {
    running += task.state == TaskState::running ? 1 : 0;
    held += task.state == TaskState::held ? 1 : 0;
    if (task.state != TaskState::waiting) continue;
    ++waiting;
    if (!task.reason.empty() && task.reason != "None") reasons.insert(task.reason);
  }
  std::vector<std::string> parts;
  if (running > 0) parts.push_back(fmt::format("{} running", running));
  if (waiting > 0)
    parts.push_back(fmt::format("{} waiting{}", waiting,
                                reasons.empty() ? std::string() : fmt::format(" ({})", fmt::join(reasons, ", "))));
  if (held > 0) parts.push_back(fmt::format("{} held (scontrol release lets them go)", held));
  return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace campaign
