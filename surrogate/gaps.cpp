#include "surrogate/gaps.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace surrogate {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::RowVectorXd;
using Eigen::VectorXd;

constexpr double nowhere = std::numeric_limits<double>::infinity();

/// Matern 5/2.
double correlation(double distance, double length) {
  double square = distance * distance / (length * length), value = 0.0;
  correlate(Kernel::matern52, {{&square, 1}, {&value, 1}, {nullptr, 0}});
  return value;
}

double weight_of(double width) { return std::clamp((width - gap_narrow) / (gap_wide - gap_narrow), 0.0, 1.0); }

bool inside(const InputGap& gap, double x) { return x > gap.low && x < gap.high; }

/// rho: how alike the departure is at two points that differ in the other inputs.
double likeness(const InputGap& gap, const RowVectorXd& a, const RowVectorXd& b) {
  double square = 0.0;
  for (Index k = 0; k < a.size(); ++k)
    if (k != gap.input) square += (a[k] - b[k]) * (a[k] - b[k]);
  return correlation(std::sqrt(square), gap_reach);
}

}  // namespace

std::vector<InputGap> find_gaps(const Standardised& data) {
  std::vector<InputGap> gaps;
  for (Index k = 0; k < data.points.cols(); ++k) {
    const std::vector<double> values = levels_of(data.points.col(k));
    const auto add = [&](double low, double high, double width) {
      if (const double weight = weight_of(width); weight > 0.0)
        gaps.push_back({.input = static_cast<int>(k), .low = low, .high = high, .sd = weight});
    };
    add(-nowhere, values.front(), 2.0 * values.front());
    for (std::size_t i = 1; i < values.size(); ++i) add(values[i - 1], values[i], values[i] - values[i - 1]);
    add(values.back(), nowhere, 2.0 * (1.0 - values.back()));
  }
  return gaps;
}

VectorXd input_effects(const GaussianProcess& process) {
  constexpr Index rows_most = 48, values_most = 9;
  const Standardised& data = process.data();
  const Index count = std::min(rows_most, data.points.rows());
  VectorXd effects = VectorXd::Zero(data.points.cols());
  for (Index k = 0; k < data.points.cols(); ++k) {
    const std::vector<double> all = levels_of(data.points.col(k));
    const Index values = std::min<Index>(values_most, static_cast<Index>(all.size()));
    MatrixXd points = data.low.transpose().replicate(count * values, 1);
    for (Index i = 0; i < count; ++i)
      for (Index v = 0; v < values; ++v) {
        const Index row = i * values + v;
        for (Index j = 0; j < data.points.cols(); ++j)
          points(row, data.active[j]) = data.points(i * data.points.rows() / count, j);
        points(row, data.active[k]) =
            all[static_cast<std::size_t>(v * (static_cast<Index>(all.size()) - 1) / std::max<Index>(1, values - 1))];
      }
    VectorXd mean = process.predict_marginal(points).mean;
    if (data.scale == OutputScale::log) mean = mean.array().max(1e-300).log();
    double sum = 0.0;
    for (Index i = 0; i < count; ++i) {
      const VectorXd part = mean.segment(i * values, values);
      sum += std::pow((part.maxCoeff() - part.minCoeff()) / data.unit, 2);
    }
    effects[k] = std::sqrt(sum / static_cast<double>(count));
  }
  return effects;
}

double gap_covariance(const InputGap& gap, double a, double b) {
  if (!inside(gap, a) || !inside(gap, b)) return 0.0;
  const auto c = [](double distance) { return correlation(distance, gap_length); };
  double value = c(a - b);
  const bool below = std::isfinite(gap.low), above = std::isfinite(gap.high);
  if (below && above) {
    const double a0 = c(a - gap.low), a1 = c(gap.high - a), b0 = c(b - gap.low), b1 = c(gap.high - b);
    const double r = c(gap.high - gap.low);
    value -= (a0 * b0 + a1 * b1 - r * (a0 * b1 + a1 * b0)) / (1.0 - r * r);
  } else if (below) {
    value -= c(a - gap.low) * c(b - gap.low);
  } else {
    value -= c(gap.high - a) * c(gap.high - b);
  }
  return a == b ? std::max(value, 0.0) : value;
}

namespace {

double departure_covariance(const InputGap& gap, const RowVectorXd& a, const RowVectorXd& b) {
  return gap.sd * gap.sd * gap_covariance(gap, a[gap.input], b[gap.input]) * likeness(gap, a, b);
}

}  // namespace

void add_gaps(const std::vector<InputGap>& gaps, const MatrixXd& points, MatrixXd& covariance) {
  for (const InputGap& gap : gaps)
    for (Index j = 0; j < points.rows(); ++j) {
      if (!inside(gap, points(j, gap.input))) continue;
      for (Index i = 0; i <= j; ++i) {
        if (!inside(gap, points(i, gap.input))) continue;
        const double value = departure_covariance(gap, points.row(i), points.row(j));
        covariance(i, j) += value;
        if (i != j) covariance(j, i) += value;
      }
    }
}

void add_gaps_between(const std::vector<InputGap>& gaps, const MatrixXd& a, const MatrixXd& b, MatrixXd& covariance) {
  for (const InputGap& gap : gaps)
    for (Index j = 0; j < b.rows(); ++j) {
      if (!inside(gap, b(j, gap.input))) continue;
      for (Index i = 0; i < a.rows(); ++i)
        if (inside(gap, a(i, gap.input))) covariance(i, j) += departure_covariance(gap, a.row(i), b.row(j));
    }
}

double gap_variance(const std::vector<InputGap>& gaps, const RowVectorXd& point) {
  double sum = 0.0;
  for (const InputGap& gap : gaps) sum += gap.sd * gap.sd * gap_covariance(gap, point[gap.input], point[gap.input]);
  return sum;
}

void add_gap_slopes(const std::vector<InputGap>& gaps, const MatrixXd& points, int input, MatrixXd& slope) {
  constexpr double step = 1e-6;  // unit cube; b has two derivatives, so central differences have its square as error
  for (const InputGap& gap : gaps) {
    if (gap.input != input) continue;
    for (Index j = 0; j < points.rows(); ++j)
      for (Index i = 0; i < points.rows(); ++i) {
        const double a = points(i, input), b = points(j, input);
        if (!inside(gap, a) || !inside(gap, b)) continue;
        const double up = gap_covariance(gap, a + step, b + step), down = gap_covariance(gap, a - step, b - step);
        slope(i, j) +=
            gap.sd * gap.sd * (up - down) / (2.0 * step) * (i == j ? 1.0 : likeness(gap, points.row(i), points.row(j)));
      }
  }
}

std::vector<InputGap> parted(const std::vector<InputGap>& gaps, const RowVectorXd& point) {
  std::vector<InputGap> left;
  for (const InputGap& gap : gaps) {
    const double x = point[gap.input];
    if (!inside(gap, x)) {
      left.push_back(gap);
      continue;
    }
    InputGap below = gap, above = gap;
    below.high = above.low = x;
    left.push_back(below);
    left.push_back(above);
  }
  return left;
}

}  // namespace surrogate
