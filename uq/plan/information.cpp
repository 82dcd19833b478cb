#include "uq/plan/information.hpp"

#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "data/random.hpp"

namespace uq::plan {
namespace {

using Eigen::ArrayXd;
using Eigen::ArrayXXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index blocks = 20;                                // of the jackknife
constexpr std::array windows = {1.0, 0.4, 0.2, 0.1, 0.05};  // of the draws, on either side
constexpr Index window_least = 20;                          // draws
constexpr double correction_most = 0.1;                     // nats
constexpr double smoothing = 0.1;                           // of the draws, on either side, in the local regression

/// The readings' laws, whitened: |W_j (y - m_j)|^2 and the logarithm of N's constant.
struct Laws {
  std::vector<MatrixXd> whiten;
  VectorXd log_constant;
};

Laws whitened(const Ensemble& ensemble) {
  Laws laws{.whiten = {}, .log_constant = VectorXd(ensemble.draws())};
  const Index d = ensemble.readings();
  for (Index j = 0; j < ensemble.draws(); ++j) {
    const Eigen::LLT<MatrixXd> factor(ensemble.covariance[j]);
    laws.whiten.push_back(factor.matrixL().solve(MatrixXd::Identity(d, d)));
    laws.log_constant[j] = laws.whiten.back().diagonal().array().log().sum() -
                           0.5 * static_cast<double>(d) * std::log(2.0 * std::numbers::pi);
  }
  return laws;
}

/// The jackknife's block of a draw; the first half of the blocks are the first half of the draws.
Index block_of(Index draw, Index draws) { return draw * blocks / draws; }

/// Sums over draws j of densities at readings i, per block of j, in units of p(y_i | theta_i), and how many there are.
struct Sums {
  ArrayXXd density, count;  ///< readings x blocks
  explicit Sums(Index n) : density(ArrayXXd::Zero(n, blocks)), count(ArrayXXd::Zero(n, blocks)) {}
};

/// Blocks first to last, one of them left out; -1: none.
struct Part {
  Index first = 0, last = blocks, left_out = -1;
};

/// Mean over the part's readings of the logarithm of the part's mean density there.
double mean_log(const Sums& sums, const Part& part) {
  ArrayXd density = sums.density.middleCols(part.first, part.last - part.first).rowwise().sum();
  ArrayXd count = sums.count.middleCols(part.first, part.last - part.first).rowwise().sum();
  const bool less = part.left_out >= part.first && part.left_out < part.last;
  if (less) {
    density -= sums.density.col(part.left_out);
    count -= sums.count.col(part.left_out);
  }
  const Index n = density.size();
  double total = 0.0;
  Index used = 0;
  for (Index i = 0; i < n; ++i) {
    const Index block = block_of(i, n);
    if (block < part.first || block >= part.last || block == part.left_out) continue;
    total += std::log(density[i] / count[i]);
    ++used;
  }
  return total / static_cast<double>(used);
}

/// The densities of the readings by all draws, by each half of its own readings, and by each quarter.
struct Densities {
  std::array<Sums, 3> by;
};

/// Mean over parts of the draws, 1 << level of them, of the logarithm of the part's mean density at its own readings.
double mean_of_parts(const Densities& densities, int level, Index left_out = -1) {
  const Index parts = Index{1} << level;
  double sum = 0.0;
  for (Index k = 0; k < parts; ++k)
    sum += mean_log(densities.by[level], {k * blocks / parts, (k + 1) * blocks / parts, left_out});
  return sum / static_cast<double>(parts);
}

/// Twice the mean over all draws less the mean over the halves.
double extrapolated(const Densities& densities, Index left_out) {
  return 2.0 * mean_of_parts(densities, 0, left_out) - mean_of_parts(densities, 1, left_out);
}

/// The excess of the extrapolation through all, halves and quarters over that through all and halves.
double next_order(const Densities& densities) {
  return (2.0 * mean_of_parts(densities, 0) - 3.0 * mean_of_parts(densities, 1) + mean_of_parts(densities, 2)) / 3.0;
}

/// `value(b)`: an estimate without block b, all for b = -1.
template <class Value>
Estimate jackknife(const Value& value) {
  VectorXd without(blocks);
  for (Index b = 0; b < blocks; ++b) without[b] = value(b);
  const double n = static_cast<double>(blocks);
  return {value(-1), gsl_cdf_tdist_Pinv(0.975, n - 1.0) *
                         std::sqrt((n - 1.0) / n * (without.array() - without.mean()).square().sum())};
}

/// A large correction is no small term of an expansion: then it is the error.
Estimate widened(Estimate estimate, const Densities& densities) {
  const double correction = std::abs(extrapolated(densities, -1) - mean_of_parts(densities, 0));
  if (correction > correction_most) estimate.error = std::max(estimate.error, correction);
  return estimate;
}

/// A local quadratic in x at `knots`, ranks a share `smoothing` about each, of every column of y; and the root mean
/// square about it.
struct Smooth {
  MatrixXd level, spread;  ///< draws x readings
};

Smooth smooth_on(const VectorXd& x, const MatrixXd& y) {
  const Index n = x.size(), d = y.cols();
  const Index reach = std::max<Index>(static_cast<Index>(smoothing * static_cast<double>(n)), 10);
  const Index knots = std::min<Index>(n, 160);
  MatrixXd level(knots, d), spread(knots, d);
  VectorXd at(knots);
  for (Index k = 0; k < knots; ++k) {
    const Index centre = k * (n - 1) / std::max<Index>(knots - 1, 1);
    const Index first = std::max<Index>(centre - reach, 0), last = std::min<Index>(centre + reach, n - 1);
    const Index count = last - first + 1;
    at[k] = x[centre];
    const ArrayXd t = x.segment(first, count).array() - x[centre];
    const double width = std::max(t.abs().maxCoeff(), 1e-300);
    MatrixXd basis(count, 3);
    basis.col(0).setOnes();
    basis.col(1) = t / width;
    basis.col(2) = (t / width).square();
    const ArrayXd weight = (1.0 - (t / width).abs().cube()).max(1e-3);  // tricube, near enough
    const MatrixXd weighted = basis.array().colwise() * weight;
    const MatrixXd coefficients = (weighted.transpose() * basis + 1e-9 * MatrixXd::Identity(3, 3))
                                      .ldlt()
                                      .solve(weighted.transpose() * y.middleRows(first, count));
    level.row(k) = coefficients.row(0);
    const MatrixXd rest = y.middleRows(first, count) - basis * coefficients;
    spread.row(k) = ((rest.array().square().colwise() * weight).colwise().sum() / weight.sum()).sqrt().matrix();
  }
  Smooth smooth{MatrixXd(n, d), MatrixXd(n, d)};
  Index k = 0;
  for (Index i = 0; i < n; ++i) {
    while (k + 2 < knots && x[i] > at[k + 1]) ++k;
    const double gap = at[std::min(k + 1, knots - 1)] - at[k];
    const double share = gap > 0.0 ? std::clamp((x[i] - at[k]) / gap, 0.0, 1.0) : 0.0;
    const Index next = std::min(k + 1, knots - 1);
    smooth.level.row(i) = level.row(k) + share * (level.row(next) - level.row(k));
    smooth.spread.row(i) = spread.row(k) + share * (spread.row(next) - spread.row(k));
  }
  for (Index c = 0; c < d; ++c) {
    const double floor = 1e-3 * smooth.spread.col(c).maxCoeff() + 1e-300;
    smooth.spread.col(c) = smooth.spread.col(c).cwiseMax(floor);
  }
  return smooth;
}

/// Squared length of W (y_i - shift_i), readings y and shifts stored by columns.
void squared_length(const MatrixXd& whiten, const MatrixXd& difference, ArrayXd& result) {
  const Index d = difference.cols();
  result = (whiten(0, 0) * difference.col(0).array()).square();
  for (Index r = 1; r < d; ++r) {
    ArrayXd row = whiten(r, 0) * difference.col(0).array();
    for (Index c = 1; c <= r; ++c) row += whiten(r, c) * difference.col(c).array();
    result += row.square();
  }
}

/// What the draws say of every reading.
struct Marginal {
  Sums density;
  ArrayXXd sd;  ///< readings x parameters: posterior sd
};

Marginal marginal_of(const Ensemble& ensemble, const Laws& laws, const MatrixXd& readings, const ArrayXd& own) {
  const Index n = ensemble.draws(), p = ensemble.values.cols();
  Marginal found{Sums(n), ArrayXXd::Zero(n, p)};
  ArrayXXd first = ArrayXXd::Zero(n, p), second = ArrayXXd::Zero(n, p);
  ArrayXd squares = ArrayXd::Zero(n), others = ArrayXd::Zero(n), term(n);
  const Eigen::RowVectorXd centre = ensemble.values.colwise().mean();
  MatrixXd difference(n, ensemble.readings());
  for (Index j = 0; j < n; ++j) {
    difference = readings.rowwise() - ensemble.mean.row(j);
    squared_length(laws.whiten[j], difference, term);
    term = (-0.5 * term + laws.log_constant[j] - own).exp();
    found.density.density.col(block_of(j, n)) += term;
    found.density.count.col(block_of(j, n)) += 1.0;
    term[j] = 0.0;  // what a reading makes of the unknowns is asked as if its own draw were not among them
    squares += term.square();
    others += term;
    for (Index k = 0; k < p; ++k) {
      const double value = ensemble.values(j, k) - centre[k];
      first.col(k) += term * value;
      second.col(k) += term * (value * value);
    }
  }
  const ArrayXd sum = others.max(1e-300);
  const ArrayXd effective = sum.square() / squares.max(1e-300);
  for (Index k = 0; k < p; ++k) {
    const ArrayXd variance = (second.col(k) / sum - (first.col(k) / sum).square()).max(0.0);
    found.sd.col(k) = (variance * effective / (effective - 1.0).max(0.5)).sqrt();
  }
  return found;
}

/// Draws first to last of an ensemble, with their readings.
struct Span {
  Index first = 0, count = 0;
};

/// Adds, per window, the densities of the span's readings given parameter k, as the span's draws tell them.
void add_conditional(const Ensemble& ensemble, const Laws& laws, const MatrixXd& readings, const ArrayXd& own, Index k,
                     Span span, std::vector<Sums*> sums) {
  const Index n = span.count, d = ensemble.readings();
  std::vector<Index> order(static_cast<std::size_t>(n));
  std::iota(order.begin(), order.end(), span.first);
  std::stable_sort(order.begin(), order.end(),
                   [&](Index a, Index b) { return ensemble.values(a, k) < ensemble.values(b, k); });
  VectorXd x(n);
  MatrixXd mean(n, d), about(n, d);
  ArrayXd reference(n);
  for (Index i = 0; i < n; ++i) {
    const Index from = order[i];
    x[i] = ensemble.values(from, k);
    mean.row(i) = ensemble.mean.row(from);
    about.row(i) = readings.row(from);
    reference[i] = own[from];
  }
  const Smooth smooth = smooth_on(x, mean);
  const MatrixXd rest = (mean - smooth.level).array() / smooth.spread.array();
  about -= smooth.level;

  std::vector<Sums> sorted(windows.size(), Sums(n));
  MatrixXd difference(n, d);
  ArrayXd term(n);
  for (Index j = 0; j < n; ++j) {
    const Index from = order[j], block = block_of(from, ensemble.draws());
    for (Index c = 0; c < d; ++c) difference.col(c) = about.col(c) - rest(j, c) * smooth.spread.col(c);
    squared_length(laws.whiten[from], difference, term);
    term = (-0.5 * term + laws.log_constant[from] - reference).exp();
    for (std::size_t w = 0; w < windows.size(); ++w) {
      const Index reach = std::max<Index>(static_cast<Index>(windows[w] * static_cast<double>(n)), window_least);
      const Index first = std::max<Index>(j - reach, 0), last = std::min<Index>(j + reach, n - 1);
      sorted[w].density.col(block).segment(first, last - first + 1) += term.segment(first, last - first + 1);
      sorted[w].count.col(block).segment(first, last - first + 1) += 1.0;
    }
  }
  for (std::size_t w = 0; w < windows.size(); ++w)
    for (Index i = 0; i < n; ++i) {
      sums[w]->density.row(order[i]) += sorted[w].density.row(i);
      sums[w]->count.row(order[i]) += sorted[w].count.row(i);
    }
}

/// Per window, the densities given parameter k.
std::vector<Densities> conditional_on(const Ensemble& ensemble, const Laws& laws, const MatrixXd& readings,
                                      const ArrayXd& own, Index k) {
  const Index n = ensemble.draws();
  std::vector<Densities> found(windows.size(), Densities{{Sums(n), Sums(n), Sums(n)}});
  const auto first_of = [n](Index block) { return (block * n + blocks - 1) / blocks; };
  for (std::size_t level = 0; level < 3; ++level) {
    std::vector<Sums*> sums;
    for (Densities& one : found) sums.push_back(&one.by[level]);
    const Index parts = Index{1} << level;
    for (Index part = 0; part < parts; ++part) {
      const Index from = first_of(part * blocks / parts), to = first_of((part + 1) * blocks / parts);
      add_conditional(ensemble, laws, readings, own, k, {from, to - from}, sums);
    }
  }
  return found;
}

MatrixXd drawn_noise(Index draws, Index readings, std::uint64_t seed) {
  data::RandomStream random(seed, data::Purpose::planned_noise);
  MatrixXd noise(draws, readings);
  for (Index i = 0; i < draws; ++i)
    for (Index c = 0; c < readings; ++c) noise(i, c) = random.normal();
  return noise;
}

}  // namespace

Information information(const Ensemble& ensemble, const InformationOptions& options) {
  const Index n = ensemble.draws(), d = ensemble.readings(), p = ensemble.values.cols();
  const Laws laws = whitened(ensemble);
  const MatrixXd noise = options.noise.size() > 0 ? options.noise : drawn_noise(n, d, options.seed);
  MatrixXd readings(n, d);
  ArrayXd own(n);
  for (Index i = 0; i < n; ++i) {
    const auto& whiten = laws.whiten[i];
    readings.row(i) =
        ensemble.mean.row(i) + whiten.triangularView<Eigen::Lower>().solve(noise.row(i).transpose()).transpose();
    own[i] = laws.log_constant[i] - 0.5 * noise.row(i).squaredNorm();
  }
  const Marginal marginal = marginal_of(ensemble, laws, readings, own);
  Information found;
  const Densities density{{marginal.density, marginal.density, marginal.density}};
  found.total = widened(jackknife([&](Index b) { return -extrapolated(density, b); }), density);
  found.total.remainder = -next_order(density);
  for (Index k = 0; k < p; ++k) {
    const std::vector<Densities> conditional = conditional_on(ensemble, laws, readings, own, k);
    // A narrower window has to earn its place: the largest of several noisy scores is too large.
    const Densities* best = &conditional.front();
    for (const Densities& narrower : conditional) {
      const Estimate gain = jackknife([&](Index b) { return extrapolated(narrower, b) - extrapolated(*best, b); });
      if (gain.value > gain.error) best = &narrower;
    }
    InformationAbout about;
    about.information = jackknife([&](Index b) { return extrapolated(*best, b) - extrapolated(density, b); });
    about.information = widened(widened(about.information, density), *best);
    about.information.value = std::max(about.information.value, 0.0);
    about.information.remainder = next_order(*best) - next_order(density);
    about.sd_after = jackknife([&](Index b) {
      double sum = 0.0;
      Index used = 0;
      for (Index i = 0; i < n; ++i)
        if (block_of(i, n) != b) {
          sum += marginal.sd(i, k);
          ++used;
        }
      return sum / static_cast<double>(used);
    });
    found.about.push_back(about);
  }
  return found;
}

Information combined(const std::vector<Information>& repeats) {
  if (repeats.size() < 2) return repeats.empty() ? Information{} : repeats.front();
  const auto n = static_cast<double>(repeats.size());
  // Student's 96 % of a few means that are not quite normal hold at least 95 % of the truths (PLANS.md).
  const double factor = gsl_cdf_tdist_Pinv(0.98, n - 1.0);
  const auto pooled = [&](const auto& member) {
    double sum = 0.0, squares = 0.0, remainder = 0.0, single = 0.0;
    for (const Information& one : repeats) {
      sum += member(one).value + member(one).remainder;
      remainder += member(one).remainder / n;
      single += member(one).error / n;
    }
    for (const Information& one : repeats) squares += std::pow(member(one).value + member(one).remainder - sum / n, 2);
    const double error = std::hypot(factor * std::sqrt(squares / (n - 1.0) / n), remainder);
    // Where the next order is no small term either, repeats share more than it tells: then a single estimate's error
    // holds.
    return Estimate{sum / n, std::abs(remainder) > correction_most ? std::max(error, single) : error};
  };
  Information found;
  found.total = pooled([](const Information& one) { return one.total; });
  for (std::size_t k = 0; k < repeats.front().about.size(); ++k)
    found.about.push_back({pooled([k](const Information& one) { return one.about[k].information; }),
                           pooled([k](const Information& one) { return one.about[k].sd_after; })});
  return found;
}

}  // namespace uq::plan
