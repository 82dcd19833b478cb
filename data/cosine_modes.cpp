#include "data/cosine_modes.hpp"

#include <cmath>
#include <numbers>

namespace data {

std::vector<double> cosine_modes(std::span<const double> x, double mean, std::size_t count) {
  const auto n = static_cast<double>(x.size());
  std::vector<double> c;
  for (std::size_t j = 1; j <= count; ++j) {
    // By the recurrence cos((k + 1) a) = 2 cos(a) cos(k a) - cos((k - 1) a).
    const double angle = static_cast<double>(j) * std::numbers::pi / n, twice = 2.0 * std::cos(angle);
    double now = std::cos(0.5 * angle), before = now, sum = 0.0;  // cos(-a/2) = cos(a/2)
    for (const double value : x) {
      sum += (value - mean) * now;
      const double next = twice * now - before;
      before = now;
      now = next;
    }
    c.push_back(std::numbers::sqrt2 / n * sum);
  }
  return c;
}

}  // namespace data
