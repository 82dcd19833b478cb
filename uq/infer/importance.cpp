#include "uq/infer/importance.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

namespace uq {
namespace {

/// Shape of a generalised Pareto law of rising `excess` over zero, with the weak prior about 0.5 of Vehtari et al.
double fitted_shape(const std::vector<double>& excess) {
  const auto n = excess.size();
  const double count = static_cast<double>(n);
  const auto points = 30 + static_cast<std::size_t>(std::sqrt(count));
  const double quarter = excess[static_cast<std::size_t>(std::lround(count / 4.0)) - 1];
  const auto shape_at = [&](double theta) {
    double sum = 0.0;
    for (const double value : excess) sum += std::log1p(-theta * value);
    return sum / count;
  };
  std::vector<double> theta(points), level(points);
  double top = nowhere;
  for (std::size_t j = 0; j < points; ++j) {
    theta[j] = 1.0 / excess.back() +
               (1.0 - std::sqrt(static_cast<double>(points) / (static_cast<double>(j) + 0.5))) / (3.0 * quarter);
    const double shape = shape_at(theta[j]);
    level[j] = count * (std::log(-theta[j] / shape) - shape - 1.0);
    if (std::isnan(level[j])) level[j] = nowhere;
    top = std::max(top, level[j]);
  }
  double sum = 0.0, weighted = 0.0;
  for (std::size_t j = 0; j < points; ++j) {
    const double weight = std::exp(level[j] - top);
    sum += weight;
    weighted += weight * theta[j];
  }
  const double shape = shape_at(weighted / sum);
  return (shape * count + 0.5 * 10.0) / (count + 10.0);
}

}  // namespace

Proposals propose(const Target& target, const Mixture& mixture, int count, data::RandomStream& random) {
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

Weights importance_weights(const Proposals& made) {
  const Eigen::VectorXd log_weights = made.log_density - made.log_proposal;
  const double largest = log_weights.maxCoeff();
  Weights weights;
  weights.values = Eigen::VectorXd::Zero(log_weights.size());
  if (!(largest > nowhere)) return weights;
  weights.values = (log_weights.array() - largest).exp();
  weights.efficiency =
      std::pow(weights.values.sum(), 2) / (weights.values.squaredNorm() * static_cast<double>(log_weights.size()));
  weights.log_evidence = largest + std::log(weights.values.sum() / made.tries);
  return weights;
}

void WeightRecord::add(const WeightRecord& other) {
  log_weights.insert(log_weights.end(), other.log_weights.begin(), other.log_weights.end());
  tries += other.tries;
}

Evidence evidence_of(const WeightRecord& record) {
  Evidence found;
  if (record.log_weights.empty()) return found;
  const double largest = *std::max_element(record.log_weights.begin(), record.log_weights.end());
  if (!(largest > nowhere)) return found;
  double sum = 0.0, squares = 0.0;
  for (const double log_weight : record.log_weights) {
    const double weight = std::exp(log_weight - largest);
    sum += weight;
    squares += weight * weight;
  }
  const double mean = sum / record.tries;
  const double variance = squares / record.tries - mean * mean;
  found.log_value = largest + std::log(mean);
  found.error = std::sqrt(std::max(variance, 0.0) / record.tries) / mean;
  found.pareto_shape = pareto_shape(record.log_weights);
  found.largest_share = 1.0 / sum;
  return found;
}

double pareto_shape(std::vector<double> log_weights) {
  const auto count = log_weights.size();
  const double size = static_cast<double>(count);
  const auto tail = static_cast<std::size_t>(std::min(0.2 * size, 3.0 * std::sqrt(size)));
  if (tail < 5) return std::numeric_limits<double>::quiet_NaN();
  std::partial_sort(log_weights.begin(), log_weights.begin() + static_cast<std::ptrdiff_t>(tail) + 1, log_weights.end(),
                    std::greater<>());
  const double largest = log_weights.front();
  if (!(largest > nowhere)) return std::numeric_limits<double>::quiet_NaN();
  const double cut = std::exp(log_weights[tail] - largest);
  std::vector<double> excess(tail);
  for (std::size_t i = 0; i < tail; ++i) excess[tail - 1 - i] = std::exp(log_weights[i] - largest) - cut;
  // Equal weights have no tail.
  if (!(excess.back() > 1e-12) || !(excess[tail / 4] > 0.0)) return nowhere;
  return fitted_shape(excess);
}

}  // namespace uq
