#include "uq/verdict/range_end.hpp"

#include <algorithm>
#include <cmath>

#include "uq/posterior/curvature.hpp"
#include "uq/posterior/posterior.hpp"
#include "uq/verdict/profile.hpp"

namespace uq {
namespace {

constexpr double widths_beyond = 2.0;  // how far beyond its end a mere range is thought of, in its widths

}  // namespace

End end_of(double value, double low, double high) {
  const double slack = 1e-4 * (high - low);
  return value - low <= slack ? End::low : high - value <= slack ? End::high : End::inside;
}

std::vector<RangeEnd> range_ends(const CaseModel& model, const Eigen::VectorXd& best) {
  const Eigen::VectorXd lower = model.lower(), upper = model.upper();
  const Eigen::Index dimension = best.size();
  std::vector<Eigen::Index> inside, pulled;
  Eigen::VectorXd gradient;
  for (Eigen::Index s = 0; s < dimension; ++s) {
    const End end = end_of(best[s], lower[s], upper[s]);
    if (end == End::inside) {
      inside.push_back(s);
      continue;
    }
    if (end == End::low && physical_low(model.unknowns[s])) continue;
    if (gradient.size() == 0) gradient = profiled(model)(best).gradient;
    if (end == End::low ? gradient[s] < 0.0 : gradient[s] > 0.0) pulled.push_back(s);
  }
  std::vector<RangeEnd> found;
  if (pulled.empty() || inside.empty()) return found;
  const std::optional<Eigen::MatrixXd> curved = curvature(model, best, KnownBeside::all);
  if (!curved) return found;
  Eigen::MatrixXd all = *curved;
  for (const Eigen::Index s : pulled) {
    const ScaledPrior& prior = model.unknowns[s].prior;
    if (prior.is_informative()) continue;
    all(s, s) += std::pow(widths_beyond * (upper[s] - lower[s]), -2) - std::pow(prior.sd(), -2);
  }
  const Eigen::VectorXd held_variance = Eigen::MatrixXd(all(inside, inside))
                                            .llt()
                                            .solve(Eigen::MatrixXd::Identity(std::ssize(inside), std::ssize(inside)))
                                            .diagonal();
  for (const Eigen::Index s : pulled) {
    std::vector<Eigen::Index> free = inside;
    free.push_back(s);
    Eigen::VectorXd pull = Eigen::VectorXd::Zero(std::ssize(free));
    pull[pull.size() - 1] = gradient[s];
    const Eigen::VectorXd shift = Eigen::MatrixXd(all(free, free)).llt().solve(pull);
    RangeEnd moved{.unknown = static_cast<int>(s), .shift = Eigen::VectorXd::Zero(dimension)};
    for (std::size_t i = 0; i < inside.size(); ++i) {
      const auto at = static_cast<Eigen::Index>(i);
      moved.shift[inside[i]] = shift[at] / std::sqrt(held_variance[at]);
    }
    found.push_back(std::move(moved));
  }
  return found;
}

}  // namespace uq
