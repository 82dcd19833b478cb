#include "uq/posterior/case_checks.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "data/atomic_file.hpp"
#include "uq/posterior/control_reach.hpp"
#include "uq/posterior/distinct.hpp"

namespace uq {
namespace {

using data::Problem;

bool is_varied(const Emulator& emulator, std::size_t control) {
  return std::any_of(emulator.inputs.begin(), emulator.inputs.end(), [&](const EmulatorInput& input) {
    return input.kind == InputKind::control && input.index == control;
  });
}

/// A case and one of its sets beside the runs of the set's material.
class BesideRuns {
 public:
  BesideRuns(const data::Study& study, const data::CalibrationCase& item, const data::ObservationSet& set,
             const Emulator& emulator)
      : study_(study), item_(item), set_(set), emulator_(emulator) {}

  std::vector<Problem> problems() {
    for (const EmulatorInput& input : emulator_.inputs)
      if (input.kind == InputKind::control) check_reach(input.index);
    for (const auto& [parameter, constant] : emulator_.constants)
      check_constant(study_.parameters[parameter], constant);
    for (const auto& [control, range] : emulator_.control_range)
      if (!is_varied(emulator_, control)) check_constant_control(control, range.first);
    return std::move(problems_);
  }

 private:
  void problem(const std::string& place, std::string what, std::string remedy) {
    problems_.push_back({place, std::move(what), std::move(remedy)});
  }

  void check_reach(std::size_t index) {
    const data::Control& control = study_.controls[index];
    const auto range = emulator_.control_range.find(index);
    const auto [low, high] =
        range == emulator_.control_range.end() ? std::pair{control.low, control.high} : range->second;
    for (const data::Observation& point : set_.points) {
      const double value = point.controls[index];
      if (within_reach(control, value, {low, high})) continue;
      problem(
          fmt::format("{}:{}", data::shown_path(set_.file), point.line),
          fmt::format("{} is {:g}{}, but the runs of this material reach from {:g} to {:g}{}", control.name,
                      control.unit.from_si(value), data::behind_number(control.unit.symbol), control.unit.from_si(low),
                      control.unit.from_si(high), data::behind_number(control.unit.symbol)),
          "leave the point out, or make runs there (of ours: demcal train STUDY --until posterior)");
    }
  }

  /// A parameter that the material's runs hold at one value cannot be fixed at another, by the case or the material,
  /// nor be free where another material's runs vary it.
  void check_constant(const data::Parameter& parameter, double constant) {
    const auto value = [&](double si) {
      return fmt::format("{:g}{}", parameter.unit.from_si(si), data::behind_number(parameter.unit.symbol));
    };
    const data::Material& material = study_.material(set_.material);
    const auto in_material = material.fixed.find(parameter.name);
    const auto fixed = item_.fixed.find(parameter.name);
    const bool by_case = fixed != item_.fixed.end(), by_material = in_material != material.fixed.end();
    if (!by_case && !by_material) {
      if (study_.materials.size() > 1 &&
          std::find(item_.free.begin(), item_.free.end(), parameter.name) != item_.free.end())
        problem(
            item_.place,
            fmt::format("case '{}' frees {}, but every run of material '{}' has {}: its data would not count for it",
                        item_.name, parameter.name, set_.material, value(constant)),
            fmt::format("vary it in training, or write materials.{}.fixed.{} = ...", set_.material, parameter.name));
      return;
    }
    const double wanted = by_case ? fixed->second : in_material->second;
    if (std::abs(wanted - constant) <= 1e-6 * (parameter.high - parameter.low)) return;
    if (by_case)
      problem(item_.place,
              fmt::format("case '{}' fixes {} at {}, but every run of material '{}' has {}", item_.name, parameter.name,
                          value(wanted), set_.material, value(constant)),
              "fix it at that value, or vary it in training");
    else
      problem(material.place,
              fmt::format("material '{}' fixes {} at {}, but every run of it has {}", set_.material, parameter.name,
                          value(wanted), value(constant)),
              "fix it at that value, or make the runs again");
  }

  /// A control that the material's runs hold at one value must be measured there: the runs know no other.
  void check_constant_control(std::size_t index, double constant) {
    const data::Control& control = study_.controls[index];
    constexpr double share = 0.02;  // of the value or the range: a speed is never set exactly
    const double slack = share * std::max(control.high - control.low, std::abs(constant));
    std::vector<int> lines;
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const data::Observation& point : set_.points) {
      if (std::abs(point.controls[index] - constant) <= slack) continue;
      lines.push_back(point.line);
      low = std::min(low, point.controls[index]);
      high = std::max(high, point.controls[index]);
    }
    if (lines.empty()) return;
    problem(fmt::format("{}:{}", data::shown_path(set_.file), lines.front()),
            fmt::format(
                "{} of {} points are measured at {} from {:g} to {:g}{}, but every run of this material has {:g}{}: "
                "the runs say nothing of another {}",
                lines.size(), set_.points.size(), control.name, control.unit.from_si(low), control.unit.from_si(high),
                data::behind_number(control.unit.symbol), control.unit.from_si(constant),
                data::behind_number(control.unit.symbol), control.name),
            "leave the points out, or add runs at other values");
  }

  const data::Study& study_;
  const data::CalibrationCase& item_;
  const data::ObservationSet& set_;
  const Emulator& emulator_;
  std::vector<Problem> problems_;
};

}  // namespace

namespace {

/// Equal numbers, and nothing measured in the same places.
bool is_same(const std::vector<double>& a, const std::vector<double>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](double x, double y) { return x == y || (std::isnan(x) && std::isnan(y)); });
}

}  // namespace

bool hold_the_same(const data::ObservationSet& a, const data::ObservationSet& b) {
  if (a.assumed || b.assumed) return false;
  if (std::none_of(a.outputs.begin(), a.outputs.end(),
                   [&](std::size_t output) { return b.column_of(output).has_value(); }))
    return false;
  const bool one_file = !a.file.empty() && a.file == b.file;
  std::size_t common = 0;
  for (const data::Observation& point : b.points)
    common += std::any_of(a.points.begin(), a.points.end(), [&](const data::Observation& other) {
      return (one_file || other.controls == point.controls) && is_same(other.values, point.values) &&
             is_same(other.standard_errors, point.standard_errors);
    });
  return common > 0 && 2 * common >= std::min(a.points.size(), b.points.size());
}

std::vector<Problem> against_the_runs(const data::Study& study, const data::CalibrationCase& item,
                                      const data::ObservationSet& set, const Emulator& emulator) {
  return BesideRuns(study, item, set, emulator).problems();
}

void refuse_too_many_settings(const data::Study& study, const CaseModel& model) {
  for (const RowGroup& group : distinct_rows(model).groups) {
    if (group.base.rows() <= settings_max) continue;
    const data::ObservationSet& set = study.observations[group.origin.front().set];
    throw data::InputError(
        data::ExitStatus::bad_data,
        {set.file,
         fmt::format("case '{}' has measurements of {} at {} different settings; above {} a calibration takes hours",
                     model.name, study.outputs[group.emulator.output].name, group.base.rows(), settings_max),
         "average them to a row per setting with its standard error (demcal observe), or round the settings: rows at "
         "exactly the same settings count as one"});
  }
}

}  // namespace uq
