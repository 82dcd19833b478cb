// A Gaussian process of a sine with a known error, and the median of its predictions.
#include <cstdio>

#include "surrogate/fit.hpp"
#include "uq/infer/diagnostics.hpp"

int main() {
  const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(9, 0.0, 1.0);
  const surrogate::GaussianProcess process =
      surrogate::fit({x, (6.0 * x).array().sin().matrix(), Eigen::VectorXd::Constant(9, 1e-6)});
  const Eigen::VectorXd mean = process.predict(Eigen::VectorXd::Constant(1, 0.3)).mean;
  std::printf("%.2f\n", uq::quantile(mean, 0.5));  // sin(1.8) = 0.97
}
