#pragma once
// Which parameters are traded against each other, and as what combination the data know them.
//
// A pair is traded when its posterior correlation, plain or of logarithms, or its correlation ratio, which sees a bent
// ridge too, is at least a threshold and not both are identified. Along the ridge (points of the profile paths within
// the deviance drop) two forms are fitted by total least squares:
//   power law   a * b^q = const:  log a + q log b constant
//   linear      a + c b = const
// and the one that keeps nearer to the ridge, in the scaled coordinates, is named; a ridge that bends away from both is
// only called a curved relation. Values are in the study's units.
#include <Eigen/Dense>
#include <string>
#include <vector>

#include "uq/case_model.hpp"
#include "uq/profile.hpp"
#include "uq/results.hpp"
#include "uq/verdict.hpp"

namespace uq {

/// The combination that the points share.
struct Combination {
  std::string text;  ///< "friction * hamaker^0.9" or "friction + 0.03 * cohesion"
  bool power_law = false;
  double coefficient = 0.0;  ///< q or c, with the first parameter's taken as one; NaN of a curved relation
  double misfit = 0.0;       ///< rms distance of the ridge from the form, in scaled coordinates
};

/// `points`: values of the two parameters along the ridge (study's units); `ranges`: their widths.
Combination find_combination(const std::string& first, const std::string& second, const Eigen::MatrixXd& points,
                             const Eigen::Vector2d& ranges);

/// Traded pairs of the case's own parameters. `draws`: rows in u. `identified`: per own parameter.
std::vector<TradedPair> find_traded_pairs(const CaseModel& model, const Eigen::MatrixXd& draws,
                                          const std::vector<Profile>& profiles, const std::vector<bool>& identified,
                                          const VerdictThresholds& thresholds);

}  // namespace uq
