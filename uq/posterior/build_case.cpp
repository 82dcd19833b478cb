#include "uq/posterior/case_model.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "data/atomic_file.hpp"
#include "data/error.hpp"
#include "uq/posterior/build_measurement.hpp"
#include "uq/posterior/control_reach.hpp"
#include "uq/posterior/distinct.hpp"
#include "uq/posterior/linked_cases.hpp"
#include "uq/posterior/set_unknowns.hpp"

namespace uq {
namespace {

using data::CalibrationCase;
using data::ExitStatus;
using data::Problem;
using data::Study;

Acts acts_of(data::NuisanceKind kind) {
  using data::NuisanceKind;
  const bool mean = kind == NuisanceKind::offset || kind == NuisanceKind::gain || kind == NuisanceKind::scale ||
                    kind == NuisanceKind::setting;
  return mean ? Acts::on_mean : Acts::on_spread;
}

/// Whether half of the shorter set's readings stand in the other to the last digit: at the same controls, or, in one
/// file, at whatever controls the study gives them.
bool holds_the_same(const data::ObservationSet& a, const data::ObservationSet& b) {
  if (a.assumed || b.assumed) return false;
  if (std::none_of(a.outputs.begin(), a.outputs.end(), [&](std::size_t output) {
        return std::find(b.outputs.begin(), b.outputs.end(), output) != b.outputs.end();
      }))
    return false;
  const bool one_file = !a.file.empty() && a.file == b.file;
  std::size_t common = 0;
  for (const data::Observation& point : b.points)
    common += std::any_of(a.points.begin(), a.points.end(), [&](const data::Observation& other) {
      return (one_file || other.controls == point.controls) && other.values == point.values &&
             other.standard_errors == point.standard_errors;
    });
  return common > 0 && 2 * common >= std::min(a.points.size(), b.points.size());
}

class Builder {
 public:
  Builder(const Study& study, const std::vector<Emulator>& emulators, const CalibrationCase& wanted)
      : study_(study), emulators_(emulators), wanted_(wanted), links_(study, wanted), problems_(links_.problems()) {}

  CaseModel build() {
    stop_on_problems();
    CaseModel model{.name = wanted_.name, .slots = {}, .groups = {}, .linked = {}, .observed_sets = wanted_.observe};
    for (const auto* item : links_.cases()) {
      if (item != &wanted_) model.linked.push_back(item->name);
      for (const auto& name : item->free) add_slot(model, *item, name);
      add_nuisances(model, *item);
    }
    stop_on_problems();
    for (const auto* item : links_.cases()) add_rows(model, *item);
    check_slots_used(model);
    stop_on_problems();
    for (auto& group : model.groups) {
      find_coordinates(group, model.dimension());
      for (auto& part : group.measurement.discrepancies)
        part.magnitude = std::sqrt(group.observed.segment(part.first, part.count).array().square().mean());
    }
    pool_rows(model);
    check_settings(model);
    stop_on_problems();
    return model;
  }

 private:
  void problem(const std::string& place, std::string what, std::string remedy) {
    problems_.push_back({place, std::move(what), std::move(remedy)});
  }
  void stop_on_problems() const {
    if (!problems_.empty()) throw data::InputError(ExitStatus::bad_study, problems_);
  }

  /// An unknown that is not there yet.
  void add_unknown(CaseModel& model, const Home& where, Slot slot) {
    if (std::find(homes_.begin(), homes_.end(), where) != homes_.end()) return;
    homes_.push_back(where);
    model.slots.push_back(std::move(slot));
  }

  int slot_of(const Home& where) const {
    return static_cast<int>(std::find(homes_.begin(), homes_.end(), where) - homes_.begin());
  }

  std::string label_of(const CalibrationCase& item, const std::string& name) const {
    return &item == &wanted_ ? name : item.name + ": " + name;
  }

  void add_slot(CaseModel& model, const CalibrationCase& item, const std::string& name) {
    const data::Parameter& parameter = study_.parameters[study_.parameter_index(name).value()];
    const data::Prior& prior = links_.prior_of(item, name);
    add_unknown(model, links_.home(item, name),
                {.label = label_of(item, name),
                 .prior = ScaledPrior(parameter, links_.first_prior(item, name)),
                 .own = &item == &wanted_,
                 .nuisance = Acts::none,
                 .cut_from = prior.cut ? prior.posterior_of : "",
                 .cut = {}});
  }

  void add_nuisance(CaseModel& model, const Home& where, const std::string& label, const data::Nuisance& nuisance) {
    add_unknown(model, where,
                {.label = label,
                 .prior = ScaledPrior(nuisance.parameter, nuisance.parameter.prior),
                 .own = false,
                 .nuisance = acts_of(nuisance.kind),
                 .cut_from = {},
                 .cut = {}});
  }

  void add_nuisances(CaseModel& model, const CalibrationCase& item) {
    for (const auto& nuisance : item.nuisances) {
      const std::string& name = nuisance.parameter.name;
      if (nuisance.parameter.prior.cut) {
        problem(nuisance.parameter.place, fmt::format("{} is cut from another case", name),
                "cut parameters only; give it a prior, or the posterior without cut");
        continue;
      }
      add_nuisance(model, links_.home(item, name), label_of(item, name), links_.first_nuisance(item, name));
    }
    for (const auto& set_name : item.observe) {
      const data::ObservationSet& set = study_.observations[study_.observation_index(set_name).value()];
      for (const data::Nuisance& unknown : set_unknowns(study_, set))
        add_nuisance(model, home_of(unknown), unknown.parameter.name, unknown);
    }
  }

  /// Of an unknown that a measurement has.
  static Home home_of(const data::Nuisance& unknown) { return {nullptr, unknown.parameter.name}; }

  const Emulator* find_emulator(const std::string& material, std::size_t output) const {
    for (const auto& emulator : emulators_)
      if (emulator.material == material && emulator.output == output) return &emulator;
    return nullptr;
  }

  void add_rows(CaseModel& model, const CalibrationCase& item) {
    for (const auto& set_name : item.observe) {
      const std::size_t set_index = study_.observation_index(set_name).value();
      const data::ObservationSet& set = study_.observations[set_index];
      if (!used_sets_.insert(set_index).second) {
        problem(item.place,
                fmt::format("the data of '{}' would count twice: case '{}' and a case linked with it both observe them",
                            set_name, item.name),
                "let only one of the linked cases observe them");
        continue;
      }
      for (const std::size_t other : used_sets_)
        if (other != set_index && holds_the_same(study_.observations[other], set))
          problem(item.place,
                  fmt::format("the data of '{}' would count twice: '{}' holds the same measurements", set_name,
                              study_.observations[other].name),
                  "observe one of the two");
      if (set.points.empty())
        problem(set.place.empty() ? set.file : set.place, fmt::format("the observation set '{}' has no rows", set_name),
                "measure at least one point");
      for (std::size_t column = 0; column < set.outputs.size(); ++column) {
        const Emulator* emulator = find_emulator(set.material, set.outputs[column]);
        if (emulator == nullptr) {
          problem(set.place,
                  fmt::format("'{}' measures {} of material '{}', of which there are no runs", set_name,
                              study_.outputs[set.outputs[column]].name, set.material),
                  "simulate that material, or leave the output out");
          continue;
        }
        append(model, *emulator, item, set_index, column);
      }
    }
  }

  void append(CaseModel& model, const Emulator& emulator, const CalibrationCase& item, std::size_t set_index,
              std::size_t column) {
    auto group = std::find_if(model.groups.begin(), model.groups.end(), [&](const RowGroup& other) {
      return other.emulator.material == emulator.material && other.emulator.output == emulator.output;
    });
    const auto inputs = static_cast<Eigen::Index>(emulator.inputs.size());
    if (group == model.groups.end()) {
      model.groups.push_back({.emulator = emulator,
                              .base = Eigen::MatrixXd(0, inputs),
                              .slot = Eigen::MatrixXi(0, inputs),
                              .observed = {},
                              .variance = {},
                              .origin = {},
                              .coordinate = {}});
      group = model.groups.end() - 1;
    }
    const data::ObservationSet& set = study_.observations[set_index];
    const auto rows = static_cast<Eigen::Index>(set.points.size());
    const Eigen::Index before = group->base.rows();
    group->base.conservativeResize(before + rows, inputs);
    group->slot.conservativeResize(before + rows, inputs);
    group->observed.conservativeResize(before + rows);
    group->variance.conservativeResize(before + rows);
    for (Eigen::Index k = 0; k < inputs; ++k) {
      const EmulatorInput& input = emulator.inputs[k];
      if (input.kind == InputKind::control) {
        fill_control(*group, emulator, set, before, k);
        for (const auto& error : set.setting_errors)
          if (error.unknown && error.control == input.index)
            group->slot.col(k).tail(rows).setConstant(slot_of(home_of(setting_unknown(study_, set, error))));
        continue;
      }
      const Value value = value_of(item, set, input.index);
      group->base.col(k).tail(rows).setConstant(value.scaled);
      group->slot.col(k).tail(rows).setConstant(value.slot);
    }
    for (const auto& [parameter, constant] : emulator.constants) check_constant(item, set, parameter, constant);
    for (const auto& [control, range] : emulator.control_range) check_constant_control(emulator, set, control, range);
    for (Eigen::Index i = 0; i < rows; ++i) {
      const data::Observation& point = set.points[i];
      group->observed[before + i] = point.values[column];
      group->variance[before + i] = point.standard_errors[column] * point.standard_errors[column];
      group->origin.push_back({.set = set_index, .point = static_cast<std::size_t>(i), .output = set.outputs[column]});
    }
    std::vector<Acting> unknowns;
    for (const auto& nuisance : item.nuisances)
      unknowns.push_back({nuisance, slot_of(links_.home(item, nuisance.parameter.name))});
    for (const auto& nuisance : set_unknowns(study_, set)) unknowns.push_back({nuisance, slot_of(home_of(nuisance))});
    const std::vector<Problem> unknowable =
        add_measurement(*group, study_, {set, set.outputs[column], before}, unknowns);
    problems_.insert(problems_.end(), unknowable.begin(), unknowable.end());
  }

  void fill_control(RowGroup& group, const Emulator& emulator, const data::ObservationSet& set, Eigen::Index before,
                    Eigen::Index k) {
    const std::size_t index = emulator.inputs[k].index;
    const data::Control& control = study_.controls[index];
    const auto range = emulator.control_range.find(index);
    const auto [low, high] =
        range == emulator.control_range.end() ? std::pair{control.low, control.high} : range->second;
    for (std::size_t i = 0; i < set.points.size(); ++i) {
      const double value = set.points[i].controls[index];
      if (!within_reach(control, value, {low, high}))
        problem(fmt::format("{}:{}", set.file, set.points[i].line),
                fmt::format("{} is {:g} {}, but the runs of this material reach from {:g} to {:g} {}", control.name,
                            control.unit.from_si(value), control.unit.symbol, control.unit.from_si(low),
                            control.unit.from_si(high), control.unit.symbol),
                "leave the point out, or make runs there (of ours: demcal train STUDY --until posterior)");
      group.base(before + static_cast<Eigen::Index>(i), k) = control.axis().to_unit(value);
      group.slot(before + static_cast<Eigen::Index>(i), k) = -1;
    }
  }

  struct Value {
    int slot = -1;
    double scaled = 0.0;
  };

  Value value_of(const CalibrationCase& item, const data::ObservationSet& set, std::size_t parameter_index) {
    const data::Parameter& parameter = study_.parameters[parameter_index];
    if (std::find(item.free.begin(), item.free.end(), parameter.name) != item.free.end()) {
      return {.slot = slot_of(links_.home(item, parameter.name)), .scaled = 0.0};
    }
    std::optional<double> value;
    if (const auto fixed = item.fixed.find(parameter.name); fixed != item.fixed.end()) value = fixed->second;
    if (!value) {
      const data::Material& material = study_.material(set.material);
      if (const auto fixed = material.fixed.find(parameter.name); fixed != material.fixed.end()) value = fixed->second;
    }
    if (!value) {
      problem(item.place,
              fmt::format("case '{}' neither frees nor fixes {}, which the runs of material '{}' vary", item.name,
                          parameter.name, set.material),
              fmt::format("add \"{}\" to free, or fixed = {{ {} = ... }}", parameter.name, parameter.name));
      return {};
    }
    const double scaled = parameter.axis().to_unit(*value);
    if (!(scaled >= -1e-9 && scaled <= 1.0 + 1e-9))
      problem(item.place,
              fmt::format("case '{}' fixes {} at {:g} {}, outside the range of its runs [{:g}, {:g}]", item.name,
                          parameter.name, parameter.unit.from_si(*value), parameter.unit.symbol,
                          parameter.unit.from_si(parameter.low), parameter.unit.from_si(parameter.high)),
              "fix it inside the range, or train in a wider one");
    return {.slot = -1, .scaled = scaled};
  }

  /// A parameter that the material's runs hold at one value cannot be fixed at another, by the case or the material,
  /// nor be free where another material's runs vary it.
  void check_constant(const CalibrationCase& item, const data::ObservationSet& set, std::size_t parameter_index,
                      double constant) {
    const data::Parameter& parameter = study_.parameters[parameter_index];
    const auto value = [&](double si) {
      return fmt::format("{:g} {}", parameter.unit.from_si(si), parameter.unit.symbol);
    };
    const data::Material& material = study_.material(set.material);
    const auto in_material = material.fixed.find(parameter.name);
    const auto fixed = item.fixed.find(parameter.name);
    const bool by_case = fixed != item.fixed.end(), by_material = in_material != material.fixed.end();
    if (!by_case && !by_material) {
      if (study_.materials.size() > 1 &&
          std::find(item.free.begin(), item.free.end(), parameter.name) != item.free.end())
        problem(
            item.place,
            fmt::format("case '{}' frees {}, but every run of material '{}' has {}: its data would not count for it",
                        item.name, parameter.name, set.material, value(constant)),
            fmt::format("vary it in training, or write materials.{}.fixed.{} = ...", set.material, parameter.name));
      return;
    }
    const double wanted = by_case ? fixed->second : in_material->second;
    if (std::abs(wanted - constant) <= 1e-6 * (parameter.high - parameter.low)) return;
    if (by_case)
      problem(item.place,
              fmt::format("case '{}' fixes {} at {}, but every run of material '{}' has {}", item.name, parameter.name,
                          value(wanted), set.material, value(constant)),
              "fix it at that value, or vary it in training");
    else
      problem(material.place,
              fmt::format("material '{}' fixes {} at {}, but every run of it has {}", set.material, parameter.name,
                          value(wanted), value(constant)),
              "fix it at that value, or make the runs again");
  }

  /// A control that the material's runs hold at one value must be measured there: the runs know no other.
  void check_constant_control(const Emulator& emulator, const data::ObservationSet& set, std::size_t index,
                              const std::pair<double, double>& range) {
    const bool varied = std::any_of(emulator.inputs.begin(), emulator.inputs.end(), [&](const EmulatorInput& input) {
      return input.kind == InputKind::control && input.index == index;
    });
    if (varied) return;
    const data::Control& control = study_.controls[index];
    constexpr double share = 0.02;  // of the value or the range: a speed is never set exactly
    const double slack = share * std::max(control.high - control.low, std::abs(range.first));
    std::vector<int> lines;
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const data::Observation& point : set.points) {
      if (std::abs(point.controls[index] - range.first) <= slack) continue;
      lines.push_back(point.line);
      low = std::min(low, point.controls[index]);
      high = std::max(high, point.controls[index]);
    }
    if (lines.empty()) return;
    problem(fmt::format("{}:{}", data::shown_path(set.file), lines.front()),
            fmt::format(
                "{} of {} points are measured at {} from {:g} to {:g} {}, but every run of this material has {:g} "
                "{}: the runs say nothing of another {}",
                lines.size(), set.points.size(), control.name, control.unit.from_si(low), control.unit.from_si(high),
                control.unit.symbol, control.unit.from_si(range.first), control.unit.symbol, control.name),
            "leave the points out, or add runs at other values");
  }

  /// Each evaluation costs the cube of the number of settings.
  void check_settings(const CaseModel& model) {
    for (const RowGroup& group : distinct_rows(model).groups) {
      if (group.base.rows() <= settings_max) continue;
      const data::ObservationSet& set = study_.observations[group.origin.front().set];
      throw data::InputError(
          ExitStatus::bad_data,
          {set.file,
           fmt::format("case '{}' has measurements of {} at {} different settings; above {} a calibration takes hours",
                       wanted_.name, study_.outputs[group.emulator.output].name, group.base.rows(), settings_max),
           "average them to a row per setting with its standard error (demcal observe), or round the settings: rows at "
           "exactly the same settings count as one"});
    }
  }

  void check_slots_used(const CaseModel& model) {
    for (int s = 0; s < model.dimension(); ++s) {
      bool used = model.slots[s].nuisance != Acts::none;
      for (const auto& group : model.groups) used = used || (group.slot.array() == s).any();
      if (used) continue;
      const CalibrationCase& owner = *homes_[s].owner;
      problem(owner.place,
              fmt::format("case '{}' frees {}, but no run of its materials varies it", owner.name,
                          model.slots[s].prior.parameter().name),
              "vary it in training, or fix it");
    }
  }

  const Study& study_;
  const std::vector<Emulator>& emulators_;
  const CalibrationCase& wanted_;
  LinkedCases links_;
  std::vector<Home> homes_;  // of each slot
  std::set<std::size_t> used_sets_;
  std::vector<Problem> problems_;
};

}  // namespace

CaseModel build_case(const data::Study& study, const std::vector<Emulator>& emulators, std::size_t case_index) {
  const CalibrationCase& wanted = study.cases.at(case_index);
  if (wanted.observe.empty() || study.observations.empty())
    throw data::InputError(ExitStatus::bad_study, {wanted.place, fmt::format("case '{}' observes nothing", wanted.name),
                                                   "name at least one [[observe]] set in `observe`"});
  return Builder(study, emulators, wanted).build();
}

}  // namespace uq
