#include "campaign/slurm_commands.hpp"

#include <fmt/core.h>

#include <cstring>

#include "data/error.hpp"

namespace campaign {
namespace {

/// The last line that says something.
std::string last_line(std::string text) {
  while (!text.empty() && (text.back() == '\n' || text.back() == ' ')) text.pop_back();
  const std::size_t at = text.rfind('\n');
  return at == std::string::npos ? text : text.substr(at + 1);
}

}  // namespace

data::ProgramEnd SlurmCommands::run(std::vector<std::string> words) const {
  // The user's defaults of squeue could hide our jobs; SBATCH_WAIT would keep sbatch until the job's end. Ctrl-C spares
  // them, as a submission that is half done is in doubt.
  return start_({.words = std::move(words), .folder = {}, .without = {"SQUEUE_", "SBATCH_WAIT="}, .spared = true});
}

void SlurmCommands::require_programs() const {
  for (const char* program : {"sbatch", "squeue", "scontrol"}) {
    const data::ProgramEnd end = run({program, "--version"});
    if (end.start_error == 0) continue;
    throw data::InputError(
        data::ExitStatus::missing_program,
        {program, fmt::format("cannot be started ({}), but --slurm works through it", std::strerror(end.start_error)),
         "start demcal where Slurm's programs are, on a login node of the cluster (Debian: apt-get install "
         "slurm-client), or train here, without --slurm"});
  }
  // A controller that is down comes back; programs that know of no cluster never will.
  const data::ProgramEnd config = run({"scontrol", "show", "config"});
  const std::string said = last_line(config.err);
  if (config.exit_status != 0 && said.find("onfiguration") != std::string::npos)
    throw data::InputError(data::ExitStatus::missing_program,
                           {"scontrol", fmt::format("knows of no cluster here: {}", said),
                            "start demcal on a login node of the cluster, or name its slurm.conf in SLURM_CONF"});
}

std::optional<int> SlurmCommands::max_array_size() const {
  const data::ProgramEnd end = run({"scontrol", "show", "config"});
  if (end.exit_status != 0) return {};
  return parse_max_array_size(end.out);
}

SlurmCommands::Submitted SlurmCommands::submit(const Submission& submission) const {
  const data::ProgramEnd end = run(sbatch_words(submission));
  if (end.exit_status == 0)
    if (const auto id = parse_job_id(end.out)) return {.id = id};
  return {.id = {}, .refusal = refusal_of(end.err), .said = last_line(end.err.empty() ? end.out : end.err)};
}

SlurmCommands::Seen SlurmCommands::ask(const std::vector<std::string>& job_names) const {
  const data::ProgramEnd end = run(squeue_words(job_names));
  if (end.start_error != 0) return {.answered = false, .queue = {}, .said = std::strerror(end.start_error)};
  if (end.exit_status != 0) return {.answered = false, .queue = {}, .said = last_line(end.err)};
  return {.answered = true, .queue = parse_queue(end.out)};
}

}  // namespace campaign
