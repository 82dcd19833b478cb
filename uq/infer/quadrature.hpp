#pragma once
// Mean, standard deviation and log evidence of a density in one or two dimensions by brute integration: the independent
// check of a sampler. Each cell is integrated by Gauss-Legendre points (three per side, degree 5); a cell is split in
// halves per side while its integral differs from that of its parts, and where a guide (a point known to lie in the
// density, e.g. a draw) falls into a cell whose points see little of it: a ridge a thousandth of the box wide falls
// between the points of the first grid.
#include <Eigen/Dense>
#include <cstdint>

#include "uq/infer/draws.hpp"
#include "uq/infer/log_density.hpp"

namespace uq {

struct QuadratureOptions {
  int first_cells = 24;     ///< cells per side before refinement
  int levels = 9;           ///< halvings at most
  double tolerance = 1e-5;  ///< error of a cell's integral, over the whole, below which it is not split
  std::int64_t evaluations_max = 400000;
  int threads = 0;
  Eigen::MatrixXd guides = {};  ///< rows; may be empty
};

struct Quadrature {
  Eigen::VectorXd mean, sd;
  Eigen::VectorXd fourth;     ///< mean fourth power of the distance to the mean
  double correlation = 0.0;   ///< of the two coordinates; in two dimensions only
  double log_evidence = 0.0;  ///< log integral of the density
  std::int64_t evaluations = 0;
  bool resolved = true;  ///< no cell was left above the tolerance
};

Quadrature integrate(const Target& target, const QuadratureOptions& options = {});

/// Whether every mean and variance of the draws is within five of its standard errors of the exact one. The error of a
/// variance is the larger of two estimates, one from the draws, and one from the exact fourth moment and the effective
/// number of draws: draws that by chance miss a far place with a thousandth of the mass do not know how far they may be
/// off.
bool agree(const Draws& draws, const Quadrature& exact);

}  // namespace uq
