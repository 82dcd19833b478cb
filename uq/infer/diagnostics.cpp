#include "uq/infer/diagnostics.hpp"

#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace uq {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

/// First and last halves of each chain as chains of their own; an odd middle draw is left out.
Eigen::MatrixXd split(const Eigen::MatrixXd& draws) {
  const Eigen::Index half = draws.rows() / 2;
  Eigen::MatrixXd halves(half, 2 * draws.cols());
  halves.leftCols(draws.cols()) = draws.topRows(half);
  halves.rightCols(draws.cols()) = draws.bottomRows(half);
  return halves;
}

/// The worse of two judgements of one quantity; NaN if either is.
enum class Worse { smaller, larger };
double worse_of(double a, double b, Worse worse) {
  if (std::isnan(a) || std::isnan(b)) return not_a_number;
  return worse == Worse::smaller ? std::min(a, b) : std::max(a, b);
}

bool unusable(const Eigen::MatrixXd& draws) {
  return draws.size() < 6 || !draws.allFinite() || draws.maxCoeff() == draws.minCoeff();
}

/// Normal scores of the average ranks (Eq. 14).
Eigen::MatrixXd normal_scores(const Eigen::MatrixXd& draws) {
  const auto size = static_cast<std::size_t>(draws.size());
  std::vector<Eigen::Index> order(size);
  std::iota(order.begin(), order.end(), Eigen::Index{0});
  std::sort(order.begin(), order.end(),
            [&](Eigen::Index a, Eigen::Index b) { return draws.data()[a] < draws.data()[b]; });
  Eigen::MatrixXd scores(draws.rows(), draws.cols());
  for (std::size_t first = 0; first < size;) {
    std::size_t last = first;
    while (last + 1 < size && draws.data()[order[last + 1]] == draws.data()[order[first]]) ++last;
    const double rank = 0.5 * static_cast<double>(first + last) + 1.0;
    const double score = gsl_cdf_ugaussian_Pinv((rank - 3.0 / 8.0) / (static_cast<double>(size) + 1.0 / 4.0));
    for (std::size_t i = first; i <= last; ++i) scores.data()[order[i]] = score;
    first = last + 1;
  }
  return scores;
}

double variance(const Eigen::VectorXd& values) {
  return (values.array() - values.mean()).square().sum() / static_cast<double>(values.size() - 1);
}

/// R-hat of chains as they are (Eqs. 1 to 4).
double plain_rhat(const Eigen::MatrixXd& chains) {
  const double iterations = static_cast<double>(chains.rows());
  const Eigen::VectorXd means = chains.colwise().mean();
  const double between = iterations * variance(means);
  double within = 0.0;
  for (Eigen::Index c = 0; c < chains.cols(); ++c) within += variance(chains.col(c));
  within /= static_cast<double>(chains.cols());
  return std::sqrt((between / within + iterations - 1.0) / iterations);
}

/// Effective sample size of chains as they are (Eqs. 10 to 13), with Geyer's initial positive and monotone sequences.
double plain_ess(const Eigen::MatrixXd& chains) {
  const Eigen::Index iterations = chains.rows();
  if (iterations < 3 || unusable(chains)) return not_a_number;
  const double n = static_cast<double>(iterations);
  const Eigen::VectorXd means = chains.colwise().mean();
  const Eigen::MatrixXd centred = chains.rowwise() - means.transpose();

  // Autocovariance at one lag, averaged over chains, with the biased 1/n normalisation.
  auto autocovariance = [&](Eigen::Index lag) {
    double sum = 0.0;
    for (Eigen::Index c = 0; c < chains.cols(); ++c)
      sum += centred.col(c).head(iterations - lag).dot(centred.col(c).tail(iterations - lag));
    return sum / (n * static_cast<double>(chains.cols()));
  };
  const double lag_zero = autocovariance(0);
  const double within = lag_zero * n / (n - 1.0);
  const double pooled = lag_zero + (chains.cols() > 1 ? variance(means) : 0.0);
  auto correlation = [&](Eigen::Index lag) { return 1.0 - (within - autocovariance(lag)) / pooled; };

  // Initial positive sequence: pairs of an even and an odd lag while their sum is positive.
  std::vector<double> rho(static_cast<std::size_t>(iterations) + 2, 0.0);
  double even = 1.0, odd = correlation(1);
  rho[0] = even;
  rho[1] = odd;
  std::size_t t = 0;
  while (static_cast<Eigen::Index>(t) < iterations - 5 && even + odd > 0.0) {
    t += 2;
    even = correlation(static_cast<Eigen::Index>(t));
    odd = correlation(static_cast<Eigen::Index>(t) + 1);
    if (even + odd >= 0.0) {
      rho[t] = even;
      rho[t + 1] = odd;
    }
  }
  const std::size_t last = t;
  if (even > 0.0) rho[last] = even;

  // Initial monotone sequence.
  for (std::size_t pair = 2; pair + 2 <= last; pair += 2) {
    if (rho[pair] + rho[pair + 1] > rho[pair - 2] + rho[pair - 1]) {
      rho[pair] = 0.5 * (rho[pair - 2] + rho[pair - 1]);
      rho[pair + 1] = rho[pair];
    }
  }
  const double size = n * static_cast<double>(chains.cols());
  double tau = -1.0 + rho[last];
  for (std::size_t i = 0; i < last; ++i) tau += 2.0 * rho[i];
  return size / std::max(tau, 1.0 / std::log10(size));
}

}  // namespace

double quantile(const Eigen::VectorXd& values, double probability) {
  if (values.size() == 0) return not_a_number;
  std::vector<double> sorted(values.begin(), values.end());
  const double position = probability * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(std::floor(position));
  std::nth_element(sorted.begin(), sorted.begin() + static_cast<std::ptrdiff_t>(below), sorted.end());
  const double low = sorted[below];
  if (below + 1 >= sorted.size()) return low;
  const double high = *std::min_element(sorted.begin() + static_cast<std::ptrdiff_t>(below) + 1, sorted.end());
  return low + (position - static_cast<double>(below)) * (high - low);
}

/// The mean of the two middle values, so that both lie equally far from it and share a rank once folded.
static double median(const Eigen::VectorXd& values) {
  std::vector<double> sorted(values.begin(), values.end());
  std::sort(sorted.begin(), sorted.end());
  const std::size_t n = sorted.size();
  return n % 2 == 1 ? sorted[n / 2] : 0.5 * (sorted[n / 2 - 1] + sorted[n / 2]);
}

double rank_rhat(const Eigen::MatrixXd& draws) {
  if (unusable(draws)) return not_a_number;
  const double centre = median(draws.reshaped());
  const Eigen::MatrixXd folded = (draws.array() - centre).abs();
  return worse_of(plain_rhat(normal_scores(split(draws))), plain_rhat(normal_scores(split(folded))), Worse::larger);
}

double bulk_ess(const Eigen::MatrixXd& draws) {
  return unusable(draws) ? not_a_number : plain_ess(normal_scores(split(draws)));
}

double tail_ess(const Eigen::MatrixXd& draws) {
  if (unusable(draws)) return not_a_number;
  auto of_quantile = [&](double probability) {
    const double level = quantile(draws.reshaped(), probability);
    const Eigen::MatrixXd below = (draws.array() <= level).cast<double>();
    return plain_ess(split(below));
  };
  return worse_of(of_quantile(0.05), of_quantile(0.95), Worse::smaller);
}

double mean_ess(const Eigen::MatrixXd& draws) { return unusable(draws) ? not_a_number : plain_ess(split(draws)); }

double mean_mcse(const Eigen::MatrixXd& draws) {
  const Eigen::VectorXd all = draws.reshaped();
  return std::sqrt(variance(all) / mean_ess(draws));
}

double energy_fraction(const Eigen::VectorXd& energy) {
  if (energy.size() < 3) return not_a_number;
  const Eigen::Index n = energy.size();
  return (energy.tail(n - 1) - energy.head(n - 1)).squaredNorm() / (energy.array() - energy.mean()).square().sum();
}

}  // namespace uq
