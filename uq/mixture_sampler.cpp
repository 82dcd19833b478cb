#include "uq/mixture_sampler.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "uq/parallel.hpp"

namespace uq {
namespace {

using data::Purpose;
using data::RandomStream;
constexpr std::uint32_t shared_stream = 0x10000000;  // of what all chains share: the fit of the mixture
constexpr double nowhere = -std::numeric_limits<double>::infinity();

/// Sums for the mean and variance of the importance weights p / q, kept relative to their largest.
struct WeightSums {
  double largest = nowhere, sum = 0.0, sum_of_squares = 0.0;
  double tries = 0.0;  // proposals, those outside the support (weight zero) included
  void add(double log_weight) {
    if (!(log_weight > nowhere)) return;
    if (log_weight > largest) {
      const double shrink = std::exp(largest - log_weight);
      sum *= shrink;
      sum_of_squares *= shrink * shrink;
      largest = log_weight;
    }
    const double weight = std::exp(log_weight - largest);
    sum += weight;
    sum_of_squares += weight * weight;
  }
  void add(const WeightSums& other) {
    if (other.largest > nowhere) {
      const double top = std::max(largest, other.largest);
      const double mine = std::exp(largest - top), theirs = std::exp(other.largest - top);
      sum = sum * mine + other.sum * theirs;
      sum_of_squares = sum_of_squares * mine * mine + other.sum_of_squares * theirs * theirs;
      largest = top;
    }
    tries += other.tries;
  }
};

/// Draws from the mixture cut at the support. `tries` counts the draws outside, too.
struct Proposals {
  Eigen::MatrixXd x;
  Eigen::VectorXd log_density, log_proposal;
  double tries = 0.0;
};

Proposals propose(const Target& target, const Mixture& mixture, int count, RandomStream& random) {
  Proposals made{.x = Eigen::MatrixXd(count, target.dimension), .log_density = {}, .log_proposal = {}};
  for (int i = 0; i < count; ++i) {
    Eigen::VectorXd x = mixture.draw(random);
    ++made.tries;
    for (int again = 0; again < 1000 && !target.contains(x); ++again, ++made.tries) x = mixture.draw(random);
    made.x.row(i) = x.transpose();
  }
  made.log_proposal = mixture.log_densities(made.x);
  made.log_density = evaluate(target, made.x);
  return made;
}

/// Importance weights of proposals, largest 1; their effective share.
struct Weights {
  Eigen::VectorXd values;
  double efficiency = 0.0;
};

Weights importance_weights(const Proposals& made) {
  const Eigen::VectorXd log_weights = made.log_density - made.log_proposal;
  const double largest = log_weights.maxCoeff();
  Weights weights;
  if (!(largest > nowhere)) return {.values = Eigen::VectorXd::Zero(log_weights.size()), .efficiency = 0.0};
  weights.values = (log_weights.array() - largest).exp();
  weights.efficiency =
      std::pow(weights.values.sum(), 2) / (weights.values.squaredNorm() * static_cast<double>(log_weights.size()));
  return weights;
}

struct Fitted {
  Mixture mixture;
  double efficiency = 0.0;
  std::int64_t evaluations = 0;
};

/// Fits the mixture to the populations, then to its own weighted draws as long as these become better.
Fitted fit_proposal(const Target& target, const Eigen::MatrixXd& points, const MixtureSamplerOptions& options) {
  RandomStream random(options.seed, Purpose::sampler, shared_stream);
  Fitted best;
  Eigen::VectorXd even = Eigen::VectorXd::Ones(points.rows());
  best.mixture = fit_mixture(points, even, random, options.mixture);
  Mixture current = best.mixture;
  Eigen::MatrixXd gathered = points;
  Eigen::VectorXd shares = even / even.sum();
  for (int refit = 0; refit <= options.refits_max; ++refit) {
    const Proposals made = propose(target, current, options.refit_draws, random);
    best.evaluations += options.refit_draws;
    const Weights weights = importance_weights(made);
    const bool better = weights.efficiency > best.efficiency;
    if (better) {
      best.mixture = current;
      best.efficiency = weights.efficiency;
    }
    if (best.efficiency > 0.85 || (refit > 1 && !better) || weights.efficiency == 0.0) break;
    // Weighted draws join what is known, in proportion to how well they stand for the density; large weights are cut at
    // sqrt(n) times the mean (Ionides 2008) so that one of them cannot make a component of its own.
    const double cut = weights.values.mean() * std::sqrt(static_cast<double>(options.refit_draws));
    const Eigen::VectorXd cut_weights = weights.values.cwiseMin(cut);
    const double trust = std::max(weights.efficiency, 0.05) * options.refit_draws;
    const double before = static_cast<double>(gathered.rows()) * (refit == 0 ? 0.5 : 1.0);
    Eigen::MatrixXd all(gathered.rows() + made.x.rows(), points.cols());
    all << gathered, made.x;
    Eigen::VectorXd all_shares(all.rows());
    all_shares << shares * before / (before + trust), cut_weights * (trust / (before + trust) / cut_weights.sum());
    gathered = all;
    shares = all_shares;
    current = fit_mixture(gathered, shares, random, options.mixture, &current);
  }
  return best;
}

/// One chain between rounds.
struct Walker {
  RandomStream random;
  Eigen::VectorXd x;
  double log_density = nowhere, log_proposal = nowhere;
  WeightSums weights = {};
  std::int64_t evaluations = 0;
};

/// What all chains share and none changes.
struct Moves {
  const Target& target;
  const Mixture& mixture;
  const Eigen::MatrixXd& archive;
  double local_share;
  int per_draw;
};

/// A differential-evolution step along the difference of two archived points.
double local_move(const Moves& moves, Walker& walker) {
  const auto n = static_cast<double>(moves.archive.rows());
  const auto first = static_cast<Eigen::Index>(walker.random.uniform() * n);
  const auto second = static_cast<Eigen::Index>(walker.random.uniform() * n);
  const double scale = std::exp(walker.random.uniform(std::log(0.1), std::log(1.5))) * 2.38 /
                       std::sqrt(2.0 * static_cast<double>(moves.archive.cols()));
  const double chance = walker.random.uniform();
  const Eigen::VectorXd proposal =
      walker.x + scale * (moves.archive.row(first) - moves.archive.row(second)).transpose();
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

/// Appends `draws` draws to a chain.
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
      local[static_cast<std::size_t>(i)] = walker.random.uniform() < moves.local_share;
      if (!local[static_cast<std::size_t>(i)]) ++global;
    }
    const Proposals made = propose(moves.target, moves.mixture, global, walker.random);
    walker.evaluations += global;
    walker.weights.tries += made.tries;
    Eigen::Index used = 0;
    for (int i = 0; i < count; ++i) {
      double acceptance = 0.0;
      for (int step = 0; step < moves.per_draw; ++step) {
        if (local[static_cast<std::size_t>(i * moves.per_draw + step)]) {
          acceptance += local_move(moves, walker);
          continue;
        }
        const double log_weight = made.log_density[used] - made.log_proposal[used];
        walker.weights.add(log_weight);
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

}  // namespace

Draws sample_mixture(const Target& target, const MixtureSamplerOptions& options) {
  Draws result;
  result.sampler = "mixture";
  result.log_evidence = result.log_evidence_error = std::numeric_limits<double>::quiet_NaN();
  const auto chains = static_cast<std::size_t>(options.chains);

  // Warm-up of each chain from its own reference draws.
  std::vector<Population> populations(chains);
  std::vector<Walker> walkers;
  for (std::size_t c = 0; c < chains; ++c)
    walkers.push_back({.random = RandomStream(options.seed, Purpose::sampler, static_cast<std::uint32_t>(c)), .x = {}});
  for_each_index(options.chains, options.threads, [&](int c) {
    const auto i = static_cast<std::size_t>(c);
    populations[i] = temper(target, walkers[i].random, options.tempering);
  });
  const Eigen::Index size = populations.front().x.rows();
  Eigen::MatrixXd archive(size * options.chains, target.dimension);
  for (std::size_t c = 0; c < chains; ++c) {
    archive.middleRows(static_cast<Eigen::Index>(c) * size, size) = populations[c].x;
    result.evaluations += populations[c].evaluations;
    if (populations[c].log_density.allFinite() && populations[c].reached) continue;
    result.reason = populations[c].log_density.maxCoeff() > nowhere ? "tempering from the prior did not come to its end"
                                                                    : "the density is zero at every start";
    return result;
  }

  // The proposal.
  const Fitted fitted = fit_proposal(target, archive, options);
  result.evaluations += fitted.evaluations;
  result.proposal_efficiency = fitted.efficiency;
  const Moves moves{.target = target,
                    .mixture = fitted.mixture,
                    .archive = archive,
                    .local_share = fitted.efficiency > 0.05 ? options.local_share : std::max(options.local_share, 0.8),
                    .per_draw = fitted.efficiency > 0.2 ? 1 : (fitted.efficiency > 0.05 ? 3 : 10)};

  // Chains start at a point of their own population.
  for (std::size_t c = 0; c < chains; ++c) {
    const auto row = static_cast<Eigen::Index>(walkers[c].random.uniform() * static_cast<double>(size));
    walkers[c].x = populations[c].x.row(row).transpose();
    walkers[c].log_density = populations[c].log_density[row];
    walkers[c].log_proposal = fitted.mixture.log_density(walkers[c].x);
  }

  // A short burn-in under the final moves, then rounds until the stop rule is met; each round doubles the number of
  // draws.
  for_each_index(options.chains, options.threads, [&](int c) {
    Chain left_out;
    extend(moves, walkers[static_cast<std::size_t>(c)], left_out, options.burn_in);
  });
  result.chains.resize(chains);
  int drawn = 0;
  while (true) {
    const int more = std::min(drawn == 0 ? options.draws : drawn, options.draws_max - drawn);
    for_each_index(options.chains, options.threads, [&](int c) {
      const auto i = static_cast<std::size_t>(c);
      extend(moves, walkers[i], result.chains[i], more);
    });
    drawn += more;
    assess(result, options.stop);
    if (result.converged || drawn >= options.draws_max) break;
  }
  if (!result.converged) result.reason += " after " + std::to_string(drawn) + " draws per chain";

  // Evidence: mean of p / q over every proposal, outside the support zero.
  WeightSums weights;
  for (const auto& walker : walkers) {
    weights.add(walker.weights);
    result.evaluations += walker.evaluations;
  }
  const double mean = weights.sum / weights.tries;
  const double variance = weights.sum_of_squares / weights.tries - mean * mean;
  result.log_evidence = weights.largest + std::log(mean);
  result.log_evidence_error = std::sqrt(std::max(variance, 0.0) / weights.tries) / mean;
  return result;
}

}  // namespace uq
