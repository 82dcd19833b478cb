#pragma once
// The law of an unknown that was cut from another case, as a profile needs it: a density with a slope, in place of the
// other case's data.
//
// A normal law of that posterior's mean and sd is enough where the posterior has one hill. Where it has several, such
// as two frictions that give the same torque, the normal law is likeliest between them, where no draw lies. The law is
// then the mixture of one component for each hill (uq/infer/student_mixture.hpp, without its wide component).
#include <Eigen/Core>

#include "uq/infer/student_mixture.hpp"

namespace uq {

struct CutLaw {
  double mean = 0.0, sd = 1.0;  ///< in u
  Mixture hills = {};           ///< none: the law is normal
  double highest = 0.0;         ///< log density of the hills where it is highest

  /// Log density, 0 at its highest.
  double log_density(double u) const;
  double slope(double u) const;  ///< of log_density
  /// The inverse variance of the hill that u belongs to.
  double precision(double u) const;
};

/// The law of draws of one unknown, in u.
CutLaw cut_law(const Eigen::VectorXd& draws, std::uint64_t seed);

}  // namespace uq
