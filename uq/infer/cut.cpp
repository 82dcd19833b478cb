#include "uq/infer/cut.hpp"

#include <algorithm>
#include <cmath>

#include "uq/infer/parallel.hpp"

namespace uq {
namespace {

/// One chain of theta under a held phi.
class Conditional {
 public:
  Conditional(const Target& target, const GivenDraws& given, const CutOptions& options, std::uint32_t chain)
      : target_(target), given_(given), phi_(given.chains[chain]), random_(options.seed, data::Purpose::cut, chain) {
    for (int s = 0; s < target.dimension; ++s)
      if (std::find(given.unknowns.begin(), given.unknowns.end(), s) == given.unknowns.end()) free_.push_back(s);
  }

  /// Starts from the best of some reference draws at the first phi; false when the density is zero at all of them.
  bool start(int sweeps) {
    for (int i = 0; i < 200; ++i) {
      Eigen::VectorXd x = target_.reference.draw(random_);
      hold(x, 0);
      const double level = density(x);
      ++evaluations_;
      if (i == 0 || level > level_) {
        x_ = x;
        level_ = level;
      }
    }
    if (!std::isfinite(level_)) return false;
    if (free_.empty()) return true;  // all is given
    const auto d = static_cast<Eigen::Index>(free_.size());
    axes_ = Eigen::MatrixXd::Zero(target_.dimension, d);
    for (Eigen::Index k = 0; k < d; ++k) axes_(free_[k], k) = 0.1;
    Eigen::MatrixXd seen(sweeps, d);
    for (int i = 0; i < sweeps; ++i) {
      sweep();
      for (Eigen::Index k = 0; k < d; ++k) seen(i, k) = x_[free_[k]];
    }
    const Eigen::MatrixXd late = seen.bottomRows(sweeps - sweeps / 3);
    const Eigen::MatrixXd centred = late.rowwise() - late.colwise().mean();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(centred.transpose() * centred /
                                                                static_cast<double>(late.rows()));
    // Steps of two sd along the principal axes.
    for (Eigen::Index k = 0; k < d; ++k)
      for (Eigen::Index j = 0; j < d; ++j)
        axes_(free_[j], k) = 2.0 * std::sqrt(std::max(solver.eigenvalues()[k], 1e-16)) * solver.eigenvectors()(j, k);
    return true;
  }

  /// Draws at every `step`-th phi.
  void extend(Chain& chain, Eigen::Index step, int sweeps) {
    for (Eigen::Index row = 0; row < phi_.rows(); row += step) {
      hold(x_, row);
      level_ = density(x_);
      ++evaluations_;
      for (int i = 0; i < sweeps; ++i) sweep();
      const Eigen::Index at = chain.x.rows();
      chain.x.conservativeResize(at + 1, target_.dimension);
      chain.log_density.conservativeResize(at + 1);
      chain.acceptance.conservativeResize(at + 1);
      chain.x.row(at) = x_.transpose();
      chain.log_density[at] = level_;
      chain.acceptance[at] = 1.0;
    }
  }

  std::int64_t evaluations() const { return evaluations_; }

 private:
  void hold(Eigen::VectorXd& x, Eigen::Index row) const {
    for (std::size_t k = 0; k < given_.unknowns.size(); ++k)
      x[given_.unknowns[k]] = phi_(row, static_cast<Eigen::Index>(k));
  }

  double density(const Eigen::VectorXd& x) const {
    if (!target_.contains(x)) return nowhere;
    const double value = target_.log_density(x);
    return std::isnan(value) ? nowhere : value;
  }

  /// One slice update along each axis, by stepping out and shrinking. The steps out are limited, and a random share of
  /// them is each side's (Neal, figure 3): with a fixed limit a side the update would not leave the density invariant.
  void sweep() {
    constexpr int out_max = 80, shrink_max = 200;
    for (Eigen::Index k = 0; k < axes_.cols(); ++k) {
      const Eigen::VectorXd axis = axes_.col(k);
      const auto at = [&](double t) {
        ++evaluations_;
        return density(x_ + t * axis);
      };
      const double slice = level_ + std::log(random_.uniform());
      double low = -random_.uniform(), high = low + 1.0;
      int left = static_cast<int>(random_.uniform() * out_max), right = out_max - 1 - left;
      for (; left > 0 && at(low) > slice; --left) low -= 1.0;
      for (; right > 0 && at(high) > slice; --right) high += 1.0;
      for (int i = 0; i < shrink_max; ++i) {
        const double t = random_.uniform(low, high);
        const double level = at(t);
        if (level > slice) {
          x_ += t * axis;
          level_ = level;
          break;
        }
        (t < 0.0 ? low : high) = t;
      }
    }
  }

  const Target& target_;
  const GivenDraws& given_;
  const Eigen::MatrixXd& phi_;
  data::RandomStream random_;
  std::vector<int> free_;  // unknowns that are not given
  Eigen::VectorXd x_;
  double level_ = 0.0;
  Eigen::MatrixXd axes_;  // columns
  std::int64_t evaluations_ = 0;
};

}  // namespace

Draws sample_cut(const Target& target, const GivenDraws& given, const CutOptions& options) {
  Draws result;
  result.sampler = "cut";
  result.log_evidence = result.log_evidence_error = std::numeric_limits<double>::quiet_NaN();
  const auto count = static_cast<int>(given.chains.size());
  const Eigen::Index available = given.chains.front().rows();
  std::vector<Conditional> chains;
  for (int c = 0; c < count; ++c) chains.emplace_back(target, given, options, static_cast<std::uint32_t>(c));
  std::vector<char> started(chains.size(), 0);
  for_each_index(count, options.threads, [&](int c) {
    const auto i = static_cast<std::size_t>(c);
    started[i] = chains[i].start(options.burn_in) ? 1 : 0;
  });
  if (std::find(started.begin(), started.end(), 0) != started.end()) {
    result.reason = "the density is zero at every start";
    return result;
  }
  Eigen::Index step = std::max<Eigen::Index>(1, available / options.draws);
  while (true) {
    result.chains.assign(chains.size(), {});
    for_each_index(count, options.threads, [&](int c) {
      const auto i = static_cast<std::size_t>(c);
      chains[i].extend(result.chains[i], step, options.sweeps);
    });
    assess(result, options.stop);
    if (result.converged || step == 1) break;
    step /= 2;
  }
  if (!result.converged)
    result.reason += " after " + std::to_string(result.chains.front().x.rows()) + " draws per chain";
  for (const auto& chain : chains) result.evaluations += chain.evaluations();
  return result;
}

}  // namespace uq
