#pragma once
// Warm-up from the reference to the density by tempering: a population of each chain follows
//   log p_b(x) = (1 - b) log reference(x) + b log p(x),  b from 0 to 1,
// with reweighting, resampling and Metropolis moves at each step (Del Moral, Doucet, Jasra 2006). The next b is where
// the weights' effective size falls to half. Moves are differential evolution (ter Braak 2006): x' = x + g (x_i - x_j)
// + small noise, from the population as it was when the step began. Populations are independent from chain to chain.
// What the moves adapt to makes the result approximate: it only starts the chains and shapes their proposal, it is not
// a sample.
#include <Eigen/Dense>
#include <cstdint>

#include "uq/infer/log_density.hpp"

namespace uq {

struct TemperingOptions {
  int population = 128;  ///< points per chain
  int moves = 4;         ///< Metropolis moves of each point per step
  int final_moves = 8;   ///< further moves at b = 1
  int steps_max = 60;
};

struct Population {
  Eigen::MatrixXd x;            ///< points x dimension
  Eigen::VectorXd log_density;  ///< log density of p
  int steps = 0;
  bool reached = false;  ///< whether b came to 1
  std::int64_t evaluations = 0;
};

/// Reference draws from which tempering starts; there may be more than the population holds.
struct Starts {
  Eigen::MatrixXd x;
  Eigen::VectorXd log_density;
};
Population temper(const Target& target, Starts starts, data::RandomStream& random,
                  const TemperingOptions& options = {});

}  // namespace uq
