#pragma once
// Predictions together with their covariance to points that never change, such as the expensive runs of a two-level
// process. What concerns the fixed points alone is worked out once.
#include "surrogate/gaussian_process.hpp"

namespace surrogate {

/// The prediction at M points in groups of g.
struct JointPrediction {
  Eigen::VectorXd mean;        ///< unit of y, M
  Eigen::MatrixXd covariance;  ///< unit^2 of y, g x M: the groups' own covariances side by side
  Eigen::MatrixXd cross;       ///< unit^2 of y, fixed points x M
};

class FixedPoints {
 public:
  /// Fixed points in the unit cube, one per row. Throws std::invalid_argument for a process on the log scale, whose
  /// moments are not those of a normal law.
  FixedPoints(GaussianProcess process, const Eigen::MatrixXd& fixed);

  /// Predicts points stacked in groups of `group` rows. The moments are those that GaussianProcess::predict gives for
  /// the fixed points and a group together.
  void predict(const Eigen::MatrixXd& points, int group, PredictionWorkspace& workspace, JointPrediction& result) const;

 private:
  /// Precomputed values for one of the settings that predictions average over.
  struct Part {
    Eigen::MatrixXd scaled, whitened, projected;  // as PredictionWorkspace has them
    Eigen::VectorXd deviation;                    // deviation of its mean from the first part's, in units of z
  };

  GaussianProcess process_;
  std::vector<Part> parts_;
  Eigen::VectorXd shift_;      // weighted mean of the deviations
  Eigen::MatrixXd locations_;  // active inputs, unit cube
};

}  // namespace surrogate
