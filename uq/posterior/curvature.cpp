#include "uq/posterior/curvature.hpp"

#include <cmath>

#include "uq/posterior/distinct.hpp"
#include "uq/posterior/posterior.hpp"

namespace uq {

std::optional<Eigen::MatrixXd> curvature(const CaseModel& model, const Eigen::VectorXd& u, KnownBeside beside) {
  const CaseModel& rows = distinct_rows(model);
  const Eigen::LLT<Eigen::MatrixXd> noise(predict(rows, u).total());
  if (noise.info() != Eigen::Success) return {};
  Eigen::MatrixXd slopes = sensitivity(rows, u);
  noise.matrixL().solveInPlace(slopes);
  Eigen::MatrixXd found = slopes.transpose() * slopes;
  for (Eigen::Index s = 0; s < u.size(); ++s) {
    const Unknown& unknown = model.unknowns[s];
    if (beside == KnownBeside::all || unknown.nuisance) found(s, s) += 1.0 / std::pow(unknown.prior.sd(), 2);
    if (beside == KnownBeside::nuisances && unknown.cut) found(s, s) += unknown.cut->precision(u[s]);
  }
  return found;
}

}  // namespace uq
