#include "uq/posterior/discrepancy.hpp"

#include <algorithm>
#include <cmath>

#include "data/random.hpp"
#include "uq/infer/diagnostics.hpp"
#include "uq/infer/factor.hpp"
#include "uq/posterior/posterior.hpp"
#include "uq/posterior/predictive.hpp"

namespace uq {
namespace {

constexpr Eigen::Index band_draws = 300, band_points = 31;

/// Settings of a set's first point, with the first control spread over the set's points.
struct Line {
  Eigen::MatrixXd controls;  // points x controls, in their ranges
  Eigen::VectorXd x;         // of the first control, SI
};

Line line_through(const data::Study& study, const data::ObservationSet& set) {
  const data::Control& first = study.controls.front();
  double low = set.points.front().controls[0], high = low;
  for (const auto& point : set.points) {
    low = std::min(low, point.controls[0]);
    high = std::max(high, point.controls[0]);
  }
  Line line{.controls = Eigen::MatrixXd(band_points, static_cast<Eigen::Index>(study.controls.size())),
            .x = Eigen::VectorXd::LinSpaced(band_points, low, high)};
  for (std::size_t c = 0; c < study.controls.size(); ++c) {
    const double scaled = study.controls[c].axis().to_unit(set.points.front().controls[c]);
    line.controls.col(c).setConstant(scaled);
  }
  line.controls.col(0) = line.x.unaryExpr([axis = first.axis()](double x) { return axis.to_unit(x); });
  return line;
}

DiscrepancyBand band_of(const data::Study& study, const CaseModel& model, const RowGroup& group,
                        const DiscrepancyRows& part, const std::pair<std::size_t, std::uint64_t>& set_and_seed,
                        const Eigen::MatrixXd& draws) {
  const data::ObservationSet& set = study.observations[set_and_seed.first];
  const Line line = line_through(study, set);
  data::RandomStream random(set_and_seed.second, data::Purpose::discrepancy_band,
                            static_cast<std::uint32_t>(set_and_seed.first));
  Eigen::MatrixXd values(draws.rows(), band_points);
  double share = 0.0;
  for (Eigen::Index i = 0; i < draws.rows(); ++i) {
    const Eigen::VectorXd u = draws.row(i).transpose();
    const GroupLaw law = group_law(model, group, u);
    Eigen::MatrixXd covariance = law.covariance;
    covariance.diagonal() += law.noise;
    const Unknown& sd = model.unknowns[part.sd];
    const Unknown& length = model.unknowns[part.length];
    const double variance = std::pow(sd.value(u[part.sd]) * part.magnitude, 2);
    Eigen::MatrixXd cross = Eigen::MatrixXd::Zero(group.observed.size(), band_points);
    cross.middleRows(part.first, part.count) =
        variance * discrepancy_correlation(part.controls, line.controls, length.value(u[part.length]));
    const Factor root = factor(covariance, "the data about the model");
    Eigen::VectorXd residual = group.observed - law.mean;
    root.llt.matrixL().solveInPlace(residual);
    root.llt.matrixL().solveInPlace(cross);
    // Each point's own law; the band is pointwise.
    for (Eigen::Index j = 0; j < band_points; ++j)
      values(i, j) = cross.col(j).dot(residual) +
                     std::sqrt(std::max(variance - cross.col(j).squaredNorm(), 0.0)) * random.normal();
    const double total = covariance.diagonal().segment(part.first, part.count).sum();
    share += variance * static_cast<double>(part.count) / total;
  }
  const data::Output& output = study.outputs[group.emulator.output];
  const data::Control& control = study.controls.front();
  DiscrepancyBand band{.output = output.name,
                       .unit = output.unit.symbol,
                       .control = control.name,
                       .control_unit = control.unit.symbol,
                       .observation_set = set.name,
                       .share = share / static_cast<double>(draws.rows()),
                       .x = {},
                       .mean = {},
                       .q05 = {},
                       .q95 = {}};
  for (Eigen::Index j = 0; j < band_points; ++j) {
    band.x.push_back(control.unit.from_si(line.x[j]));
    band.mean.push_back(values.col(j).mean() / output.unit.factor);
    band.q05.push_back(quantile(values.col(j), 0.05) / output.unit.factor);
    band.q95.push_back(quantile(values.col(j), 0.95) / output.unit.factor);
  }
  return band;
}

}  // namespace

std::vector<DiscrepancyBand> discrepancy_bands(const data::Study& study, const CaseModel& full,
                                               const Eigen::MatrixXd& draws, std::uint64_t seed) {
  const CaseModel& model = distinct_rows(full);
  std::vector<DiscrepancyBand> bands;
  if (study.controls.empty()) return bands;
  const Eigen::MatrixXd used = thinned(draws, band_draws);
  for (const auto& group : model.groups)
    for (const auto& part : group.measurement.discrepancies)
      for (Eigen::Index row = part.first; row < part.first + part.count; ++row) {
        const std::size_t set = group.origin[row].set;
        const bool first_of_set = row == part.first || group.origin[row - 1].set != set;
        if (first_of_set && is_own_set(study, model, set))
          bands.push_back(band_of(study, model, group, part, {set, seed}, used));
      }
  return bands;
}

}  // namespace uq
