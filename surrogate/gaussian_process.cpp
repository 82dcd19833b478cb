#include "surrogate/gaussian_process.hpp"

#include <cmath>
#include <limits>

#include "data/error.hpp"
#include "surrogate/prediction.hpp"

namespace surrogate {

using Eigen::Index;

GaussianProcess::GaussianProcess(Kernel kernel, MeanBasis mean, bool nugget, Standardised data,
                                 std::vector<Conditioned> parts, FitDiagnostics diagnostics)
    : kernel_(kernel),
      mean_(mean),
      nugget_(nugget),
      data_(std::make_shared<const Standardised>(std::move(data))),
      parts_(std::make_shared<const std::vector<Conditioned>>(std::move(parts))),
      diagnostics_(std::make_shared<const FitDiagnostics>(std::move(diagnostics))) {}

double GaussianProcess::log_marginal_likelihood() const {
  // The flat prior on beta is flat in the units of y, so p of the n Jacobian factors cancel.
  const double p = flat_coefficients(mean_, static_cast<int>(data_->active.size()));
  return parts_->front().factorised.log_likelihood + data_->log_jacobian + p * std::log(data_->unit);
}

HyperParameters GaussianProcess::hyper_parameters() const {
  const Conditioned& part = parts_->front();
  HyperParameters result;
  result.length_scales = Eigen::VectorXd::Constant(dimension(), std::numeric_limits<double>::infinity());
  for (std::size_t k = 0; k < data_->active.size(); ++k)
    result.length_scales[data_->active[k]] = part.parameters.length_scales[k];
  result.signal_sd = data_->unit * std::sqrt(part.parameters.signal_variance);
  result.nugget_sd = data_->unit * std::sqrt(part.parameters.nugget_variance);
  result.mean_coefficients = data_->unit * part.factorised.mean_coefficients;
  if (result.mean_coefficients.size() > 0) result.mean_coefficients[0] += data_->shift;
  return result;
}

std::vector<OutsideRange> GaussianProcess::outside_training_range(const Eigen::MatrixXd& points) const {
  check_points(points, dimension());
  constexpr double slack = 1e-9;  // unit-cube length: rounding of a scaled bound
  std::vector<OutsideRange> outside;
  for (Index i = 0; i < points.rows(); ++i)
    for (Index k = 0; k < points.cols(); ++k)
      if (points(i, k) < data_->low[k] - slack || points(i, k) > data_->high[k] + slack)
        outside.push_back({static_cast<int>(i), static_cast<int>(k), points(i, k), data_->low[k], data_->high[k]});
  return outside;
}

GaussianProcess condition(const TrainingSet& training, const ModelForm& form, const HyperParameters& hyper_parameters) {
  Standardised data = standardise(training, form.scale, centre_of(form.mean));
  Conditioned part;
  part.parameters.length_scales.resize(static_cast<Index>(data.active.size()));
  for (std::size_t k = 0; k < data.active.size(); ++k)
    part.parameters.length_scales[k] = hyper_parameters.length_scales[data.active[k]];
  const double signal = hyper_parameters.signal_sd / data.unit, nugget = hyper_parameters.nugget_sd / data.unit;
  part.parameters.signal_variance = signal * signal;
  part.parameters.nugget_variance = nugget * nugget;
  part.scaled_points = data.points * part.parameters.length_scales.cwiseInverse().asDiagonal();
  Likelihood likelihood(data, form.kernel, form.mean, nugget > 0.0);
  part.factorised = likelihood.factorise(part.parameters);
  if (!part.factorised.ok)
    throw data::InputError(data::ExitStatus::bad_data,
                           {"surrogate", "the covariance of the training runs cannot be factorised even with jitter",
                            "give the runs their standard errors, or use a process with a nugget"});
  FitDiagnostics diagnostics;
  diagnostics.converged = true;
  diagnostics.jitter = part.factorised.jitter;
  return {form.kernel, form.mean, nugget > 0.0, std::move(data), {std::move(part)}, std::move(diagnostics)};
}

}  // namespace surrogate
