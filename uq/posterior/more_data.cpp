#include "uq/posterior/more_data.hpp"

#include <cmath>
#include <map>

#include "uq/posterior/posterior.hpp"

namespace uq {
namespace {

constexpr std::size_t rows_most = 120;  // of a set's points, in the model of what they leave open

}  // namespace

/// Points measured again at the same controls become one, and of very many some stand for all.
void condense(data::ObservationSet& set) {
  std::map<std::vector<double>, std::vector<const data::Observation*>> at;
  for (const data::Observation& point : set.points) at[point.controls].push_back(&point);
  std::vector<data::Observation> points;
  for (const auto& [controls, same] : at) {
    data::Observation one = *same.front();
    for (std::size_t c = 0; c < one.values.size(); ++c) {
      double weight = 0.0, sum = 0.0;
      for (const auto* point : same) {
        const double w = 1.0 / std::pow(point->standard_errors[c], 2);
        weight += w;
        sum += w * point->values[c];
      }
      one.values[c] = sum / weight;
      one.standard_errors[c] = 1.0 / std::sqrt(weight);
    }
    points.push_back(std::move(one));
  }
  if (points.size() > rows_most) {
    std::vector<data::Observation> some;
    for (std::size_t i = 0; i < rows_most; ++i) some.push_back(points[i * (points.size() - 1) / (rows_most - 1)]);
    points = std::move(some);
  }
  set.points = std::move(points);
}

CaseModel with_more_data(const data::Study& wider, const std::vector<Emulator>& emulators, std::size_t case_index,
                         const CaseModel& sampled) {
  CaseModel model = build_case(wider, emulators, case_index);
  model.slots = sampled.slots;
  model.distinct.reset();
  for (RowGroup& group : model.groups)
    for (const RowGroup& other : sampled.groups)
      if (other.emulator.material == group.emulator.material && other.emulator.output == group.emulator.output)
        for (std::size_t k = 0; k < other.measurement.discrepancies.size(); ++k)
          group.measurement.discrepancies.at(k).magnitude = other.measurement.discrepancies[k].magnitude;
  return model;
}

ReadingLaw reading_law(const StackedPrediction& all, const Eigen::VectorXd& observed,
                       const std::vector<Eigen::Index>& wanted, const std::vector<Eigen::Index>& measured) {
  ReadingLaw law{all.mean(wanted), all.covariance(wanted, wanted), all.noise(wanted)};
  if (measured.empty()) return law;
  Eigen::MatrixXd among = all.covariance(measured, measured);
  among.diagonal() += all.noise(measured);
  const Eigen::LLT<Eigen::MatrixXd> factor(among);
  if (factor.info() != Eigen::Success) return law;
  const Eigen::MatrixXd between = all.covariance(measured, wanted);
  law.mean += between.transpose() * factor.solve(observed(measured) - all.mean(measured));
  law.shared -= between.transpose() * factor.solve(between);
  return law;
}

}  // namespace uq
