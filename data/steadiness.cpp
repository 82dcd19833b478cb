// The slowest cosine modes of a series x_1 ... x_n say how well its mean is known, and whether it drifts.
//
//   c_j = sqrt(2)/n sum_k x_k cos(j pi (k - 1/2)/n),  P_j = n c_j^2,  j = 1, 2, ...
// For large n, the c_j of a stationary series are independent normal numbers of variance V/n each. V = sd^2 tau is the
// variance of the series' sum per sample. The mean's error is another such number (R. D. Foley, D. Goldsman,
// "Confidence intervals using orthonormally weighted standardized time series", ACM Trans. Model. Comput. Simul. 9
// (1999) 297).
//
// Error. V = (P_1 + ... + P_8)/8, the spectrum at frequency zero from the lowest frequencies as in P. Heidelberger,
// P. D. Welch, Commun. ACM 24 (1981) 233. (mean - truth)/sqrt(V/n) follows Student's t with 8 degrees of freedom. The
// error stated is the standard deviation of that law, sqrt(V/n 8/6), since others take it as a normal one. More modes
// would make it steadier by a little, and wrong where motions of several speeds mix: the torque of a slow cohesive bed
// has a spectrum that still rises below one per turn, and 16 modes of one turn reach up to eight (dem/STEADY.md).
//
// Drift. A series that drifts has its excess in the slowest modes: of a straight line mode 1 holds 98.6 % of the
// variance, and a decaying start-up lies in modes 1 and 2. The test compares them with the next,
//   F = (P_1 + P_2)/2 / ((P_3 + ... + P_L)/(L - 2)),  which follows Fisher's F with 2 and L - 2 degrees of freedom,
//   p = (1 + 2 F/(L - 2))^(-(L - 2)/2)
// This is Schruben's test for initialisation bias (Oper. Res. 30 (1982) 569) with the Cramer-von Mises statistic of
// P. Heidelberger and P. D. Welch (Oper. Res. 31 (1983) 1109), sum_j P_j/(j pi)^2 / V, cut off after two modes, and
// with a variance taken from other modes, as in D. Goldsman, L. W. Schruben, J. J. Swain (Naval Res. Logist. 41 (1994)
// 171): the drift itself does not enter it and hide, and the law is exact for a few degrees of freedom.
//
// L. The modes must lie where the spectrum is known. That of a Lorentzian with integrated time tau falls as
// 1/(1 + (pi j tau/(2 n))^2), which each P_j is divided by; used are modes up to j = n/(2 tau), where that is 0.62, and
// 16 at most for the drift. Where there are fewer than 8 the error is not known. tau
// is that of the series without its slowest two modes (data/time_series.hpp), so that a drift does not pass for
// correlation.
//
// Known or not. Where the correlation is not short beside the series that tau comes out too small: of series of 7 tau
// it left 8 modes in 60 of 100, whose means scattered by 1.5 errors. So the error also counts as not known where the
// spectrum of the modes 3 to 66 has not become flat by mode 8: with the Lorentzian that fits them best,
//   minimum over tau of  sum_j (ln S_j + P_j/S_j),  S_j = V/(1 + (tau^2 - 1) sin^2(pi j/(2 n))),
// n < 16 tau (P. Whittle, J. R. Stat. Soc. B 15 (1953) 125; of an autoregressive series of order 1 the law is exact).
// With this rule the error is known in 10 of 100 series of 7 tau, in 20 of 10 tau, in 60 of 16 tau, in 93 of 25 tau.
// A sensor's white noise is a floor under that spectrum, S_j + f V: without it, the fit would take the floor for the
// end of the fall, and a slow series for a fast one. It counts where it makes the modes e^4 times as probable.
#include "data/steadiness.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "data/cosine_modes.hpp"

namespace data {
namespace {

constexpr std::size_t slow = 2;             // modes in which a drift lies
constexpr std::size_t spectrum_modes = 66;  // by which its shape is judged

std::vector<double> without_slow_modes(std::span<const double> x, const std::vector<double>& c) {
  std::vector<double> rest(x.begin(), x.end());
  const auto n = static_cast<double>(x.size());
  for (std::size_t k = 0; k < rest.size(); ++k)
    for (std::size_t j = 1; j <= slow; ++j)
      rest[k] -= std::numbers::sqrt2 * c[j - 1] *
                 std::cos(static_cast<double>(j) * std::numbers::pi * (static_cast<double>(k) + 0.5) / n);
  return rest;
}

/// The integrated time of the autoregressive series whose spectrum fits `power` best, that of the modes after the slow
/// ones of a series of n. From 1, uncorrelated samples, to 4 n, where no mode is slow enough to tell.
double fitted_time(std::span<const double> power, double n, bool fast_noise) {
  constexpr double step = 1.05, worth_a_floor = 4.0;
  constexpr std::array floors{0.0, 1e-4, 3e-4, 1e-3, 3e-3, 0.01, 0.03, 0.1, 0.3};
  std::vector<double> sine(power.size());
  for (std::size_t k = 0; k < power.size(); ++k)
    sine[k] = std::pow(std::sin(0.5 * std::numbers::pi * static_cast<double>(k + slow + 1) / n), 2);
  const auto misfit = [&](double tau, double floor) {
    double level = 0.0, logs = 0.0;
    for (std::size_t k = 0; k < power.size(); ++k) {
      const double spectrum = 1.0 / (1.0 + (tau * tau - 1.0) * sine[k]) + floor;
      level += power[k] / spectrum;
      logs -= std::log(spectrum);
    }
    return static_cast<double>(power.size()) * std::log(level) - logs;
  };
  double best = std::numeric_limits<double>::infinity(), found = 1.0;
  for (const double floor : std::span(floors).first(fast_noise ? floors.size() : 1))
    for (double tau = 1.0; tau < 4.0 * n; tau *= step)
      if (const double one = misfit(tau, floor) + (floor > 0.0 ? worth_a_floor : 0.0); one < best) {
        best = one;
        found = tau;
      }
  return found;
}

}  // namespace

Steadiness steadiness(std::span<const double> series, const SteadinessOptions& options) {
  Steadiness result;
  // The usual estimate, without its own truncation, holds where there is too little for this one.
  result.mean = mean_with_error(series, {.start_up_fraction_max = 0.0});
  if (series.size() < 2 * options.drift_modes || !std::isfinite(result.mean.standard_error)) {
    result.mean.reliable = false;
    return result;
  }
  if (result.mean.sd == 0.0) return result;  // a constant
  const auto n = static_cast<double>(series.size());
  const std::vector<double> c = cosine_modes(series, result.mean.mean, std::min(spectrum_modes, series.size() / 2));
  const SeriesMean rest = mean_with_error(without_slow_modes(series, c), {.start_up_fraction_max = 0.0});
  const double tau = rest.integrated_time;
  const auto flat = static_cast<std::size_t>(0.5 * n / tau);
  const std::size_t modes = std::clamp(flat, options.error_modes, options.drift_modes);
  double of_error = 0.0, slowest = 0.0, others = 0.0;
  for (std::size_t j = 0; j < modes; ++j) {
    const double fall = 0.5 * std::numbers::pi * static_cast<double>(j + 1) * tau / n;
    const double power = n * c[j] * c[j] * (1.0 + fall * fall);
    if (j < options.error_modes) of_error += power;
    (j < slow ? slowest : others) += power;
  }
  const auto freedom = static_cast<double>(options.error_modes), others_freedom = static_cast<double>(modes - slow);
  const double variance = of_error / freedom;
  std::vector<double> powers;
  for (std::size_t j = slow; j < c.size(); ++j) powers.push_back(n * c[j] * c[j]);
  result.mean.reliable = flat >= options.error_modes && n >= 2.0 * static_cast<double>(options.error_modes) *
                                                                 fitted_time(powers, n, options.fast_noise);
  result.mean.standard_error = std::sqrt(variance / n * freedom / (freedom - 2.0));
  result.mean.integrated_time = std::max(variance / (result.mean.sd * result.mean.sd), 1.0 / n);
  result.mean.effective_samples = n / result.mean.integrated_time;
  const double f = 0.5 * slowest / (others / others_freedom);
  result.drift_p = std::pow(1.0 + 2.0 * f / others_freedom, -0.5 * others_freedom);
  return result;
}

bool drifts(std::span<const double> p, double level) {
  const double each = level / static_cast<double>(std::max<std::size_t>(1, p.size()));
  return std::any_of(p.begin(), p.end(), [&](double value) { return value < each; });
}

}  // namespace data
