#pragma once
// Problems whose information is known: closed forms, quadrature, and published examples.
#include <Eigen/Dense>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "surrogate/design.hpp"
#include "uq/plan/information.hpp"

namespace known {

/// Of a standard normal law (P. J. Acklam's rational start, one step of Newton on erfc).
inline double normal_quantile(double p) {
  const double t = std::sqrt(-2.0 * std::log(std::min(p, 1.0 - p)));
  double z =
      t - (2.515517 + 0.802853 * t + 0.010328 * t * t) / (1.0 + 1.432788 * t + 0.189269 * t * t + 0.001308 * t * t * t);
  if (p < 0.5) z = -z;
  for (int step = 0; step < 3; ++step)
    z -= (0.5 * std::erfc(-z / std::numbers::sqrt2) - p) * std::sqrt(2.0 * std::numbers::pi) * std::exp(0.5 * z * z);
  return z;
}

struct Problem {
  std::string name;
  int unknowns = 1, readings = 1;
  bool normal_prior = true;  ///< standard normal numbers of the unknowns, else uniform on (0, 1)
  std::function<Eigen::VectorXd(const Eigen::VectorXd&)> value;  ///< unknowns from those numbers
  std::function<Eigen::VectorXd(const Eigen::VectorXd&)> mean;   ///< readings from unknowns
  double noise_sd = 1.0;
  double total = 0.0;                              ///< nats
  std::vector<std::pair<int, double>> about = {};  ///< unknown, nats
};

inline Problem linear(std::string name, Eigen::MatrixXd rows, Eigen::VectorXd prior_sd, double noise, double total,
                      std::vector<std::pair<int, double>> about = {}) {
  return {.name = std::move(name),
          .unknowns = static_cast<int>(rows.cols()),
          .readings = static_cast<int>(rows.rows()),
          .normal_prior = true,
          .value = [prior_sd](const Eigen::VectorXd& z) -> Eigen::VectorXd { return prior_sd.cwiseProduct(z); },
          .mean = [rows](const Eigen::VectorXd& theta) -> Eigen::VectorXd { return rows * theta; },
          .noise_sd = noise,
          .total = total,
          .about = std::move(about)};
}

inline Problem scalar(std::string name, std::function<double(double)> value, std::function<double(double)> mean,
                      double noise, double total) {
  return {
      .name = std::move(name),
      .unknowns = 1,
      .readings = 1,
      .normal_prior = false,
      .value = [value](const Eigen::VectorXd& u) -> Eigen::VectorXd {
        return Eigen::VectorXd::Constant(1, value(u[0]));
      },
      .mean = [mean](const Eigen::VectorXd& t) -> Eigen::VectorXd { return Eigen::VectorXd::Constant(1, mean(t[0])); },
      .noise_sd = noise,
      .total = total,
      .about = {{0, total}}};
}

inline std::vector<Problem> problems() {
  std::vector<Problem> all;
  all.push_back(linear("three readings of two", (Eigen::MatrixXd(3, 2) << 1, 0, 0, 1, 0, 1).finished(),
                       Eigen::Vector2d(1.0, 1.5), 1.0, 1.19895, {{1, 0.85237}, {0, 0.34657}}));
  all.push_back(linear("a sum", Eigen::MatrixXd::Ones(1, 2), Eigen::Vector2d(1.0, 1.0), 0.1, 2.65165, {{0, 0.34409}}));
  all.push_back(linear("scalar, noise 0.5", Eigen::MatrixXd::Ones(1, 1), Eigen::VectorXd::Ones(1), 0.5, 0.8047189562));
  all.push_back(linear("scalar, noise 0.1", Eigen::MatrixXd::Ones(1, 1), Eigen::VectorXd::Ones(1), 0.1, 2.307560));
  all.push_back(linear("scalar, noise 0.02", Eigen::MatrixXd::Ones(1, 1), Eigen::VectorXd::Ones(1), 0.02, 3.912223));
  Eigen::MatrixXd line(6, 2);
  line << 1, 0, 1, 0.2, 1, 0.4, 1, 0.6, 1, 0.8, 1, 1;
  all.push_back(linear("a line", line, Eigen::Vector2d(1.0, 2.0), 0.3, 3.8570080873, {{1, 1.7497112421}}));
  const std::vector<std::pair<double, double>> huan = {{0.0, 3.00829}, {0.1, 3.11682}, {0.2, 3.24198}, {0.3, 3.19557},
                                                       {0.5, 3.17113}, {0.7, 3.22072}, {0.9, 3.31782}, {1.0, 3.37733}};
  for (const auto& [d, truth] : huan)
    all.push_back(scalar(
        "Huan & Marzouk, d = " + std::to_string(d).substr(0, 3), [](double u) { return u; },
        [d = d](double t) { return t * t * t * d * d + t * std::exp(-std::abs(0.2 - d)); }, 0.01, truth));
  // Its frequency alone is unknown; the published numbers are of a grid of 181 x 100.
  for (const auto& [t, truth] : {std::pair{1.0, 0.82169}, {3.5, 1.69886}, {5.0, 1.67781}})
    all.push_back(scalar(
        "sine, t = " + std::to_string(t).substr(0, 3), [](double u) { return 0.2 + 1.8 * u; },
        [t = t](double f) { return std::sin(f * t); }, 0.1, truth));
  return all;
}

/// Draws and readings' noise from one scrambled Sobol sequence, or both independent when `random` says so.
inline std::pair<uq::plan::Ensemble, Eigen::MatrixXd> ensemble_of(const Problem& problem, int draws,
                                                                  std::uint64_t seed) {
  const Eigen::MatrixXd cube = surrogate::scrambled_sobol(draws, problem.unknowns + problem.readings, seed);
  uq::plan::Ensemble ensemble{.values = Eigen::MatrixXd(draws, problem.unknowns),
                              .mean = Eigen::MatrixXd(draws, problem.readings),
                              .covariance = {}};
  Eigen::MatrixXd noise(draws, problem.readings);
  for (int i = 0; i < draws; ++i) {
    Eigen::VectorXd z = cube.row(i).head(problem.unknowns).transpose();
    if (problem.normal_prior) z = z.unaryExpr(&normal_quantile);
    const Eigen::VectorXd theta = problem.value(z);
    ensemble.values.row(i) = theta.transpose();
    ensemble.mean.row(i) = problem.mean(theta).transpose();
    noise.row(i) = cube.row(i).tail(problem.readings).unaryExpr(&normal_quantile);
  }
  ensemble.covariance.assign(
      static_cast<std::size_t>(draws),
      problem.noise_sd * problem.noise_sd * Eigen::MatrixXd::Identity(problem.readings, problem.readings));
  return {ensemble, noise};
}

}  // namespace known
