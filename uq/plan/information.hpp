#pragma once
// The expected information of a reading y, in nats, about all unknowns or about one of them.
// Nothing here knows of studies: an Ensemble is draws of the unknowns with the normal law of the reading given each.
//
// About all unknowns theta (D. V. Lindley, Ann. Math. Stat. 27:986 (1956)):
//   I(theta; y) = E [ log p(y | theta) - log p(y) ],
// with p(y) estimated by the mean of p(y | theta_j) over the other draws. About one of them, the rest integrated out:
//   I(theta_k; y) = E [ log p(y | theta_k) - log p(y) ].
// p(y | theta_k) is a conditional density, and any other normalised density in its place gives less on average (D.
// Barber & F. Agakov, NIPS 16 (2003); A. Foster et al., NeurIPS 32 (2019)), so the best of several is taken. Each is a
// mean over draws j whose theta_k ranks within a window about that of draw i,
//   q(y | theta_k) = mean_j N(y; M_i + s_i (m_j - M_j) / s_j, S_j),
// M and s a local quadratic regression of the draws' means m on theta_k and the local spread about it. It is exact, at
// any window, where only location and scale of what the other unknowns bring hang on theta_k, as in the linear-normal
// case; elsewhere a narrower window is better until it holds too few draws: it is taken where its score is larger by
// more than the error.
//
// Bias and error. The logarithm of a mean of n terms is biased by a constant over n, upwards for I where draw i itself
// is left out of its mean (T. Rainforth et al., ICML (2018): nested Monte Carlo; with ten draws it gives 157 nats where
// 3.9 are right), downwards where it is counted in, as here, so that no estimate exceeds log n. Twice the estimate less
// the mean of those from either half of the draws is free of that term (M. Quenouille, Biometrika 43:353 (1956)), for
// independent draws and for nets of quasi-random ones alike. A correction above a tenth of a nat is not small, and is
// stated as the error. The error of independent draws is the delete-a-block jackknife's; that of quasi-random ones
// comes from repeats with other scramblings (`combined`). Repeats share the bias that is left, a term over n^2: the
// next order, from quarters of the draws, takes it off, and what it took off joins the error.
#include <Eigen/Dense>
#include <cstdint>
#include <vector>

namespace uq::plan {

/// Draws of the unknowns, and the law of a reading given each: N(mean, covariance), noise included.
struct Ensemble {
  Eigen::MatrixXd values;  ///< draws x parameters asked for
  Eigen::MatrixXd mean;    ///< draws x readings
  std::vector<Eigen::MatrixXd> covariance;

  Eigen::Index draws() const { return mean.rows(); }
  Eigen::Index readings() const { return mean.cols(); }
};

/// A number with the half-width of its 95 % interval.
struct Estimate {
  double value = 0.0, error = 0.0;
  double remainder = 0.0;  ///< what the next order of the extrapolation would add; of information alone
};

struct InformationAbout {
  Estimate information;  ///< nats
  Estimate sd_after;     ///< expected posterior sd, unit of the values
};

struct Information {
  Estimate total;  ///< nats
  std::vector<InformationAbout> about;
};

struct InformationOptions {
  std::uint64_t seed = 1;
  /// Standard normal numbers of the readings, draws x readings; empty: drawn.
  Eigen::MatrixXd noise = {};
};

/// The information of an ensemble's reading. It needs at least 60 draws. Work: draws squared, times readings squared.
Information information(const Ensemble& ensemble, const InformationOptions& options = {});

/// The mean of independent estimates of the same information, with Student's error.
Information combined(const std::vector<Information>& repeats);

}  // namespace uq::plan
