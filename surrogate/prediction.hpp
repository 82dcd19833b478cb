#pragma once
// The steps of a prediction, for the sources of this folder only.
#include "surrogate/gaussian_process.hpp"

namespace surrogate {

enum class Slopes { no, yes };

/// Correlations, whitened correlations and mean-uncertainty of one part at the given points, left in the workspace:
/// correlations = s^2 c, slopes = s^2 f (if wanted), whitened = L^-1 k*, projected = E.
void cross(const Conditioned& part, const GaussianProcess& process, const Eigen::MatrixXd& points, Slopes slopes,
           PredictionWorkspace& workspace);

/// Mean and covariance of z of points first ... first + count - 1 of the workspace.
struct PointRange {
  Eigen::Index first = 0, count = 0;
};
void latent(const Conditioned& part, const GaussianProcess& process, PointRange points, PredictionWorkspace& workspace,
            Prediction& result);

/// Takes a prediction of z to one of y.
void rescale(const Standardised& data, Prediction& result);

/// r^2 (kernel.hpp) between the rows of a and b, which are divided by the length scales: rows of a by rows of b.
void square_distances(const Eigen::Ref<const Eigen::MatrixXd>& a, const Eigen::Ref<const Eigen::MatrixXd>& b,
                      Eigen::MatrixXd& squares);

/// Checks that the points of a batch are whole groups, and says how many groups share a matrix product.
void check_groups(const Eigen::MatrixXd& points, int group);
Eigen::Index groups_at_once(int group);

void check_points(const Eigen::MatrixXd& points, int dimension);

}  // namespace surrogate
