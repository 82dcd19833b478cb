#pragma once
// The beta distribution for any shapes from 0.01 to 1e6.
//   cdf       I_s(a, b), by Lentz's continued fraction (NIST DLMF 8.17.22)
//   quantile  the root of the cdf, by the ITP method (I. F. D. Oliveira, R. H. C. Takahashi, ACM Trans. Math. Softw. 47
//             (2021) 5) in the logarithm of the distance from the nearer end, since shapes below one put it there
namespace uq {

inline constexpr double beta_shape_min = 0.01, beta_shape_max = 1e6;

struct BetaShapes {
  double alpha = 1.0, beta = 1.0;
};

double beta_cdf(double share, BetaShapes shapes);
/// The upper tail 1 - cdf, without the cancellation of this difference.
double beta_upper(double share, BetaShapes shapes);
double beta_quantile(double probability, BetaShapes shapes);
/// Log of the density, at a share that is kept a rounding error away from the ends.
double beta_log_density(double share, BetaShapes shapes);

}  // namespace uq
