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

#include "data/observations.hpp"
#include "uq/posterior/more_data.hpp"
#include "uq/posterior/posterior.hpp"

namespace uq::plan {
namespace {

using data::Study;
using Eigen::Index;

bool has_unknown_setting(const data::ObservationSet& set) {
  return std::any_of(set.setting_errors.begin(), set.setting_errors.end(),
                     [](const data::SettingError& error) { return error.as == data::SettingErrorAs::unknown; });
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
      one.read_with = whole.name;
      one.outputs = {whole.outputs[column]};
      one.points.clear();
      for (const std::size_t point : data::points_with(whole, column)) {
        one.points.push_back(whole.points[point]);
        one.points.back().values = {whole.points[point].values[column]};
        one.points.back().standard_errors = {whole.points[point].standard_errors[column]};
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

/// The set at whose settings a candidate is read: the case's own that takes one of its outputs, else a new one.
std::string read_with_of(const Study& study, const std::vector<std::size_t>& sets, const Candidate& candidate,
                         std::string otherwise) {
  for (const std::size_t output : candidate.outputs)
    if (const auto host = host_of(study, sets, candidate, output)) {
      const data::ObservationSet& set = study.observations[*host];
      return set.read_with.empty() ? set.name : set.read_with;
    }
  return otherwise;
}

/// A set that reads an output with the meter a candidate has when it names none: one of the case and the material
/// before others of the case, and these before all others.
const data::ObservationSet* usual_reading(const Study& study, std::size_t case_index, const std::string& material,
                                          std::size_t output) {
  const std::vector<std::size_t> own = own_sets(study, case_index);
  const data::ObservationSet* found = nullptr;
  int best = 0;
  for (std::size_t i = 0; i < study.observations.size(); ++i) {
    const data::ObservationSet& set = study.observations[i];
    if (!set.column_of(output)) continue;
    const bool of_case = std::find(own.begin(), own.end(), i) != own.end();
    const int rank = 1 + (of_case ? 2 : 0) + (set.material == material ? 1 : 0);
    if (rank <= best) continue;
    best = rank;
    found = &set;
  }
  return found;
}

/// How well the settings of further readings of a material are known: as those of the case's own, or as the study says
/// of its controls. A new reading is set anew, so no error of it is one of the case's unknowns.
std::vector<data::SettingError> setting_errors_of(const Study& study, std::size_t case_index,
                                                  const std::string& material) {
  std::vector<data::SettingError> errors;
  for (std::size_t c = 0; c < study.controls.size(); ++c)
    if (study.controls[c].uncertainty) {
      errors.push_back(*study.controls[c].uncertainty);
      errors.back().control = c;
    }
  for (const std::size_t own : own_sets(study, case_index))
    if (const data::ObservationSet& known = study.observations[own]; known.material == material && !known.assumed)
      errors = known.setting_errors;
  for (data::SettingError& error : errors)
    if (error.as == data::SettingErrorAs::unknown) error.as = data::SettingErrorAs::covariance;
  return errors;
}

/// A set for readings of `output` that no set of the case has a place for: of the candidate's meter, or of the one that
/// has read the output.
data::ObservationSet new_set(const Study& study, std::size_t case_index, const Candidate& candidate, std::size_t output,
                             std::string name) {
  data::ObservationSet set{.name = std::move(name), .material = candidate.material, .outputs = {output}};
  set.setting_errors = setting_errors_of(study, case_index, candidate.material);
  for (const std::size_t own : own_sets(study, case_index))
    if (study.observations[own].material == candidate.material)
      set.of_machine = study.observations[own].of_machine && output == 0;
  const auto take_errors = [&](const data::ObservationSet& read) {
    std::copy_if(read.common_errors.begin(), read.common_errors.end(), std::back_inserter(set.common_errors),
                 [&](const data::CommonError& error) { return error.output == output; });
  };
  if (candidate.common_error) {
    set.common_errors = {{output, *candidate.common_error}};
  } else if (!candidate.meter.empty()) {
    set.meter = candidate.meter;
    for (const data::ObservationSet& read : study.observations)
      if (read.meter == candidate.meter && set.common_errors.empty()) take_errors(read);
  } else if (const data::ObservationSet* const read = usual_reading(study, case_index, candidate.material, output)) {
    set.meter = read->meter;
    take_errors(*read);
  }
  return set;
}

/// Where a planned point belongs: an index into the candidates, and one into the candidate's outputs.
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
    const std::string read_with = read_with_of(wider, sets, candidate, fmt::format("planned {}", i));
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
        wider.observations.back().read_with = read_with;
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

/// Whether the readings have an unknown sd in the place of standard errors.
bool has_unknown_sd(const Measurement& measurement, Index row) {
  return std::any_of(measurement.sets.begin(), measurement.sets.end(), [row](const ReadSet& set) {
    return set.noise_is_sd && row >= set.first && row < set.first + set.count;
  });
}

/// A discrepancy is a share of what is read. Of outputs that the case has not read that is the model's prediction.
void scale_new_discrepancies(CaseModel& model, const CaseModel& sampled, const Eigen::VectorXd& prediction) {
  Index first = 0;
  for (RowGroup& group : model.groups) {
    const bool read = std::any_of(sampled.groups.begin(), sampled.groups.end(), [&](const RowGroup& other) {
      return other.emulator.material == group.emulator.material && other.emulator.output == group.emulator.output;
    });
    if (!read)
      for (DiscrepancyRows& part : group.measurement.discrepancies)
        part.magnitude = std::sqrt(prediction.segment(first + part.first, part.count).array().square().mean());
    first += group.observed.size();
  }
}

}  // namespace

Eigen::VectorXd ExtendedCase::noise_at(const Eigen::VectorXd& mean, const Eigen::VectorXd& noise) const {
  Eigen::VectorXd scaled = noise;
  for (Index i = 0; i < noise.size(); ++i) {
    const auto variance = [&](double m) { return std::pow(absolute[i], 2) + std::pow(relative[i] * m, 2); };
    if (sd_unknown[i] > 0.0)
      scaled[i] = noise[i] / sd_unknown[i];
    else if (sd_replaced[i] > 0.0)
      scaled[i] = std::max(variance(mean[i]), 1e-300) / sd_replaced[i];
    else if (relative[i] > 0.0 && variance(reference[i]) > 0.0)
      scaled[i] *= std::max(variance(mean[i]) / variance(reference[i]), 1e-12);
  }
  return scaled;
}

ExtendedCase extend(const Study& study, const std::vector<Emulator>& emulators, std::size_t case_index,
                    const CaseModel& sampled, const std::vector<Candidate>& candidates, const Eigen::VectorXd& u) {
  Study wider = study;
  for (data::ObservationSet& set : wider.observations) condense(set, study.cases[case_index]);
  const Homes homes = add_planned(wider, study, case_index, candidates);
  ExtendedCase found{.model = with_more_data(wider, emulators, case_index, sampled), .measured = {}, .planned = {}};
  CaseModel& model = found.model;
  const StackedPrediction prediction = predict(model, u);
  found.planned.resize(candidates.size());
  found.absolute = found.relative = Eigen::VectorXd::Zero(prediction.mean.size());
  found.sd_unknown = found.sd_replaced = found.absolute;
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
      if (has_unknown_sd(group.measurement, static_cast<Index>(r)))
        (candidate.stated_error ? found.sd_replaced : found.sd_unknown)[row] = candidate.readings;
      found.planned[planned->second.candidate].push_back(row);
    }
  scale_new_discrepancies(model, sampled, prediction.mean);
  // A planned reading is one of its own: nothing says that its error goes with another's.
  const auto is_measured = [&](Index at) {
    return std::binary_search(found.measured.begin(), found.measured.end(), at);
  };
  std::erase_if(model.linked_errors,
                [&](const LinkedErrors& pair) { return !is_measured(pair.first) || !is_measured(pair.second); });
  return found;
}

}  // namespace uq::plan
