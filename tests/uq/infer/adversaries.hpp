#pragma once
// Densities on which samplers are known to go wrong without a word, with their true means and standard deviations in
// closed form, or by one-dimensional sums of an accuracy far beyond what is asked of draws.
#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "uq/infer/log_density.hpp"

namespace adversaries {

using Eigen::VectorXd;

struct Adversary {
  std::string name;
  uq::Target target;
  VectorXd mean, sd;          ///< NaN: not looked at
  double log_evidence = 0.0;  ///< NaN: not looked at
};

inline double log_sum(const std::vector<double>& terms) {
  double top = -std::numeric_limits<double>::infinity(), sum = 0.0;
  for (const double term : terms) top = std::max(top, term);
  for (const double term : terms) sum += std::exp(term - top);
  return top + std::log(sum);
}

/// Round normals with weights; gradient included, for NUTS.
struct Normals {
  std::vector<VectorXd> centre;
  std::vector<double> sd, weight;
  int dimension() const { return static_cast<int>(centre.front().size()); }
  std::vector<double> terms(const VectorXd& x) const {
    std::vector<double> found;
    for (std::size_t i = 0; i < centre.size(); ++i)
      found.push_back(std::log(weight[i]) - 0.5 * (x - centre[i]).squaredNorm() / (sd[i] * sd[i]) -
                      dimension() * std::log(sd[i] * std::sqrt(2.0 * std::numbers::pi)));
    return found;
  }
  double log_density(const VectorXd& x) const { return log_sum(terms(x)); }
  uq::Evaluation log_density_gradient(const VectorXd& x) const {
    const std::vector<double> parts = terms(x);
    const double whole = log_sum(parts);
    VectorXd slope = VectorXd::Zero(x.size());
    for (std::size_t i = 0; i < centre.size(); ++i)
      slope += std::exp(parts[i] - whole) * (centre[i] - x) / (sd[i] * sd[i]);
    return {.value = whole, .gradient = slope};
  }
};

/// Along (t, t^2, t^3), t standard normal, to a width.
struct CubicRidge {
  double width = 0.01;
  int dimension() const { return 3; }
  double log_density(const VectorXd& x) const {
    const double a = (x[1] - x[0] * x[0]) / width, b = (x[2] - x[0] * x[0] * x[0]) / width;
    return -0.5 * (x[0] * x[0] + a * a + b * b) - 1.5 * std::log(2.0 * std::numbers::pi) - 2.0 * std::log(width);
  }
};

/// A sphere's shell of radius 0.4.
struct Ring {
  int d = 2;
  double width = 0.01;
  int dimension() const { return d; }
  double log_density(const VectorXd& x) const { return -0.5 * std::pow((x.norm() - 0.4) / width, 2); }
};

/// Neal's: v ~ N(0, 3^2), the others N(0, exp(v)).
struct Funnel {
  int d = 2;
  int dimension() const { return d; }
  double log_density(const VectorXd& x) const {
    const double v = x[0], others = x.squaredNorm() - v * v;
    return -v * v / 18.0 - std::log(3.0) - 0.5 * others * std::exp(-v) - 0.5 * (d - 1) * v -
           0.5 * d * std::log(2.0 * std::numbers::pi);
  }
};

/// y = x_1 x_2 to a relative width, on a box that does not hold all of the hyperbola: a ridge that runs into two
/// bounds.
struct Hyperbola {
  double width = 0.001;
  int dimension() const { return 2; }
  double log_density(const VectorXd& x) const { return -0.5 * std::pow((x[0] * x[1] - 0.1) / width, 2); }
};

inline uq::Target on_box(const uq::LogDensity auto& density, const VectorXd& low, const VectorXd& high) {
  return uq::make_target(density, low, high, uq::uniform_reference(low, high));
}

/// The sum of the first two coordinates is known to be 1, of the others nothing.
struct KnownSum {
  int d = 8;
  double sd = 0.05;
  int dimension() const { return d; }
  double log_density(const VectorXd& x) const { return -0.5 * std::pow((x[0] + x[1] - 1.0) / sd, 2); }
};

/// Modes at the centres, each coordinate of which is one number, on the unit cube.
inline Adversary normals(const std::string& name, const Normals& density) {
  const auto d = static_cast<Eigen::Index>(density.dimension());
  VectorXd mean = VectorXd::Zero(d), variance = VectorXd::Zero(d);
  for (std::size_t i = 0; i < density.centre.size(); ++i) mean += density.weight[i] * density.centre[i];
  for (std::size_t i = 0; i < density.centre.size(); ++i)
    variance += density.weight[i] *
                (VectorXd::Constant(d, density.sd[i] * density.sd[i]) + (density.centre[i] - mean).cwiseAbs2());
  return {name, on_box(density, VectorXd::Zero(d), VectorXd::Ones(d)), mean, variance.cwiseSqrt(), 0.0};
}

inline Adversary narrow_and_wide(int d) {
  return normals(
      "modes .005 and .05 wide, " + std::to_string(d) + "-D",
      {.centre = {VectorXd::Constant(d, 0.3), VectorXd::Constant(d, 0.7)}, .sd = {0.005, 0.05}, .weight = {0.5, 0.5}});
}

/// The same off every line through the wide one.
inline Adversary askew(int d) {
  VectorXd narrow(d);
  for (int k = 0; k < d; ++k) narrow[k] = k % 2 == 0 ? 0.31 - 0.07 * k : 0.83 - 0.05 * k;
  return normals("the same off the diagonals, " + std::to_string(d) + "-D",
                 {.centre = {narrow, VectorXd::Constant(d, 0.6)}, .sd = {0.005, 0.05}, .weight = {0.5, 0.5}});
}

inline Adversary spike(int d, double width) {
  VectorXd at = VectorXd::Constant(d, 0.55);
  at[0] = 0.42;
  return normals("sd .15 with a spike of " + std::to_string(width).substr(0, 5) + ", " + std::to_string(d) + "-D",
                 {.centre = {VectorXd::Constant(d, 0.5), at}, .sd = {0.15, width}, .weight = {0.5, 0.5}});
}

inline Adversary cubic_ridge(double width) {
  const Eigen::Vector3d low(-4, -1, -16), high(4, 16, 16);
  // t is cut where t^3 leaves the box.
  const double end = std::cbrt(16.0), step = 1e-4;
  double mass = 0.0;
  Eigen::Vector3d first = Eigen::Vector3d::Zero(), second = first;
  for (double t = -end + 0.5 * step; t < end; t += step) {
    const double p = std::exp(-0.5 * t * t) * step;
    const Eigen::Vector3d x(t, t * t, t * t * t);
    mass += p;
    first += p * x;
    second += p * x.cwiseAbs2();
  }
  const Eigen::Vector3d mean = first / mass;
  const VectorXd sd = (second / mass - mean.cwiseAbs2()).cwiseSqrt();
  char name[64];
  std::snprintf(name, sizeof(name), "ridge (t, t^2, t^3) of width %g", width);
  return {name, on_box(CubicRidge{width}, low, high), mean, sd, std::log(mass / std::sqrt(2.0 * std::numbers::pi))};
}

inline Adversary ring(int d, double width) {
  // E[r^2] of the shell: its density in r is r^(d-1) exp(...), narrow against the radius.
  double mass = 0.0, square = 0.0;
  for (double r = std::max(0.0, 0.4 - 8.0 * width); r < 0.4 + 8.0 * width; r += 0.001 * width) {
    const double p = std::pow(r, d - 1) * std::exp(-0.5 * std::pow((r - 0.4) / width, 2));
    mass += p;
    square += p * r * r;
  }
  char name[64];
  std::snprintf(name, sizeof(name), "ring of width %g, %d-D", width, d);
  const double surface = 2.0 * std::pow(std::numbers::pi, 0.5 * d) / std::tgamma(0.5 * d);
  return {name, on_box(Ring{d, width}, VectorXd::Constant(d, -1.0), VectorXd::Ones(d)), VectorXd::Zero(d),
          VectorXd::Constant(d, std::sqrt(square / mass / d)), std::log(surface * mass * 0.001 * width)};
}

inline Adversary funnel(int d) {
  VectorXd low = VectorXd::Constant(d, -500.0), high = -low, sd = VectorXd::Constant(d, std::nan(""));
  low[0] = -12.0;
  high[0] = 12.0;
  sd[0] = 3.0;
  return {"funnel, " + std::to_string(d) + "-D", on_box(Funnel{d}, low, high), VectorXd::Zero(d), sd, std::nan("")};
}

inline Adversary hyperbola(double width) {
  // On the unit square, x_2 given x_1 is normal about 0.1 / x_1 with sd width / x_1, cut at one.
  double mass = 0.0, first = 0.0, second = 0.0;
  const double step = 1e-6;
  for (double x = 0.5 * step; x < 1.0; x += step) {
    const double sd = width / x, reach = (1.0 - 0.1 / x) / sd;
    const double p = sd * 0.5 * std::erfc(-reach / std::numbers::sqrt2) * step;
    mass += p;
    first += p * x;
    second += p * x * x;
  }
  const double mean = first / mass, sd = std::sqrt(second / mass - mean * mean);
  char name[64];
  std::snprintf(name, sizeof(name), "hyperbola of width %g into two bounds", width);
  return {name, on_box(Hyperbola{width}, VectorXd::Zero(2), VectorXd::Ones(2)), VectorXd::Constant(2, mean),
          VectorXd::Constant(2, sd), std::log(mass * std::sqrt(2.0 * std::numbers::pi))};
}

inline Adversary mirror() {
  return normals(
      "mirror images, 2-D",
      {.centre = {Eigen::Vector2d(0.2, 0.5), Eigen::Vector2d(0.8, 0.5)}, .sd = {0.01, 0.01}, .weight = {0.5, 0.5}});
}

inline Adversary four_values() {
  return normals("four values of one, 2-D", {.centre = {Eigen::Vector2d(0.08, 0.5), Eigen::Vector2d(0.17, 0.5),
                                                        Eigen::Vector2d(0.58, 0.5), Eigen::Vector2d(0.67, 0.5)},
                                             .sd = {0.006, 0.006, 0.006, 0.006},
                                             .weight = {0.25, 0.25, 0.25, 0.25}});
}

inline Adversary known_sum(int d, double sd) {
  // The sum s of two uniform numbers has the density 1 - |s - 1|; given s, each is uniform over the 1 - |s - 1| left.
  double mass = 0.0, square = 0.0;
  const double step = 1e-5;
  for (double t = -1.0 + 0.5 * step; t < 1.0; t += step) {
    const double left = 1.0 - std::abs(t), p = left * std::exp(-0.5 * t * t / (sd * sd)) * step;
    mass += p;
    square += p * (0.25 * t * t + left * left / 12.0);
  }
  VectorXd spread = VectorXd::Constant(d, 1.0 / std::sqrt(12.0));
  spread.head(2).setConstant(std::sqrt(square / mass));
  char name[64];
  std::snprintf(name, sizeof(name), "one sum known to %g, %d-D", sd, d);
  return {name, on_box(KnownSum{d, sd}, VectorXd::Zero(d), VectorXd::Ones(d)), VectorXd::Constant(d, 0.5), spread,
          std::log(mass)};
}

/// Of many dimensions, where bounded coordinates are sampled on the whole line.
inline std::vector<Adversary> many_dimensions() {
  return {known_sum(8, 0.05), known_sum(8, 0.005), known_sum(10, 0.05), narrow_and_wide(8), askew(8), spike(8, 0.03)};
}

inline std::vector<Adversary> all() {
  return {narrow_and_wide(2), narrow_and_wide(3), narrow_and_wide(5), askew(2),         askew(3),
          askew(5),           spike(2, 0.003),    spike(3, 0.003),    cubic_ridge(0.1), cubic_ridge(0.01),
          cubic_ridge(0.001), ring(2, 0.01),      ring(2, 0.001),     ring(3, 0.01),    funnel(2),
          funnel(4),          hyperbola(0.001),   hyperbola(0.0001),  mirror(),         four_values()};
}

}  // namespace adversaries
