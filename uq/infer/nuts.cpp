#include "uq/infer/nuts.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <limits>
#include <mutex>

#include "uq/infer/parallel.hpp"
#include "uq/infer/second_check.hpp"
#include "uq/infer/unconstrained.hpp"

namespace uq {
namespace {

using data::Purpose;
using data::RandomStream;
using Eigen::MatrixXd;
using Eigen::VectorXd;
constexpr double energy_rise_max = 1000.0;

/// log(exp(a) + exp(b)).
double log_add(double a, double b) {
  const double top = std::max(a, b);
  return top == nowhere ? nowhere : top + std::log(std::exp(a - top) + std::exp(b - top));
}

struct Phase {
  VectorXd z, p;
  Evaluation density;
};

/// Covariance of z and its Cholesky factor.
struct Metric {
  MatrixXd covariance, factor;
  explicit Metric(Eigen::Index d) : covariance(MatrixXd::Identity(d, d)), factor(MatrixXd::Identity(d, d)) {}
  /// Keeps what there is where `wanted` has no factor, as the covariance of draws that hardly move: any metric is
  /// valid, and a worse one only costs steps.
  void set(const MatrixXd& wanted) {
    const Eigen::LLT<MatrixXd> llt(wanted);
    if (llt.info() != Eigen::Success) return;
    covariance = wanted;
    factor = llt.matrixL();
  }
};

/// Nesterov's dual averaging of the log step size (Hoffman & Gelman, eq. 6, with their constants).
struct StepSize {
  double centre = 0.0, mean_error = 0.0, log_step = 0.0, log_mean = 0.0;
  int count = 0;
  void restart(double step) {
    centre = std::log(10.0 * step);
    mean_error = log_mean = 0.0;
    log_step = std::log(step);
    count = 0;
  }
  void learn(double acceptance, double wanted) {
    ++count;
    const double n = count;
    const double weight = 1.0 / (n + 10.0);
    mean_error = (1.0 - weight) * mean_error + weight * (wanted - acceptance);
    log_step = centre - std::sqrt(n) / 0.05 * mean_error;
    const double keep = std::pow(n, -0.75);
    log_mean = (1.0 - keep) * log_mean + keep * log_step;
  }
};

class NutsChain {
 public:
  NutsChain(const Target& target, const NutsOptions& options, std::uint32_t index)
      : target_(target), options_(options), random_(options.seed, Purpose::nuts, index), metric_(target.dimension) {}

  /// Starts from a reference draw where the density is positive; false when 100 draws found none.
  bool start() {
    for (int i = 0; i < 100; ++i) {
      now_.z = to_unconstrained(target_, target_.reference.draw(random_));
      now_.density = density(now_.z);
      if (std::isfinite(now_.density.value) && now_.density.gradient.allFinite()) return true;
    }
    return false;
  }

  void warm_up() {
    find_step();
    // Windows: a fast start, windows of doubling length that learn the metric, a last stretch for the step size.
    const int total = options_.warm_up, first = total * 15 / 100, last = total / 10;
    int window = 25, end = first + window;
    std::vector<VectorXd> seen;
    for (int i = 0; i < total; ++i) {
      transition();
      step_.learn(acceptance_, options_.acceptance);
      if (i < first || i >= total - last) continue;
      seen.push_back(now_.z);
      if (i + 1 < end && i + 1 < total - last) continue;
      learn_metric(seen);
      seen.clear();
      window *= 2;
      end = i + 1 + window;
      if (end + 2 * window > total - last) end = total - last;
      find_step();
    }
    step_.log_step = step_.log_mean;
  }

  void extend(Chain& chain, int draws) {
    const Eigen::Index before = chain.x.rows();
    chain.x.conservativeResize(before + draws, target_.dimension);
    chain.log_density.conservativeResize(before + draws);
    chain.acceptance.conservativeResize(before + draws);
    chain.energy.conservativeResize(before + draws);
    for (Eigen::Index i = before; i < before + draws; ++i) {
      transition();
      const VectorXd x = from_unconstrained(target_, now_.z);
      chain.x.row(i) = x.transpose();
      chain.log_density[i] = target_.log_density(x);
      chain.acceptance[i] = acceptance_;
      chain.energy[i] = energy_;
      chain.tree_depth.push_back(depth_);
      chain.diverged.push_back(diverged_);
    }
  }

  void tell(std::function<void()> after_each_transition) { told_ = std::move(after_each_transition); }
  std::int64_t evaluations() const { return evaluations_; }

 private:
  /// A side of the trajectory, or a part of it.
  struct Tree {
    VectorXd p_begin, p_end, velocity_begin, velocity_end, momentum_sum;
    Phase proposal;
    double log_weight = nowhere;
  };

  Evaluation density(const VectorXd& z) {
    ++evaluations_;
    Evaluation found = unconstrained_density(target_, z);
    if (std::isnan(found.value)) found.value = nowhere;
    return found;
  }

  double energy(const Phase& phase) const {
    const double found = -phase.density.value + 0.5 * phase.p.dot(metric_.covariance * phase.p);
    return std::isnan(found) ? -nowhere : found;
  }

  void draw_momentum(Phase& phase) {
    VectorXd normal(target_.dimension);
    for (double& value : normal) value = random_.normal();
    phase.p = metric_.factor.transpose().triangularView<Eigen::Upper>().solve(normal);
  }

  void leapfrog(Phase& phase, double step) {
    phase.p += 0.5 * step * phase.density.gradient;
    phase.z += step * (metric_.covariance * phase.p);
    phase.density = density(phase.z);
    if (phase.density.gradient.allFinite()) phase.p += 0.5 * step * phase.density.gradient;
  }

  /// Halves or doubles the step until one leapfrog step accepts with probability near 0.8, then restarts its
  /// adaptation.
  void find_step() {
    double step = std::exp(step_.log_step);
    int direction = 0;
    for (int i = 0; i < 60; ++i) {
      Phase trial = now_;
      draw_momentum(trial);
      const double before = energy(trial);
      leapfrog(trial, step);
      const int wanted = before - energy(trial) > std::log(0.8) ? 1 : -1;
      if (direction != 0 && wanted != direction) break;
      direction = wanted;
      step *= direction > 0 ? 2.0 : 0.5;
    }
    step_.restart(step);
  }

  void learn_metric(const std::vector<VectorXd>& seen) {
    const double n = static_cast<double>(seen.size());
    if (n < 2.0 * target_.dimension) return;
    VectorXd mean = VectorXd::Zero(target_.dimension);
    for (const auto& z : seen) mean += z / n;
    MatrixXd covariance = MatrixXd::Zero(target_.dimension, target_.dimension);
    for (const auto& z : seen) covariance += (z - mean) * (z - mean).transpose() / (n - 1.0);
    // Shrunk a little towards a small multiple of the identity, as in Stan.
    covariance *= n / (n + 5.0);
    covariance.diagonal().array() += 1e-3 * 5.0 / (n + 5.0);
    metric_.set(covariance);
  }

  static bool goes_on(const VectorXd& velocity_begin, const VectorXd& velocity_end, const VectorXd& momentum_sum) {
    return velocity_begin.dot(momentum_sum) > 0.0 && velocity_end.dot(momentum_sum) > 0.0;
  }

  /// Grows a tree of 2^depth steps from `phase`, which moves along. False when it turned back or diverged.
  bool grow(int depth, Phase& phase, double step, Tree& tree) {
    if (depth == 0) {
      leapfrog(phase, step);
      ++steps_;
      const double rise = energy(phase) - start_energy_;
      if (!(rise <= energy_rise_max)) diverged_ = true;
      tree.log_weight = -rise;
      acceptance_sum_ += std::min(1.0, std::exp(-rise));
      tree.proposal = phase;
      tree.p_begin = tree.p_end = tree.momentum_sum = phase.p;
      tree.velocity_begin = tree.velocity_end = metric_.covariance * phase.p;
      return !diverged_;
    }
    Tree first, second;
    if (!grow(depth - 1, phase, step, first) || !grow(depth - 1, phase, step, second)) return false;
    tree.log_weight = log_add(first.log_weight, second.log_weight);
    tree.proposal =
        random_.uniform() < std::exp(second.log_weight - tree.log_weight) ? second.proposal : first.proposal;
    join(tree, first, second);
    return keeps_going(first, second, tree.momentum_sum);
  }

  static void join(Tree& tree, const Tree& first, const Tree& second) {
    tree.p_begin = first.p_begin;
    tree.velocity_begin = first.velocity_begin;
    tree.p_end = second.p_end;
    tree.velocity_end = second.velocity_end;
    tree.momentum_sum = first.momentum_sum + second.momentum_sum;
  }

  /// The criterion over the whole, and from each half to the near end of the other.
  static bool keeps_going(const Tree& first, const Tree& second, const VectorXd& sum) {
    return goes_on(first.velocity_begin, second.velocity_end, sum) &&
           goes_on(first.velocity_begin, second.velocity_begin, first.momentum_sum + second.p_begin) &&
           goes_on(first.velocity_end, second.velocity_end, second.momentum_sum + first.p_end);
  }

  void transition() {
    draw_momentum(now_);
    start_energy_ = energy(now_);
    acceptance_sum_ = 0.0;
    steps_ = 0;
    diverged_ = false;
    const double step = std::exp(step_.log_step);
    Phase forward = now_, backward = now_;
    Tree tree;
    tree.p_begin = tree.p_end = tree.momentum_sum = now_.p;
    tree.velocity_begin = tree.velocity_end = metric_.covariance * now_.p;
    tree.proposal = now_;
    tree.log_weight = 0.0;
    for (depth_ = 0; depth_ < options_.depth_max;) {
      const bool ahead = random_.uniform() < 0.5;
      Tree side;
      const bool valid = grow(depth_, ahead ? forward : backward, ahead ? step : -step, side);
      ++depth_;
      if (!valid) break;
      if (random_.uniform() < std::exp(side.log_weight - tree.log_weight)) tree.proposal = side.proposal;
      // A side grown backwards begins at its far end in time; momenta keep their sign, so only its ends swap.
      if (!ahead) {
        std::swap(side.p_begin, side.p_end);
        std::swap(side.velocity_begin, side.velocity_end);
      }
      const Tree& first = ahead ? tree : side;
      const Tree& second = ahead ? side : tree;
      const VectorXd sum = tree.momentum_sum + side.momentum_sum;
      const bool on = keeps_going(first, second, sum);
      Tree whole;
      join(whole, first, second);
      whole.log_weight = log_add(tree.log_weight, side.log_weight);
      whole.proposal = tree.proposal;
      tree = std::move(whole);
      if (!on) break;
    }
    acceptance_ = steps_ > 0 ? acceptance_sum_ / steps_ : 0.0;
    now_ = tree.proposal;
    energy_ = energy(now_);
    if (told_) told_();
  }

  const Target& target_;
  const NutsOptions& options_;
  RandomStream random_;
  Metric metric_;
  StepSize step_;
  Phase now_;
  double acceptance_ = 0.0, energy_ = 0.0, start_energy_ = 0.0, acceptance_sum_ = 0.0;
  int depth_ = 0, steps_ = 0;
  bool diverged_ = false;
  std::int64_t evaluations_ = 0;
  std::function<void()> told_;  ///< after each transition
};

/// The work done, told now and then.
class Tally {
 public:
  explicit Tally(const NutsOptions& options)
      : tell_(options.progress),
        planned_(options.chains * static_cast<std::int64_t>(options.warm_up + options.draws)) {}

  void add_round(std::int64_t transitions) { planned_ += transitions; }

  void transition() {
    if (!tell_) return;
    const std::scoped_lock lock(mutex_);
    if (++done_ % 32 != 0) return;
    share_ = std::max(share_, static_cast<double>(done_) / static_cast<double>(planned_));
    tell_(std::min(1.0, share_));
  }

 private:
  const std::function<void(double)>& tell_;
  std::mutex mutex_;
  std::int64_t planned_, done_ = 0;
  double share_ = 0.0;
};

}  // namespace

Draws sample_nuts(const Target& target, const NutsOptions& options) {
  assert(target.log_density_gradient);
  Draws result;
  result.sampler = "nuts";
  result.log_evidence = result.log_evidence_error = std::numeric_limits<double>::quiet_NaN();
  Tally tally(options);
  std::vector<NutsChain> chains;
  for (int c = 0; c < options.chains; ++c) {
    chains.emplace_back(target, options, static_cast<std::uint32_t>(c));
    chains.back().tell([&tally] { tally.transition(); });
  }
  std::vector<char> started(chains.size(), 0);
  for_each_index(options.chains, options.threads, [&](int c) {
    const auto i = static_cast<std::size_t>(c);
    started[i] = chains[i].start() ? 1 : 0;
    if (started[i] != 0) chains[i].warm_up();
  });
  if (std::find(started.begin(), started.end(), 0) != started.end()) {
    result.reason = "the density is zero at every start";
    return result;
  }
  result.chains.resize(chains.size());
  for (int drawn = 0; drawn < options.draws_max && !result.converged;) {
    const int more = std::min(drawn == 0 ? options.draws : drawn, options.draws_max - drawn);
    if (drawn > 0) tally.add_round(options.chains * static_cast<std::int64_t>(more));
    for_each_index(options.chains, options.threads, [&](int c) {
      const auto i = static_cast<std::size_t>(c);
      chains[i].extend(result.chains[i], more);
    });
    drawn += more;
    assess(result, options.stop);
  }
  result.divergences = 0;
  for (std::size_t c = 0; c < chains.size(); ++c) {
    result.evaluations += chains[c].evaluations();
    for (const bool diverged : result.chains[c].diverged) result.divergences += diverged ? 1 : 0;
  }
  if (!result.converged) return result;
  result.reason = missed_maxima(target, result, {.explore = {.threads = options.threads}, .seed = options.seed});
  result.converged = result.reason.empty();
  return result;
}

}  // namespace uq
