#include "uq/plan/unmeasured.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "data/error.hpp"
#include "uq/posterior/case_model.hpp"

namespace uq::plan {
namespace {

/// The middle of the runs in every control, SI.
std::vector<double> middle_of_runs(const data::Study& study, const Emulator& emulator) {
  std::vector<double> controls;
  for (std::size_t c = 0; c < study.controls.size(); ++c) {
    const auto covered = emulator.control_range.find(c);
    data::Axis axis = study.controls[c].axis();
    if (covered != emulator.control_range.end()) std::tie(axis.low, axis.high) = covered->second;
    controls.push_back(axis.low < axis.high ? axis.from_unit(0.5) : axis.low);
  }
  return controls;
}

/// The surrogate's mean there, parameters in the middle of their ranges, SI.
double mean_at(const data::Study& study, const Emulator& emulator, const std::vector<double>& controls) {
  Eigen::MatrixXd point(1, static_cast<Eigen::Index>(emulator.inputs.size()));
  for (std::size_t k = 0; k < emulator.inputs.size(); ++k) {
    const EmulatorInput& input = emulator.inputs[k];
    point(0, static_cast<Eigen::Index>(k)) =
        input.kind == InputKind::parameter ? 0.5 : study.controls[input.index].axis().to_unit(controls[input.index]);
  }
  return emulator.predict(point).mean[0];
}

/// Gives a case that observes nothing one reading of the first output in the middle of the runs.
void assume_reading(data::Study& study, const std::vector<Emulator>& emulators, data::CalibrationCase& item) {
  constexpr std::size_t output = 0;
  const auto emulator = std::find_if(emulators.begin(), emulators.end(), [&](const Emulator& one) {
    return one.material == item.material && one.output == output;
  });
  if (emulator == emulators.end())
    throw data::InputError(data::ExitStatus::bad_data,
                           {item.place,
                            fmt::format("case '{}' is of material '{}', of which there are no runs with {}", item.name,
                                        item.material, study.outputs.at(output).name),
                            "simulate that material first"});
  const std::vector<double> controls = middle_of_runs(study, *emulator);
  data::ObservationSet set{.name = fmt::format("(nothing measured of {})", item.name),
                           .material = item.material,
                           .outputs = {output},
                           .assumed = true,
                           .place = item.place};
  for (std::size_t c = 0; c < study.controls.size(); ++c)
    if (study.controls[c].uncertainty) {
      set.setting_errors.push_back(*study.controls[c].uncertainty);
      set.setting_errors.back().control = c;
      // A reading that is not made has no unknown of its own.
      if (data::SettingErrorAs& as = set.setting_errors.back().as; as == data::SettingErrorAs::unknown)
        as = data::SettingErrorAs::covariance;
    }
  set.points.push_back(
      {.controls = controls, .values = {mean_at(study, *emulator, controls)}, .standard_errors = {1.0}});
  item.observe.push_back(set.name);
  study.observations.push_back(std::move(set));
}

}  // namespace

data::Study with_cases(const data::Study& study) {
  data::Study wider = study;
  if (!study.cases.empty()) return wider;
  for (const data::Material& material : study.materials) {
    data::CalibrationCase one{
        .name = material.name.empty() ? study.name : material.name, .material = material.name, .place = study.file};
    for (const data::Parameter& parameter : study.parameters)
      if (!material.fixed.contains(parameter.name)) one.free.push_back(parameter.name);
    if (!one.free.empty()) wider.cases.push_back(std::move(one));
  }
  return wider;
}

SampledCase unmeasured_case(data::Study& study, const std::vector<Emulator>& emulators, std::size_t case_index) {
  for (data::CalibrationCase& one : study.cases)  // all, since another case's prior can be this one's
    if (one.observe.empty()) assume_reading(study, emulators, one);
  return {.model = std::make_shared<const CaseModel>(build_case(study, emulators, case_index)), .draws = {}};
}

}  // namespace uq::plan
