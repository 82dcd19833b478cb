#pragma once
// Cases whose model is a formula: no study file, no surrogate. For tests of the posterior and of the verdicts.
#include <Eigen/Dense>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "data/random.hpp"
#include "uq/posterior/case_model.hpp"

namespace closed_form {

struct FreeParameter {
  std::string name;
  double low = 0.0, high = 1.0;
  data::Prior prior = {};  // uniform on the range unless its kind or bounds say otherwise
  double unit_factor = 1.0;
  data::Scale scale = data::Scale::linear;
};

/// Model value at (parameters in SI, x).
using Formula = std::function<double(const Eigen::VectorXd& parameters, double x)>;

inline data::Parameter parameter_of(const FreeParameter& unknown) {
  data::Parameter parameter;
  parameter.name = unknown.name;
  parameter.unit.factor = unknown.unit_factor;
  parameter.low = unknown.low;
  parameter.high = unknown.high;
  parameter.scale = unknown.scale;
  parameter.prior = unknown.prior;
  if (unknown.prior.kind == data::PriorKind::uniform && unknown.prior.low == 0.0 && unknown.prior.high == 1.0) {
    parameter.prior.low = unknown.low;
    parameter.prior.high = unknown.high;
  }
  return parameter;
}

/// y measured at x with the given sd; the emulator is the formula itself, without error.
inline uq::CaseModel make_case(const std::vector<FreeParameter>& unknowns, const Formula& formula,
                               const Eigen::VectorXd& x, const Eigen::VectorXd& y, const Eigen::VectorXd& sd) {
  uq::CaseModel model{.name = "closed form", .unknowns = {}, .groups = {}, .linked = {}, .observed_sets = {}};
  std::vector<data::Parameter> parameters;
  for (const auto& unknown : unknowns) {
    parameters.push_back(parameter_of(unknown));
    model.unknowns.push_back(
        {.label = unknown.name, .prior = uq::ScaledPrior(parameters.back(), parameters.back().prior), .cut = {}});
  }
  const auto d = static_cast<Eigen::Index>(unknowns.size());
  uq::RowGroup group{.emulator = {},
                     .base = Eigen::MatrixXd::Zero(x.size(), d + 1),
                     .unknown = Eigen::MatrixXi::Constant(x.size(), d + 1, -1),
                     .observed = y,
                     .variance = sd.cwiseAbs2(),
                     .origin = {},
                     .coordinate = {}};
  for (std::size_t k = 0; k < unknowns.size(); ++k) group.emulator.inputs.push_back({uq::InputKind::parameter, k});
  group.emulator.inputs.push_back({uq::InputKind::control, 0});
  group.emulator.predict = [parameters, formula](const Eigen::MatrixXd& points) -> surrogate::Prediction {
    surrogate::Prediction found{.mean = Eigen::VectorXd(points.rows()),
                                .covariance = Eigen::MatrixXd::Zero(points.rows(), points.rows())};
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      Eigen::VectorXd values(static_cast<Eigen::Index>(parameters.size()));
      for (std::size_t k = 0; k < parameters.size(); ++k)
        values[k] = parameters[k].axis().from_unit(points(i, static_cast<Eigen::Index>(k)));
      found.mean[i] = formula(values, points(i, points.cols() - 1));
    }
    return found;
  };
  for (Eigen::Index k = 0; k < d; ++k) group.unknown.col(k).setConstant(static_cast<int>(k));
  group.base.col(d) = x;
  for (Eigen::Index i = 0; i < x.size(); ++i) group.origin.push_back({0, static_cast<std::size_t>(i), 0});
  uq::find_coordinates(group, static_cast<int>(d));
  model.groups.push_back(group);
  return model;
}

/// The same with y from the formula at `truth` plus normal noise of the stated sd, index `index`.
inline uq::CaseModel make_synthetic(const std::vector<FreeParameter>& unknowns, const Formula& formula,
                                    const Eigen::VectorXd& x, const Eigen::VectorXd& truth, double relative_error,
                                    std::uint32_t index) {
  Eigen::VectorXd y(x.size()), sd(x.size());
  data::RandomStream random(20111026, data::Purpose::test, index);
  for (Eigen::Index i = 0; i < x.size(); ++i) {
    const double exact = formula(truth, x[i]);
    sd[i] = relative_error * std::abs(exact);
    y[i] = exact + sd[i] * random.normal();
  }
  return make_case(unknowns, formula, x, y, sd);
}

}  // namespace closed_form
