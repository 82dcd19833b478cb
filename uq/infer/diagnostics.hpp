#pragma once
// Convergence diagnostics of Vehtari, Gelman, Simpson, Carpenter, Buerkner, "Rank-normalization, folding, and
// localization: an improved R-hat for assessing convergence of MCMC", Bayesian Analysis 16:667 (2021). Equation numbers
// are that paper's. They agree with R's posterior package on the same draws (tests/uq/infer/diagnostics.cpp).
//
// In all functions `draws` is iterations x chains of one scalar quantity. A constant or non-finite quantity gives NaN.
#include <Eigen/Dense>

namespace uq {

/// Rank-normalised split R-hat: the larger of the plain and the folded one (Eqs. 1 to 4, 14, and section 4.2).
double rank_rhat(const Eigen::MatrixXd& draws);

/// Effective sample size of the rank-normalised draws (section 4.3).
double bulk_ess(const Eigen::MatrixXd& draws);

/// The smaller effective sample size of the 5 % and 95 % quantiles (section 4.3).
double tail_ess(const Eigen::MatrixXd& draws);

/// Effective sample size of the mean, by Geyer's initial monotone sequence over split chains (Eqs. 10 to 13).
double mean_ess(const Eigen::MatrixXd& draws);

/// Monte Carlo standard error of the mean.
double mean_mcse(const Eigen::MatrixXd& draws);

/// Energy Bayesian fraction of missing information of one chain (Betancourt 2016): mean squared step of the energy over
/// its variance; below 0.3 the momentum resampling explores the energies too slowly.
double energy_fraction(const Eigen::VectorXd& energy);

/// Quantile by linear interpolation of order statistics (R's type 7). `values` in any order.
double quantile(const Eigen::VectorXd& values, double probability);

}  // namespace uq
