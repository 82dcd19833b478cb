#include "uq/posterior/prior.hpp"

#include <fmt/core.h>
#include <gsl/gsl_cdf.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "data/error.hpp"
#include "uq/infer/log_density.hpp"
#include "uq/posterior/beta_law.hpp"

namespace uq {

using data::PriorKind;
using data::Scale;

ScaledPrior::ScaledPrior(const data::Parameter& parameter, const data::Prior& prior)
    : parameter_(parameter), prior_(prior) {
  const std::string where = prior.place.empty() ? parameter.place : prior.place;
  if (prior.kind == PriorKind::posterior)
    throw data::InputError(data::ExitStatus::bad_study,
                           {where,
                            fmt::format("the prior of {} is the posterior of case '{}', which is not linked here",
                                        parameter.name, prior.posterior_of),
                            "give it a density of its own"});
  const bool shaped = prior.alpha >= beta_shape_min && prior.alpha <= beta_shape_max && prior.beta >= beta_shape_min &&
                      prior.beta <= beta_shape_max;
  if (prior.kind == PriorKind::beta && !shaped)
    throw data::InputError(
        data::ExitStatus::bad_study,
        {where,
         fmt::format("the beta prior of {} has the shapes {:g} and {:g}, outside {:g} to {:g}", parameter.name,
                     prior.alpha, prior.beta, beta_shape_min, beta_shape_max),
         "below, all mass lies on the range's ends; above, on one value: fix the parameter instead"});
  const double low = std::max(prior.low, parameter.low), high = std::min(prior.high, parameter.high);
  const data::Unit& unit = parameter.unit;
  if (!(low < high))
    throw data::InputError(
        data::ExitStatus::bad_study,
        {where,
         fmt::format("the prior of {} lies in [{:g}, {:g}]{}, outside the parameter's range [{:g}, {:g}]",
                     parameter.name, unit.from_si(prior.low), unit.from_si(prior.high),
                     data::behind_number(unit.symbol), unit.from_si(parameter.low), unit.from_si(parameter.high)),
         "let prior and range overlap"});
  low_ = std::clamp(parameter.axis().to_unit(low), 0.0, 1.0);
  high_ = std::clamp(parameter.axis().to_unit(high), 0.0, 1.0);

  // Mass of the law on the support, in the tail that keeps digits.
  upper_tail_ = law_cdf(low, false) > 0.5;
  tail_at_low_ = law_cdf(low, upper_tail_);
  tail_at_high_ = law_cdf(high, upper_tail_);
  const double mass = std::abs(tail_at_high_ - tail_at_low_);
  if (!(mass > 1e-300))
    throw data::InputError(data::ExitStatus::bad_study,
                           {where,
                            fmt::format("the prior of {} has no mass inside the range [{:g}, {:g}]{}", parameter.name,
                                        unit.from_si(low), unit.from_si(high), data::behind_number(unit.symbol)),
                            "move the prior's mean or widen its sd or the range"});
  log_mass_ = std::log(mass);
  // The mass that the range leaves of the prior as the user stated it, its own bounds included.
  const bool own_tail = law_cdf(prior.low, false) > 0.5;
  kept_mass_ = std::min(1.0, mass / std::abs(law_cdf(prior.high, own_tail) - law_cdf(prior.low, own_tail)));
  find_moments();
}

double ScaledPrior::law_cdf(double x, bool upper) const {
  switch (prior_.kind) {
    case PriorKind::uniform: {
      const double p = std::clamp((x - prior_.low) / (prior_.high - prior_.low), 0.0, 1.0);
      return upper ? 1.0 - p : p;
    }
    case PriorKind::log_uniform: {
      const double p = std::clamp(std::log(x / prior_.low) / std::log(prior_.high / prior_.low), 0.0, 1.0);
      return upper ? 1.0 - p : p;
    }
    case PriorKind::normal:
    case PriorKind::truncated_normal: {
      const double z = (x - prior_.mean) / prior_.sd;
      return upper ? gsl_cdf_ugaussian_Q(z) : gsl_cdf_ugaussian_P(z);
    }
    case PriorKind::log_normal: {
      if (x <= 0.0) return upper ? 1.0 : 0.0;
      const double z = std::log(x / prior_.mean) / prior_.sd;
      return upper ? gsl_cdf_ugaussian_Q(z) : gsl_cdf_ugaussian_P(z);
    }
    case PriorKind::beta: {
      const double share = std::clamp((x - prior_.low) / (prior_.high - prior_.low), 0.0, 1.0);
      return upper ? beta_upper(share, {prior_.alpha, prior_.beta}) : beta_cdf(share, {prior_.alpha, prior_.beta});
    }
    case PriorKind::posterior:
      break;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

double ScaledPrior::law_inverse(double probability, bool upper) const {
  switch (prior_.kind) {
    case PriorKind::uniform:
      return prior_.low + (upper ? 1.0 - probability : probability) * (prior_.high - prior_.low);
    case PriorKind::log_uniform:
      return prior_.low * std::pow(prior_.high / prior_.low, upper ? 1.0 - probability : probability);
    case PriorKind::normal:
    case PriorKind::truncated_normal:
      return prior_.mean +
             prior_.sd * (upper ? gsl_cdf_ugaussian_Qinv(probability) : gsl_cdf_ugaussian_Pinv(probability));
    case PriorKind::log_normal:
      return prior_.mean *
             std::exp(prior_.sd * (upper ? gsl_cdf_ugaussian_Qinv(probability) : gsl_cdf_ugaussian_Pinv(probability)));
    case PriorKind::beta:
      return prior_.low +
             (prior_.high - prior_.low) * (upper ? 1.0 - beta_quantile(probability, {prior_.beta, prior_.alpha})
                                                 : beta_quantile(probability, {prior_.alpha, prior_.beta}));
    case PriorKind::posterior:
      break;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

double ScaledPrior::log_density_of_value(double x) const {
  const double log_root = 0.5 * std::log(2.0 * std::numbers::pi);
  switch (prior_.kind) {
    case PriorKind::uniform:
      return -std::log(prior_.high - prior_.low);
    case PriorKind::log_uniform:
      return -std::log(x * std::log(prior_.high / prior_.low));
    case PriorKind::normal:
    case PriorKind::truncated_normal: {
      const double z = (x - prior_.mean) / prior_.sd;
      return -0.5 * z * z - std::log(prior_.sd) - log_root;
    }
    case PriorKind::log_normal: {
      if (x <= 0.0) return nowhere;
      const double z = std::log(x / prior_.mean) / prior_.sd;
      return -0.5 * z * z - std::log(prior_.sd * x) - log_root;
    }
    case PriorKind::beta: {
      const double width = prior_.high - prior_.low, share = (x - prior_.low) / width;
      return beta_log_density(share, {prior_.alpha, prior_.beta}) - std::log(width);
    }
    case PriorKind::posterior:
      break;
  }
  return nowhere;
}

double ScaledPrior::slope_of_value(double x) const {
  switch (prior_.kind) {
    case PriorKind::uniform:
      return 0.0;
    case PriorKind::log_uniform:
      return -1.0 / x;
    case PriorKind::normal:
    case PriorKind::truncated_normal:
      return -(x - prior_.mean) / (prior_.sd * prior_.sd);
    case PriorKind::log_normal:
      return -(std::log(x / prior_.mean) / (prior_.sd * prior_.sd) + 1.0) / x;
    case PriorKind::beta: {
      const double edge = std::numeric_limits<double>::epsilon() * (prior_.high - prior_.low);
      const double first = prior_.alpha == 1.0 ? 0.0 : (prior_.alpha - 1.0) / std::max(x - prior_.low, edge);
      const double second = prior_.beta == 1.0 ? 0.0 : (prior_.beta - 1.0) / std::max(prior_.high - x, edge);
      return first - second;
    }
    case PriorKind::posterior:
      break;
  }
  return 0.0;
}

double ScaledPrior::log_density(double u) const {
  if (!(u >= low_ && u <= high_)) return -std::numeric_limits<double>::infinity();
  return log_density_of_value(parameter_.axis().from_unit(u)) + std::log(parameter_.axis().slope(u)) - log_mass_;
}

double ScaledPrior::slope(double u) const {
  const double jacobian = parameter_.scale == Scale::log ? std::log(parameter_.high / parameter_.low) : 0.0;
  return slope_of_value(parameter_.axis().from_unit(u)) * parameter_.axis().slope(u) + jacobian;
}

double ScaledPrior::cdf(double u) const {
  if (u <= low_) return 0.0;
  if (u >= high_) return 1.0;
  return (law_cdf(parameter_.axis().from_unit(u), upper_tail_) - tail_at_low_) / (tail_at_high_ - tail_at_low_);
}

double ScaledPrior::inverse_cdf(double probability) const {
  const double tail = tail_at_low_ + probability * (tail_at_high_ - tail_at_low_);
  return std::clamp(parameter_.axis().to_unit(law_inverse(tail, upper_tail_)), low_, high_);
}

void ScaledPrior::find_moments() {
  // E[g] is the integral of g(x(p)) over p in (0, 1): Gauss-Legendre, three points in each of equal parts.
  constexpr int parts = 2000;
  const double offset = 0.5 * std::sqrt(0.6);
  Eigen::ArrayXd u(3 * parts), x(3 * parts), weight(3 * parts);
  for (int i = 0; i < parts; ++i)
    for (int j = 0; j < 3; ++j) {
      u[3 * i + j] = inverse_cdf((i + 0.5 + (j - 1) * offset) / parts);
      x[3 * i + j] = parameter_.axis().from_unit(u[3 * i + j]);
      weight[3 * i + j] = (j == 1 ? 8.0 : 5.0) / (18.0 * parts);
    }
  mean_ = (weight * u).sum();
  sd_ = std::sqrt((weight * (u - mean_).square()).sum());
  value_mean_ = (weight * x).sum();
  value_sd_ = std::sqrt((weight * (x - value_mean_).square()).sum());
}

}  // namespace uq
