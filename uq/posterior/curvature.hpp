#pragma once
// The curvature of a case's log density by Gauss and Newton: with J the slopes of the data's means over the unknowns, S
// the data's covariance and P what is known of the unknowns beside the data,
//   J' S^-1 J + P.
#include <Eigen/Dense>
#include <optional>

#include "uq/posterior/case_model.hpp"

namespace uq {

/// The unknowns whose priors are part of P: all unknowns, or the nuisances and cut parameters, as in a likelihood that
/// is profiled over the parameters.
enum class KnownBeside { all, nuisances };

/// The curvature at u, unknowns x unknowns, on the scaled axes. None where S cannot be factorised.
std::optional<Eigen::MatrixXd> curvature(const CaseModel& model, const Eigen::VectorXd& u, KnownBeside beside);

}  // namespace uq
