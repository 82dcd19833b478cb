#pragma once
// Counter-based random streams: the n-th number of a stream is a function of (seed, purpose, index, n) alone,
// so a run's result never depends on what else was drawn, or on threads.
//
// Philox4x32-10: J. K. Salmon et al., "Parallel random numbers: as easy as 1, 2, 3", SC'11 (2011).
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

namespace data {

/// What a stream is drawn for. Two purposes never share numbers under one seed. Each purpose stands in the code at one
/// place per index (a test sees to it), so no two uses draw the same numbers.
enum class Purpose : std::uint32_t {
  packing = 1,
  run = 2,
  measurement_noise = 3,
  design_scramble = 4,
  optimiser_starts = 5,
  sampler = 6,               ///< chains of the mixture sampler
  posterior_predictive = 7,  ///< replicate data
  prior_predictive = 8,      ///< are the data within the priors' reach?
  test = 9,
  nuts = 10,               ///< chains of the NUTS sampler
  cut = 11,                ///< chains of a cut posterior
  scouts = 12,             ///< reference draws in which maxima are looked for
  proposal = 13,           ///< adaptation of the mixture sampler's proposals
  search_directions = 14,  ///< directions in which scouts are compared
  predictive_curve = 15,
  discrepancy_band = 16,
  sobol = 17,                 ///< surrogates drawn for sensitivities
  contradiction = 18,         ///< starts of each observation set's own fit
  rank_bands = 19,            ///< bands of the ranks in simulation-based calibration
  simulated_truth = 20,       ///< true values in simulation-based calibration
  case_seed = 21,             ///< child_seed of a case's sampler
  error_scan_seed = 22,       ///< child_seed of the samplers of an error scan
  comparison_seed = 23,       ///< child_seed of the sampler of a held model
  simulation_seed = 24,       ///< child_seed of a replicate's sampler
  second_check = 26,          ///< second check of the draws by NUTS
  shuffled_points = 29,       ///< shuffled points, against which a cloud of points is thin
  repeated_data = 30,         ///< repeated data for the probabilities of verdicts
  report_seed = 28,           ///< child_seed of what a case's report draws
  thinned_runs = 31,          ///< which of many runs a surrogate learns from
  planned_noise = 32,         ///< noise of the readings that a plan considers
  planned_words = 33,         ///< readings for which a plan asks the verdicts
  planned_prior = 34,         ///< true values of a plan before any measurement
  unused_data = 35,           ///< data drawn beside those that a case has not used
  simulation_case_seed = 27,  ///< child_seed of a case's simulation-based calibration
};

/// Philox4x32-10: four 32-bit words from a 128-bit counter and a 64-bit key.
constexpr std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter, std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t p0 = std::uint64_t{0xD2511F53} * counter[0];
    const std::uint64_t p1 = std::uint64_t{0xCD9E8D57} * counter[2];
    counter = {static_cast<std::uint32_t>(p1 >> 32) ^ counter[1] ^ key[0], static_cast<std::uint32_t>(p1),
               static_cast<std::uint32_t>(p0 >> 32) ^ counter[3] ^ key[1], static_cast<std::uint32_t>(p0)};
    key[0] += 0x9E3779B9;
    key[1] += 0xBB67AE85;
  }
  return counter;
}

/// One stream. Also a C++ UniformRandomBitGenerator of 64-bit words.
class RandomStream {
 public:
  using result_type = std::uint64_t;

  RandomStream(std::uint64_t seed, Purpose purpose, std::uint32_t index = 0)
      : key_{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)},
        purpose_(static_cast<std::uint32_t>(purpose)),
        index_(index) {}

  static constexpr result_type min() { return 0; }
  static constexpr result_type max() { return ~result_type{0}; }

  result_type operator()() {
    if (used_ == 2) refill();
    const int i = 2 * used_++;
    return (std::uint64_t{words_[i + 1]} << 32) | words_[i];
  }

  /// Uniform in the open interval (0, 1): 53 bits, never 0 or 1.
  double uniform() { return (static_cast<double>((*this)() >> 11) + 0.5) * 0x1p-53; }
  double uniform(double low, double high) { return low + (high - low) * uniform(); }

  /// Standard normal by Box and Muller; both numbers of a pair are used.
  double normal() {
    if (has_spare_) {
      has_spare_ = false;
      return spare_;
    }
    const double radius = std::sqrt(-2.0 * std::log(uniform()));
    const double angle = 2.0 * std::numbers::pi * uniform();
    spare_ = radius * std::sin(angle);
    has_spare_ = true;
    return radius * std::cos(angle);
  }

 private:
  void refill() {
    words_ =
        philox({static_cast<std::uint32_t>(block_), static_cast<std::uint32_t>(block_ >> 32), index_, purpose_}, key_);
    ++block_;
    used_ = 0;
  }

  std::array<std::uint32_t, 2> key_;
  std::uint32_t purpose_, index_;
  std::uint64_t block_ = 0;
  std::array<std::uint32_t, 4> words_{};
  int used_ = 2;
  double spare_ = 0.0;
  bool has_spare_ = false;
};

/// A seed of its own for the index-th of many jobs, each of which draws streams as if it were alone.
inline std::uint64_t child_seed(std::uint64_t seed, Purpose purpose, std::uint32_t index) {
  return RandomStream(seed, purpose, index)();
}

}  // namespace data
