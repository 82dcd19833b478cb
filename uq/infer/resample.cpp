#include "uq/infer/resample.hpp"

namespace uq {

std::vector<Eigen::Index> resample(const Eigen::ArrayXd& weights, Eigen::Index count, double offset) {
  std::vector<Eigen::Index> kept;
  kept.reserve(static_cast<std::size_t>(count));
  const double spacing = weights.sum() / static_cast<double>(count);
  double position = offset * spacing, sum = weights[0];
  Eigen::Index i = 0;
  for (Eigen::Index j = 0; j < count; ++j, position += spacing) {
    while (sum < position && i + 1 < weights.size()) sum += weights[++i];
    kept.push_back(i);
  }
  return kept;
}

}  // namespace uq
