#include "uq/case_model.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cassert>
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

/// Case and parameter that an unknown belongs to, links followed.
struct Home {
  const CalibrationCase* owner = nullptr;
  std::size_t parameter = 0;
  bool operator==(const Home&) const = default;
};

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
    }
    stop_on_problems();
    for (const auto* item : included_) add_rows(model, *item);
    check_slots_used(model);
    stop_on_problems();
    for (auto& group : model.groups) find_coordinates(group, model.dimension());
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
    for (const auto& [name, prior] : item.priors) {
      if (prior.kind != data::PriorKind::posterior) continue;
      const CalibrationCase* other = find_case(study_, prior.posterior_of);
      if (other == nullptr) {
        problem(prior.place,
                fmt::format("there is no case '{}' whose posterior could be the prior of {}", prior.posterior_of, name),
                "name one of the [[calibrate]] cases");
      } else if (std::find(other->free.begin(), other->free.end(), name) == other->free.end()) {
        problem(prior.place,
                fmt::format("{} is not free in case '{}', so it has no posterior there", name, other->name),
                fmt::format("free it in '{}', or fix it here", other->name));
      } else {
        include(*other, path);
      }
    }
  }

  Home home(const CalibrationCase& item, const std::string& name) const {
    const auto found = item.priors.find(name);
    if (found != item.priors.end() && found->second.kind == data::PriorKind::posterior)
      return home(*find_case(study_, found->second.posterior_of), name);
    return {&item, study_.parameter_index(name).value()};
  }

  void add_slot(CaseModel& model, const CalibrationCase& item, const std::string& name) {
    const Home where = home(item, name);
    if (std::find(homes_.begin(), homes_.end(), where) != homes_.end()) return;
    const data::Parameter& parameter = study_.parameters[where.parameter];
    const auto own_prior = where.owner->priors.find(name);
    const data::Prior& prior = own_prior == where.owner->priors.end() ? parameter.prior : own_prior->second;
    const bool own = &item == &wanted_;
    homes_.push_back(where);
    model.slots.push_back(
        {.label = own ? name : item.name + ": " + name, .prior = ScaledPrior(parameter, prior), .own = own});
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
      const Home where = home(item, parameter.name);
      const auto found = std::find(homes_.begin(), homes_.end(), where);
      return {.slot = static_cast<int>(found - homes_.begin()), .scaled = 0.0};
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
      bool used = false;
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

Emulator make_emulator(std::shared_ptr<const surrogate::GaussianProcess> process, std::string material,
                       std::size_t output, std::vector<EmulatorInput> inputs) {
  Emulator emulator{.material = std::move(material),
                    .output = output,
                    .inputs = std::move(inputs),
                    .constants = {},
                    .control_range = {},
                    .predict = {}};
  emulator.predict = [process](const Eigen::MatrixXd& points) -> surrogate::Prediction {
    return process->predict(points);
  };
  emulator.predict_with_gradient = [process](const Eigen::MatrixXd& points,
                                             std::span<const int> coordinates) -> surrogate::PredictionGradient {
    return process->predict_with_gradient(points, coordinates);
  };
  emulator.predict_batch = [process](const Eigen::MatrixXd& points, int group) -> std::vector<surrogate::Prediction> {
    return process->predict_batch(points, group);
  };
  return emulator;
}

int CaseModel::own_count() const {
  return static_cast<int>(std::count_if(slots.begin(), slots.end(), [](const Slot& slot) { return slot.own; }));
}

int CaseModel::row_count() const {
  Eigen::Index rows = 0;
  for (const auto& group : groups) rows += group.observed.size();
  return static_cast<int>(rows);
}

Eigen::VectorXd CaseModel::lower() const {
  Eigen::VectorXd low(dimension());
  for (int s = 0; s < dimension(); ++s) low[s] = slots[static_cast<std::size_t>(s)].prior.low();
  return low;
}

Eigen::VectorXd CaseModel::upper() const {
  Eigen::VectorXd high(dimension());
  for (int s = 0; s < dimension(); ++s) high[s] = slots[static_cast<std::size_t>(s)].prior.high();
  return high;
}

CaseModel build_case(const data::Study& study, const std::vector<Emulator>& emulators, std::size_t case_index) {
  const CalibrationCase& wanted = study.cases.at(case_index);
  if (wanted.observe.empty() || study.observations.empty())
    throw data::InputError(ExitStatus::bad_study, {wanted.place, fmt::format("case '{}' observes nothing", wanted.name),
                                                   "name at least one [[observe]] set in `observe`"});
  return Builder(study, emulators, wanted).build();
}

void find_coordinates(RowGroup& group, int slots) {
  group.uniform = true;
  group.coordinate.assign(static_cast<std::size_t>(slots), std::nullopt);
  for (Eigen::Index k = 0; k < group.slot.cols(); ++k) {
    if (group.slot.rows() == 0) continue;
    const int s = group.slot(0, k);
    if ((group.slot.col(k).array() != s).any()) group.uniform = false;
    if (s < 0) continue;
    if (group.coordinate[static_cast<std::size_t>(s)]) group.uniform = false;
    group.coordinate[static_cast<std::size_t>(s)] = static_cast<int>(k);
  }
}

CaseModel with_data(const CaseModel& model, const Eigen::VectorXd& observed, const Eigen::VectorXd& variance) {
  CaseModel other = model;
  Eigen::Index first = 0;
  for (auto& group : other.groups) {
    const Eigen::Index rows = group.observed.size();
    group.observed = observed.segment(first, rows);
    group.variance = variance.segment(first, rows);
    first += rows;
  }
  assert(first == observed.size());
  return other;
}

Eigen::VectorXd observed(const CaseModel& model) {
  Eigen::VectorXd all(model.row_count());
  Eigen::Index first = 0;
  for (const auto& group : model.groups) {
    all.segment(first, group.observed.size()) = group.observed;
    first += group.observed.size();
  }
  return all;
}

Eigen::VectorXd observed_variance(const CaseModel& model) {
  Eigen::VectorXd all(model.row_count());
  Eigen::Index first = 0;
  for (const auto& group : model.groups) {
    all.segment(first, group.variance.size()) = group.variance;
    first += group.variance.size();
  }
  return all;
}

std::vector<RowOrigin> origins(const CaseModel& model) {
  std::vector<RowOrigin> all;
  for (const auto& group : model.groups) all.insert(all.end(), group.origin.begin(), group.origin.end());
  return all;
}

}  // namespace uq
