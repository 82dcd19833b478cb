#pragma once
// demcal train --until posterior: runs where they sharpen the posteriors of the study's cases.
#include <optional>

#include "campaign/slurm.hpp"
#include "cli/command.hpp"

namespace cli {

struct PosteriorTraining {
  int jobs = 1;                            ///< runs at the same time; also the number of runs of a batch
  int runs = 0;                            ///< most new runs; 0: as many as it takes
  std::optional<double> seconds;           ///< wall time
  double share = 0.1;                      ///< share of the posterior variance that may stay the surrogate's
  std::optional<SlurmOptions> slurm = {};  ///< where set, Slurm makes the batches
};

/// Parses "2h", "90 min". Throws InputError (64).
double parse_duration(const std::string& text, const std::string& place);

data::ExitStatus train_until_posterior(const Common& common, const PosteriorTraining& options);

}  // namespace cli
