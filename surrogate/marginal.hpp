#pragma once
// Hyper-parameters integrated out instead of plugged in, so that few runs do not give false certainty.
//
// Their posterior density p(u) (fit.hpp: logarithms, in a box, under normal priors) is integrated by adaptive
// importance sampling (O. Cappe et al., "Population Monte Carlo", J. Comput. Graph. Stat. 13:907 (2004)), which sees
// mass away from the mode, such as the shoulder at short length scales that few runs leave:
//   stage 0   half the draws from Student's t (5 degrees of freedom) about the mode with the normal approximation's
//             covariance, half from the prior cut to the box (uniform where it is flat);
//   stage 1+  t about the weighted mean, with the weighted covariance of all draws so far;
//   weights   p(u) / sum_k (n_k / n) q_k(u) over all stages (A. Owen & Y. Zhou, J. Am. Stat. Assoc. 95:135 (2000)),
// the draws of each stage being scrambled Sobol points. For prediction the weighted draws are cut down to a few nodes:
// the draws are split into cells again and again; one draw of each cell, taken with probability proportional to its
// weight, stands for the cell and has its whole weight. Means over the nodes are unbiased for means over the draws. The
// cell that is split is the one with the largest score, at its weighted mean along the coordinate that the score is of:
//   weight x variance     of a hyper-parameter;
//   weight^2 x variance   of what predictions make of it: the mean and the second moment at a few points, in units of
//                         the predictive sd and variance there. It is the cell's share of the nodes' squared error. A
//                         rare short length scale widens predictions by tens: it gets cells of its own, where it
//                         would else stand for many times its weight in one set of nodes and be missed in another.
#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "surrogate/maximise.hpp"

namespace surrogate {

/// The density that is integrated over.
struct HyperPosterior {
  std::function<double(const Eigen::VectorXd& u)>
      log_density;                              ///< any constant left out; -infinity where there is none
  Eigen::VectorXd low, high;                    ///< box of u
  Eigen::VectorXd prior_mean, prior_precision;  ///< of u; precision 0: flat
  Eigen::VectorXd mode;
  Eigen::MatrixXd covariance;  ///< covariance of the normal approximation at the mode
  /// Predictions with the hyper-parameters u at a few points: means and variances. Empty: cells are split by u alone.
  std::function<MarginalPrediction(const Eigen::VectorXd& u)> predict = {};
};

struct IntegrationOptions {
  int draws = 512;  ///< draws per stage
  int stages = 3;
  int nodes = 32;  ///< nodes that predictions use, at most
  std::uint64_t seed = 0;
};

struct HyperNode {
  Eigen::VectorXd u;
  double weight = 0.0;
};

/// The nodes that predictions average over. The mode comes first, with weight 0 (it is the setting that is reported);
/// weights add up to one.
std::vector<HyperNode> integration_nodes(const HyperPosterior& posterior, const IntegrationOptions& options);

/// The posterior of a fit's objective about its maximum.
HyperPosterior hyper_posterior(const Objective& objective, const Eigen::VectorXd& mode);

/// The options for a number of distinct points. Where points are many the posterior is narrow, and each draw expensive.
/// With 1,000 of the runs of data/drum-table six nodes predict as sixteen do. Compared with 64 nodes of 768 draws, over
/// seeds and outputs, means differ by 0.04 to 0.10 of an sd (sixteen nodes: 0.02 to 0.15), sds by 2 to 8 % (1 to 12 %):
/// the draws decide.
IntegrationOptions integration_options(Eigen::Index points, std::uint64_t seed);

}  // namespace surrogate
