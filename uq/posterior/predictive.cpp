#include "uq/posterior/predictive.hpp"

#include <gsl/gsl_cdf.h>

#include <algorithm>
#include <cmath>

#include "data/random.hpp"
#include "uq/findings/study_units.hpp"
#include "uq/infer/diagnostics.hpp"
#include "uq/infer/factor.hpp"
#include "uq/posterior/fisher.hpp"
#include "uq/posterior/posterior.hpp"

namespace uq {
namespace {

constexpr int predictive_draws = 500;

/// Rows at which a set's curve is drawn: the set's first row, with one control spread over its range.
struct CurveRows {
  Eigen::MatrixXd base;
  Eigen::VectorXi unknown;
  Eigen::VectorXd x;  // SI
};

CurveRows curve_rows(const data::Study& study, const RowGroup& group, std::size_t row, std::size_t control_column) {
  constexpr Eigen::Index points = 41;
  const std::size_t control_index = group.emulator.inputs[control_column].index;
  const data::Control& control = study.controls[control_index];
  const auto range = group.emulator.control_range.find(control_index);
  auto [low, high] = range == group.emulator.control_range.end() ? std::pair{control.low, control.high} : range->second;
  for (const data::Observation& point : study.observations[group.origin[row].set].points) {
    low = std::min(low, point.controls[control_index]);
    high = std::max(high, point.controls[control_index]);
  }
  const data::Axis shown{low, high, control.scale};
  CurveRows rows{
      .base = group.base.row(row).replicate(points, 1),
      .unknown = group.unknown.row(row).transpose(),
      .x = Eigen::VectorXd::LinSpaced(points, 0.0, 1.0).unaryExpr([shown](double u) { return shown.from_unit(u); })};
  rows.base.col(control_column) = rows.x.unaryExpr([axis = control.axis()](double x) { return axis.to_unit(x); });
  return rows;
}

/// Mean and quantiles of the model over `draws` against the first control of each own set; the surrogate's error moves
/// the curve of draw i by normal[i] of its standard deviations.
std::vector<PredictiveCurve> curves_of(const data::Study& study, const CaseModel& model, const Eigen::MatrixXd& used,
                                       const Eigen::VectorXd& normal) {
  std::vector<PredictiveCurve> curves;
  for (const auto& group : model.groups) {
    const auto control = std::find_if(group.emulator.inputs.begin(), group.emulator.inputs.end(),
                                      [](const EmulatorInput& input) { return input.kind == InputKind::control; });
    if (control == group.emulator.inputs.end()) continue;
    const auto control_column = static_cast<std::size_t>(control - group.emulator.inputs.begin());
    for (std::size_t row = 0; row < group.origin.size(); ++row) {
      const bool first_of_set = row == 0 || group.origin[row].set != group.origin[row - 1].set;
      if (!first_of_set || !is_own_set(study, model, group.origin[row].set)) continue;
      const CurveRows rows = curve_rows(study, group, row, control_column);
      Eigen::MatrixXd values(used.rows(), rows.x.size());
      for (Eigen::Index i = 0; i < used.rows(); ++i) {
        Eigen::MatrixXd points = rows.base;
        for (Eigen::Index k = 0; k < points.cols(); ++k)
          if (rows.unknown[k] >= 0 && static_cast<std::size_t>(k) != control_column)
            points.col(k).setConstant(used(i, rows.unknown[k]));
        const surrogate::Prediction prediction = group.emulator.predict(points);
        const Meter meter =
            meter_at(group.measurement, model.unknowns, used.row(i).transpose(), static_cast<Eigen::Index>(row));
        for (Eigen::Index j = 0; j < rows.x.size(); ++j)
          values(i, j) =
              meter.offset +
              meter.factor * (prediction.mean[j] + std::sqrt(std::max(prediction.covariance(j, j), 0.0)) * normal[i]);
      }
      const data::Control& x = study.controls[control->index];
      const data::Output& output = study.outputs[group.origin[row].output];
      PredictiveCurve curve{.output = output.name,
                            .unit = output.unit.symbol,
                            .control = x.name,
                            .control_unit = x.unit.symbol,
                            .observation_set = study.observations[group.origin[row].set].name,
                            .x = {},
                            .mean = {},
                            .q05 = {},
                            .q95 = {}};
      for (Eigen::Index j = 0; j < rows.x.size(); ++j) {
        curve.x.push_back(x.unit.from_si(rows.x[j]));
        curve.mean.push_back(output.unit.from_si(values.col(j).mean()));
        curve.q05.push_back(output.unit.from_si(quantile(values.col(j), 0.05)));
        curve.q95.push_back(output.unit.from_si(quantile(values.col(j), 0.95)));
      }
      curves.push_back(std::move(curve));
    }
  }
  return curves;
}

}  // namespace

bool is_own_set(const data::Study& study, const CaseModel& model, std::size_t set) {
  return std::find(model.observed_sets.begin(), model.observed_sets.end(), study.observations[set].name) !=
         model.observed_sets.end();
}

Eigen::MatrixXd thinned(const Eigen::MatrixXd& draws, Eigen::Index count) {
  if (draws.rows() <= count) return draws;
  Eigen::MatrixXd kept(count, draws.cols());
  for (Eigen::Index i = 0; i < count; ++i) kept.row(i) = draws.row(i * draws.rows() / count);
  return kept;
}

FitCheck check_fit(const CaseModel& model, const Eigen::MatrixXd& draws, const Eigen::VectorXd& best) {
  const int count = number_count(model);
  const double n = count;
  const Eigen::MatrixXd used = thinned(draws, predictive_draws);
  FitCheck check;
  for_each_law(model, used, [&](Eigen::Index i, const std::vector<GroupLaw>& laws) {
    check.predictive_p += gsl_cdf_chisq_Q(chi_squared(model, laws, used.row(i).transpose()), n);
  });
  check.predictive_p /= static_cast<double>(used.rows());
  check.chi2 = chi_squared(model, best);
  check.dof = std::max(1, count - fisher_spectrum(model, best).known_directions);
  check.best_fit_p = gsl_cdf_chisq_Q(check.chi2, check.dof);
  return check;
}

Eigen::VectorXd own_errors(const Eigen::VectorXd& variance, const std::vector<LinkedErrors>& linked,
                           const Eigen::VectorXd& normal) {
  if (linked.empty()) return variance.cwiseSqrt().cwiseProduct(normal);
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(variance.size(), variance.size());
  add_own_errors(variance, linked, covariance);
  return semidefinite_root(covariance, "replicate errors") * normal;
}

Eigen::MatrixXd replicates(const CaseModel& model, const Eigen::MatrixXd& draws, std::uint64_t seed) {
  Eigen::MatrixXd made(draws.rows(), model.row_count());
  data::RandomStream random(seed, data::Purpose::posterior_predictive);
  for_each_law(model, draws, [&](Eigen::Index i, const std::vector<GroupLaw>& laws) {
    const Eigen::VectorXd u = draws.row(i).transpose();
    Eigen::VectorXd own(made.cols()), variance(made.cols());
    if (!model.linked_settings.empty()) {  // what the outputs share is drawn once
      const StackedPrediction all = stack(model, laws, u);
      Eigen::VectorXd shared(made.cols());
      for (double& value : shared) value = random.normal();
      for (double& value : own) value = random.normal();
      shared = all.mean + semidefinite_root(all.covariance, "replicate data") * shared;
      made.row(i) = (shared + own_errors(all.noise, model.linked_errors, own)).transpose();
      return;
    }
    Eigen::Index first = 0;
    for (std::size_t g = 0; g < laws.size(); ++g) {
      // What rows of equal settings share, then each row's own noise.
      const RowGroup& group = model.groups[g];
      Eigen::VectorXd shared(laws[g].mean.size());
      for (double& value : shared) value = random.normal();
      shared = laws[g].mean + semidefinite_root(laws[g].covariance, "replicate data") * shared;
      const Eigen::VectorXd noise = noise_of(group.measurement, model.unknowns, group.variance, u);
      for (Eigen::Index row = 0; row < noise.size(); ++row) {
        const Eigen::Index at = model.distinct ? group.distinct_row[row] : row;
        made(i, first + row) = shared[at];
        own[first + row] = random.normal();
      }
      variance.segment(first, noise.size()) = noise;
      first += noise.size();
    }
    made.row(i) += own_errors(variance, model.linked_errors, own).transpose();
  });
  return made;
}

Eigen::VectorXd mean_prediction(const CaseModel& model, const Eigen::MatrixXd& draws) {
  const Eigen::MatrixXd used = thinned(draws, predictive_draws);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(model.row_count());
  for_each_law(model, used, [&](Eigen::Index i, const std::vector<GroupLaw>& laws) {
    sum += moments(model, laws, used.row(i).transpose()).mean;
  });
  return sum / static_cast<double>(used.rows());
}

PredictivePoint observed_point(const data::Study& study, const RowOrigin& from) {
  const data::ObservationSet& set = study.observations[from.set];
  const data::Observation& observation = set.points[from.point];
  const data::Output& output = study.outputs[from.output];
  const std::size_t column = set.column_of(from.output).value();
  return {.controls = named_controls(study, observation.controls),
          .output = output.name,
          .unit = output.unit.symbol,
          .observed = output.unit.from_si(observation.values[column]),
          .standard_error = observation.standard_errors[column] / output.unit.factor,
          .observation_set = set.name};
}

std::vector<PredictivePoint> predictive_points(const data::Study& study, const CaseModel& model,
                                               const Eigen::MatrixXd& draws, std::uint64_t seed) {
  const Eigen::MatrixXd made = replicates(model, thinned(draws, 4 * predictive_draws), seed);
  const Eigen::VectorXd mean = mean_prediction(model, draws);
  const std::vector<RowOrigin> from = origins(model);
  std::vector<PredictivePoint> points;
  for (std::size_t row = 0; row < from.size(); ++row) {
    if (!is_own_set(study, model, from[row].set)) continue;
    const data::Unit& unit = study.outputs[from[row].output].unit;
    const Eigen::VectorXd values = made.col(row);
    PredictivePoint point = observed_point(study, from[row]);
    point.mean = unit.from_si(mean[row]);
    point.q05 = unit.from_si(quantile(values, 0.05));
    point.q95 = unit.from_si(quantile(values, 0.95));
    points.push_back(std::move(point));
  }
  return points;
}

std::vector<PredictiveCurve> predictive_curves(const data::Study& study, const CaseModel& model,
                                               const Eigen::MatrixXd& draws, std::uint64_t seed) {
  const Eigen::MatrixXd used = thinned(draws, predictive_draws);
  // One normal number per draw moves its whole curve: the bands are pointwise, so the covariance between points does
  // not enter, and the quantiles come out as smooth as the curves.
  data::RandomStream random(seed, data::Purpose::predictive_curve);
  Eigen::VectorXd normal(used.rows());
  for (double& value : normal) value = random.normal();
  return curves_of(study, model, used, normal);
}

std::vector<PredictiveCurve> mean_curves(const data::Study& study, const CaseModel& model, const Eigen::VectorXd& u) {
  return curves_of(study, model, u.transpose(), Eigen::VectorXd::Zero(1));
}

}  // namespace uq
