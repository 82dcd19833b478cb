#include "uq/fisher.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "uq/posterior.hpp"

namespace uq {

FisherSpectrum fisher_spectrum(const CaseModel& model, const Eigen::VectorXd& u) {
  constexpr double infinite = std::numeric_limits<double>::infinity();
  const StackedPrediction prediction = predict(model, u);
  Eigen::MatrixXd covariance = prediction.covariance;
  covariance.diagonal() += observed_variance(model);
  const Eigen::LLT<Eigen::MatrixXd> factor(covariance);
  Eigen::MatrixXd whitened = sensitivity(model, u);
  for (Eigen::Index s = 0; s < u.size(); ++s) whitened.col(s) *= model.slots[static_cast<std::size_t>(s)].prior.sd();
  if (factor.info() == Eigen::Success) factor.matrixL().solveInPlace(whitened);

  FisherSpectrum found;
  const Eigen::MatrixXd information = whitened.transpose() * whitened;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(information);
  found.eigenvalues = solver.eigenvalues().cwiseMax(0.0);
  found.directions = solver.eigenvectors();
  const double largest = found.eigenvalues.maxCoeff(), smallest = found.eigenvalues.minCoeff();
  found.condition = smallest > 1e-14 * largest ? largest / smallest : infinite;
  found.known_directions = static_cast<int>((found.eigenvalues.array() > 1.0).count());

  Eigen::MatrixXd unit = whitened;
  for (Eigen::Index s = 0; s < u.size(); ++s) {
    const double length = unit.col(s).norm();
    if (length > 0.0) unit.col(s) /= length;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> gram(unit.transpose() * unit);
  const double least = gram.eigenvalues().minCoeff();
  found.collinearity = least > 1e-14 ? 1.0 / std::sqrt(least) : infinite;
  return found;
}

}  // namespace uq
