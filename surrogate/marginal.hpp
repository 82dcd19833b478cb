#pragma once
// Hyper-parameters integrated out instead of plugged in, so that few runs do not give false certainty.
//
// The posterior density of u (fit.hpp) is integrated by a central composite design about its mode, as in INLA (H. Rue,
// S. Martino & N. Chopin, J. R. Stat. Soc. B 71:319 (2009), section 6.5): with the covariance S = V diag(e) V' of the
// Laplace approximation and m parameters,
//   nodes     u_0 = mode,  u_{i+-} = mode +- r w_{i+-} sqrt(e_i) v_i,   r = f sqrt(m), f = 1.1,
//   weights   1 - 1/f^2 for the mode, w_{i+-} / (w_{i+} + w_{i-}) / (m f^2) for the others,
// each times density / normal density there, then normalised. The widths w stretch each half of each axis until the
// density has fallen at the node as a normal density would, INLA's remedy for skewness; with w = 1 the rule is exact
// for the mean and variance of a normal density. Deviations: INLA's fractional factorial corners are replaced by the
// axes of S, and a node that would leave the box of u is put on its face. S is the inverse of the Hessian by
// differences of the gradient, or of the average information where the Hessian is not positive definite.
// Limit: mass away from the mode, such as a shoulder at short length scales, is not seen; intervals are then wider than
// plugged-in ones but still narrower than the full posterior's (tests/surrogate/marginal.cpp compares with quadrature).
#include "surrogate/maximise.hpp"

namespace surrogate {

struct HyperNode {
  Eigen::VectorXd u;
  double weight = 0.0;
};

/// The mode first; weights add up to one. Nodes of weight below 1e-6 are left out.
std::vector<HyperNode> integration_nodes(const Objective& objective, const Eigen::VectorXd& mode);

}  // namespace surrogate
