#include "uq/posterior/more_data.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "uq/posterior/posterior.hpp"
#include "uq/posterior/set_unknowns.hpp"

namespace uq {
namespace {

constexpr std::size_t rows_most = 120;  // of a set's points, in the model of what they leave open

/// The study with what the sampled case does not know as an error of the new sets: a meter that it has not read, the
/// machine's scale.
data::Study without_new_unknowns(data::Study study, std::size_t case_index, const CaseModel& sampled) {
  const auto is_known = [&](const std::string& name) {
    return std::any_of(sampled.unknowns.begin(), sampled.unknowns.end(),
                       [&](const Unknown& unknown) { return unknown.label == name; });
  };
  std::optional<data::CommonError> scale;
  if (study.scale && study.scale->unknown && !is_known(study.scale->unknown->parameter.name)) {
    const data::Parameter& parameter = study.scale->unknown->parameter;
    const ScaledPrior prior(parameter, parameter.prior);
    scale = {.output = 0, .spread = {.relative = prior.value_sd() / prior.value_mean()}, .apart = true};
    study.scale = {.value = prior.value_mean(), .unknown = {}};
  }
  for (const std::string& name : study.cases[case_index].observe) {
    data::ObservationSet& set = study.observations[study.observation_index(name).value()];
    for (data::CommonError& error : set.common_errors) {
      data::ObservationSet alone = set;
      alone.common_errors = {error};
      for (const data::Nuisance& unknown : set_unknowns(study, alone))
        if ((unknown.kind == data::NuisanceKind::gain || unknown.kind == data::NuisanceKind::offset) &&
            !is_known(unknown.parameter.name))
          error.apart = true;
    }
    if (!scale || !set.of_machine) continue;
    const auto stated = std::find_if(set.common_errors.begin(), set.common_errors.end(),
                                     [](const data::CommonError& error) { return error.output == 0; });
    if (stated == set.common_errors.end())
      set.common_errors.push_back(*scale);
    else
      stated->spread.relative = std::hypot(stated->spread.relative, scale->spread.relative);
  }
  return study;
}

}  // namespace

void condense(data::ObservationSet& set, const data::CalibrationCase& wanted) {
  const bool unknown_sd = std::any_of(wanted.nuisances.begin(), wanted.nuisances.end(), [](const data::Nuisance& one) {
    return one.kind == data::NuisanceKind::noise_sd;
  });
  std::map<std::vector<double>, std::vector<const data::Observation*>> at;
  std::vector<data::Observation> points;
  if (unknown_sd)
    points = set.points;
  else
    for (const data::Observation& point : set.points) at[point.controls].push_back(&point);
  for (const auto& [controls, same] : at) {
    data::Observation one = *same.front();
    for (std::size_t c = 0; c < one.values.size(); ++c) {
      double weight = 0.0, sum = 0.0;
      for (const auto* point : same) {
        if (!point->has(c)) continue;
        const double w = 1.0 / std::pow(point->standard_errors[c], 2);
        weight += w;
        sum += w * point->values[c];
      }
      one.values[c] = sum / weight;  // NaN where none of them measures it
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
  CaseModel model = build_case(without_new_unknowns(wider, case_index, sampled), emulators, case_index);
  model.unknowns = sampled.unknowns;
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
  ReadingLaw law{all.mean(wanted), all.covariance(wanted, wanted), all.noise(wanted),
                 linked_among(all.linked_errors, wanted)};
  if (measured.empty()) return law;
  const Eigen::MatrixXd total = all.total();
  const Eigen::MatrixXd among = total(measured, measured);
  const Eigen::LLT<Eigen::MatrixXd> factor(among);
  if (factor.info() != Eigen::Success) return law;
  const Eigen::MatrixXd between = total(measured, wanted);
  law.mean += between.transpose() * factor.solve(observed(measured) - all.mean(measured));
  law.shared -= between.transpose() * factor.solve(between);
  return law;
}

}  // namespace uq
