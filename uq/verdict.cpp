#include "uq/verdict.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace uq {
namespace {

/// Three significant digits.
std::string number(double value) { return fmt::format("{:.3g}", value); }

std::string in_unit(const std::string& text, const std::string& unit) {
  return unit.empty() || unit == "1" ? text : text + " " + unit;
}

std::string interval(const ParameterEvidence& parameter) {
  const std::string low = parameter.profile_low ? with_error(*parameter.profile_low, parameter.sd) : "open";
  const std::string high = parameter.profile_high ? with_error(*parameter.profile_high, parameter.sd) : "open";
  return low + " to " + high;
}

/// Whether a contraction is within the scatter of another data set of a threshold.
bool near_contraction(double contraction, double threshold, const VerdictThresholds& thresholds) {
  const double left = std::max(1.0 - contraction, 1e-12);
  return std::abs(std::log(left / (1.0 - threshold))) < thresholds.borderline_variance;
}

std::string left_variance(const ParameterEvidence& parameter) {
  return fmt::format("{:.2g} % of the prior's variance is left", 100.0 * std::max(1.0 - parameter.contraction, 0.0));
}

}  // namespace

std::string with_error(double value, double error) {
  if (!(error > 0.0) || !std::isfinite(value)) return number(value);
  // Two digits of the error.
  const int decimals = 1 - static_cast<int>(std::floor(std::log10(error)));
  if (decimals > 4 || decimals < 0) {
    const double leading = std::max(std::abs(value), error);
    const int digits = std::clamp(static_cast<int>(std::floor(std::log10(leading / error))) + 2, 2, 12);
    return fmt::format("{:.{}g}", value, digits);
  }
  return fmt::format("{:.{}f}", value, decimals);
}

std::vector<std::pair<std::string, std::string>> describe(const VerdictThresholds& thresholds) {
  return {
      {"contraction for identified", fmt::format("at least {:g}", thresholds.contraction_identified)},
      {"contraction for weakly identified", fmt::format("at least {:g}", thresholds.contraction_weak)},
      {"profile likelihood interval", fmt::format("deviance up to {:.4g} (95 %)", thresholds.profile_drop)},
      {"interval open for another parameter's range",
       fmt::format("twice that range would lower the deviance at its end by at least {:.3g}",
                   0.5 * thresholds.profile_drop)},
      {"posterior predictive p for a fit", fmt::format("at least {:g}", thresholds.predictive_p)},
      {"chi-squared tail of the best fit for a fit", fmt::format("at least {:g}", thresholds.best_fit_p)},
      {"correlation of a traded pair",
       fmt::format("at least {:g} (plain, of logarithms, or as a correlation ratio)", thresholds.traded_correlation)},
      {"structural",
       fmt::format("at least {:g} of the interval is left with the measurement error {:.3g} times smaller",
                   thresholds.noise_free_share, 1.0 / std::sqrt(thresholds.noise_free_factor))},
      {"surrogate sharp enough to call it structural",
       fmt::format("its sd at most {:.2g} of the measurement's", thresholds.surrogate_share)},
      {"borderline",
       fmt::format("residual variance within a factor {:.2g} of a threshold, or deviance at a bound within {:g} of its",
                   std::exp(thresholds.borderline_variance), thresholds.borderline_deviance)},
  };
}

ParameterVerdict judge(const ParameterEvidence& parameter, const FitEvidence& fit,
                       const VerdictThresholds& thresholds) {
  ParameterVerdict found;
  const std::string value = in_unit(
      with_error(parameter.mean, parameter.sd) + " +- " + with_error(parameter.sd, parameter.sd), parameter.unit);
  if (!fit.fits(thresholds)) {
    found.verdict = Verdict::does_not_fit;
    found.borderline = fit.predictive_p > 0.5 * thresholds.predictive_p && fit.best_fit_p > 0.5 * thresholds.best_fit_p;
    found.sentence = fmt::format(
        "{}: the model does not fit the data at any value (posterior predictive p {:.2g}, best-fit p {:.2g}), so its "
        "{} means nothing.",
        parameter.name, fit.predictive_p, fit.best_fit_p, value);
    return found;
  }
  if (!parameter.unsupported.empty()) {
    found.reason = "unsupported";
    found.sentence = fmt::format("{} is not identified: {}.", parameter.name, parameter.unsupported);
    return found;
  }
  const bool open_low = !parameter.profile_low, open_high = !parameter.profile_high;
  const bool contracted = parameter.contraction >= thresholds.contraction_identified;
  const bool narrowed = parameter.contraction >= thresholds.contraction_weak;
  const bool structural = parameter.structural;

  // Near a threshold: of contraction, or of a bound's deviance.
  auto near_bound = [&](double deviance) {
    return std::abs(deviance - thresholds.profile_drop) < thresholds.borderline_deviance;
  };
  found.borderline = near_contraction(parameter.contraction, thresholds.contraction_weak, thresholds) ||
                     (!open_low && !open_high &&
                      near_contraction(parameter.contraction, thresholds.contraction_identified, thresholds)) ||
                     near_bound(parameter.deviance_at_low) || near_bound(parameter.deviance_at_high);

  if (!open_low && !open_high) {
    if (contracted) {
      found.verdict = Verdict::identified;
      found.sentence = fmt::format("{} is identified: {}; 95 % profile interval {}; {}.", parameter.name, value,
                                   interval(parameter), left_variance(parameter));
    } else if (narrowed) {
      found.verdict = Verdict::weakly_identified;
      found.reason = "practical";
      found.sentence = fmt::format("{} is weakly identified: {}; the interval {} is closed but wide; {}.",
                                   parameter.name, value, interval(parameter), left_variance(parameter));
    } else {
      found.reason = "practical";
      found.sentence =
          fmt::format("{} is not identified: the interval {} is closed but {}; the measurement's noise hides it.",
                      parameter.name, in_unit(interval(parameter), parameter.unit), left_variance(parameter));
    }
    return found;
  }
  if (open_low && !open_high && parameter.physical_low) {
    found.reason = "bound";
    found.verdict = narrowed ? Verdict::weakly_identified : Verdict::not_identified;
    found.sentence = fmt::format(
        "{}: only an upper limit, {} at most (95 % profile; 95 % of the posterior lies below {}); it cannot be told "
        "from {}, its physical bound.",
        parameter.name, in_unit(with_error(*parameter.profile_high, parameter.sd), parameter.unit),
        in_unit(with_error(parameter.q95, parameter.sd), parameter.unit), number(parameter.range_low));
    if (structural) found.reason = "structural";
    return found;
  }
  found.reason = structural ? "structural" : (open_low != open_high ? "one-sided" : "practical");
  const std::string& by = open_high ? parameter.high_pinned_by : parameter.low_pinned_by;
  const std::string why = structural ? ", and a better measurement of the same kind would not help" : "";
  if (open_low && open_high) {
    found.sentence = fmt::format(
        "{} is not identified: the data leave it open on both sides{}; {}.", parameter.name,
        by.empty() ? ""
                   : fmt::format(
                         " (between {} only the ranges of other parameters limit it)",
                         in_unit(number(parameter.range_low) + " and " + number(parameter.range_high), parameter.unit)),
        structural ? "a better measurement of the same kind would not help" : "the measurement's noise hides it");
    return found;
  }
  const std::string limit =
      open_high ? "at least " + in_unit(with_error(*parameter.profile_low, parameter.sd), parameter.unit)
                : "at most " + in_unit(with_error(*parameter.profile_high, parameter.sd), parameter.unit);
  if (by.empty()) {
    const std::string end = in_unit(number(open_high ? parameter.range_high : parameter.range_low), parameter.unit);
    found.sentence = fmt::format(
        "{} is not identified: {} (95 % profile), but {} that every value up to the end of its range, {}, fits{}.",
        parameter.name, limit, open_high ? "above" : "below", end, why);
  } else {
    found.sentence = fmt::format(
        "{} is not identified: {} (95 % profile), but on the other side only the end of the range of {} limits it{}.",
        parameter.name, limit, by, why);
  }
  return found;
}

}  // namespace uq
