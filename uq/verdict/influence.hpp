#pragma once
// Differences that the surrogate can tell apart. Predictions at two points u and v, read at the rows of a case, differ
// by
//   d_i = f_i (m_i(u) - m_i(v)),   var d_i = f_i^2 (C_ii(u, u) + C_ii(v, v) - 2 C_ii(u, v)),
// f the meter's factor and C the joint covariance of the surrogate at both points: an error that is the same at both
// drops out. In units of each row's own spread s_i (noise and surrogate, at the best fit):
//   size^2 = sum_i d_i^2 / s_i^2,    doubt^2 = sum_i var d_i / s_i^2.
// A difference whose size is below three times its doubt cannot be told from none.
//
// A parameter has influence when moving it through its range, or from end to end of it, the others held at the best fit
// or at a draw, changes the predictions by more than that, and by enough for the data to see it. A parameter without
// influence may have any value: what the surrogate's mean makes of it is the noise of the runs.
#include <Eigen/Dense>
#include <vector>

#include "uq/findings/thresholds.hpp"
#include "uq/posterior/case_model.hpp"

namespace uq {

/// The rows that are looked at, and the errors that they are measured in, at one point.
struct Yardstick {
  struct Group {
    std::vector<Eigen::Index> rows;  ///< rows of the group: at most some tens, evenly spaced
    Eigen::VectorXd weight;          ///< f_i / s_i
    Eigen::VectorXd noise_weight;    ///< f_i over the noise alone; f_i / s_i where there is none
    double stands_for = 1.0;         ///< rows of the group over rows looked at
  };
  std::vector<Group> groups;
};
Yardstick make_yardstick(const CaseModel& model, const Eigen::VectorXd& best);

/// A difference of predictions, in data errors.
struct Difference {
  double size = 0.0;   ///< root of the sum of squares over all rows
  double doubt = 0.0;  ///< surrogate's sd of the difference, likewise
  bool told_apart(const VerdictThresholds& thresholds) const {
    return size > thresholds.told_apart_sd * doubt && size > 1e-6;
  }
};
Difference difference(const CaseModel& model, const Yardstick& yardstick, const Eigen::VectorXd& u,
                      const Eigen::VectorXd& v);

/// The size of the difference from one point v: many u at the cost of their means.
class DistanceFrom {
 public:
  DistanceFrom(const CaseModel& model, const Yardstick& yardstick, const Eigen::VectorXd& v);
  double operator()(const Eigen::VectorXd& u) const;

 private:
  const CaseModel& model_;
  const Yardstick& yardstick_;
  std::vector<Eigen::VectorXd> means_;  ///< means of each group at v
};

struct Influence {
  bool shown = true;      ///< the surrogate can tell the influence from none
  double deviance = 0.0;  ///< deviance that the whole range brings about, largest of the points looked at
  double doubt = 0.0;     ///< the surrogate's variance of such a change, in squares of the noise alone
  bool some = true;       ///< shown, and large enough for the data
  bool hidden = false;    ///< shown, and too small for the data's errors, but not for smaller ones
};

/// The influence of each unknown of the model; nuisances always have some. `draws`: rows in u, of which a few are
/// looked at beside `best`.
std::vector<Influence> find_influence(const CaseModel& model, const Eigen::VectorXd& best, const Eigen::MatrixXd& draws,
                                      const VerdictThresholds& thresholds);

}  // namespace uq
