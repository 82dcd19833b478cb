#include "uq/plan/extended_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>

#include "uq/posterior/more_data.hpp"
#include "uq/posterior/posterior.hpp"

namespace uq::plan {
namespace {

using data::Study;
using Eigen::Index;

bool has_unknown_setting(const data::ObservationSet& set) {
  return std::any_of(set.setting_errors.begin(), set.setting_errors.end(),
                     [](const data::SettingError& error) { return error.unknown; });
}

/// The case's own sets, those of several outputs as one of each output: the model is the same, and a reading of one
/// output can be added. A set whose setting is an unknown stays whole, since the unknown bears its name.
std::vector<std::size_t> sets_of_one_output(Study& study, std::size_t case_index) {
  std::vector<std::size_t> sets = own_sets(study, case_index);
  for (std::size_t i = 0, own = sets.size(); i < own; ++i) {
    const data::ObservationSet whole = study.observations[sets[i]];
    if (has_unknown_setting(whole)) continue;
    for (std::size_t column = 0; column < whole.outputs.size(); ++column) {
      data::ObservationSet one = whole;
      one.outputs = {whole.outputs[column]};
      for (data::Observation& point : one.points) {
        point.values = {point.values[column]};
        point.standard_errors = {point.standard_errors[column]};
      }
      if (column == 0) {
        study.observations[sets[i]] = std::move(one);
        continue;
      }
      one.name += " " + study.outputs[whole.outputs[column]].name;
      study.cases[case_index].observe.push_back(one.name);
      sets.push_back(study.observations.size());
      study.observations.push_back(std::move(one));
    }
  }
  return sets;
}

/// A set of the case that reads this output alone with the candidate's meter, so that its errors are shared.
std::optional<std::size_t> host_of(const Study& study, const std::vector<std::size_t>& sets, const Candidate& candidate,
                                   std::size_t output) {
  if (candidate.common_error) return {};
  for (const std::size_t index : sets) {
    const data::ObservationSet& set = study.observations[index];
    if (set.material == candidate.material && set.outputs == std::vector{output} && !has_unknown_setting(set) &&
        (candidate.meter.empty() || candidate.meter == set.meter))
      return index;
  }
  return {};
}

/// A set for readings of `output` that no set of the case has a place for: of the candidate's meter, or of the one that the
/// case reads the material with.
data::ObservationSet new_set(const Study& study, std::size_t case_index, const Candidate& candidate, std::size_t output,
                             std::string name) {
  data::ObservationSet set{.name = std::move(name), .material = candidate.material, .outputs = {output}};
  const bool meter_of_case = !candidate.common_error && candidate.meter.empty();
  for (const std::size_t own : own_sets(study, case_index)) {
    const data::ObservationSet& known = study.observations[own];
    if (known.material != candidate.material) continue;
    set.of_machine = known.of_machine && output == 0;
    if (!meter_of_case) continue;
    set.meter = known.meter;
    set.common_errors = known.common_errors;
  }
  if (candidate.common_error) {
    set.common_errors = {{output, *candidate.common_error}};
  } else if (!candidate.meter.empty()) {
    set.meter = candidate.meter;
    for (const data::ObservationSet& read : study.observations)
      if (read.meter == candidate.meter && set.common_errors.empty())
        std::copy_if(read.common_errors.begin(), read.common_errors.end(), std::back_inserter(set.common_errors),
                     [&](const data::CommonError& error) { return error.output == output; });
  }
  return set;
}

/// Of a planned point: an index into the candidates, and one into the candidate's outputs.
struct Home {
  std::size_t candidate = 0, column = 0;
};
using Homes = std::map<std::pair<std::size_t, std::size_t>, Home>;  ///< by set and point

/// Adds the candidates' points to the sets that read the same with the same meter, and to new ones.
Homes add_planned(Study& wider, const Study& study, std::size_t case_index, const std::vector<Candidate>& candidates) {
  const std::vector<std::size_t> sets = sets_of_one_output(wider, case_index);
  Homes homes;
  std::map<std::tuple<std::string, std::string, std::size_t>, std::size_t> of_new_meter;  // by meter and what it reads
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const Candidate& candidate = candidates[i];
    for (std::size_t column = 0; column < candidate.outputs.size(); ++column) {
      const std::size_t output = candidate.outputs[column];
      std::size_t index = 0;
      const std::tuple reads{candidate.meter, candidate.material, output};
      if (const auto host = host_of(wider, sets, candidate, output)) {
        index = *host;
      } else if (const auto same = of_new_meter.find(reads); !candidate.meter.empty() && same != of_new_meter.end()) {
        index = same->second;
      } else {
        index = wider.observations.size();
        if (!candidate.meter.empty()) of_new_meter[reads] = index;
        wider.observations.push_back(
            new_set(study, case_index, candidate, output, fmt::format("planned {}.{}", i, column)));
        wider.cases[case_index].observe.push_back(wider.observations.back().name);
      }
      data::ObservationSet& set = wider.observations[index];
      for (const auto& controls : candidate.settings) {
        homes[{index, set.points.size()}] = {i, column};
        // Any value, but never that of a measured row.
        set.points.push_back(
            {.controls = controls, .values = {1.0 + static_cast<double>(homes.size())}, .standard_errors = {1.0}});
      }
    }
  }
  return homes;
}

}  // namespace

Eigen::VectorXd ExtendedCase::noise_at(const Eigen::VectorXd& mean, const Eigen::VectorXd& noise) const {
  Eigen::VectorXd scaled = noise;
  for (Index i = 0; i < noise.size(); ++i) {
    const auto variance = [&](double m) { return std::pow(absolute[i], 2) + std::pow(relative[i] * m, 2); };
    if (relative[i] > 0.0 && variance(reference[i]) > 0.0)
      scaled[i] *= std::max(variance(mean[i]) / variance(reference[i]), 1e-12);
  }
  return scaled;
}

ExtendedCase extend(const Study& study, const std::vector<Emulator>& emulators, std::size_t case_index,
                    const CaseModel& sampled, const std::vector<Candidate>& candidates, const Eigen::VectorXd& u) {
  Study wider = study;
  for (data::ObservationSet& set : wider.observations) condense(set);
  const Homes homes = add_planned(wider, study, case_index, candidates);
  ExtendedCase found{.model = with_more_data(wider, emulators, case_index, sampled), .measured = {}, .planned = {}};
  CaseModel& model = found.model;
  const StackedPrediction prediction = predict(model, u);
  found.planned.resize(candidates.size());
  found.absolute = found.relative = Eigen::VectorXd::Zero(prediction.mean.size());
  found.reference = prediction.mean;
  Index row = 0;
  for (RowGroup& group : model.groups)
    for (std::size_t r = 0; r < group.origin.size(); ++r, ++row) {
      const auto planned = homes.find({group.origin[r].set, group.origin[r].point});
      if (planned == homes.end()) {
        found.measured.push_back(row);
        continue;
      }
      const Candidate& candidate = candidates[planned->second.candidate];
      const data::Spread& error = candidate.error[planned->second.column];
      const double sd = std::hypot(error.absolute, error.relative * prediction.mean[row]);
      found.absolute[row] = error.absolute;
      found.relative[row] = error.relative;
      group.variance[r] = std::max(sd * sd, 1e-300) / candidate.readings;
      found.planned[planned->second.candidate].push_back(row);
    }
  // A planned reading is one of its own: nothing says that its error goes with another's.
  const auto is_measured = [&](Index at) {
    return std::binary_search(found.measured.begin(), found.measured.end(), at);
  };
  std::erase_if(model.linked_errors,
                [&](const LinkedErrors& pair) { return !is_measured(pair.first) || !is_measured(pair.second); });
  return found;
}

}  // namespace uq::plan
