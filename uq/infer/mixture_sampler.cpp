#include "uq/infer/mixture_sampler.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "uq/infer/diagnostics.hpp"
#include "uq/infer/mixture_halves.hpp"
#include "uq/infer/mixture_moves.hpp"
#include "uq/infer/parallel.hpp"
#include "uq/infer/unconstrained.hpp"

namespace uq {
namespace {

using data::Purpose;
using data::RandomStream;

// Shares of the time that a sampling takes.
constexpr double after_scouts = 0.1, after_tempering = 0.4, after_adapting = 0.5, after_search = 0.6;

/// Tempers each chain from its own share of the scouts.
std::vector<Population> temper_all(const Target& target, const Scouts& scouts, std::vector<Walker>& walkers,
                                   const MixtureSamplerOptions& options) {
  std::vector<Population> populations(walkers.size());
  const Eigen::Index share = scouts.x.rows() / static_cast<Eigen::Index>(walkers.size());
  for_each_index(options.chains, options.threads, [&](int c) {
    const auto i = static_cast<std::size_t>(c);
    populations[i] =
        temper(target, {scouts.x.middleRows(c * share, share), scouts.log_density.segment(c * share, share)},
               walkers[i].random, options.tempering);
  });
  return populations;
}

/// How two means differ, in standard errors.
double apart(const Eigen::MatrixXd& first, const Eigen::MatrixXd& second) {
  return std::abs(first.mean() - second.mean()) / std::hypot(mean_mcse(first), mean_mcse(second));
}

/// The disagreement of the two halves, in words; empty where they agree.
std::string disagreement(const Draws& draws, const std::vector<Half>& halves, const MixtureSamplerOptions& options) {
  if (halves.size() < 2) return "";
  const auto count = static_cast<Eigen::Index>(halves[0].chains.size());
  for (int k = 0; k < draws.dimension(); ++k) {
    const Eigen::MatrixXd all = draws.coordinate(k);
    const Eigen::MatrixXd squares = (all.array() - all.mean()).square();
    const double means = apart(all.leftCols(count), all.rightCols(all.cols() - count));
    const double spreads = apart(squares.leftCols(count), squares.rightCols(all.cols() - count));
    if (means > options.apart_max || spreads > options.apart_max)
      return fmt::format("coordinate {}: two halves that were adapted alone differ by {:.1f} standard errors in the {}",
                         k, std::max(means, spreads), means > spreads ? "mean" : "spread");
  }
  return "";
}

std::string evidence_doubt(const std::vector<Half>& halves, const MixtureSamplerOptions& options) {
  for (const Half& half : halves)
    if (half.evidence.doubtful())
      return fmt::format(
          "the proposal does not cover the density: one of its weights is {:.2g} % of all (k-hat {:.2f}, wanted below "
          "{})",
          100.0 * half.evidence.largest_share, half.evidence.pareto_shape, pareto_shape_max);
  if (halves.size() < 2) return "";
  const double difference = std::abs(halves[0].evidence.log_value - halves[1].evidence.log_value);
  if (difference > options.apart_max * std::hypot(halves[0].evidence.error, halves[1].evidence.error) + 0.01)
    return fmt::format("two halves that were adapted alone find log evidences {:.2g} apart", difference);
  return "";
}

/// The evidence of all proposals; where the halves differ by more than their errors say, that is the error.
void set_evidence(Draws& result, const std::vector<Half>& halves) {
  const double count = static_cast<double>(halves.size());
  double largest = nowhere, sum = 0.0, variance = 0.0;
  for (const Half& half : halves) largest = std::max(largest, half.evidence.log_value);
  for (const Half& half : halves) {
    const double value = std::exp(half.evidence.log_value - largest);
    sum += value / count;
    variance += std::pow(value * half.evidence.error / count, 2);
  }
  result.log_evidence = largest + std::log(sum);
  result.log_evidence_error = std::sqrt(variance) / sum;
  result.pareto_shape = nowhere;
  for (const Half& half : halves) {
    result.pareto_shape = std::max(result.pareto_shape, half.evidence.pareto_shape);
    const double off = std::abs(half.evidence.log_value - result.log_evidence);
    if (off > 2.0 * result.log_evidence_error) result.log_evidence_error = off;
  }
}

Moves moves_of(const Target& target, const Half& half, const MixtureSamplerOptions& options) {
  const double efficiency = half.proposal.efficiency;
  return {.target = target,
          .mixture = half.proposal.best,
          .archive = half.archive,
          .local_share = efficiency > 0.05 ? options.local_share : std::max(options.local_share, 0.8),
          .per_draw = efficiency > 0.2 ? 1 : (efficiency > 0.05 ? 3 : 10)};
}

/// Draws under moves that no longer change. Chains start at a point of their own population; after a short burn-in
/// there are rounds until the stop rule is met, each of which doubles the number of draws.
void draw(const Target& target, const std::vector<Population>& populations, std::vector<Half>& halves,
          std::vector<Walker>& walkers, const MixtureSamplerOptions& options, Draws& result) {
  std::vector<Moves> moves;
  result.proposal_efficiency = 1.0;
  for (const Half& half : halves) {
    moves.push_back(moves_of(target, half, options));
    result.proposal_efficiency = std::min(result.proposal_efficiency, half.proposal.efficiency);
  }
  const auto half_of = [&](std::size_t c) { return halves.size() > 1 && c >= halves[0].chains.size() ? 1U : 0U; };
  for_each_index(options.chains, options.threads, [&](int c) {
    const auto i = static_cast<std::size_t>(c);
    Walker& walker = walkers[i];
    const auto row = static_cast<Eigen::Index>(walker.random.uniform() * static_cast<double>(populations[i].x.rows()));
    walker.x = populations[i].x.row(row).transpose();
    walker.log_density = populations[i].log_density[row];
    walker.log_proposal = moves[half_of(i)].mixture.log_density(walker.x);
    walker.weights = {};
    Chain left_out;
    extend(moves[half_of(i)], walker, left_out, options.burn_in);
  });
  result.chains.assign(walkers.size(), {});
  int drawn = 0;
  while (true) {
    const int more = std::min(drawn == 0 ? options.draws : drawn, options.draws_max - drawn);
    for_each_index(options.chains, options.threads, [&](int c) {
      const auto i = static_cast<std::size_t>(c);
      extend(moves[half_of(i)], walkers[i], result.chains[i], more);
    });
    drawn += more;
    if (options.progress) options.progress(1.0 - (1.0 - after_search) * options.draws / (options.draws + drawn));
    assess(result, options.stop);
    if (result.converged) result.reason = disagreement(result, halves, options);
    result.converged = result.converged && result.reason.empty();
    if (result.converged || drawn >= options.draws_max) break;
  }
  if (!result.converged) result.reason += " after " + std::to_string(drawn) + " draws per chain";
  for (Half& half : halves) {
    WeightRecord weights;
    for (const std::size_t c : half.chains) weights.add(walkers[c].weights);
    half.evidence = evidence_of(weights);
  }
  set_evidence(result, halves);
}

/// Each half's proposal begins anew from the draws of its own chains, which have been where the old one does not reach.
void learn_from_draws(const Draws& draws, std::vector<Half>& halves, const MixtureSamplerOptions& options) {
  for (Half& half : halves) {
    Eigen::Index rows = 0;
    for (const std::size_t c : half.chains) rows += draws.chains[c].x.rows();
    Eigen::MatrixXd all(rows, draws.dimension());
    rows = 0;
    for (const std::size_t c : half.chains) {
      all.middleRows(rows, draws.chains[c].x.rows()) = draws.chains[c].x;
      rows += draws.chains[c].x.rows();
    }
    const Eigen::Index count = std::min<Eigen::Index>(rows, options.proposal.points_max);
    Eigen::MatrixXd points(count, all.cols());
    for (Eigen::Index i = 0; i < count; ++i) points.row(i) = all.row(i * rows / count);
    const Adaptation before = std::move(half.proposal);
    half.proposal = begin_proposal(points, half.random, options.proposal);
    half.proposal.evaluations = before.evaluations;
    half.proposal.kept = before.kept;
  }
}

/// What the draws miss of the maxima that were found last: how many fewer lie near each than its mass asks for,
/// beyond two standard deviations of their number. In words; empty where it is little.
std::string missed_of(const std::vector<LastMaximum>& last, const Draws& draws, const MixtureSamplerOptions& options) {
  const Eigen::MatrixXd all = draws.pooled();
  const auto count = static_cast<double>(all.rows());
  double missed = 0.0;
  int maxima = 0;
  for (const LastMaximum& one : last) {
    const auto near = static_cast<double>(draws_near(one.peak, all));
    const double fewer = one.share / (1.0 + one.share) * count - near - 2.0 * std::sqrt(std::max(near, 1.0));
    if (fewer <= 0.0) continue;
    missed += fewer / count;
    ++maxima;
  }
  if (missed < options.missing_mass) return "";
  return fmt::format("{} hold{} about {:.2g} % of the mass, and the draws lack {}",
                     maxima == 1 ? "a maximum" : fmt::format("{} maxima", maxima), maxima == 1 ? "s" : "",
                     100.0 * missed, maxima == 1 ? "it" : "them");
}

Draws sample_as_given(const Target& target, const MixtureSamplerOptions& given) {
  MixtureSamplerOptions options = given;
  options.explore.threads = options.threads;
  Draws result;
  result.sampler = "mixture";
  result.log_evidence = result.log_evidence_error = std::numeric_limits<double>::quiet_NaN();
  const auto chains = static_cast<std::size_t>(options.chains);

  // Scouts, and each chain's warm-up from its own share of them.
  RandomStream random(options.seed, Purpose::scouts);
  const auto tell = [&](double share) {
    if (options.progress) options.progress(share);
  };
  const Scouts scouts = send_scouts(target, random, options.explore);
  tell(after_scouts);
  result.scouts = static_cast<int>(scouts.x.rows());
  result.evaluations += result.scouts;
  std::vector<Walker> walkers;
  for (std::size_t c = 0; c < chains; ++c)
    walkers.push_back({.random = RandomStream(options.seed, Purpose::sampler, static_cast<std::uint32_t>(c)), .x = {}});
  const std::vector<Population> populations = temper_all(target, scouts, walkers, options);
  tell(after_tempering);
  std::size_t best = 0;
  for (std::size_t c = 0; c < chains; ++c) {
    result.evaluations += populations[c].evaluations;
    if (populations[c].log_density.maxCoeff() > populations[best].log_density.maxCoeff()) best = c;
    if (populations[c].log_density.allFinite() && populations[c].reached) continue;
    result.reason = populations[c].log_density.maxCoeff() > nowhere ? "tempering from the prior did not come to its end"
                                                                    : "the density is zero at every start";
    return result;
  }

  // The proposals of the two halves, and what both do not know.
  std::vector<Half> halves = make_halves(populations, options);
  begin_halves(target, scouts, halves, options);
  adapt_halves(target, halves, options);
  tell(after_adapting);
  const std::vector<LastMaximum> last = find_unknown(target, scouts, populations[best], halves, options, result);
  tell(after_search);
  for (int learnt = 0;; ++learnt) {
    draw(target, populations, halves, walkers, options, result);
    const std::string doubt = evidence_doubt(halves, options);
    if (!result.converged || doubt.empty() || learnt == options.learn_again) {
      const std::string missed = result.converged ? missed_of(last, result, options) : std::string();
      if (result.converged && !(missed.empty() && doubt.empty())) {
        result.converged = false;
        result.reason = missed.empty() ? doubt : missed;
      }
      break;
    }
    learn_from_draws(result, halves, options);
    adapt_halves(target, halves, options);
  }
  for (const Half& half : halves) result.evaluations += half.proposal.evaluations;
  for (const Walker& walker : walkers) result.evaluations += walker.evaluations;
  return result;
}

}  // namespace

Draws sample_mixture(const Target& target, const MixtureSamplerOptions& options) {
  if (target.dimension < options.unconstrained_from) return sample_as_given(target, options);
  Draws draws = sample_as_given(unconstrained_target(target), options);
  for (Chain& chain : draws.chains)
    for (Eigen::Index i = 0; i < chain.x.rows(); ++i) {
      const Eigen::VectorXd z = chain.x.row(i).transpose();
      chain.log_density[i] -= log_jacobian(target, z);
      chain.x.row(i) = from_unconstrained(target, z).transpose();
    }
  return draws;
}

}  // namespace uq
