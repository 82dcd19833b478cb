#include "uq/infer/climb.hpp"

#include <algorithm>
#include <cmath>

namespace uq {
namespace {

constexpr int steps_max = 80;
constexpr double first_radius = 0.03, rise_min = 1e-3;

class Climber {
 public:
  Climber(const Target& target, const Eigen::VectorXd& start, const Eigen::VectorXd& width)
      : target_(target), width_(width), x_(start) {
    value_ = value_at(x_);
  }

  Climb run(const Knowledge& knowledge) {
    const auto end = [&](bool known) {
      return Climb{.x = x_, .log_density = value_, .known = known, .evaluations = evaluations_};
    };
    if (!(value_ > nowhere)) return end(false);
    const auto arrived = [&] { return value_ >= knowledge.log_bulk && knowledge.knows(x_, value_); };
    if (arrived()) return end(true);
    Eigen::VectorXd slope = slope_at(x_);
    const Eigen::Index d = x_.size();
    // The first model: a step of the radius would take the slope to zero.
    Eigen::MatrixXd curvature = Eigen::MatrixXd::Identity(d, d) * std::max(slope.norm() / first_radius, 1e-6);
    for (int i = 0; i < steps_max && radius_ > 1e-7; ++i) {
      const Eigen::VectorXd step = step_from(slope, curvature);
      const double predicted = slope.dot(step) - 0.5 * step.dot(curvature * step);
      if (!(predicted > rise_min)) break;
      const Eigen::VectorXd next = moved(x_, step);
      const double found = value_at(next);
      const double ratio = (found - value_) / predicted;
      if (ratio < 0.25 || !std::isfinite(ratio)) {
        radius_ = 0.25 * step.norm();
      } else if (ratio > 0.75 && step.norm() > 0.8 * radius_) {
        radius_ = std::min(2.0 * radius_, 0.3);
      }
      // The slope there teaches the model even where the step is refused, unless the place is out of the world.
      if (!std::isfinite(found)) continue;
      const Eigen::VectorXd there = slope_at(next);
      learn(curvature, step, slope - there);
      if (!(ratio > 1e-4)) continue;
      x_ = next;
      value_ = found;
      slope = there;
      if (arrived()) return end(true);
    }
    return end(knowledge.knows(x_, value_));
  }

 private:
  double value_at(const Eigen::VectorXd& x) {
    ++evaluations_;
    if (!target_.contains(x)) return nowhere;
    const double found = target_.log_density(x);
    return std::isnan(found) ? nowhere : found;
  }

  /// d log p / dz, z = x / width; central differences where there is no gradient, one-sided at the faces.
  Eigen::VectorXd slope_at(const Eigen::VectorXd& x) {
    const Eigen::Index d = x.size();
    if (target_.log_density_gradient) {
      evaluations_ += 2;
      Eigen::VectorXd known = target_.log_density_gradient(x).gradient.cwiseProduct(width_);
      if (known.allFinite()) return known;
    }
    constexpr double step = 1e-6;
    Eigen::VectorXd slope(d);
    for (Eigen::Index k = 0; k < d; ++k) {
      Eigen::VectorXd high = x, low = x;
      high[k] = std::min(x[k] + step * width_[k], target_.upper[k]);
      low[k] = std::max(x[k] - step * width_[k], target_.lower[k]);
      const double above = value_at(high), below = value_at(low);
      const double apart = (high[k] - low[k]) / width_[k];
      slope[k] = std::isfinite(above) && std::isfinite(below) ? (above - below) / apart : 0.0;
    }
    return slope;
  }

  Eigen::VectorXd moved(const Eigen::VectorXd& x, const Eigen::VectorXd& step) const {
    return (x + step.cwiseProduct(width_)).cwiseMax(target_.lower).cwiseMin(target_.upper);
  }

  /// Maximiser of the model inside the trust region and the support: coordinates that a face holds are left out.
  Eigen::VectorXd step_from(const Eigen::VectorXd& slope, const Eigen::MatrixXd& curvature) const {
    const Eigen::Index d = slope.size();
    std::vector<Eigen::Index> free;
    for (Eigen::Index k = 0; k < d; ++k) {
      const double edge = 1e-9 * width_[k];
      const bool held =
          (x_[k] <= target_.lower[k] + edge && slope[k] < 0.0) || (x_[k] >= target_.upper[k] - edge && slope[k] > 0.0);
      if (!held) free.push_back(k);
    }
    Eigen::VectorXd step = Eigen::VectorXd::Zero(d);
    if (free.empty()) return step;
    const Eigen::VectorXd along = slope(free);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(Eigen::MatrixXd(curvature(free, free)));
    const Eigen::VectorXd turned = solver.eigenvectors().transpose() * along;
    const auto length_at = [&](double damping) {
      return turned.cwiseQuotient((solver.eigenvalues().array() + damping).matrix()).norm();
    };
    // The damping at which the step is as long as the radius.
    double damping = std::max(0.0, 1e-9 - solver.eigenvalues().minCoeff());
    if (length_at(damping) > radius_) {
      double low = damping, high = std::max(1.0, damping) + turned.norm() / radius_;
      for (int i = 0; i < 60; ++i) {
        const double middle = i < 30 && low > 0.0 ? std::sqrt(low * high) : 0.5 * (low + high);
        (length_at(middle) > radius_ ? low : high) = middle;
      }
      damping = high;
    }
    const Eigen::VectorXd found =
        solver.eigenvectors() * turned.cwiseQuotient((solver.eigenvalues().array() + damping).matrix());
    for (std::size_t k = 0; k < free.size(); ++k) step[free[k]] = found[k];
    // Only the part of the step that the support allows is made.
    return (moved(x_, step) - x_).cwiseQuotient(width_);
  }

  static void learn(Eigen::MatrixXd& curvature, const Eigen::VectorXd& step, const Eigen::VectorXd& change) {
    const double along = step.dot(change);
    if (!(along > 1e-10 * step.norm() * change.norm())) return;
    const Eigen::VectorXd pushed = curvature * step;
    curvature += change * change.transpose() / along - pushed * pushed.transpose() / step.dot(pushed);
  }

  const Target& target_;
  const Eigen::VectorXd& width_;
  Eigen::VectorXd x_;
  double value_ = nowhere, radius_ = first_radius;
  int evaluations_ = 0;
};

}  // namespace

Climb climb(const Target& target, const Eigen::VectorXd& start, const Eigen::VectorXd& width,
            const Knowledge& knowledge) {
  return Climber(target, start, width).run(knowledge);
}

}  // namespace uq
