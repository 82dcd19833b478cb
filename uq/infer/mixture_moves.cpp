#include "uq/infer/mixture_moves.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace uq {
namespace {

using data::RandomStream;

/// Along the difference of two archived points (differential evolution).
Eigen::VectorXd archived_step(const Moves& moves, RandomStream& random) {
  const auto n = static_cast<double>(moves.archive.rows());
  const auto first = static_cast<Eigen::Index>(random.uniform() * n);
  const auto second = static_cast<Eigen::Index>(random.uniform() * n);
  return (moves.archive.row(first) - moves.archive.row(second)).transpose() / std::numbers::sqrt2;
}

/// A step with the shape of one of the mixture's components, chosen at random.
Eigen::VectorXd component_step(const Moves& moves, RandomStream& random) {
  const auto& components = moves.mixture.components;
  const auto k = static_cast<std::size_t>(random.uniform() * static_cast<double>(components.size()));
  Eigen::VectorXd normal(moves.archive.cols());
  for (double& value : normal) value = random.normal();
  return components[k].factor * normal;
}

/// A symmetric step, whose law does not depend on where the chain is.
double local_move(const Moves& moves, Walker& walker) {
  const double scale = std::exp(walker.random.uniform(std::log(0.1), std::log(1.5))) * 2.38 /
                       std::sqrt(static_cast<double>(moves.archive.cols()));
  const bool archived = moves.mixture.fitted < 2 || walker.random.uniform() < 0.5;
  const double chance = walker.random.uniform();
  const Eigen::VectorXd proposal =
      walker.x + scale * (archived ? archived_step(moves, walker.random) : component_step(moves, walker.random));
  if (!moves.target.contains(proposal)) return 0.0;
  const double value = moves.target.log_density(proposal);
  ++walker.evaluations;
  if (!(value > nowhere)) return 0.0;
  const double accept = std::min(1.0, std::exp(value - walker.log_density));
  if (chance < accept) {
    walker.x = proposal;
    walker.log_density = value;
    walker.log_proposal = moves.mixture.log_density(proposal);
  }
  return accept;
}

}  // namespace

void extend(const Moves& moves, Walker& walker, Chain& chain, int draws) {
  const Eigen::Index before = chain.x.rows();
  chain.x.conservativeResize(before + draws, moves.target.dimension);
  chain.log_density.conservativeResize(before + draws);
  chain.acceptance.conservativeResize(before + draws);
  constexpr int block = 64;
  for (int done = 0; done < draws;) {
    const int count = std::min(block, draws - done);
    const int steps = count * moves.per_draw;
    std::vector<bool> local(static_cast<std::size_t>(steps));
    int global = 0;
    for (int i = 0; i < steps; ++i) {
      local[i] = walker.random.uniform() < moves.local_share;
      if (!local[i]) ++global;
    }
    const Proposals made = propose(moves.target, moves.mixture, global, walker.random);
    walker.evaluations += global;
    walker.weights.tries += made.tries;
    Eigen::Index used = 0;
    for (int i = 0; i < count; ++i) {
      double acceptance = 0.0;
      for (int step = 0; step < moves.per_draw; ++step) {
        if (local[i * moves.per_draw + step]) {
          acceptance += local_move(moves, walker);
          continue;
        }
        const double log_weight = made.log_density[used] - made.log_proposal[used];
        walker.weights.log_weights.push_back(log_weight);
        const double accept = log_weight > nowhere
                                  ? std::min(1.0, std::exp(log_weight - (walker.log_density - walker.log_proposal)))
                                  : 0.0;
        if (walker.random.uniform() < accept) {
          walker.x = made.x.row(used).transpose();
          walker.log_density = made.log_density[used];
          walker.log_proposal = made.log_proposal[used];
        }
        acceptance += accept;
        ++used;
      }
      const Eigen::Index row = before + done + i;
      chain.x.row(row) = walker.x.transpose();
      chain.log_density[row] = walker.log_density;
      chain.acceptance[row] = acceptance / moves.per_draw;
    }
    done += count;
  }
}

}  // namespace uq
