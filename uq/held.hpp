#pragma once
// A case's posterior with some unknowns held, over the others alone: the same data and the same priors on both sides of
// a comparison, whatever the held unknown is linked with.
//   log p(rest | held, y) = sum over the rest of log prior + log L(held, rest) + const,   evidence = integral over the
//   rest
//
// What a surrogate's error makes of a Bayes factor. Both evidences integrate the surrogate's functions f out. With f
// known they would be
//   Z(f) = integral L(u; f) prior(u) du = Z E[ N(y | f(u)) / L(u) ],   u from the posterior
// so ln Z_free(f) - ln Z_held(f) over draws of f, the same on both sides, spreads as the factor would if more runs told
// which f it is.
#include <memory>
#include <vector>

#include "uq/case_model.hpp"
#include "uq/log_density.hpp"
#include "uq/optimise.hpp"

namespace uq {

/// `held`: unknowns and their values in u. At least one unknown must be left.
Target held_target(std::shared_ptr<const CaseModel> model, const std::vector<Held>& held);

/// Points of all unknowns from points of the rest.
Eigen::MatrixXd with_held(const Eigen::MatrixXd& rest, const std::vector<Held>& held);

/// Standard deviation of the log Bayes factor over the surrogates' functions; `first`, `second`: posterior draws of the
/// two sides (rows, all unknowns). Zero for an emulator without error.
double surrogate_part(const CaseModel& model, const Eigen::MatrixXd& first, const Eigen::MatrixXd& second,
                      std::uint64_t seed);

}  // namespace uq
