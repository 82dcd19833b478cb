#include "uq/verdict/hills.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace uq {
namespace {

/// Integral of exp(-deviance / 2 + log prior) from point `first` to point `last`.
double integral(const Eigen::VectorXd& u, const Eigen::VectorXd& log_density, Eigen::Index first, Eigen::Index last) {
  double sum = 0.0;
  for (Eigen::Index i = first; i < last; ++i) {
    // Of an exponential between two points.
    const double from = log_density[i], to = log_density[i + 1], width = u[i + 1] - u[i];
    const double change = to - from;
    sum += width * (std::abs(change) < 1e-6 ? std::exp(0.5 * (from + to)) : (std::exp(to) - std::exp(from)) / change);
  }
  return sum;
}

}  // namespace

std::vector<Hill> find_hills(const Eigen::VectorXd& u, const Eigen::VectorXd& deviance,
                             const Eigen::VectorXd& log_prior, double prominence) {
  // Lowest and highest points in turn, each confirmed once the deviance has changed by the prominence since.
  std::vector<Eigen::Index> wells, peaks;
  Eigen::Index lowest = 0, highest = 0;
  bool falling = true;  // a well is looked for
  for (Eigen::Index i = 0; i < deviance.size(); ++i) {
    if (falling) {
      if (deviance[i] < deviance[lowest]) lowest = i;
      if (deviance[i] < deviance[lowest] + prominence) continue;
      wells.push_back(lowest);
    } else {
      if (deviance[i] > deviance[highest]) highest = i;
      if (deviance[i] > deviance[highest] - prominence) continue;
      peaks.push_back(highest);
    }
    falling = !falling;
    lowest = highest = i;
  }
  if (falling && deviance.size() > 0) wells.push_back(lowest);

  const Eigen::VectorXd log_density = log_prior.array() - log_prior.maxCoeff() - 0.5 * deviance.array();
  const double total = integral(u, log_density, 0, u.size() - 1);
  std::vector<Hill> hills;
  for (std::size_t k = 0; k < wells.size(); ++k) {
    Hill hill{.best = wells[k],
              .first = k == 0 ? 0 : peaks[k - 1],
              .last = k < peaks.size() ? peaks[k] : deviance.size() - 1,
              .peak = std::numeric_limits<double>::infinity()};
    if (k > 0) hill.peak = deviance[hill.first];
    if (k < peaks.size()) hill.peak = std::min(hill.peak, deviance[hill.last]);
    hill.mass = total > 0.0 ? integral(u, log_density, hill.first, hill.last) / total : 0.0;
    hills.push_back(hill);
  }
  return hills;
}

}  // namespace uq
