#pragma once
// Slurm's programs: sbatch, squeue, scontrol. A controller that does not answer is a value, not an exception.
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "campaign/slurm_jobs.hpp"
#include "data/program.hpp"

namespace campaign {

class SlurmCommands {
 public:
  using Start = std::function<data::ProgramEnd(const data::ProgramCall&)>;
  explicit SlurmCommands(Start start) : start_(std::move(start)) {}

  /// Throws InputError (69) where sbatch, squeue or scontrol cannot be started, or know of no cluster.
  void require_programs() const;

  /// The cluster's MaxArraySize; none while the controller does not answer.
  std::optional<int> max_array_size() const;

  struct Submitted {
    std::optional<std::string> id;     ///< number of the job, when sbatch took it
    Refusal refusal = Refusal::other;  ///< why sbatch took no job
    std::string said = {};             ///< words of sbatch
  };
  Submitted submit(const Submission& submission) const;

  struct Seen {
    bool answered = false;
    Queue queue;
    std::string said = {};  ///< words of squeue, when it has no answer
  };
  Seen ask(const std::vector<std::string>& job_names) const;

 private:
  data::ProgramEnd run(std::vector<std::string> words) const;
  Start start_;
};

}  // namespace campaign
