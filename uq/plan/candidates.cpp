#include "uq/plan/candidates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <set>

#include "data/error.hpp"
#include "data/observations.hpp"
#include "data/time_series.hpp"
#include "uq/findings/study_units.hpp"
#include "uq/posterior/control_reach.hpp"

namespace uq::plan {
namespace {

using data::Study;

/// Standard deviation of the logarithms of positive numbers.
double log_spread(const std::vector<double>& values) {
  double sum = 0.0, squares = 0.0;
  for (const double value : values) {
    sum += std::log(value);
    squares += std::pow(std::log(value), 2);
  }
  const double n = static_cast<double>(values.size());
  return std::sqrt(std::max(squares / n - std::pow(sum / n, 2), 0.0));
}

/// The error of the case's readings of an output: their median, in the output's unit or as a share of the value,
/// whichever differs less from reading to reading. None where the case reads none.
std::optional<data::Spread> stated_error(const Study& study, const std::vector<std::size_t>& sets, std::size_t output) {
  std::vector<double> errors, shares;
  for (const std::size_t index : sets) {
    const data::ObservationSet& set = study.observations[index];
    if (set.assumed) continue;
    const std::optional<std::size_t> c = set.column_of(output);
    if (!c) continue;
    for (const data::Observation& point : set.points)
      if (point.has(*c) && point.standard_errors[*c] > 0.0) {
        errors.push_back(point.standard_errors[*c]);
        if (point.values[*c] != 0.0) shares.push_back(std::abs(point.standard_errors[*c] / point.values[*c]));
      }
  }
  if (errors.empty()) return {};
  constexpr double clearly = 1e-6;  // readings of one value do not tell the two apart
  const bool absolute = shares.size() < errors.size() || log_spread(errors) + clearly < log_spread(shares);
  if (absolute) return data::Spread{.absolute = data::median_of(std::move(errors))};
  return data::Spread{.relative = data::median_of(std::move(shares))};
}

/// Settings at which a set has a reading of an output.
std::set<std::vector<double>> settings_of(const data::ObservationSet& set, std::size_t output) {
  std::set<std::vector<double>> found;
  if (const std::optional<std::size_t> column = set.column_of(output))
    for (const std::size_t i : data::points_with(set, *column)) found.insert(set.points[i].controls);
  return found;
}

/// Range of a control that the runs of a material cover.
std::pair<double, double> range_of(const Study& study, const Emulator& emulator, std::size_t control) {
  const auto known = emulator.control_range.find(control);
  if (known != emulator.control_range.end()) return known->second;
  return {study.controls[control].low, study.controls[control].high};
}

bool varied(const Emulator& emulator, std::size_t control) {
  return std::any_of(emulator.inputs.begin(), emulator.inputs.end(), [&](const EmulatorInput& input) {
    return input.kind == InputKind::control && input.index == control;
  });
}

std::string name_of(const Study& study, const Candidate& candidate, bool of_several_materials) {
  std::vector<std::string> outputs, settings;
  for (const std::size_t output : candidate.outputs) outputs.push_back(study.outputs[output].name);
  for (std::size_t c = 0; c < study.controls.size(); ++c) {
    std::set<double> values;
    for (const auto& point : candidate.settings) values.insert(point[c]);
    const data::Unit& unit = study.controls[c].unit;
    std::vector<std::string> texts;
    for (const double value : values) texts.push_back(fmt::format("{:.4g}", unit.from_si(value)));
    settings.push_back(fmt::format("{}{}{}", study.controls.size() > 1 ? study.controls[c].name + " " : "",
                                   fmt::join(texts, ", "), behind_number(unit.symbol)));
  }
  std::string name = fmt::format("{}", fmt::join(outputs, " and "));
  if (!settings.empty()) name += fmt::format(" at {}", fmt::join(settings, ", "));
  if (of_several_materials) name += " of " + candidate.material;
  if (candidate.readings > 1) name += fmt::format(", {} readings", candidate.readings);
  return name;
}

/// Whether an output of enlarged grains may differ from the real powder's. An output that the case reads is taken as
/// comparable: the parameters are found through it. Every other one counts as the model's alone.
bool only_of_model(const Study& study, const std::vector<std::size_t>& sets, std::size_t output,
                   const std::string& material, const CandidateOptions& options) {
  if (!options.coarse_grained.contains(material)) return false;
  return std::none_of(sets.begin(), sets.end(), [&](std::size_t set) {
    const std::vector<std::size_t>& read = study.observations[set].outputs;
    return std::find(read.begin(), read.end(), output) != read.end();
  });
}

class Usual {
 public:
  Usual(const Study& study, const std::vector<Emulator>& emulators, std::size_t case_index,
        const CandidateOptions& options)
      : study_(study), emulators_(emulators), sets_(own_sets(study, case_index)), options_(options) {}

  std::vector<Candidate> all() {
    std::set<std::string> materials;
    for (const std::size_t index : sets_) materials.insert(study_.observations[index].material);
    for (const std::string& material : materials) {
      std::set<std::vector<double>> observed;                      // settings, of any output
      std::map<std::size_t, std::set<std::vector<double>>> where;  // of each output
      for (const std::size_t index : sets_) {
        const data::ObservationSet& set = study_.observations[index];
        if (set.material != material) continue;
        for (const std::size_t output : set.outputs) where[output].merge(settings_of(set, output));
        for (const data::Observation& point : set.points) observed.insert(point.controls);
      }
      if (observed.empty()) continue;
      for (std::size_t output = 0; output < study_.outputs.size(); ++output) {
        const Emulator* emulator = emulator_of(emulators_, material, output);
        if (emulator == nullptr) continue;
        add_output(material, output, *emulator, {observed, where[output]});
      }
    }
    for (Candidate& one : found_) one.name = name_of(study_, one, materials.size() > 1);
    return found_;
  }

 private:
  /// Settings at which the case's data were taken.
  struct Observed {
    const std::set<std::vector<double>>&of_any, &of_this;  ///< settings of any output, and of the one asked for
  };

  void add_output(const std::string& material, std::size_t output, const Emulator& emulator, const Observed& observed) {
    const bool known = !observed.of_this.empty();
    const std::optional<data::Spread> stated = stated_error(study_, sets_, output);
    std::set<std::vector<double>> taken;
    const auto add_all = [&](const std::vector<std::vector<double>>& settings, CandidateKind kind) {
      Candidate one{.kind = kind, .material = material, .outputs = {output}, .settings = settings};
      one.cost = static_cast<double>(settings.size());
      one.error = {stated.value_or(data::Spread{.relative = options_.assumed_error})};
      one.assumed_error = !stated;
      one.model_only = only_of_model(study_, sets_, output, material, options_);
      found_.push_back(std::move(one));
    };
    const auto add = [&](const std::vector<double>& controls, CandidateKind kind) {
      if (taken.insert(controls).second) add_all({controls}, kind);
    };
    if (known) {
      const std::vector<std::vector<double>> again = few(observed.of_this);
      for (const auto& controls : again) add(controls, CandidateKind::repeat);
      if (again.size() > 1) add_all(again, CandidateKind::repeat);
      for (const auto& controls : few(observed.of_any))  // where only others were read
        if (!near_observed(observed.of_this, controls)) add(controls, CandidateKind::setting);
    }
    // One control at a time, the others as they were measured.
    const std::vector<double> centre =
        *std::next(observed.of_any.begin(), static_cast<std::ptrdiff_t>(observed.of_any.size() / 2));
    const int count = known ? options_.settings : options_.settings_other;
    bool any = false;
    for (std::size_t c = 0; c < study_.controls.size(); ++c) {
      if (!varied(emulator, c)) continue;
      any = true;
      const auto [low, high] = range_of(study_, emulator, c);
      for (int i = 0; i < count; ++i) {
        std::vector<double> controls = centre;
        const data::Axis covered{low, high, study_.controls[c].scale};
        const double value = covered.from_unit(i / (count - 1.0));
        controls[c] =
            std::clamp(study_.controls[c].unit.rounded(value, 2), study_.controls[c].low, study_.controls[c].high);
        if (known && near_observed(observed.of_this, controls)) continue;
        add(controls, known ? CandidateKind::setting : CandidateKind::output);
      }
    }
    if (!known && !any) add(centre, CandidateKind::output);
  }

  /// Within a hundredth of every control's range of a setting that is there.
  bool near_observed(const std::set<std::vector<double>>& observed, const std::vector<double>& controls) const {
    return std::any_of(observed.begin(), observed.end(), [&](const std::vector<double>& other) {
      for (std::size_t c = 0; c < controls.size(); ++c)
        if (const data::Axis axis = study_.controls[c].axis();
            std::abs(axis.to_unit(other[c]) - axis.to_unit(controls[c])) > 0.01)
          return false;
      return true;
    });
  }

  /// The observed settings; a dozen of them where they are many.
  static std::vector<std::vector<double>> few(const std::set<std::vector<double>>& observed) {
    std::vector<std::vector<double>> all(observed.begin(), observed.end());
    constexpr std::size_t most = 12;
    if (all.size() <= most) return all;
    std::vector<std::vector<double>> some;
    for (std::size_t i = 0; i < most; ++i) some.push_back(all[i * (all.size() - 1) / (most - 1)]);
    return some;
  }

  const Study& study_;
  const std::vector<Emulator>& emulators_;
  std::vector<std::size_t> sets_;
  const CandidateOptions& options_;
  std::vector<Candidate> found_;
};

/// The candidates of one entry of [plan] for a case.
class Entry {
 public:
  Entry(const Study& study, const std::vector<Emulator>& emulators, std::size_t case_index,
        const data::PlanEntry& entry, const CandidateOptions& options, std::vector<data::Problem>& problems)
      : study_(study),
        emulators_(emulators),
        sets_(own_sets(study, case_index)),
        entry_(entry),
        options_(options),
        problems_(problems) {}

  std::vector<Candidate> all() {
    Candidate base{.kind = CandidateKind::setting, .material = entry_.material, .outputs = entry_.outputs};
    if (base.material.empty() && !sets_.empty()) base.material = study_.observations[sets_.front()].material;
    base.cost = entry_.cost;
    base.readings = entry_.readings;
    base.common_error = entry_.common_error;
    base.stated_error = entry_.error.has_value();
    bool measured = false;
    for (const std::size_t output : base.outputs) {
      const std::optional<data::Spread> stated = stated_error(study_, sets_, output);
      measured = measured || stated;
      if (!entry_.error && !stated)
        problem(fmt::format("no error of {} is known: the case does not measure it", study_.outputs[output].name),
                "state error = \"3 %\", or a value with its unit");
      base.error.push_back(entry_.error ? *entry_.error
                                        : stated.value_or(data::Spread{.relative = options_.assumed_error}));
      base.model_only = base.model_only || only_of_model(study_, sets_, output, base.material, options_);
      if (emulator_of(emulators_, base.material, output) == nullptr)
        problem(fmt::format("there are no runs of material '{}' with {}", base.material, study_.outputs[output].name),
                "simulate it, or leave the output out");
    }
    if (!measured) base.kind = CandidateKind::output;
    const std::vector<std::vector<double>> points = grid(base);
    std::vector<Candidate> found;
    for (const auto& controls : points) {
      if (entry_.together && !found.empty()) {
        found.back().settings.push_back(controls);
        continue;
      }
      base.settings = {controls};
      found.push_back(base);
    }
    for (Candidate& one : found) {
      const bool repeat =
          one.kind == CandidateKind::setting &&
          std::all_of(one.settings.begin(), one.settings.end(), [&](const auto& p) { return is_observed(p, one); });
      if (repeat) one.kind = CandidateKind::repeat;
      one.name = name_of(study_, one, false);
      if (!entry_.name.empty()) one.name = found.size() == 1 ? entry_.name : entry_.name + ": " + one.name;
    }
    return found;
  }

 private:
  void problem(std::string what, std::string remedy) {
    problems_.push_back({entry_.place, std::move(what), std::move(remedy)});
  }

  /// Whether the case's data have every output of a candidate there, of its material.
  bool is_observed(const std::vector<double>& controls, const Candidate& candidate) const {
    return std::all_of(candidate.outputs.begin(), candidate.outputs.end(), [&](std::size_t output) {
      return std::any_of(sets_.begin(), sets_.end(), [&](std::size_t index) {
        const data::ObservationSet& set = study_.observations[index];
        return set.material == candidate.material && settings_of(set, output).contains(controls);
      });
    });
  }

  /// All combinations of the values stated; a control without any has the one value that the case's data have.
  std::vector<std::vector<double>> grid(const Candidate& base) {
    std::vector<std::vector<double>> points = {{}};
    const Emulator* emulator = emulator_of(emulators_, base.material, base.outputs.front());
    for (std::size_t c = 0; c < study_.controls.size(); ++c) {
      std::vector<double> values = entry_.settings[c];
      if (values.empty()) {
        std::set<double> observed;
        for (const std::size_t index : sets_)
          for (const data::Observation& point : study_.observations[index].points) observed.insert(point.controls[c]);
        if (observed.size() != 1) {
          problem(fmt::format("settings.{} is missing, and the data have {} values of it", study_.controls[c].name,
                              observed.size()),
                  fmt::format("state settings = {{ {} = ... }}", study_.controls[c].name));
          return {};
        }
        values.assign(observed.begin(), observed.end());
      }
      if (emulator != nullptr) {
        const auto [low, high] = range_of(study_, *emulator, c);
        const data::Unit& unit = study_.controls[c].unit;
        for (const double value : values)
          if (!within_reach(study_.controls[c], value, {low, high}))
            problem(fmt::format("{} {:g}{} is outside the runs of this material, which reach from {:g} to {:g}{}",
                                study_.controls[c].name, unit.from_si(value), behind_number(unit.symbol),
                                unit.from_si(low), unit.from_si(high), behind_number(unit.symbol)),
                    "choose a setting inside, or make runs there");
      }
      std::vector<std::vector<double>> next;
      for (const auto& point : points)
        for (const double value : values) {
          next.push_back(point);
          next.back().push_back(value);
        }
      points = std::move(next);
    }
    return points;
  }

  const Study& study_;
  const std::vector<Emulator>& emulators_;
  std::vector<std::size_t> sets_;
  const data::PlanEntry& entry_;
  const CandidateOptions& options_;
  std::vector<data::Problem>& problems_;
};

}  // namespace

const Emulator* emulator_of(const std::vector<Emulator>& emulators, const std::string& material, std::size_t output) {
  for (const Emulator& one : emulators)
    if (one.material == material && one.output == output) return &one;
  return nullptr;
}

bool reaches(const Study& study, const Emulator& emulator, const std::vector<double>& setting) {
  for (std::size_t c = 0; c < setting.size(); ++c)
    if (!within_reach(study.controls[c], setting[c], range_of(study, emulator, c))) return false;
  return true;
}

std::vector<std::size_t> own_sets(const Study& study, std::size_t case_index) {
  std::vector<std::size_t> sets;
  for (const std::string& name : study.cases[case_index].observe) sets.push_back(study.observation_index(name).value());
  return sets;
}

std::vector<Candidate> candidates_of(const Study& study, const std::vector<Emulator>& emulators, std::size_t case_index,
                                     const data::PlanSection& plan, const CandidateOptions& options) {
  if (plan.candidates.empty()) return Usual(study, emulators, case_index, options).all();
  std::vector<data::Problem> problems;
  std::vector<Candidate> found;
  for (const data::PlanEntry& entry : plan.candidates) {
    std::vector<Candidate> more = Entry(study, emulators, case_index, entry, options, problems).all();
    for (Candidate& one : more)
      one.meter = entry.common_error ? fmt::format("planned {}", &entry - plan.candidates.data()) : entry.meter;
    found.insert(found.end(), more.begin(), more.end());
  }
  if (!problems.empty()) throw data::InputError(data::ExitStatus::bad_study, problems);
  return found;
}

}  // namespace uq::plan
