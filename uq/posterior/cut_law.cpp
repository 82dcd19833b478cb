#include "uq/posterior/cut_law.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace uq {
namespace {

Eigen::VectorXd at(double u) { return Eigen::VectorXd::Constant(1, u); }

/// Whether the density between two hills falls well below the lower of them.
bool parted(const Mixture& hills, double first, double second) {
  constexpr double valley = 2.0;  // of the log density: e^-2 is about an eighth
  const double lower = std::min(hills.log_density(at(first)), hills.log_density(at(second)));
  constexpr int steps = 32;
  for (int i = 1; i < steps; ++i)
    if (hills.log_density(at(first + (second - first) * i / steps)) < lower - valley) return true;
  return false;
}

}  // namespace

double CutLaw::log_density(double u) const {
  if (hills.components.empty()) return -0.5 * std::pow((u - mean) / sd, 2);
  return hills.log_density(at(u)) - highest;
}

double CutLaw::slope(double u) const {
  if (hills.components.empty()) return -(u - mean) / (sd * sd);
  const double step = 1e-4 * sd;
  return (hills.log_density(at(u + step)) - hills.log_density(at(u - step))) / (2.0 * step);
}

double CutLaw::precision(double u) const {
  if (hills.components.empty()) return 1.0 / (sd * sd);
  const Eigen::ArrayXXd terms = hills.log_terms(Eigen::MatrixXd::Constant(1, 1, u));
  Eigen::Index own = 0;
  terms.row(0).maxCoeff(&own);
  return 1.0 / std::pow(hills.components[own].factor(0, 0), 2);
}

CutLaw cut_law(const Eigen::VectorXd& draws, std::uint64_t seed) {
  CutLaw law{.mean = draws.mean(), .sd = std::sqrt((draws.array() - draws.mean()).square().mean())};
  data::RandomStream random(seed, data::Purpose::cut, 1);
  Mixture found = fit_mixture(draws, Eigen::VectorXd::Ones(draws.size()), random);
  found.components.resize(static_cast<std::size_t>(found.fitted));  // without the wide one
  bool several = false;
  for (const MixtureComponent& one : found.components)
    for (const MixtureComponent& other : found.components)
      several = several || parted(found, one.mean[0], other.mean[0]);
  if (!several) return law;
  law.highest = -std::numeric_limits<double>::infinity();
  for (const MixtureComponent& one : found.components) law.highest = std::max(law.highest, found.log_density(one.mean));
  law.hills = std::move(found);
  return law;
}

}  // namespace uq
