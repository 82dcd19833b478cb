#include "uq/posterior/build_measurement.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace uq {
namespace {

/// Column of a control among the emulator's inputs; none: the runs do not vary it.
std::optional<int> column_of(const Emulator& emulator, std::size_t control) {
  const auto found = std::find_if(
      emulator.inputs.begin(), emulator.inputs.end(),
      [control](const EmulatorInput& input) { return input.kind == InputKind::control && input.index == control; });
  if (found == emulator.inputs.end()) return {};
  return static_cast<int>(found - emulator.inputs.begin());
}

/// A control's error as a covariance: common to the rows at one value of it, or to all rows where it is said to be.
SettingShift shift_of(const data::Control& control, const SetRows& of, const data::SettingError& error, int column) {
  const auto rows = static_cast<Eigen::Index>(of.points.size());
  SettingShift shift{
      .control = error.control, .column = column, .error = Eigen::VectorXd(rows), .level = Eigen::VectorXd::Zero(rows)};
  for (Eigen::Index i = 0; i < rows; ++i) {
    const double value = of.set.points[of.points[i]].controls[error.control];
    const data::Axis axis = control.axis();
    shift.error[i] = std::hypot(error.spread.absolute, error.spread.relative * value) / axis.slope(axis.to_unit(value));
    if (error.as != data::SettingErrorAs::shared) shift.level[i] = value;
  }
  return shift;
}

/// Unknowns of a discrepancy process; -1: none.
struct DiscrepancyUnknowns {
  int sd = -1, length = -1;
};

/// The case's discrepancy over the rows just added, one process with the case's other rows of the group.
void add_discrepancy(RowGroup& group, const data::Study& study, const SetRows& rows,
                     const DiscrepancyUnknowns& unknowns) {
  auto& all = group.measurement.discrepancies;
  if (all.empty() || all.back().sd != unknowns.sd)
    all.push_back({.first = rows.first, .sd = unknowns.sd, .length = unknowns.length, .controls = {}});
  DiscrepancyRows& part = all.back();
  const Eigen::Index count = group.base.rows() - rows.first;
  part.controls.conservativeResize(part.count + count, static_cast<Eigen::Index>(study.controls.size()));
  for (Eigen::Index i = 0; i < count; ++i)
    for (std::size_t c = 0; c < study.controls.size(); ++c)
      part.controls(part.count + i, static_cast<Eigen::Index>(c)) =
          study.controls[c].axis().to_unit(rows.set.points[rows.points[i]].controls[c]);
  part.count += count;
}

bool is_plain(const ReadSet& read) {
  return read.factor == 1.0 && read.factors.empty() && read.offsets.empty() && read.noise < 0 &&
         read.common_absolute == 0.0 && read.common_relative == 0.0 && read.settings.empty();
}

}  // namespace

std::vector<data::Problem> add_measurement(RowGroup& group, const data::Study& study, const SetRows& rows,
                                           const std::vector<Acting>& unknowns) {
  const data::ObservationSet& set = rows.set;
  ReadSet read{
      .first = rows.first, .count = group.base.rows() - rows.first, .factors = {}, .offsets = {}, .settings = {}};
  if (set.of_machine && study.scale && !study.scale->unknown) read.factor = study.scale->value;
  DiscrepancyUnknowns discrepancy;
  for (const auto& [nuisance, unknown] : unknowns) {
    if (nuisance.output.value_or(rows.output) != rows.output) continue;
    switch (nuisance.kind) {
      case data::NuisanceKind::offset:
        read.offsets.push_back(unknown);
        break;
      case data::NuisanceKind::gain:
      case data::NuisanceKind::scale:
        read.factors.push_back(unknown);
        break;
      case data::NuisanceKind::noise_scale:
      case data::NuisanceKind::noise_sd:
        read.noise = unknown;
        read.noise_is_sd = nuisance.kind == data::NuisanceKind::noise_sd;
        break;
      case data::NuisanceKind::discrepancy_sd:
        discrepancy.sd = unknown;
        break;
      case data::NuisanceKind::discrepancy_length:
        discrepancy.length = unknown;
        break;
      case data::NuisanceKind::setting:
        break;  // moves the row itself
    }
  }
  for (const auto& error : set.common_errors)
    if (error.output == rows.output && (set.meter.empty() || error.apart)) {
      read.common_absolute = error.spread.absolute;
      read.common_relative = error.spread.relative;
    }
  std::vector<data::Problem> problems;
  for (const auto& error : set.setting_errors) {
    const data::Control& control = study.controls[error.control];
    const std::optional<int> column = column_of(group.emulator, error.control);
    if (!column)
      problems.push_back({error.place,
                          fmt::format("the runs of material '{}' do not vary {}, so its uncertainty's effect is not "
                                      "known",
                                      set.material, control.name),
                          fmt::format("vary it in training, or state its effect as common_error of '{}'", set.name)});
    else if (error.as != data::SettingErrorAs::unknown)
      read.settings.push_back(shift_of(control, rows, error, *column));
  }
  if (!is_plain(read)) group.measurement.sets.push_back(read);
  if (discrepancy.sd >= 0) add_discrepancy(group, study, rows, discrepancy);
  return problems;
}

}  // namespace uq
