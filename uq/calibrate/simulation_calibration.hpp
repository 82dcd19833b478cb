#pragma once
// Simulation-based calibration: is the posterior as wide as it claims? Of each of N replicates
//   u* ~ prior,   y* ~ N(mean(u*), S(u*))
// so the torque function at the measured settings is drawn from the emulator's process, not its mean, with every error
// that the case states. The posterior given y* is sampled, thinned to L draws, and the rank of u* among them is uniform
// on 0 .. L if all is right (S. Talts et al., arXiv:1804.06788 (2018)).
//
// The empirical distribution of the ranks is compared with simultaneous bands (T. Sailynoja, P.-C. Buerkner, A.
// Vehtari, Stat. Comput. 32:32 (2022)): at z = 1 / (L + 1) ... L / (L + 1) the number of ranks below z (L + 1) is
// binomial (N, z), and the pointwise level is the one at which uniform ranks stay inside everywhere with the wanted
// probability, found by simulation (their section 2.2). With k unknowns that probability is 1 - 0.05 / k for each. The
// coverage of the central intervals comes from the same replicates, with all draws.
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "uq/findings/rank_check.hpp"
#include "uq/infer/mixture_sampler.hpp"
#include "uq/posterior/case_model.hpp"

namespace uq {

struct SimulationOptions {
  int replicates = 100;
  int ranks = 99;         ///< L, number of draws kept of each replicate
  double interval = 0.9;  ///< probability of the intervals whose coverage is counted
  double level = 0.95;    ///< probability of the bands, simultaneous over all points and unknowns
  MixtureSamplerOptions sampler = {.draws = 400, .draws_max = 6400, .stop = {.ess_bulk = 600.0}};  ///< of a replicate
  int threads = 0;  ///< 0: as many as the machine has; each replicate takes one
  std::uint64_t seed = 1;
  std::function<void(double share)> progress = {};
};

SimulationCalibration simulate_calibration(const CaseModel& model, const SimulationOptions& options = {});

/// Bands of the empirical distribution of `count` ranks uniform on 0 .. rank_max, at z = i / (rank_max + 1).
struct RankBands {
  std::vector<double> z, low, high;
};
RankBands rank_bands(int count, int rank_max, double level, std::uint64_t seed);

/// Whether the ranks stay inside the bands everywhere.
bool inside_bands(const std::vector<int>& ranks, int rank_max, const RankBands& bands);

}  // namespace uq
