#include "uq/infer/tempering.hpp"

#include <algorithm>
#include <cmath>

#include "uq/infer/resample.hpp"

namespace uq {
namespace {

/// Effective size of weights exp(step * slope), as a share of their number.
double effective_share(const Eigen::VectorXd& slope, double step) {
  const double largest = slope.maxCoeff();
  const Eigen::ArrayXd weights = (step * (slope.array() - largest)).exp();
  return weights.sum() * weights.sum() / (weights.square().sum() * static_cast<double>(slope.size()));
}

/// Largest step in b that leaves as many points effective as half a population.
double next_step(const Eigen::VectorXd& slope, double left, Eigen::Index population) {
  const double wanted = 0.5 * static_cast<double>(population) / static_cast<double>(slope.size());
  if (effective_share(slope, left) >= wanted) return left;
  double low = 0.0, high = left;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (effective_share(slope, middle) >= wanted ? low : high) = middle;
  }
  return low;
}

struct MoveState {
  Eigen::VectorXd log_reference;
  double scale = 1.0;  // factor on the differential-evolution step, adapted to an acceptance near 0.3
};

/// One Metropolis move of every point at power b.
void move(const Target& target, Population& population, MoveState& state, double b, data::RandomStream& random) {
  const Eigen::MatrixXd frozen = population.x;
  const Eigen::Index n = frozen.rows(), d = frozen.cols();
  const Eigen::VectorXd spread =
      ((frozen.rowwise() - frozen.colwise().mean()).colwise().squaredNorm() / static_cast<double>(n)).cwiseSqrt();
  Eigen::MatrixXd proposals(n, d);
  auto any = [&] { return static_cast<Eigen::Index>(random.uniform() * static_cast<double>(n)); };
  for (Eigen::Index i = 0; i < n; ++i) {
    const Eigen::Index first = any(), second = any();
    const double step = random.uniform() < 0.1 ? 1.0 : state.scale * 2.38 / std::sqrt(2.0 * static_cast<double>(d));
    for (Eigen::Index k = 0; k < d; ++k)
      proposals(i, k) =
          frozen(i, k) + step * (frozen(first, k) - frozen(second, k)) + 1e-3 * spread[k] * random.normal();
  }
  const Eigen::VectorXd values = evaluate(target, proposals);
  population.evaluations += n;
  int accepted = 0;
  for (Eigen::Index i = 0; i < n; ++i) {
    const double chance = random.uniform();
    if (!std::isfinite(values[i])) continue;
    const double reference = target.reference.log_density(proposals.row(i).transpose());
    const double rise = b * (values[i] - population.log_density[i]) + (1.0 - b) * (reference - state.log_reference[i]);
    if (!(std::log(chance) < rise)) continue;
    population.x.row(i) = proposals.row(i);
    population.log_density[i] = values[i];
    state.log_reference[i] = reference;
    ++accepted;
  }
  const double rate = static_cast<double>(accepted) / static_cast<double>(n);
  state.scale = std::clamp(state.scale * std::exp(rate - 0.3), 0.05, 3.0);
}

}  // namespace

Population temper(const Target& target, Starts starts, data::RandomStream& random, const TemperingOptions& options) {
  const Eigen::Index n = options.population;
  Population population{.x = std::move(starts.x), .log_density = std::move(starts.log_density)};
  if (!(population.log_density.maxCoeff() > nowhere)) return population;

  MoveState state;
  double b = 0.0;
  while (population.steps < options.steps_max && b < 1.0) {
    ++population.steps;
    // Weights (p / reference)^step; a point where p is zero has none.
    const Eigen::Index now = population.x.rows();
    state.log_reference.resize(now);
    for (Eigen::Index i = 0; i < now; ++i)
      state.log_reference[i] = target.reference.log_density(population.x.row(i).transpose());
    const Eigen::VectorXd slope = (population.log_density - state.log_reference).cwiseMax(-1e300);
    const double step = next_step(slope, 1.0 - b, n);
    const std::vector<Eigen::Index> kept =
        resample((step * (slope.array() - slope.maxCoeff())).exp(), n, random.uniform());
    b = step >= 1.0 - b ? 1.0 : b + step;

    population.x = Eigen::MatrixXd(population.x(kept, Eigen::all));
    population.log_density = Eigen::VectorXd(population.log_density(kept));
    state.log_reference = Eigen::VectorXd(state.log_reference(kept));
    const int moves = options.moves + (b == 1.0 ? options.final_moves : 0);
    for (int m = 0; m < moves; ++m) move(target, population, state, b, random);
  }
  population.reached = b == 1.0;
  return population;
}

}  // namespace uq
