// The knowledge of a measurement beside its numbers: the meter's offset, gain, noise and common error, settings known
// only within an uncertainty, the machine's scale, and the model's discrepancy.
//
// Default priors, where a study only asks for an unknown:
//   noise = "unknown"     log-normal with median 1 and sd 1 of the logarithm, on 0.1 to 10 times the standard errors
//   discrepancy = true    sd: half-normal of scale 0.1, as a share of the root mean square of the measured values;
//                         length: log-normal with median 0.5 and sd 0.7, in ranges of the controls
// A table without `kind` is a normal prior. Ranges not given: six sd about the mean.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "data/edit_distance.hpp"
#include "data/file_name.hpp"
#include "data/study_keys.hpp"
#include "data/study_parts.hpp"

namespace data {
namespace {

bool is_percent(const Section& section, std::string_view key) {
  return section.kind(key) == ValueKind::text && section.text(key).find('%') != std::string::npos;
}

constexpr double noise_sd = 1.0, noise_low = 0.1, noise_high = 10.0;
constexpr double discrepancy_scale = 0.1, discrepancy_length = 0.5, discrepancy_length_sd = 0.7;

/// Where a nuisance's numbers lie when the study does not say.
struct Usual {
  std::optional<double> mean = {};  ///< SI
  double low = -INFINITY;           ///< SI, physical
};

/// The range of a nuisance's prior, from its own numbers.
void find_range(const Section& section, Parameter& parameter, const Usual& usual) {
  Prior& prior = parameter.prior;
  const auto bound = [&](std::string_view key, double otherwise) {
    return section.has(key) ? section.quantity(key, parameter.unit.si_symbol, any_number, {}, bare_unit(parameter.unit))
                            : otherwise;
  };
  const bool logarithmic = prior.kind == PriorKind::log_normal;
  const bool own_range =
      prior.kind == PriorKind::uniform || prior.kind == PriorKind::log_uniform || prior.kind == PriorKind::beta;
  if (own_range)
    for (const char* key : {"low", "high"})
      if (!section.has(key))
        section.problem(key, "is missing, and this prior has no other bounds", "state low and high, or a normal prior");
  const double low = logarithmic ? prior.mean * std::exp(-6.0 * prior.sd) : prior.mean - 6.0 * prior.sd;
  const double high = logarithmic ? prior.mean * std::exp(6.0 * prior.sd) : prior.mean + 6.0 * prior.sd;
  parameter.low = std::max(bound("low", own_range ? 0.0 : low), usual.low);
  parameter.high = bound("high", own_range ? 1.0 : high);
  if (logarithmic || (prior.kind == PriorKind::log_uniform && parameter.low > 0.0)) parameter.scale = Scale::log;
  if (!(parameter.low < parameter.high))
    section.has("low") || section.has("high")
        ? section.problem("low", "leaves nothing below high", "choose low < high, and high above what is physical")
        : section.problem(
              "mean", fmt::format("{:g} leaves nothing above {:g}, the least that is physical", prior.mean, usual.low),
              "correct the mean, or state low and high");
}

/// A table of a prior; `usual.mean` stands in for a missing mean.
Parameter read_unknown(const Section& section, const std::string& name, const Unit& unit, const Usual& usual) {
  Parameter parameter{.name = name, .target = name, .unit = unit, .place = section.place()};
  Prior& prior = parameter.prior;
  if (section.has("posterior")) {
    prior = read_prior(section, parameter, PriorOf::case_);
    return parameter;
  }
  const Unit difference = unit.differences();
  if (!section.has("kind") || section.text("kind") == "normal") {
    prior.kind = PriorKind::normal;
    prior.mean = section.quantity("mean", unit.si_symbol, any_number, usual.mean, bare_unit(unit));
    prior.sd = section.difference("sd", unit.si_symbol, positive, {}, bare_unit(difference));
    prior.place = section.place();
    find_range(section, parameter, usual);
    prior.low = parameter.low;
    prior.high = parameter.high;
    return parameter;
  }
  // First the numbers, which tell the range. The prior is cut to it; a beta's ends are part of its law and stay, and
  // what lies outside the range has no mass.
  parameter.low = -INFINITY;
  parameter.high = INFINITY;
  prior = read_prior(section, parameter, PriorOf::case_);
  find_range(section, parameter, usual);
  if (prior.kind == PriorKind::beta) return parameter;
  prior.low = std::max(prior.low, parameter.low);
  prior.high = std::min(prior.high, parameter.high);
  return parameter;
}

std::optional<std::size_t> read_output(const Section& section, const Study& study,
                                       std::optional<std::size_t> otherwise) {
  if (!section.has("output")) return otherwise;
  std::vector<std::string> names;
  for (const Output& output : study.outputs) names.push_back(output.name);
  const std::string chosen = section.choice("output", names);
  return static_cast<std::size_t>(std::find(names.begin(), names.end(), chosen) - names.begin());
}

Nuisance noise_of(const Section& section, const Study& study) {
  Parameter parameter{.name = "noise", .target = "noise", .low = noise_low, .high = noise_high, .scale = Scale::log};
  parameter.prior = {.kind = PriorKind::log_normal, .low = noise_low, .high = noise_high, .mean = 1.0, .sd = noise_sd};
  if (section.kind("noise") == ValueKind::text) {
    section.choice("noise", {"unknown"});
    return {NuisanceKind::noise_scale, {}, parameter};
  }
  const Section table = section.child("noise");
  if (!table.flag("absolute", false)) {
    parameter = read_unknown(table, "noise", {}, {.mean = 1.0, .low = 1e-3});
    return {NuisanceKind::noise_scale, read_output(table, study, {}), parameter};
  }
  const std::size_t output = read_output(table, study, 0).value();
  const Unit unit = study.outputs[output].unit.differences();
  parameter = read_unknown(table, "noise", unit, {.mean = {}, .low = 0.0});
  return {NuisanceKind::noise_sd, output, parameter};
}

/// sd and length of the discrepancy process.
std::vector<Nuisance> discrepancy_of(const Section& section, const Study& study) {
  double scale = discrepancy_scale, length = discrepancy_length;
  std::optional<std::size_t> output;
  if (section.kind("discrepancy") != ValueKind::table) {
    if (!section.flag("discrepancy", false)) return {};
  } else {
    const Section table = section.child("discrepancy");
    scale = table.number("sd", {.low = 0.0, .high = 1.0, .open_low = true}, scale);
    length = table.number("length", {.low = 0.01, .high = 10.0}, length);
    output = read_output(table, study, {});
  }
  Parameter sd{.name = "discrepancy_sd", .target = "discrepancy_sd", .low = 0.0, .high = 5.0 * scale};
  sd.prior = {.kind = PriorKind::truncated_normal, .low = 0.0, .high = sd.high, .mean = 0.0, .sd = scale};
  Parameter reach{.name = "discrepancy_length",
                  .target = "discrepancy_length",
                  .low = 0.1 * length,
                  .high = 10.0 * length,
                  .scale = Scale::log};
  reach.prior = {
      .kind = PriorKind::log_normal, .low = reach.low, .high = reach.high, .mean = length, .sd = discrepancy_length_sd};
  return {{NuisanceKind::discrepancy_sd, output, sd}, {NuisanceKind::discrepancy_length, output, reach}};
}

}  // namespace

Spread read_spread(const Section& section, std::string_view key, const Unit& unit, BareNumber bare,
                   const Unit* section_unit) {
  Spread spread;
  const bool number = section.kind(key) == ValueKind::number;
  if (is_percent(section, key) || (number && bare == BareNumber::share)) {
    spread.relative = section.quantity(key, "1", {.low = 0.0, .high = 1.0, .open_low = true});
    if (unit.offset != 0.0)
      section.problem(key, fmt::format("is a share of a value in {}, whose zero is arbitrary", unit.symbol),
                      fmt::format("state it as a difference, such as \"1 {}\"", unit.si_symbol));
    return spread;
  }
  const Unit difference = section_unit != nullptr ? section_unit->differences() : Unit{};
  spread.absolute =
      section.difference(key, unit.si_symbol, positive, {}, section_unit != nullptr ? &difference : nullptr);
  return spread;
}

void read_rig_scale(const Section& root, Study& study) {
  if (!root.has("rig")) return;
  const Section rig = root.child("rig");
  if (rig.kind("scale") == ValueKind::missing) return;
  RigScale scale;
  if (rig.kind("scale") == ValueKind::table) {
    scale.unknown = Nuisance{NuisanceKind::scale, 0, read_unknown(rig.child("scale"), "scale", {}, {.low = 1e-6})};
    scale.value = scale.unknown->parameter.prior.mean;
  } else {
    scale.value = rig.number("scale", positive);
  }
  study.scale = scale;
}

std::optional<SettingError> read_uncertainty(const Section& section, std::string_view key, const Control& control,
                                             const Unit* section_unit) {
  SettingError error{.control = 0, .spread = {}, .place = section.place(key)};
  switch (section.kind(key)) {
    case ValueKind::missing:
      return {};
    case ValueKind::table: {
      const Section table = section.child(key);
      if (table.kind("sd") == ValueKind::missing) {
        table.quantity("sd", control.unit.si_symbol, positive, {}, section_unit);  // says what is missing
        return {};
      }
      error.spread = read_spread(table, "sd", control.unit, BareNumber::value, section_unit);
      error.as = table.choice("as", error.as);
      return error;
    }
    default:
      error.spread = read_spread(section, key, control.unit, BareNumber::value, section_unit);
      return error;
  }
}

void read_measurement(const Section& root, const Section& section, const Study& study, ObservationSet& set) {
  // A machine's torque says nothing of a slice's until a scale joins them.
  if (root.has("rig")) {
    const std::string simulated = root.child("rig").text("kind", "slice");
    const std::string measured = section.choice("rig", words_of("rig.kind"), simulated);
    set.of_machine = simulated == "slice" && measured != "slice";
    if (set.of_machine && !study.scale)
      section.problem("rig", "is the whole machine, but the runs simulate a slice of it, and nothing says how many",
                      "state [rig] scale = PITCHES PER MACHINE, or scale = { mean = ..., sd = ... }");
    if (set.of_machine)
      for (const std::size_t output : set.outputs)
        if (output != 0)
          section.problem("file",
                          fmt::format("measures {} on the machine, and [rig] scale is of {} only",
                                      study.outputs[output].name, study.outputs[0].name),
                          "leave that column out");
  }

  if (section.kind("common_error") == ValueKind::table) {
    const Section table = section.child("common_error");
    for (const std::size_t output : set.outputs)
      if (const std::string& name = study.outputs[output].name; table.has(name))
        set.common_errors.push_back({output, read_spread(table, name, study.outputs[output].unit, BareNumber::share)});
  } else if (section.kind("common_error") != ValueKind::missing) {
    const std::vector<std::size_t> outputs = set.outputs.empty() ? std::vector<std::size_t>{0} : set.outputs;
    const Spread spread = read_spread(section, "common_error", study.outputs[outputs[0]].unit, BareNumber::share);
    if (outputs.size() > 1 && spread.absolute > 0.0)
      section.problem(
          "common_error", fmt::format("is a value with a unit, and '{}' measures {} outputs", set.name, outputs.size()),
          fmt::format(
              "say whose it is: common_error = {{ {} = {} }}", study.outputs[outputs[0]].name,
              section.kind("common_error") == ValueKind::text ? '"' + section.text("common_error") + '"' : "..."));
    // A share holds of every output, each of which has an error of its own.
    for (const std::size_t output : outputs) set.common_errors.push_back({output, spread});
  }

  if (section.has("meter")) {
    set.meter = section.text("meter");
    if (!is_file_name(set.meter))
      section.problem("meter", fmt::format("'{}' cannot be part of an unknown's name", set.meter),
                      "use at most 100 letters, digits, '-', '_' and '.', beginning with a letter");
    if (set.common_errors.empty())
      section.problem("meter",
                      fmt::format("'{}' has no error that '{}' could share with other sets", set.meter, set.name),
                      "state common_error, as the meter's certificate has it, or leave meter out");
  }

  const Section uncertainties = section.child("uncertainty");
  for (std::size_t c = 0; c < study.controls.size(); ++c) {
    const Control& control = study.controls[c];
    std::optional<SettingError> error = read_uncertainty(uncertainties, control.name, control, nullptr);
    if (!error) error = control.uncertainty;
    if (!error) continue;
    error->control = c;
    const bool varies = std::any_of(set.points.begin(), set.points.end(), [&](const Observation& point) {
      return point.controls[c] != set.points.front().controls[c];
    });
    if (error->as == SettingErrorAs::unknown && varies)
      section.problem(
          "uncertainty",
          fmt::format("{} differs from point to point of '{}', so it is not one unknown", control.name, set.name),
          "as = \"shared\" is one error of all points, as a tachometer has; without as, each point has its own");
    set.setting_errors.push_back(*error);
  }
}

namespace {

/// Index of an output by name that the set has readings of; none is a problem of the section.
std::optional<std::size_t> read_measured_output(const Section& section, const Study& study, const ObservationSet& set,
                                                const std::string& name) {
  for (const std::size_t output : set.outputs)
    if (study.outputs[output].name == name) return output;
  std::vector<std::string> names;
  for (const std::size_t output : set.outputs) names.push_back(study.outputs[output].name);
  section.problem("between", fmt::format("'{}' is no output that '{}' measures", name, set.name),
                  fmt::format("it measures {}", fmt::join(names, ", ")));
  return {};
}

}  // namespace

void read_correlations(const Section& root, Study& study) {
  std::size_t index = 0;
  for (const Section& observe : root.array("observe")) {
    ObservationSet& set = study.observations[index++];
    for (const Section& section : observe.array("correlation")) {
      ErrorCorrelation found{.other_set = section.text("with", ""), .place = section.place()};
      found.value = section.number("value", {.low = -1.0, .high = 1.0, .open_low = true, .open_high = true});
      const std::vector<std::string> between = section.texts("between", true);
      if (between.size() != 2) {
        if (section.has("between"))
          section.problem("between", fmt::format("names {} outputs, but a correlation is of two", between.size()),
                          "name two outputs");
        continue;
      }
      const std::optional<std::size_t> other =
          found.other_set.empty() ? index - 1 : study.observation_index(found.other_set);
      if (!other) {
        section.problem("with", fmt::format("there is no observation set '{}'", found.other_set),
                        "name an [[observe]], or leave with out where one file has both outputs");
        continue;
      }
      const auto first = read_measured_output(section, study, set, between[0]);
      const auto second = read_measured_output(section, study, study.observations[*other], between[1]);
      if (!first || !second) continue;
      if (*other == index - 1 && *first == *second) {
        section.problem("between", fmt::format("names {} twice", between[0]), "name two outputs");
        continue;
      }
      found.output = *first;
      found.other_output = *second;
      found.other_set = study.observations[*other].name;
      set.correlations.push_back(std::move(found));
    }
  }
}

std::map<std::string, double> read_settings(const Section& section, const Study& study) {
  std::map<std::string, double> settings;
  for (const Control& control : study.controls)
    if (section.has(control.name))
      settings[control.name] =
          section.quantity(control.name, control.unit.si_symbol, any_number, {}, bare_unit(control.unit));
  return settings;
}

std::vector<Nuisance> read_nuisances(const Section& section, const Study& study) {
  std::vector<Nuisance> found;
  if (section.has("offset")) {
    const Section table = section.child("offset");
    const std::size_t output = read_output(table, study, 0).value();
    found.push_back({NuisanceKind::offset, output,
                     read_unknown(table, "offset", study.outputs[output].unit.differences(), {.mean = 0.0})});
  }
  if (section.has("gain")) {
    const Section table = section.child("gain");
    found.push_back({NuisanceKind::gain, read_output(table, study, 0),
                     read_unknown(table, "gain", {}, {.mean = 1.0, .low = 1e-3})});
  }
  if (section.has("noise")) found.push_back(noise_of(section, study));
  for (Nuisance& part : discrepancy_of(section, study)) found.push_back(std::move(part));
  return found;
}

}  // namespace data
