#include "uq/posterior/beta_law.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "data/log_gamma.hpp"

namespace uq {
namespace {

double log_beta(BetaShapes s) {
  return data::log_gamma(s.alpha) + data::log_gamma(s.beta) - data::log_gamma(s.alpha + s.beta);
}

/// I_s(a, b) by the continued fraction, which converges fast for s < (a + 1) / (a + b + 2). `log_share`, `log_rest`: of
/// s and of 1 - s.
double by_fraction(double share, double log_share, double log_rest, BetaShapes shapes) {
  constexpr double tiny = 1e-300;
  const double a = shapes.alpha, b = shapes.beta;
  double c = 1.0, d = 1.0 - (a + b) * share / (a + 1.0);
  d = 1.0 / (std::abs(d) < tiny ? tiny : d);
  double fraction = d;
  for (int m = 1; m < 100000; ++m) {
    double change = 1.0;
    for (const double term : {m * (b - m) * share / ((a + 2.0 * m - 1.0) * (a + 2.0 * m)),
                              -(a + m) * (a + b + m) * share / ((a + 2.0 * m) * (a + 2.0 * m + 1.0))}) {
      d = 1.0 + term * d;
      d = 1.0 / (std::abs(d) < tiny ? tiny : d);
      c = 1.0 + term / c;
      if (std::abs(c) < tiny) c = tiny;
      change = d * c;
      fraction *= change;
    }
    if (std::abs(change - 1.0) < 1e-15) break;
  }
  return std::exp(a * log_share + b * log_rest - log_beta(shapes)) * fraction / a;
}

/// Lower or upper tail at a point given by its distance from the low end, or from the high end.
double tail(double distance, bool from_low, bool upper, BetaShapes shapes) {
  if (!from_low) return tail(distance, true, !upper, {shapes.beta, shapes.alpha});
  if (distance <= 0.0) return upper ? 1.0 : 0.0;
  if (distance >= 1.0) return upper ? 0.0 : 1.0;
  const double near = std::log(distance), far = std::log1p(-distance);
  const double turn = (shapes.alpha + 1.0) / (shapes.alpha + shapes.beta + 2.0);
  const bool low_side = distance < turn;
  const double found = low_side ? by_fraction(distance, near, far, shapes)
                                : by_fraction(1.0 - distance, far, near, {shapes.beta, shapes.alpha});
  return std::clamp(low_side == upper ? 1.0 - found : found, 0.0, 1.0);
}

}  // namespace

double beta_cdf(double share, BetaShapes shapes) { return tail(share, true, false, shapes); }
double beta_upper(double share, BetaShapes shapes) { return tail(share, true, true, shapes); }

double beta_quantile(double probability, BetaShapes shapes) {
  if (!(probability > 0.0)) return 0.0;
  if (!(probability < 1.0)) return 1.0;
  const bool from_low = beta_cdf(0.5, shapes) >= probability;
  // Rises with the distance from the nearer end: the cdf, or what is above.
  const double wanted = from_low ? probability : 1.0 - probability;
  const auto excess = [&](double log_distance) {
    return tail(std::exp(log_distance), from_low, !from_low, shapes) - wanted;
  };
  double low = -740.0, high = std::log(0.5), at_low = excess(low), at_high = excess(high);
  if (at_low >= 0.0) return from_low ? 0.0 : 1.0;
  constexpr double tolerance = 1e-13;
  const int bisections = static_cast<int>(std::ceil(std::log2((high - low) / tolerance)));
  const double first = high - low;
  for (int i = 0; high - low > 2.0 * tolerance && i < bisections + 2; ++i) {
    // Interpolated, truncated towards the middle, and projected into what bisection would reach by now.
    const double middle = 0.5 * (low + high), radius = tolerance * std::exp2(bisections + 1 - i) - 0.5 * (high - low);
    const double straight = (at_high * low - at_low * high) / (at_high - at_low);
    const double side = middle >= straight ? 1.0 : -1.0;
    const double push = std::min(0.2 / first * (high - low) * (high - low), std::abs(middle - straight));
    const double truncated = straight + side * push;
    const double next = std::abs(truncated - middle) <= radius ? truncated : middle - side * radius;
    const double found = excess(next);
    if (found == 0.0) {
      low = high = next;
    } else if (found > 0.0) {
      high = next;
      at_high = found;
    } else {
      low = next;
      at_low = found;
    }
  }
  const double distance = std::exp(0.5 * (low + high));
  return from_low ? distance : 1.0 - distance;
}

double beta_log_density(double share, BetaShapes shapes) {
  constexpr double edge = std::numeric_limits<double>::epsilon();
  const double inside = std::clamp(share, edge, 1.0 - edge);
  const double first = shapes.alpha == 1.0 ? 0.0 : (shapes.alpha - 1.0) * std::log(inside);
  const double second = shapes.beta == 1.0 ? 0.0 : (shapes.beta - 1.0) * std::log1p(-inside);
  return first + second - log_beta(shapes);
}

}  // namespace uq
