// One more run under the same hyper-parameters and standardisation.
//
// A run at a new point borders the covariance matrix: with b = K12 of the new point, w = L^-1 b and
// lambda^2 = k22 - w'w, the new factor's inverse is
//   [ L^-1               0        ]
//   [ -w' L^-1 / lambda  1/lambda ],
// n^2 operations. A replicate of a point changes its pooled variance, and K is factorised again.
#include <cmath>

#include "surrogate/dense.hpp"
#include "surrogate/gaps.hpp"
#include "surrogate/gaussian_process.hpp"

namespace surrogate {
namespace {

using Eigen::Index;

Standardised append(const Standardised& data, const Eigen::VectorXd& x, double y, double noise_variance) {
  // The one run is checked and brought to its scale as a set of two equal runs would be.
  TrainingSet twice{x.transpose().replicate(2, 1), Eigen::VectorXd::Constant(2, y),
                    Eigen::VectorXd::Constant(2, noise_variance)};
  (void)standardise(twice, data.scale);

  Standardised result = data;
  const Index n = data.z.size();
  const bool log_scale = data.scale == OutputScale::log;
  result.z.conservativeResize(n + 1);
  result.noise.conservativeResize(n + 1);
  result.z[n] = ((log_scale ? std::log(y) : y) - data.shift) / data.unit;
  result.noise[n] = noise_variance / (log_scale ? y * y : 1.0) / data.unit / data.unit;
  result.log_jacobian -= std::log(data.unit) + (log_scale ? std::log(y) : 0.0);
  result.low = data.low.cwiseMin(x);
  result.high = data.high.cwiseMax(x);
  Eigen::RowVectorXd point(data.points.cols());
  for (std::size_t k = 0; k < data.active.size(); ++k) point[k] = x[data.active[k]];
  result.gaps = parted(data.gaps, point);
  Index row = 0;
  while (row < data.points.rows() && data.points.row(row) != point) ++row;
  if (row == data.points.rows()) {
    result.points.conservativeResize(row + 1, Eigen::NoChange);
    result.points.row(row) = point;
    result.runs_of_point.push_back(0);
  }
  ++result.runs_of_point[row];
  result.point_of_run.push_back(static_cast<int>(row));
  return result;
}

}  // namespace

GaussianProcess GaussianProcess::with_run(const Eigen::VectorXd& x, double y, double noise_variance) const {
  Standardised data = append(*data_, x, y, noise_variance);
  std::vector<Conditioned> parts;
  Likelihood likelihood(data, kernel_, mean_, nugget_);
  for (const Conditioned& old : *parts_) {
    Conditioned part;
    part.weight = old.weight;
    part.parameters = old.parameters;
    part.scaled_points = data.points * part.parameters.length_scales.cwiseInverse().asDiagonal();
    part.factorised = data.points.rows() > data_->points.rows() ? likelihood.border(old.factorised, part.parameters)
                                                                : likelihood.factorise(part.parameters);
    if (!part.factorised.ok) part.factorised = likelihood.factorise(part.parameters);
    parts.push_back(std::move(part));
  }
  return {kernel_, mean_, nugget_, std::move(data), std::move(parts), *diagnostics_};
}

Factorised Likelihood::border(const Factorised& old, const ScaledParameters& parameters) {
  const Index n = data_.points.rows() - 1;
  Factorised result;
  result.pooled = pool(data_, parameters.nugget_variance);
  result.jitter = old.jitter;
  scaled_.noalias() = data_.points * parameters.length_scales.cwiseInverse().asDiagonal();
  Eigen::VectorXd square = (scaled_.topRows(n).rowwise() - scaled_.row(n)).rowwise().squaredNorm(), column(n);
  correlate(kernel_, {{square.data(), n}, {column.data(), n}, {nullptr, 0}});
  column *= parameters.signal_variance;
  const Eigen::VectorXd whitened = old.inverse_factor.triangularView<Eigen::Lower>() * column;
  const double pivot = parameters.signal_variance + result.pooled.variance[n] + result.jitter - whitened.squaredNorm();
  if (!(pivot > 1e-12 * parameters.signal_variance)) return result;  // the caller factorises anew, with jitter
  const double lambda = std::sqrt(pivot);
  result.inverse_factor = Eigen::MatrixXd::Zero(n + 1, n + 1);
  result.inverse_factor.topLeftCorner(n, n) = old.inverse_factor;
  const Eigen::VectorXd row = old.inverse_factor.transpose().triangularView<Eigen::Upper>() * whitened;
  result.inverse_factor.row(n).head(n) = -row.transpose() / lambda;
  result.inverse_factor(n, n) = 1.0 / lambda;
  complete(result);
  return result;
}

}  // namespace surrogate
