#pragma once
// Sobol indices: the share that each input has in an output's variance over the ranges of the inputs.
//
// With the inputs independent and uniform over the unit cube (parameters by uq/posterior/prior.hpp's u, controls by
// their range), I. M. Sobol, Math. Comput. Simul. 55 (2001) 271, and T. Homma, A. Saltelli, Reliab. Eng. Syst. Saf. 52
// (1996) 1:
//   first order  S_i = Var(E[f | x_i]) / Var(f)         what x_i does on its own
//   total        T_i = 1 - Var(E[f | x_~i]) / Var(f)    what x_i does alone and together with others
// The expectations are tensor Gauss-Legendre sums, exact for polynomials of degree 2 nodes - 1 in each input. The
// surrogate's uncertainty is carried by joint draws of the whole response on the grid, as in L. Le Gratiet, C.
// Cannamela, B. Iooss, SIAM/ASA J. Uncertain. Quantif. 2 (2014) 336, without their Monte Carlo error of the integrals.
#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "surrogate/gaussian_process.hpp"

namespace uq {

struct SobolIndex {
  double first = 0.0, first_sd = 0.0;  ///< mean and sd over the draws of the response
  double total = 0.0, total_sd = 0.0;
};

struct SensitivityOptions {
  int points_max = 1500;  ///< points of the grid; they decide the nodes per input, at least three
  int nodes_max = 24;     ///< nodes per input at most
  int draws = 200;        ///< draws of the response
  std::uint64_t seed = 1;
};

/// The largest number of inputs. Three nodes in each of seven are 2,187 points, whose joint covariance takes about a
/// second; two nodes would not see curvature.
inline constexpr int sensitivity_inputs_max = 7;

/// The Sobol indices of a response. `predict` gives its joint prediction at points (one per row, unit cube). Empty for
/// more inputs than sensitivity_inputs_max, or where the response does not vary.
std::vector<SobolIndex> sobol_indices(const std::function<surrogate::Prediction(const Eigen::MatrixXd&)>& predict,
                                      int inputs, const SensitivityOptions& options = {});

}  // namespace uq
