#include "uq/posterior/set_unknowns.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace uq {
namespace {

constexpr double reach = 6.0;  // standard deviations of a meter's error on either side
constexpr double least_gain = 1e-3;

data::Nuisance meter_unknown(data::NuisanceKind kind, const data::ObservationSet& set, std::size_t output,
                             data::Parameter parameter, double mean, double sd) {
  parameter.target = parameter.name;
  parameter.low = mean - reach * sd;
  if (kind == data::NuisanceKind::gain) parameter.low = std::max(parameter.low, least_gain);
  parameter.high = mean + reach * sd;
  parameter.place = set.place;
  parameter.prior = {.kind = data::PriorKind::normal,
                     .low = parameter.low,
                     .high = parameter.high,
                     .mean = mean,
                     .sd = sd,
                     .place = set.place};
  return {kind, output, parameter};
}

void add_meter(const data::Study& study, const data::ObservationSet& set, std::vector<data::Nuisance>& found) {
  if (set.meter.empty()) return;
  for (const data::CommonError& error : set.common_errors) {
    if (error.apart) continue;
    const data::Output& output = study.outputs[error.output];
    const auto name = [&](const char* what) { return fmt::format("{}_{}_{}", set.meter, output.name, what); };
    if (error.spread.relative > 0.0)
      found.push_back(meter_unknown(data::NuisanceKind::gain, set, error.output, {.name = name("gain")}, 1.0,
                                    error.spread.relative));
    if (error.spread.absolute > 0.0)
      found.push_back(meter_unknown(data::NuisanceKind::offset, set, error.output,
                                    {.name = name("offset"), .unit = output.unit.differences()}, 0.0,
                                    error.spread.absolute));
  }
}

}  // namespace

data::Nuisance setting_unknown(const data::Study& study, const data::ObservationSet& set,
                               const data::SettingError& error) {
  const data::Control& control = study.controls[error.control];
  const double stated = set.points.front().controls[error.control];
  data::Parameter parameter{.name = set.name + "_" + control.name,
                            .target = control.target,
                            .unit = control.unit,
                            .low = control.low,
                            .high = control.high,
                            .scale = control.scale,
                            .place = error.place};
  const double sd = std::hypot(error.spread.absolute, error.spread.relative * stated);
  constexpr double all_of_it = 8.0;  // sds: what the control's range cuts off of it is known by that
  parameter.prior = {.kind = data::PriorKind::normal,
                     .low = std::min(control.low, stated - all_of_it * sd),
                     .high = std::max(control.high, stated + all_of_it * sd),
                     .mean = stated,
                     .sd = sd,
                     .place = error.place};
  return {data::NuisanceKind::setting, {}, parameter};
}

std::vector<data::Nuisance> set_unknowns(const data::Study& study, const data::ObservationSet& set) {
  std::vector<data::Nuisance> found;
  if (set.of_machine && study.scale && study.scale->unknown) found.push_back(*study.scale->unknown);
  add_meter(study, set, found);
  for (const data::SettingError& error : set.setting_errors)
    if (error.as == data::SettingErrorAs::unknown && !set.points.empty())
      found.push_back(setting_unknown(study, set, error));
  return found;
}

}  // namespace uq
