#include "surrogate/design.hpp"

#include <gsl/gsl_qrng.h>

#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "data/error.hpp"
#include "data/random.hpp"

namespace surrogate {
namespace {

constexpr int bits = 30;  // of GSL's Sobol numbers

/// The random bits of one dimension's permutation tree.
struct Scramble {
  std::array<std::uint32_t, 2> key;
  std::uint32_t dimension;

  /// Nested uniform scrambling of one coordinate, then a uniform offset inside the cell of size 2^-30.
  double operator()(std::uint32_t digits) const {
    std::uint32_t scrambled = 0;
    for (int level = 0; level < bits; ++level) {
      const std::uint32_t prefix = level == 0 ? 0 : digits >> (bits - level);
      const std::uint32_t flip = data::philox({prefix, static_cast<std::uint32_t>(level), dimension, 0}, key)[0] & 1u;
      scrambled = (scrambled << 1) | (((digits >> (bits - 1 - level)) & 1u) ^ flip);
    }
    const std::uint32_t below = data::philox({digits, bits, dimension, 0}, key)[0];
    const double offset = (below >> 10) + 0.5;  // 22 bits, so that the sum is exact and never 0 or 1
    return (scrambled + offset * 0x1p-22) * 0x1p-30;
  }
};

}  // namespace

Eigen::MatrixXd scrambled_sobol(int points, int dimension, std::uint64_t seed, int first) {
  if (dimension < 1 || dimension > sobol_max_dimension || points < 0 || first < 0 || points > (1 << bits) - 1 - first)
    throw data::InputError(data::ExitStatus::bad_study,
                           {"training design",
                            "a Sobol design of " + std::to_string(points) + " points in " + std::to_string(dimension) +
                                " dimensions was asked for, but dimensions go from 1 to 40 and points to 2^30 - 1",
                            "vary fewer parameters and controls, or ask for fewer runs"});
  std::vector<Scramble> scrambles;
  for (int k = 0; k < dimension; ++k) {
    data::RandomStream stream(seed, data::Purpose::design_scramble, static_cast<std::uint32_t>(k));
    const std::uint64_t word = stream();
    scrambles.push_back(Scramble{{static_cast<std::uint32_t>(word), static_cast<std::uint32_t>(word >> 32)},
                                 static_cast<std::uint32_t>(k)});
  }
  const std::unique_ptr<gsl_qrng, void (*)(gsl_qrng*)> sobol(
      gsl_qrng_alloc(gsl_qrng_sobol, static_cast<unsigned>(dimension)), gsl_qrng_free);
  std::vector<double> point(static_cast<std::size_t>(dimension), 0.0);  // point 0, which GSL leaves out
  Eigen::MatrixXd design(points, dimension);
  for (int i = 0; i < first + points; ++i) {
    if (i > 0) gsl_qrng_get(sobol.get(), point.data());
    if (i < first) continue;
    for (int k = 0; k < dimension; ++k)
      design(i - first, k) = scrambles[k](static_cast<std::uint32_t>(std::ldexp(point[k], bits)));
  }
  return design;
}

}  // namespace surrogate
