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

/// What a stream is drawn for; two purposes never share numbers under one seed.
enum class Purpose : std::uint32_t {
  packing = 1,
  run = 2,
  measurement_noise = 3,
  design_scramble = 4,
  optimiser_starts = 5,
  sampler = 6,
  posterior_predictive = 7,
  prior_predictive = 8,
  test = 9,
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

  /// Standard normal by Box and Muller; both of a pair are used.
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

}  // namespace data
