#include "surrogate/joint_prediction.hpp"

#include <stdexcept>
#include <utility>

#include "surrogate/gaps.hpp"
#include "surrogate/prediction.hpp"

namespace surrogate {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

FixedPoints::FixedPoints(GaussianProcess process, const MatrixXd& fixed) : process_(std::move(process)) {
  check_points(fixed, process_.dimension());
  if (process_.data().scale != OutputScale::linear)
    throw std::invalid_argument("points beside fixed ones need a process on the linear scale");
  locations_ = fixed(Eigen::all, process_.data().active);
  PredictionWorkspace workspace;
  VectorXd origin;
  shift_ = VectorXd::Zero(fixed.rows());
  for (const Conditioned& part : process_.averaged()) {
    cross(part, process_, fixed, Slopes::no, workspace);
    latent(part, process_, {0, fixed.rows()}, workspace, workspace.part);
    if (origin.size() == 0) origin = workspace.part.mean;
    parts_.push_back({workspace.points, workspace.whitened, workspace.projected, workspace.part.mean - origin});
    shift_ += part.weight * parts_.back().deviation;
  }
}

void FixedPoints::predict(const MatrixXd& points, int group, PredictionWorkspace& workspace,
                          JointPrediction& result) const {
  const Index fixed = locations_.rows(), all = points.rows(), groups = all / group;
  VectorXd origin(all), shift = VectorXd::Zero(all), deviation(all);
  result.covariance.setZero(group, all);
  result.cross.setZero(fixed, all);
  // A mixture over the settings, as mixture.hpp sums one, in units of z.
  for (std::size_t i = 0; i < parts_.size(); ++i) {
    const Conditioned& conditioned = process_.averaged()[i];
    const double weight = conditioned.weight;
    const Part& part = parts_[i];
    cross(conditioned, process_, points, Slopes::no, workspace);
    square_distances(part.scaled, workspace.points, workspace.squares);
    MatrixXd& between = workspace.with_fixed;
    between.resize(fixed, all);
    correlate(process_.kernel(),
              {{workspace.squares.data(), fixed * all}, {between.data(), fixed * all}, {nullptr, 0}});
    between *= conditioned.parameters.signal_variance;
    between.noalias() -= part.whitened.transpose() * workspace.whitened;
    if (part.projected.rows() > 0) between.noalias() += part.projected.transpose() * workspace.projected;
    for (Index g = 0; g < groups; ++g) {
      const Index first = g * group;
      latent(conditioned, process_, {first, group}, workspace, workspace.part);
      if (i == 0) origin.segment(first, group) = workspace.part.mean;
      auto off = deviation.segment(first, group);
      off = workspace.part.mean - origin.segment(first, group);
      result.covariance.middleCols(first, group) += weight * (workspace.part.covariance + off * off.transpose());
    }
    shift += weight * deviation;
    result.cross += weight * (between + part.deviation * deviation.transpose());
  }
  for (Index first = 0; first < all; first += group)
    result.covariance.middleCols(first, group) -= shift.segment(first, group) * shift.segment(first, group).transpose();
  result.cross -= shift_ * shift.transpose();
  const Standardised& data = process_.data();
  if (!data.gaps.empty()) add_gaps_between(data.gaps, locations_, points(Eigen::all, data.active), result.cross);
  result.mean = (data.shift + data.unit * (origin + shift).array()).matrix();
  result.covariance *= data.unit * data.unit;
  result.cross *= data.unit * data.unit;
}

}  // namespace surrogate
