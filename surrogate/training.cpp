#include "surrogate/training.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <span>

#include "data/error.hpp"
#include "data/random.hpp"
#include "data/shuffle.hpp"

namespace surrogate {
namespace {

/// Smallest variance (of z) that a run may have where several share a point: exact replicates of a deterministic code.
constexpr double least_replicate_variance = 1e-14;

void check(const TrainingSet& training, OutputScale scale) {
  std::vector<data::Problem> problems;
  const Eigen::Index n = training.y.size();
  const auto add = [&](std::string what, std::string remedy) {
    problems.push_back({"training set of the surrogate", std::move(what), std::move(remedy)});
  };
  if (training.x.rows() != n || (training.noise_variance.size() != n && training.noise_variance.size() != 0))
    add(fmt::format("{} outputs come with {} points and {} noise variances", n, training.x.rows(),
                    training.noise_variance.size()),
        "give one point and one noise variance per run");
  if (n < 2) add(fmt::format("{} runs cannot train a surrogate, two are the least", n), "add runs");
  if (problems.empty()) {
    for (Eigen::Index i = 0; i < n; ++i) {
      const double variance = training.noise_variance.size() ? training.noise_variance[i] : 0.0;
      if (!training.x.row(i).allFinite() || !std::isfinite(training.y[i]) || !std::isfinite(variance))
        add(fmt::format("run {} holds a value that is not finite", i + 1), "leave the run out");
      else if (variance < 0.0)
        add(fmt::format("run {} has noise variance {}, but it must not be negative", i + 1, variance),
            "give the square of its standard error");
      else if (scale == OutputScale::log && training.y[i] <= 0.0)
        add(fmt::format("run {} has output {}, but the log scale needs it positive", i + 1, training.y[i]),
            "use the linear scale");
    }
  }
  if (!problems.empty()) throw data::InputError(data::ExitStatus::bad_data, std::move(problems));
}

}  // namespace

Standardised standardise(const TrainingSet& training, OutputScale scale, Centre centre) {
  check(training, scale);
  const Eigen::Index n = training.y.size();
  Standardised result;
  result.scale = scale;
  result.z = training.y;
  result.noise = training.noise_variance.size() ? training.noise_variance : Eigen::VectorXd::Zero(n);
  if (scale == OutputScale::log) {
    result.noise.array() /= training.y.array().square();
    result.z = training.y.array().log();
    result.log_jacobian = -result.z.sum();
  }

  // Shift and unit; a constant output keeps a unit that is its own size, so that nothing divides by zero.
  if (centre == Centre::data_mean) result.shift = result.z.mean();
  result.z.array() -= result.shift;
  const double largest = result.z.cwiseAbs().maxCoeff();
  if (largest > 1e-14 * std::abs(result.shift) && largest > 0.0) {
    result.unit = largest * std::sqrt((result.z / largest).squaredNorm() / static_cast<double>(n));
  } else {
    const double noise = std::sqrt(result.noise.mean());
    result.unit = noise > 0.0 ? noise : (result.shift != 0.0 ? std::abs(result.shift) : 1.0);
  }
  result.z /= result.unit;
  result.noise = result.noise / result.unit / result.unit;
  result.log_jacobian -= static_cast<double>(n) * std::log(result.unit);

  // Inputs that vary.
  result.low = training.x.colwise().minCoeff();
  result.high = training.x.colwise().maxCoeff();
  for (Eigen::Index k = 0; k < training.x.cols(); ++k)
    if (result.high[k] - result.low[k] > 1e-12 * std::max(1.0, std::abs(result.high[k])))
      result.active.push_back(static_cast<int>(k));

  const Eigen::MatrixXd varying = training.x(Eigen::all, result.active);
  result.point_of_run = points_of_rows(varying);
  std::vector<int> first_run;
  for (std::size_t i = 0; i < result.point_of_run.size(); ++i) {
    if (static_cast<std::size_t>(result.point_of_run[i]) == first_run.size()) {
      first_run.push_back(static_cast<int>(i));
      result.runs_of_point.push_back(0);
    }
    ++result.runs_of_point[result.point_of_run[i]];
  }
  result.points = varying(first_run, Eigen::all);
  return result;
}

std::vector<int> points_of_rows(const Eigen::MatrixXd& x) {
  std::map<std::vector<double>, int> seen;
  std::vector<int> point_of_row;
  for (Eigen::Index i = 0; i < x.rows(); ++i) {
    const Eigen::VectorXd row = x.row(i);
    const int next = static_cast<int>(seen.size());
    point_of_row.push_back(seen.emplace(std::vector<double>(row.begin(), row.end()), next).first->second);
  }
  return point_of_row;
}

std::vector<double> levels_of(const Eigen::VectorXd& column) {
  std::vector<double> values(column.begin(), column.end());
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end(), [](double a, double b) { return b - a < same_level; }),
               values.end());
  return values;
}

std::string TrainingSet::name_of(Eigen::Index input) const {
  return names.empty() ? fmt::format("input {}", input + 1) : names.at(static_cast<std::size_t>(input));
}

std::vector<int> thin(const TrainingSet& training, int most, std::uint64_t seed) {
  std::map<std::vector<double>, std::vector<int>> points;
  for (Eigen::Index i = 0; i < training.y.size(); ++i) {
    const Eigen::VectorXd row = training.x.row(i);
    points[std::vector<double>(row.begin(), row.end())].push_back(static_cast<int>(i));
  }
  std::vector<const std::vector<int>*> order;
  for (const auto& [point, runs] : points) order.push_back(&runs);
  data::RandomStream random(seed, data::Purpose::thinned_runs, 0);
  data::shuffle(std::span(order), random);
  std::vector<int> kept;
  for (const std::vector<int>* runs : order) {
    if (!kept.empty() && kept.size() + runs->size() > static_cast<std::size_t>(most)) break;
    kept.insert(kept.end(), runs->begin(), runs->end());
  }
  std::sort(kept.begin(), kept.end());
  return kept;
}

TrainingSet chosen(const TrainingSet& training, const std::vector<int>& runs) {
  TrainingSet result{training.x(runs, Eigen::all), training.y(runs), {}, training.names};
  if (training.noise_variance.size() == training.y.size()) result.noise_variance = training.noise_variance(runs);
  return result;
}

Pooled pool(const Standardised& data, double nugget_variance) {
  const Eigen::Index points = data.points.rows();
  Pooled pooled;
  if (points == data.z.size()) {  // no replicates: every run is its own point
    pooled.mean = data.z;
    pooled.variance = data.noise.array() + nugget_variance;
    pooled.mean_slope = Eigen::VectorXd::Zero(points);
    pooled.variance_slope = Eigen::VectorXd::Ones(points);
    return pooled;
  }
  Eigen::VectorXd weight_sum = Eigen::VectorXd::Zero(points), weight_square_sum = weight_sum;
  pooled.mean = weight_sum;
  pooled.mean_slope = weight_sum;
  const auto weight_of = [&](Eigen::Index i) {
    const double variance = data.noise[i] + nugget_variance;
    return 1.0 /
           (data.runs_of_point[data.point_of_run[i]] > 1 ? std::max(variance, least_replicate_variance) : variance);
  };
  // A single run keeps its variance as it is, which may be zero; only groups need weights.
  pooled.variance.resize(points);
  pooled.variance_slope = Eigen::VectorXd::Ones(points);
  for (Eigen::Index i = 0; i < data.z.size(); ++i) {
    const int j = data.point_of_run[i];
    if (data.runs_of_point[j] == 1) {
      pooled.mean[j] = data.z[i];
      pooled.variance[j] = data.noise[i] + nugget_variance;
      continue;
    }
    const double weight = weight_of(i);
    weight_sum[j] += weight;
    weight_square_sum[j] += weight * weight;
    pooled.mean[j] += weight * data.z[i];
  }
  for (Eigen::Index j = 0; j < points; ++j)
    if (data.runs_of_point[j] > 1) {
      pooled.mean[j] /= weight_sum[j];
      pooled.variance[j] = 1.0 / weight_sum[j];
      pooled.variance_slope[j] = weight_square_sum[j] / (weight_sum[j] * weight_sum[j]);
      pooled.log_likelihood +=
          0.5 * std::log(pooled.variance[j]) - 0.5 * (data.runs_of_point[j] - 1) * std::log(2.0 * std::numbers::pi);
      pooled.log_likelihood_slope += 0.5 * weight_square_sum[j] / weight_sum[j];
    }
  for (Eigen::Index i = 0; i < data.z.size(); ++i) {
    const int j = data.point_of_run[i];
    if (data.runs_of_point[j] == 1) continue;
    const double weight = weight_of(i), deviation = data.z[i] - pooled.mean[j];
    pooled.mean_slope[j] -= weight * weight * deviation / weight_sum[j];
    pooled.log_likelihood += 0.5 * std::log(weight) - 0.5 * weight * deviation * deviation;
    pooled.log_likelihood_slope += -0.5 * weight + 0.5 * weight * weight * deviation * deviation;
  }
  return pooled;
}

}  // namespace surrogate
