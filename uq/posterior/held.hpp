#pragma once
// A case's posterior with some unknowns held, over the others alone. Both sides of a comparison then have the same data
// and the same priors, whatever the held unknown is linked with.
//   log p(rest | held, y) = sum over the rest of log prior + log L(held, rest) + const
// The evidence is its integral over the rest.
//
// What a surrogate's error makes of a Bayes factor. Both evidences integrate the surrogate's functions f out; with f
// known the factor would be another. Let f = mean + delta, delta ~ N(0, C) jointly at the rows of both sides' most
// likely points, with the response linear around each of them (J, columns of the free unknowns). A side's log evidence
// is
//   ln Z(delta) = -1/2 (r - delta)' M (r - delta) + const,   r = y - mean,
//   M = S^-1 - S^-1 J (J' S^-1 J + I)^-1 J' S^-1,            S: the measurement's covariance,
// I for the priors, which are about as wide as the unit cube. The data say something of delta, too: given them and the
// first side it is normal with covariance C' = (C^-1 + M)^-1 and mean m = C' M r. The difference of two such forms,
// D = delta' A delta + g' delta + const, then has
//   mean      m' A m + tr(A C') + g' m + const,
//   variance  h' C' h + 2 tr(A C' A C'),   h = g + 2 A m.
// The constant follows from the factor of the mean evidences, since a form's mean over delta ~ N(0, C) is known:
//   ln E Z = -1/2 r' (I + M C)^-1 M r - 1/2 log|I + C M|,   with -1/2 r' M r as the form's own constant.
// A factor with f known lies as a rule farther from zero than that of the mean evidences.
#include <memory>
#include <vector>

#include "uq/infer/log_density.hpp"
#include "uq/infer/optimise.hpp"
#include "uq/posterior/case_model.hpp"

namespace uq {

/// The case's posterior over the others. `held`: unknowns and their values in u. At least one unknown must be left.
Target held_target(const std::shared_ptr<const CaseModel>& model, const std::vector<Held>& held);

/// Points of all unknowns, made from points of the unknowns that are left.
Eigen::MatrixXd with_held(const Eigen::MatrixXd& rest, const std::vector<Held>& held);

/// One side of a comparison.
struct ComparedSide {
  Eigen::VectorXd best;  ///< most likely point, all unknowns, u
  std::vector<int> free;
};

/// The log Bayes factor that would be found with the surrogates' functions known.
struct SharperFactor {
  double shift = 0.0;  ///< its mean less the factor of the mean evidences
  double sd = 0.0;
};

/// Both are zero for an emulator without error.
SharperFactor sharper_factor(const CaseModel& model, const ComparedSide& first, const ComparedSide& second);

/// Unknowns that are not held.
std::vector<int> unknowns_left(int dimension, const std::vector<Held>& held);

}  // namespace uq
