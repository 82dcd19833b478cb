#include "uq/posterior/fisher.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "uq/infer/factor.hpp"
#include "uq/posterior/posterior.hpp"

namespace uq {

namespace {

/// S^-1/2 J for the unknowns listed, each column times its prior's sd.
Eigen::MatrixXd whiten(const Eigen::MatrixXd& slopes, const std::vector<Eigen::Index>& chosen,
                       const Eigen::MatrixXd& covariance) {
  Eigen::MatrixXd whitened(slopes.rows(), static_cast<Eigen::Index>(chosen.size()));
  for (std::size_t k = 0; k < chosen.size(); ++k) whitened.col(k) = slopes.col(chosen[k]);
  factor(covariance, "the data at the best fit").llt.matrixL().solveInPlace(whitened);
  return whitened;
}

}  // namespace

FisherSpectrum fisher_spectrum(const CaseModel& full, const Eigen::VectorXd& u) {
  const CaseModel& model = distinct_rows(full);
  constexpr double infinite = std::numeric_limits<double>::infinity();
  Eigen::MatrixXd covariance = predict(model, u).total();
  Eigen::MatrixXd slopes = sensitivity(model, u);
  std::vector<Eigen::Index> all, parameters;
  for (Eigen::Index s = 0; s < u.size(); ++s) {
    const Unknown& unknown = model.unknowns[s];
    slopes.col(s) *= unknown.prior.sd();
    all.push_back(s);
    if (!unknown.nuisance) parameters.push_back(s);
  }
  const Eigen::MatrixXd every = whiten(slopes, all, covariance);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> known(every.transpose() * every);

  FisherSpectrum found;
  found.known_directions = static_cast<int>((known.eigenvalues().array() > 1.0).count());
  // The nuisances, integrated out under their priors, are part of what is uncertain of the data.
  for (Eigen::Index s = 0; s < u.size(); ++s)
    if (model.unknowns[s].nuisance) covariance += slopes.col(s) * slopes.col(s).transpose();
  Eigen::MatrixXd unit = whiten(slopes, parameters, covariance);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(unit.transpose() * unit);
  found.eigenvalues = solver.eigenvalues().cwiseMax(0.0);
  found.directions = solver.eigenvectors();
  const double largest = found.eigenvalues.maxCoeff(), smallest = found.eigenvalues.minCoeff();
  found.condition = smallest > 1e-14 * largest ? largest / smallest : infinite;

  for (Eigen::Index k = 0; k < unit.cols(); ++k) {
    const double length = unit.col(k).norm();
    if (length > 0.0) unit.col(k) /= length;
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> gram(unit.transpose() * unit);
  const double least = gram.eigenvalues().minCoeff();
  found.collinearity = least > 1e-14 ? 1.0 / std::sqrt(least) : infinite;
  return found;
}

void add_free_unknowns(const CaseModel& model, const Eigen::VectorXd& u, Eigen::MatrixXd& covariance) {
  constexpr double nearly_free = 10.0;  // sds of a parameter's prior
  const Eigen::MatrixXd slopes = sensitivity(model, u);
  for (std::size_t s = 0; s < model.unknowns.size(); ++s) {
    const Unknown& unknown = model.unknowns[s];
    if (unknown.only_widens()) continue;
    const double sd = unknown.cut ? unknown.cut->sd : unknown.prior.sd() * (unknown.nuisance ? 1.0 : nearly_free);
    const Eigen::VectorXd moved = sd * slopes.col(static_cast<Eigen::Index>(s));
    covariance += moved * moved.transpose();
  }
}

}  // namespace uq
