#include "uq/posterior/case_model.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>
#include <tuple>

#include "data/error.hpp"
#include "data/observations.hpp"
#include "uq/posterior/build_measurement.hpp"
#include "uq/posterior/case_checks.hpp"
#include "uq/posterior/distinct.hpp"
#include "uq/posterior/linked_cases.hpp"
#include "uq/posterior/set_unknowns.hpp"

namespace uq {
namespace {

using data::CalibrationCase;
using data::ExitStatus;
using data::Problem;
using data::Study;

class Builder {
 public:
  Builder(const Study& study, const std::vector<Emulator>& emulators, const CalibrationCase& wanted)
      : study_(study), emulators_(emulators), wanted_(wanted), links_(study, wanted), problems_(links_.problems()) {}

  CaseModel build() {
    stop_on_problems();
    CaseModel model{.name = wanted_.name, .unknowns = {}, .groups = {}, .linked = {}, .observed_sets = wanted_.observe};
    for (const auto* item : links_.cases()) {
      if (item != &wanted_) model.linked.push_back(item->name);
      for (const auto& name : item->free) add_unknown(model, *item, name);
      add_nuisances(model, *item);
    }
    add_set_unknowns(model);
    stop_on_problems();
    for (const auto* item : links_.cases()) add_rows(model, *item);
    check_unknowns_used(model);
    stop_on_problems();
    for (auto& group : model.groups) {
      find_coordinates(group, model.dimension());
      for (auto& part : group.measurement.discrepancies)
        part.magnitude = std::sqrt(group.observed.segment(part.first, part.count).array().square().mean());
    }
    link_errors(model);
    link_settings(model);
    stop_on_problems();
    pool_rows(model);
    refuse_too_many_settings(study_, model);
    return model;
  }

 private:
  void problem(const std::string& place, std::string what, std::string remedy) {
    problems_.push_back({place, std::move(what), std::move(remedy)});
  }
  void add_problems(std::vector<Problem> more) { std::move(more.begin(), more.end(), std::back_inserter(problems_)); }
  void stop_on_problems() const {
    if (!problems_.empty()) throw data::InputError(ExitStatus::bad_study, problems_);
  }

  /// An unknown that is not there yet.
  void add_unknown(CaseModel& model, const Home& where, Unknown unknown) {
    if (std::find(homes_.begin(), homes_.end(), where) != homes_.end()) return;
    homes_.push_back(where);
    model.unknowns.push_back(std::move(unknown));
  }

  int unknown_of(const Home& where) const {
    return static_cast<int>(std::find(homes_.begin(), homes_.end(), where) - homes_.begin());
  }

  std::string label_of(const CalibrationCase& item, const std::string& name) const {
    return &item == &wanted_ ? name : item.name + ": " + name;
  }

  void add_unknown(CaseModel& model, const CalibrationCase& item, const std::string& name) {
    const data::Parameter& parameter = study_.parameters[study_.parameter_index(name).value()];
    const data::Prior& prior = links_.prior_of(item, name);
    add_unknown(model, links_.home(item, name),
                {.label = label_of(item, name),
                 .prior = ScaledPrior(parameter, links_.first_prior(item, name)),
                 .own = &item == &wanted_,
                 .nuisance = {},
                 .cut_from = prior.cut ? prior.posterior_of : "",
                 .cut = {}});
  }

  void add_nuisance(CaseModel& model, const Home& where, const std::string& label, const data::Nuisance& nuisance) {
    add_unknown(model, where,
                {.label = label,
                 .prior = ScaledPrior(nuisance.parameter, nuisance.parameter.prior),
                 .own = false,
                 .nuisance = nuisance.kind,
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
  }

  /// Unknowns of the measurements of all cases, by name: in the same order whichever case reads a meter first.
  void add_set_unknowns(CaseModel& model) {
    std::map<std::string, data::Nuisance> found;
    for (const auto* item : links_.cases())
      for (const auto& set_name : item->observe)
        for (const data::Nuisance& unknown :
             set_unknowns(study_, study_.observations[study_.observation_index(set_name).value()]))
          found.emplace(unknown.parameter.name, unknown);
    for (const auto& [name, unknown] : found) add_nuisance(model, home_of(unknown), name, unknown);
  }

  /// The home of an unknown that a measurement has.
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
        if (other != set_index && hold_the_same(study_.observations[other], set))
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
                  fmt::format("'{}' measures {}{}, of which there are no runs", set_name,
                              study_.outputs[set.outputs[column]].name,
                              set.material.empty() ? "" : fmt::format(" of material '{}'", set.material)),
                  "simulate it, or leave the output out");
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
                              .unknown = Eigen::MatrixXi(0, inputs),
                              .observed = {},
                              .variance = {},
                              .origin = {},
                              .coordinate = {}});
      group = model.groups.end() - 1;
    }
    const data::ObservationSet& set = study_.observations[set_index];
    const std::vector<std::size_t> points = data::points_with(set, column);
    const auto rows = static_cast<Eigen::Index>(points.size());
    const Eigen::Index before = group->base.rows();
    group->base.conservativeResize(before + rows, inputs);
    group->unknown.conservativeResize(before + rows, inputs);
    group->observed.conservativeResize(before + rows);
    group->variance.conservativeResize(before + rows);
    for (Eigen::Index k = 0; k < inputs; ++k) {
      const EmulatorInput& input = emulator.inputs[k];
      if (input.kind == InputKind::control) {
        for (Eigen::Index i = 0; i < rows; ++i)
          group->base(before + i, k) =
              study_.controls[input.index].axis().to_unit(set.points[points[i]].controls[input.index]);
        group->unknown.col(k).tail(rows).setConstant(-1);
        for (const auto& error : set.setting_errors)
          if (rows > 0 && error.as == data::SettingErrorAs::unknown && error.control == input.index)
            group->unknown.col(k).tail(rows).setConstant(unknown_of(home_of(setting_unknown(study_, set, error))));
        continue;
      }
      const Value value = value_of(item, set, input.index);
      group->base.col(k).tail(rows).setConstant(value.scaled);
      group->unknown.col(k).tail(rows).setConstant(value.unknown);
    }
    add_problems(against_the_runs(study_, item, set, emulator));
    for (Eigen::Index i = 0; i < rows; ++i) {
      const data::Observation& point = set.points[points[i]];
      group->observed[before + i] = point.values[column];
      group->variance[before + i] = point.standard_errors[column] * point.standard_errors[column];
      group->origin.push_back({.set = set_index, .point = points[i], .output = set.outputs[column]});
    }
    std::vector<Acting> unknowns;
    for (const auto& nuisance : item.nuisances)
      unknowns.push_back({nuisance, unknown_of(links_.home(item, nuisance.parameter.name))});
    for (const auto& nuisance : set_unknowns(study_, set))
      unknowns.push_back({nuisance, unknown_of(home_of(nuisance))});
    add_problems(add_measurement(*group, study_, {set, set.outputs[column], before, points}, unknowns));
  }

  struct Value {
    int unknown = -1;
    double scaled = 0.0;
  };

  Value value_of(const CalibrationCase& item, const data::ObservationSet& set, std::size_t parameter_index) {
    const data::Parameter& parameter = study_.parameters[parameter_index];
    if (std::find(item.free.begin(), item.free.end(), parameter.name) != item.free.end()) {
      return {.unknown = unknown_of(links_.home(item, parameter.name)), .scaled = 0.0};
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
              fmt::format("case '{}' fixes {} at {:g}{}, outside the range of its runs [{:g}, {:g}]", item.name,
                          parameter.name, parameter.unit.from_si(*value), data::behind_number(parameter.unit.symbol),
                          parameter.unit.from_si(parameter.low), parameter.unit.from_si(parameter.high)),
              "fix it inside the range, or train in a wider one");
    return {.unknown = -1, .scaled = scaled};
  }

  /// Rows whose own errors go together, as the observation sets say.
  void link_errors(CaseModel& model) {
    std::map<std::tuple<std::size_t, std::size_t, std::size_t>, Eigen::Index> row_of;  // by set, point and output
    const std::vector<RowOrigin> from = origins(model);
    for (std::size_t row = 0; row < from.size(); ++row)
      row_of[{from[row].set, from[row].point, from[row].output}] = static_cast<Eigen::Index>(row);
    std::string place;
    for (const std::size_t set : used_sets_)
      for (const data::ErrorCorrelation& stated : study_.observations[set].correlations) {
        const std::size_t other = study_.observation_index(stated.other_set).value();
        for (const auto& [point, other_point] :
             data::points_at_same_settings(study_, study_.observations[set], study_.observations[other])) {
          const auto first = row_of.find({set, point, stated.output});
          const auto second = row_of.find({other, other_point, stated.other_output});
          if (first == row_of.end() || second == row_of.end()) continue;
          model.linked_errors.push_back({first->second, second->second, stated.value});
          place = stated.place;
        }
      }
    if (model.linked_errors.empty()) return;
    const Eigen::VectorXd ones = Eigen::VectorXd::Ones(model.row_count());
    Eigen::MatrixXd correlation = Eigen::MatrixXd::Zero(ones.size(), ones.size());
    add_own_errors(ones, model.linked_errors, correlation);
    if (correlation.llt().info() != Eigen::Success)
      problem(
          place,
          fmt::format("the correlations of case '{}' contradict each other: no errors can have them all", wanted_.name),
          "state them as estimated from the same readings, or smaller ones");
  }

  /// Where a group's rows were read.
  struct Settings {
    std::string read_with;  ///< the set whose settings they have
    std::size_t group = 0, setting = 0;
    const ReadSet* rows = nullptr;
    const SettingShift* shift = nullptr;
  };

  /// Outputs that were read at the same settings, where a setting has an error.
  void link_settings(CaseModel& model) const {
    std::vector<Settings> all;
    for (std::size_t g = 0; g < model.groups.size(); ++g) {
      std::size_t setting = 0;
      for (const ReadSet& rows : model.groups[g].measurement.sets)
        for (const SettingShift& shift : rows.settings) {
          const data::ObservationSet& set = study_.observations[model.groups[g].origin[rows.first].set];
          all.push_back({.read_with = set.read_with.empty() ? set.name : set.read_with,
                         .group = g,
                         .setting = setting++,
                         .rows = &rows,
                         .shift = &shift});
        }
    }
    for (std::size_t i = 0; i < all.size(); ++i)
      for (std::size_t j = i + 1; j < all.size(); ++j) {
        const Settings &a = all[i], &b = all[j];
        if (a.group == b.group || a.read_with != b.read_with || a.shift->control != b.shift->control) continue;
        model.linked_settings.push_back({.first_group = a.group,
                                         .second_group = b.group,
                                         .first_setting = a.setting,
                                         .second_setting = b.setting,
                                         .first_row = a.rows->first,
                                         .second_row = b.rows->first,
                                         .same = same_level(a.shift->level, b.shift->level)});
      }
  }

  void check_unknowns_used(const CaseModel& model) {
    for (int s = 0; s < model.dimension(); ++s) {
      bool used = model.unknowns[s].nuisance.has_value();
      for (const auto& group : model.groups) used = used || (group.unknown.array() == s).any();
      if (used) continue;
      const CalibrationCase& owner = *homes_[s].owner;
      problem(owner.place,
              fmt::format("case '{}' frees {}, but no run of its materials varies it", owner.name,
                          model.unknowns[s].prior.parameter().name),
              "vary it in training, or fix it");
    }
  }

  const Study& study_;
  const std::vector<Emulator>& emulators_;
  const CalibrationCase& wanted_;
  LinkedCases links_;
  std::vector<Home> homes_;  // of each unknown
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
