#pragma once
// Mean and covariance of a mixture of predictions with weights w_i that add up to one, about the first one's mean m_0:
//   mean = m_0 + sum w_i (m_i - m_0),   cov = sum w_i (C_i + (m_i - m_0)(m_i - m_0)') - shift shift'.
#include "surrogate/gaussian_process.hpp"

namespace surrogate {

class MixedPrediction {
 public:
  void add(double weight, const Prediction& part) {
    if (count_++ == 0) {
      origin_ = part.mean;
      shift_ = Eigen::VectorXd::Zero(part.mean.size());
      covariance_ = Eigen::MatrixXd::Zero(part.mean.size(), part.mean.size());
    }
    const Eigen::VectorXd delta = part.mean - origin_;
    shift_ += weight * delta;
    covariance_ += weight * (part.covariance + delta * delta.transpose());
  }
  Prediction result() const { return {origin_ + shift_, covariance_ - shift_ * shift_.transpose()}; }

 private:
  int count_ = 0;
  Eigen::VectorXd origin_, shift_;
  Eigen::MatrixXd covariance_;
};

}  // namespace surrogate
