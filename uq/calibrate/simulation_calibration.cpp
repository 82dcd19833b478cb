#include "uq/calibrate/simulation_calibration.hpp"

#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>

#include "uq/infer/diagnostics.hpp"
#include "uq/infer/factor.hpp"
#include "uq/infer/parallel.hpp"
#include "uq/posterior/posterior.hpp"

namespace uq {
namespace {

constexpr int band_simulations = 2000;

/// Number of ranks below i, for i = 1 .. rank_max.
std::vector<int> counts_below(const std::vector<int>& ranks, int rank_max) {
  std::vector<int> below(static_cast<std::size_t>(rank_max), 0);
  for (const int rank : ranks)
    if (rank < rank_max) ++below[rank];  // below[i - 1] counts rank i - 1 so far
  for (std::size_t i = 1; i < below.size(); ++i) below[i] += below[i - 1];
  return below;
}

/// Binomial distribution functions of (count, z_i), by i and number.
class Binomials {
 public:
  Binomials(int count, int rank_max) : count_(count) {
    for (int i = 1; i <= rank_max; ++i) {
      const double z = static_cast<double>(i) / (rank_max + 1);
      std::vector<double> cdf(static_cast<std::size_t>(count) + 1);
      for (int n = 0; n <= count; ++n)
        cdf[n] = gsl_cdf_binomial_P(static_cast<unsigned>(n), z, static_cast<unsigned>(count));
      cdf_.push_back(std::move(cdf));
    }
  }
  /// Two-sided tail probability of a number at point i.
  double two_sided(std::size_t i, int number) const {
    const double low = cdf_[i][number];
    const double high = number == 0 ? 1.0 : 1.0 - cdf_[i][number - 1];
    return std::min(1.0, 2.0 * std::min(low, high));
  }
  /// Smallest and largest number whose tail probability is at least `least`.
  std::pair<int, int> limits(std::size_t i, double least) const {
    int low = 0, high = count_;
    while (low < count_ && two_sided(i, low) < least) ++low;
    while (high > 0 && two_sided(i, high) < least) --high;
    return {low, high};
  }

 private:
  int count_;
  std::vector<std::vector<double>> cdf_;
};

/// The outcome of one replicate for every unknown.
struct Replicate {
  bool converged = false;
  std::string reason;  ///< why not
  std::vector<int> ranks;
  std::vector<bool> covered;
};

Replicate replicate(const CaseModel& model, const SimulationOptions& options, int index) {
  data::RandomStream random(options.seed, data::Purpose::simulated_truth, static_cast<std::uint32_t>(index));
  Eigen::VectorXd truth(model.dimension());
  for (Eigen::Index s = 0; s < truth.size(); ++s) truth[s] = model.unknowns[s].prior.draw(random);
  const StackedPrediction prediction = predict(model, truth);
  const Factor root = factor(prediction.total(), "simulated data");
  Eigen::VectorXd y(prediction.mean.size());
  for (double& value : y) value = random.normal();
  y = prediction.mean + root.llt.matrixL() * y;

  const auto simulated = std::make_shared<const CaseModel>(with_data(model, y, observed_variance(model)));
  MixtureSamplerOptions sampler = options.sampler;
  sampler.threads = 1;
  sampler.seed = data::child_seed(options.seed, data::Purpose::simulation_seed, static_cast<std::uint32_t>(index));
  const Draws draws = sample_mixture(posterior_target(simulated), sampler);
  Replicate found{.converged = draws.converged, .reason = draws.reason, .ranks = {}, .covered = {}};
  if (!draws.converged) return found;
  const Eigen::MatrixXd all = draws.pooled();
  for (Eigen::Index s = 0; s < truth.size(); ++s) {
    int rank = 0;
    for (Eigen::Index i = 0; i < options.ranks; ++i)
      if (all(i * all.rows() / options.ranks, s) < truth[s]) ++rank;
    found.ranks.push_back(rank);
    const Eigen::VectorXd column = all.col(s);
    const double tail = 0.5 * (1.0 - options.interval);
    found.covered.push_back(quantile(column, tail) <= truth[s] && truth[s] <= quantile(column, 1.0 - tail));
  }
  return found;
}

}  // namespace

RankBands rank_bands(int count, int rank_max, double level, std::uint64_t seed) {
  const Binomials binomials(count, rank_max);
  data::RandomStream random(seed, data::Purpose::rank_bands);
  // The smallest tail probability along the way, of uniform ranks.
  std::vector<double> least(band_simulations, 1.0);
  for (double& smallest : least) {
    std::vector<int> ranks(static_cast<std::size_t>(count));
    for (int& rank : ranks) rank = static_cast<int>(random.uniform() * (rank_max + 1));
    const std::vector<int> below = counts_below(ranks, rank_max);
    for (std::size_t i = 0; i < below.size(); ++i) smallest = std::min(smallest, binomials.two_sided(i, below[i]));
  }
  const double pointwise = quantile(Eigen::Map<const Eigen::VectorXd>(least.data(), band_simulations), 1.0 - level);
  RankBands bands;
  for (int i = 1; i <= rank_max; ++i) {
    const auto [low, high] = binomials.limits(static_cast<std::size_t>(i - 1), pointwise);
    bands.z.push_back(static_cast<double>(i) / (rank_max + 1));
    bands.low.push_back(static_cast<double>(low) / count);
    bands.high.push_back(static_cast<double>(high) / count);
  }
  return bands;
}

bool inside_bands(const std::vector<int>& ranks, int rank_max, const RankBands& bands) {
  const std::vector<int> below = counts_below(ranks, rank_max);
  const double count = static_cast<double>(ranks.size());
  for (std::size_t i = 0; i < below.size(); ++i)
    if (below[i] / count < bands.low[i] - 1e-12 || below[i] / count > bands.high[i] + 1e-12) return false;
  return true;
}

SimulationCalibration simulate_calibration(const CaseModel& model, const SimulationOptions& options) {
  std::vector<Replicate> replicates(static_cast<std::size_t>(options.replicates));
  std::atomic<int> done{0};
  for_each_index(options.replicates, options.threads, [&](int i) {
    replicates[i] = replicate(model, options, i);
    if (options.progress) options.progress(static_cast<double>(++done) / options.replicates);
  });
  SimulationCalibration found{.case_name = model.name,
                              .replicates = options.replicates,
                              .rank_max = options.ranks,
                              .interval = options.interval,
                              .z = {},
                              .band_low = {},
                              .band_high = {},
                              .unknowns = {}};
  for (int s = 0; s < model.dimension(); ++s) found.unknowns.push_back({.name = model.unknowns[s].label, .ranks = {}});
  for (const Replicate& one : replicates) {
    if (!one.converged) {
      ++found.failed;
      found.reasons.push_back(one.reason);
      continue;
    }
    for (std::size_t s = 0; s < found.unknowns.size(); ++s) {
      found.unknowns[s].ranks.push_back(one.ranks[s]);
      found.unknowns[s].coverage += one.covered[s] ? 1.0 : 0.0;
    }
  }
  const int used = options.replicates - found.failed;
  if (used == 0) return found;
  const double each = 1.0 - (1.0 - options.level) / std::max(1, model.dimension());
  RankBands bands = rank_bands(used, options.ranks, each, options.seed);
  for (RankCheck& one : found.unknowns) {
    one.coverage /= used;
    one.coverage_error = std::sqrt(options.interval * (1.0 - options.interval) / used);
    one.inside = inside_bands(one.ranks, options.ranks, bands);
  }
  found.z = std::move(bands.z);
  found.band_low = std::move(bands.low);
  found.band_high = std::move(bands.high);
  return found;
}

}  // namespace uq
