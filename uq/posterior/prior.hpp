#pragma once
// Priors of single parameters, in the parameter's coordinate u in [0, 1] on its range (data/axis.hpp). All of uq/ works
// in u.
//
// A density f(x) is that of data::Prior, cut to [prior.low, prior.high] and to the parameter's range, and normalised
// there. In u it becomes f(x(u)) dx/du; a uniform prior of a log-scaled parameter is uniform in x, not in log x.
//   normal, truncated normal: sd s about m.  log normal: log x normal about log(mean) with sd.
//   log uniform: 1 / x, so that each decade has the same mass.
//   beta: (x - prior.low) / (prior.high - prior.low) is Beta(alpha, beta).
#include "data/random.hpp"
#include "data/study.hpp"

namespace uq {

class ScaledPrior {
 public:
  /// Throws data::InputError (78) when no mass of the prior lies in the parameter's range, or when it is another case's
  /// posterior.
  ScaledPrior(const data::Parameter& parameter, const data::Prior& prior);

  double low() const { return low_; }    ///< u, support
  double high() const { return high_; }  ///< u
  double log_density(double u) const;    ///< log density of u, normalised on the support
  double slope(double u) const;          ///< d log density / du
  double cdf(double u) const;
  double inverse_cdf(double probability) const;  ///< u
  double draw(data::RandomStream& random) const { return inverse_cdf(random.uniform()); }
  double mean() const { return mean_; }              ///< of u
  double sd() const { return sd_; }                  ///< of u
  double value_mean() const { return value_mean_; }  ///< of x, SI
  double value_sd() const { return value_sd_; }      ///< of x, SI
  double kept_mass() const { return kept_mass_; }    ///< mass of the stated prior inside the parameter's range
  const data::Parameter& parameter() const { return parameter_; }
  /// Whether the prior prefers some values of its range.
  bool is_informative() const {
    return prior_.kind != data::PriorKind::uniform && prior_.kind != data::PriorKind::log_uniform;
  }

 private:
  double log_density_of_value(double x) const;
  double slope_of_value(double x) const;
  /// The cdf of the uncut law, or its upper tail when asked, so that far tails keep their digits.
  double law_cdf(double x, bool upper) const;
  double law_inverse(double probability, bool upper) const;
  void find_moments();

  data::Parameter parameter_;
  data::Prior prior_;
  double low_ = 0.0, high_ = 1.0;
  bool upper_tail_ = false;  ///< work with upper tails: the support lies above the law's centre
  double tail_at_low_ = 0.0, tail_at_high_ = 1.0, log_mass_ = 0.0;
  double mean_ = 0.0, sd_ = 0.0, value_mean_ = 0.0, value_sd_ = 0.0, kept_mass_ = 1.0;
};

}  // namespace uq
