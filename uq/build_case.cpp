#include "uq/case_model.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "data/error.hpp"

namespace uq {
namespace {

using data::CalibrationCase;
using data::ExitStatus;
using data::Problem;
using data::Study;

const CalibrationCase* find_case(const Study& study, const std::string& name) {
  for (const auto& item : study.cases)
    if (item.name == name) return &item;
  return nullptr;
}

const data::Nuisance* find_nuisance(const CalibrationCase& item, const std::string& name) {
  for (const auto& nuisance : item.nuisances)
    if (nuisance.parameter.name == name) return &nuisance;
  return nullptr;
}

/// Case that an unknown belongs to, links followed, and its name there; no case: the whole study's.
struct Home {
  const CalibrationCase* owner = nullptr;
  std::string name;
  bool operator==(const Home&) const = default;
};

bool joins(const data::Prior& prior) { return prior.kind == data::PriorKind::posterior && !prior.cut; }

Acts acts_of(data::NuisanceKind kind) {
  using data::NuisanceKind;
  const bool mean = kind == NuisanceKind::offset || kind == NuisanceKind::gain || kind == NuisanceKind::scale ||
                    kind == NuisanceKind::setting;
  return mean ? Acts::on_mean : Acts::on_spread;
}

class Builder {
 public:
  Builder(const Study& study, const std::vector<Emulator>& emulators, const CalibrationCase& wanted)
      : study_(study), emulators_(emulators), wanted_(wanted) {}

  CaseModel build() {
    include(wanted_, {});
    stop_on_problems();
    CaseModel model{.name = wanted_.name, .slots = {}, .groups = {}, .linked = {}, .observed_sets = wanted_.observe};
    for (const auto* item : included_) {
      if (item != &wanted_) model.linked.push_back(item->name);
      for (const auto& name : item->free) add_slot(model, *item, name);
      add_nuisances(model, *item);
    }
    stop_on_problems();
    for (const auto* item : included_) add_rows(model, *item);
    check_slots_used(model);
    stop_on_problems();
    for (auto& group : model.groups) {
      find_coordinates(group, model.dimension());
      for (auto& part : group.measurement.discrepancies)
        part.magnitude = std::sqrt(group.observed.segment(part.first, part.count).array().square().mean());
    }
    return model;
  }

 private:
  void problem(const std::string& place, std::string what, std::string remedy) {
    problems_.push_back({place, std::move(what), std::move(remedy)});
  }
  void stop_on_problems() const {
    if (!problems_.empty()) throw data::InputError(ExitStatus::bad_study, problems_);
  }

  /// Adds a case and those whose posteriors it takes; `path` is the way from the wanted case.
  void include(const CalibrationCase& item, std::vector<std::string> path) {
    if (std::find(path.begin(), path.end(), item.name) != path.end()) {
      std::string circle;
      for (const auto& name : path) circle += name + " -> ";
      problem(item.place, fmt::format("the priors of the cases run in a circle: {}{}", circle, item.name),
              "give one of them a prior of its own");
      return;
    }
    path.push_back(item.name);
    if (std::find(included_.begin(), included_.end(), &item) == included_.end()) included_.push_back(&item);
    for (const auto& [name, prior] : item.priors) follow(name, prior, path);
    for (const auto& nuisance : item.nuisances) follow(nuisance.parameter.name, nuisance.parameter.prior, path);
  }

  /// Includes the case whose posterior an unknown takes.
  void follow(const std::string& name, const data::Prior& prior, const std::vector<std::string>& path) {
    if (prior.kind != data::PriorKind::posterior) return;
    const CalibrationCase* other = find_case(study_, prior.posterior_of);
    if (other == nullptr) {
      problem(prior.place,
              fmt::format("there is no case '{}' whose posterior could be the prior of {}", prior.posterior_of, name),
              "name one of the [[calibrate]] cases");
    } else if (std::find(other->free.begin(), other->free.end(), name) == other->free.end() &&
               find_nuisance(*other, name) == nullptr) {
      problem(prior.place, fmt::format("{} is not free in case '{}', so it has no posterior there", name, other->name),
              fmt::format("free it in '{}', or fix it here", other->name));
    } else if (!prior.cut) {
      include(*other, path);
    } else if (path.size() > 1) {
      problem(prior.place,
              fmt::format("case '{}' cuts {} from '{}', but is itself sampled jointly with case '{}'", path.back(),
                          name, other->name, wanted_.name),
              fmt::format("cut the posterior of '{}' in '{}', too", path.back(), wanted_.name));
    }
  }

  const data::Prior& prior_of(const CalibrationCase& item, const std::string& name) const {
    if (const auto* nuisance = find_nuisance(item, name)) return nuisance->parameter.prior;
    const auto own = item.priors.find(name);
    return own == item.priors.end() ? study_.parameters[study_.parameter_index(name).value()].prior : own->second;
  }

  Home home(const CalibrationCase& item, const std::string& name) const {
    const data::Prior& prior = prior_of(item, name);
    return joins(prior) ? home(*find_case(study_, prior.posterior_of), name) : Home{&item, name};
  }

  /// The density that an unknown had before any data: through cuts, too.
  const data::Prior& first_prior(const CalibrationCase& item, const std::string& name) const {
    const data::Prior& prior = prior_of(item, name);
    if (prior.kind != data::PriorKind::posterior) return prior;
    return first_prior(*find_case(study_, prior.posterior_of), name);
  }

  const data::Nuisance& first_nuisance(const CalibrationCase& item, const std::string& name) const {
    const data::Nuisance& nuisance = *find_nuisance(item, name);
    if (nuisance.parameter.prior.kind != data::PriorKind::posterior) return nuisance;
    return first_nuisance(*find_case(study_, nuisance.parameter.prior.posterior_of), name);
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
    const data::Prior& prior = prior_of(item, name);
    add_unknown(model, home(item, name),
                {.label = label_of(item, name),
                 .prior = ScaledPrior(parameter, first_prior(item, name)),
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
      add_nuisance(model, home(item, name), label_of(item, name), first_nuisance(item, name));
    }
    for (const auto& set_name : item.observe) {
      const data::ObservationSet& set = study_.observations[study_.observation_index(set_name).value()];
      if (set.of_machine && study_.scale && study_.scale->unknown)
        add_nuisance(model, {nullptr, "scale"}, "scale", *study_.scale->unknown);
      for (const auto& error : set.setting_errors)
        if (error.unknown && !set.points.empty()) {
          const data::Nuisance setting = setting_unknown(set, error);
          add_nuisance(model, {nullptr, setting.parameter.name}, setting.parameter.name, setting);
        }
    }
  }

  /// The true value of a control that is one for the whole set, about its stated value.
  data::Nuisance setting_unknown(const data::ObservationSet& set, const data::SettingError& error) const {
    const data::Control& control = study_.controls[error.control];
    const double stated = set.points.front().controls[error.control];
    data::Parameter parameter{.name = set.name + "_" + control.name,
                              .target = control.target,
                              .unit = control.unit,
                              .low = control.low,
                              .high = control.high,
                              .place = error.place};
    parameter.prior = {.kind = data::PriorKind::normal,
                       .low = control.low,
                       .high = control.high,
                       .mean = stated,
                       .sd = std::hypot(error.spread.absolute, error.spread.relative * stated),
                       .place = error.place};
    return {data::NuisanceKind::setting, {}, parameter};
  }

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
      const EmulatorInput& input = emulator.inputs[static_cast<std::size_t>(k)];
      if (input.kind == InputKind::control) {
        fill_control(*group, emulator, set, before, k);
        for (const auto& error : set.setting_errors)
          if (error.unknown && error.control == input.index)
            group->slot.col(k).tail(rows).setConstant(slot_of({nullptr, setting_unknown(set, error).parameter.name}));
        continue;
      }
      const Value value = value_of(item, set, input.index);
      group->base.col(k).tail(rows).setConstant(value.scaled);
      group->slot.col(k).tail(rows).setConstant(value.slot);
    }
    for (const auto& [parameter, constant] : emulator.constants) check_constant(item, set, parameter, constant);
    for (Eigen::Index i = 0; i < rows; ++i) {
      const data::Observation& point = set.points[static_cast<std::size_t>(i)];
      group->observed[before + i] = point.values[column];
      group->variance[before + i] = point.standard_errors[column] * point.standard_errors[column];
      group->origin.push_back({.set = set_index, .point = static_cast<std::size_t>(i), .output = set.outputs[column]});
    }
    add_measurement(*group, item, set, {before, set.outputs[column]});
  }

  /// What is known of the meter and the settings of the rows just added.
  void add_measurement(RowGroup& group, const CalibrationCase& item, const data::ObservationSet& set,
                       const std::pair<Eigen::Index, std::size_t>& first_and_output) {
    const auto [first, output] = first_and_output;
    ReadSet read{.first = first, .count = group.base.rows() - first, .factors = {}, .settings = {}};
    if (set.of_machine && study_.scale && study_.scale->unknown) {
      read.factors.push_back(slot_of({nullptr, "scale"}));
    } else if (set.of_machine && study_.scale) {
      read.factor = study_.scale->value;
    }
    int discrepancy_sd = -1, discrepancy_length = -1;
    for (const auto& nuisance : item.nuisances) {
      if (nuisance.output.value_or(output) != output) continue;
      const int s = slot_of(home(item, nuisance.parameter.name));
      switch (nuisance.kind) {
        case data::NuisanceKind::offset:
          read.offset = s;
          break;
        case data::NuisanceKind::gain:
          read.factors.push_back(s);
          break;
        case data::NuisanceKind::noise_scale:
        case data::NuisanceKind::noise_sd:
          read.noise = s;
          read.noise_is_sd = nuisance.kind == data::NuisanceKind::noise_sd;
          break;
        case data::NuisanceKind::discrepancy_sd:
          discrepancy_sd = s;
          break;
        case data::NuisanceKind::discrepancy_length:
          discrepancy_length = s;
          break;
        case data::NuisanceKind::scale:
        case data::NuisanceKind::setting:
          break;  // of the rig or the set, not of the case
      }
    }
    for (const auto& error : set.common_errors)
      if (error.output == output) {
        read.common_absolute = error.spread.absolute;
        read.common_relative = error.spread.relative;
      }
    for (const auto& error : set.setting_errors) add_setting(read, group, set, error);
    const bool plain = read.factor == 1.0 && read.factors.empty() && read.offset < 0 && read.noise < 0 &&
                       read.common_absolute == 0.0 && read.common_relative == 0.0 && read.settings.empty();
    if (!plain) group.measurement.sets.push_back(read);
    if (discrepancy_sd >= 0) add_discrepancy(group, set, read, {discrepancy_sd, discrepancy_length});
  }

  void add_setting(ReadSet& read, const RowGroup& group, const data::ObservationSet& set,
                   const data::SettingError& error) {
    const data::Control& control = study_.controls[error.control];
    const auto& inputs = group.emulator.inputs;
    const auto found = std::find_if(inputs.begin(), inputs.end(), [&](const EmulatorInput& input) {
      return input.kind == InputKind::control && input.index == error.control;
    });
    if (found == inputs.end()) {
      problem(error.place,
              fmt::format("the runs of material '{}' do not vary {}, so its uncertainty's effect is not known",
                          set.material, control.name),
              fmt::format("vary it in training, or state its effect as common_error of '{}'", set.name));
      return;
    }
    if (error.unknown) return;
    SettingShift shift{.column = static_cast<int>(found - inputs.begin()), .error = Eigen::VectorXd(read.count)};
    for (Eigen::Index i = 0; i < read.count; ++i) {
      const double value = set.points[static_cast<std::size_t>(i)].controls[error.control];
      shift.error[i] = std::hypot(error.spread.absolute, error.spread.relative * value) / (control.high - control.low);
      shift.common = shift.common && value == set.points.front().controls[error.control];
    }
    read.settings.push_back(std::move(shift));
  }

  /// The case's discrepancy over the rows just added, one process with the case's other rows of the group.
  void add_discrepancy(RowGroup& group, const data::ObservationSet& set, const ReadSet& read,
                       const std::pair<int, int>& unknowns) {
    auto& all = group.measurement.discrepancies;
    if (all.empty() || all.back().sd != unknowns.first)
      all.push_back({.first = read.first, .sd = unknowns.first, .length = unknowns.second, .controls = {}});
    DiscrepancyRows& part = all.back();
    part.controls.conservativeResize(part.count + read.count, static_cast<Eigen::Index>(study_.controls.size()));
    for (Eigen::Index i = 0; i < read.count; ++i)
      for (std::size_t c = 0; c < study_.controls.size(); ++c)
        part.controls(part.count + i, static_cast<Eigen::Index>(c)) =
            (set.points[static_cast<std::size_t>(i)].controls[c] - study_.controls[c].low) /
            (study_.controls[c].high - study_.controls[c].low);
    part.count += read.count;
  }

  void fill_control(RowGroup& group, const Emulator& emulator, const data::ObservationSet& set, Eigen::Index before,
                    Eigen::Index k) {
    const std::size_t index = emulator.inputs[static_cast<std::size_t>(k)].index;
    const data::Control& control = study_.controls[index];
    const auto range = emulator.control_range.find(index);
    const auto [low, high] =
        range == emulator.control_range.end() ? std::pair{control.low, control.high} : range->second;
    // A scrambled design of a few dozen runs stops several percent short of its range's ends, and the surrogate's
    // variance covers that; further out it extrapolates.
    const double slack = 0.1 * (control.high - control.low);
    for (std::size_t i = 0; i < set.points.size(); ++i) {
      const double value = set.points[i].controls[index];
      if (value < low - slack || value > high + slack)
        problem(fmt::format("{}:{}", set.file, set.points[i].line),
                fmt::format("{} is {:g} {}, but the runs of this material reach from {:g} to {:g} {}", control.name,
                            control.unit.from_si(value), control.unit.symbol, control.unit.from_si(low),
                            control.unit.from_si(high), control.unit.symbol),
                "leave the point out, or train in a wider range");
      group.base(before + static_cast<Eigen::Index>(i), k) = (value - control.low) / (control.high - control.low);
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
      return {.slot = slot_of(home(item, parameter.name)), .scaled = 0.0};
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
    const double scaled = to_scaled(parameter, *value);
    if (!(scaled >= -1e-9 && scaled <= 1.0 + 1e-9))
      problem(item.place,
              fmt::format("case '{}' fixes {} at {:g} {}, outside the range of its runs [{:g}, {:g}]", item.name,
                          parameter.name, parameter.unit.from_si(*value), parameter.unit.symbol,
                          parameter.unit.from_si(parameter.low), parameter.unit.from_si(parameter.high)),
              "fix it inside the range, or train in a wider one");
    return {.slot = -1, .scaled = scaled};
  }

  /// A parameter that the material's runs hold at one value cannot be fixed at another.
  void check_constant(const CalibrationCase& item, const data::ObservationSet& set, std::size_t parameter_index,
                      double constant) {
    const data::Parameter& parameter = study_.parameters[parameter_index];
    const auto fixed = item.fixed.find(parameter.name);
    if (fixed == item.fixed.end()) return;
    if (std::abs(fixed->second - constant) <= 1e-6 * (parameter.high - parameter.low)) return;
    problem(item.place,
            fmt::format("case '{}' fixes {} at {:g} {}, but every run of material '{}' has {:g} {}", item.name,
                        parameter.name, parameter.unit.from_si(fixed->second), parameter.unit.symbol, set.material,
                        parameter.unit.from_si(constant), parameter.unit.symbol),
            "fix it at that value, or vary it in training");
  }

  void check_slots_used(const CaseModel& model) {
    for (int s = 0; s < model.dimension(); ++s) {
      bool used = model.slots[static_cast<std::size_t>(s)].nuisance != Acts::none;
      for (const auto& group : model.groups) used = used || (group.slot.array() == s).any();
      if (used) continue;
      const CalibrationCase& owner = *homes_[static_cast<std::size_t>(s)].owner;
      problem(owner.place,
              fmt::format("case '{}' frees {}, but no run of its materials varies it", owner.name,
                          model.slots[static_cast<std::size_t>(s)].prior.parameter().name),
              "vary it in training, or fix it");
    }
  }

  const Study& study_;
  const std::vector<Emulator>& emulators_;
  const CalibrationCase& wanted_;
  std::vector<const CalibrationCase*> included_;
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
