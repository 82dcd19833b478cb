// [parameters], [controls] and [outputs]: names, units, ranges and priors.
#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

#include "data/study_parts.hpp"
#include "data/unit_text.hpp"

namespace data {
namespace {

Unit read_unit(const Section& section, const std::string& fallback) {
  const std::string symbol = section.text("unit", fallback);
  try {
    return parse_unit(symbol);
  } catch (const std::invalid_argument& unknown) {
    for (const char* dimension : {"N m", "degree", "rpm", "s"})  // "mNm", "deg", "U/min": as instruments spell them
      if (const auto meant = unit_meant(symbol, dimension)) return *meant;
    section.problem("unit", unknown.what(), "write it like \"mN m\", \"rpm\" or \"kg/m3\"");
    return {};
  }
}

/// A value in the parameter's unit as a person reads it.
std::string shown(double si, const Unit& unit) {
  return fmt::format("{:.10g}{}", unit.from_si(si), behind_number(unit.symbol));
}

double read_value(const Section& section, std::string_view key, const Unit& unit, Range range = any_number) {
  return section.quantity(key, unit.si_symbol, range, {}, bare_unit(unit));
}

void check_order(const Section& section, double low, double high, const Unit& unit) {
  if (section.has("low") && section.has("high") && !(low < high)) {
    section.problem("low", fmt::format("{} is not below high, which is {}", shown(low, unit), shown(high, unit)),
                    "choose low < high");
  }
}

void read_limits(const Section& section, Prior& prior, const Parameter& parameter) {
  const auto bound = [&](std::string_view key, double otherwise) {
    if (!section.has(key)) return otherwise;
    const double value = read_value(section, key, parameter.unit);
    const double slack = 1e-12 * (parameter.high - parameter.low);
    if (value < parameter.low - slack || value > parameter.high + slack) {
      section.problem(key,
                      fmt::format("{} is outside the parameter's range, {} to {}", shown(value, parameter.unit),
                                  shown(parameter.low, parameter.unit), shown(parameter.high, parameter.unit)),
                      "narrow the prior or widen the range; nothing is simulated outside it");
      return otherwise;
    }
    return value;
  };
  prior.low = bound("low", parameter.low);
  prior.high = bound("high", parameter.high);
  if (!(prior.low < prior.high) && parameter.low < parameter.high) {
    section.problem("low",
                    fmt::format("{} is not below high, which is {}", shown(prior.low, parameter.unit),
                                shown(prior.high, parameter.unit)),
                    "choose low < high");
  }
}

void read_mean_and_sd(const Section& section, Prior& prior, const Parameter& parameter) {
  prior.mean = read_value(section, "mean", parameter.unit);
  const Unit difference = parameter.unit.differences();
  const auto in_per_cent = [](const std::string& text) { return text.find('%') != std::string::npos; };
  if (section.kind("sd") == ValueKind::text && in_per_cent(section.text("sd")) && !in_per_cent(parameter.unit.symbol))
    section.problem(
        "sd", "is given in per cent, and a prior's sd is no share of its mean",
        fmt::format("give it {}", is_bare(parameter.unit.symbol) ? "as a number" : "in " + difference.symbol));
  prior.sd = section.difference("sd", parameter.unit.si_symbol, positive, {}, bare_unit(difference));
  const bool given = section.has("mean") && section.has("sd") && prior.sd > 0.0;
  if (given && (prior.mean < prior.low - 3.0 * prior.sd || prior.mean > prior.high + 3.0 * prior.sd)) {
    section.problem(
        "mean",
        fmt::format("{} is over three sd away from the parameter's range, {} to {}", shown(prior.mean, parameter.unit),
                    shown(prior.low, parameter.unit), shown(prior.high, parameter.unit)),
        "move the prior or the range");
  }
}

/// The law that a prior states. Where it states none, the numbers that are there say which one to propose, and are no
/// problems of their own.
PriorKind read_kind(const Section& section) {
  // The last, another case's posterior, is chosen by a key of its own.
  const std::vector<std::string> kinds(texts_of<PriorKind>.begin(), texts_of<PriorKind>.end() - 1);
  const std::vector<std::string> numbers{"mean", "sd", "median", "alpha", "beta"};
  if (!section.has("kind")) {
    const PriorKind proposed = section.has("alpha")    ? PriorKind::beta
                               : section.has("median") ? PriorKind::log_normal
                               : section.has("sd")     ? PriorKind::normal
                                                       : PriorKind::uniform;
    section.problem("kind", "is missing",
                    fmt::format("add a line kind = \"{}\", or one of {}", to_text(proposed), fmt::join(kinds, ", ")));
    section.pass_over(numbers);
    return PriorKind::uniform;
  }
  const std::string chosen = section.choice("kind", kinds);
  if (section.kind("kind") != ValueKind::text || section.text("kind") != chosen) section.pass_over(numbers);
  return from_text<PriorKind>(chosen).value_or(PriorKind::uniform);
}

}  // namespace

const Unit* bare_unit(const Unit& unit) { return is_bare(unit.symbol) ? nullptr : &unit; }

Scale read_scale(const Section& section, double low, const Unit& unit) {
  if (section.choice("scale", Scale::linear) == Scale::linear) return Scale::linear;
  if (section.has("low") && !(low > 0.0))
    section.problem("low", fmt::format("{} has no logarithm", shown(low, unit)),
                    "choose low above 0, or scale = \"linear\"");
  return Scale::log;
}

const std::set<std::string>& reserved_columns() {
  static const std::set<std::string> names{"material", "seed", "settings", "isa", "origin", "cpu_seconds"};
  return names;
}

Prior read_prior(const Section& section, const Parameter& parameter, PriorOf owner) {
  Prior prior{.low = parameter.low, .high = parameter.high, .place = section.place()};
  prior.stated = section.exists();
  if (!prior.stated) return prior;
  if (owner == PriorOf::case_ && section.has("posterior")) {
    prior.kind = PriorKind::posterior;
    prior.posterior_of = section.text("posterior");
    prior.cut = section.flag("cut", false);
    return prior;
  }
  prior.kind = read_kind(section);
  switch (prior.kind) {
    case PriorKind::uniform:
      read_limits(section, prior, parameter);
      break;
    case PriorKind::log_uniform:
      read_limits(section, prior, parameter);
      if (!(prior.low > 0.0))
        section.problem("kind",
                        fmt::format("is log_uniform, but the prior begins at {}", shown(prior.low, parameter.unit)),
                        "give the prior a low above 0");
      break;
    case PriorKind::normal:
      read_mean_and_sd(section, prior, parameter);
      break;
    case PriorKind::truncated_normal:
      read_limits(section, prior, parameter);
      read_mean_and_sd(section, prior, parameter);
      break;
    case PriorKind::log_normal:
      prior.mean = read_value(section, section.has("mean") ? "mean" : "median", parameter.unit, positive);
      prior.sd = section.number("sd", positive);
      if (parameter.high <= 0.0)
        section.problem("kind", "is log_normal, but the parameter's range holds nothing above 0",
                        "choose another prior");
      break;
    case PriorKind::beta:
      read_limits(section, prior, parameter);
      prior.alpha = section.number("alpha", positive);
      prior.beta = section.number("beta", positive);
      break;
    case PriorKind::posterior:
      break;
  }
  return prior;
}

void read_parameters(const Section& root, Study& study) {
  for (const auto& [name, section] : root.child("parameters").children()) {
    Parameter parameter{.name = name, .target = section.text("target", name), .place = section.place()};
    parameter.unit = read_unit(section, "");
    parameter.low = read_value(section, "low", parameter.unit);
    parameter.high = read_value(section, "high", parameter.unit);
    check_order(section, parameter.low, parameter.high, parameter.unit);
    parameter.scale = read_scale(section, parameter.low, parameter.unit);
    parameter.prior = read_prior(section.child("prior"), parameter, PriorOf::parameter);
    study.parameters.push_back(std::move(parameter));
  }
}

void read_controls(const Section& root, Study& study) {
  for (const auto& [name, section] : root.child("controls").children()) {
    Control control{.name = name, .target = section.text("target", name), .place = section.place()};
    control.unit = read_unit(section, "");
    control.low = read_value(section, "low", control.unit);
    control.high = read_value(section, "high", control.unit);
    check_order(section, control.low, control.high, control.unit);
    control.scale = read_scale(section, control.low, control.unit);
    control.uncertainty = read_uncertainty(section, "uncertainty", control, bare_unit(control.unit));
    if (control.uncertainty) control.uncertainty->control = study.controls.size();
    study.controls.push_back(std::move(control));
  }
}

void read_outputs(const Section& root, Study& study) {
  const Section outputs = root.child("outputs");
  for (const auto& [name, section] : outputs.children()) {
    study.outputs.push_back({.name = name, .unit = read_unit(section, ""), .place = section.place()});
  }
  if (study.outputs.empty()) {
    study.outputs.push_back({.name = "torque", .unit = parse_unit("N m"), .place = outputs.place()});
  }
}

void check_column_names(const Section& root, const Study& study) {
  std::map<std::string, std::string> taken;  // column -> what it is
  const auto check = [&](const Section& section, const std::string& name, const std::string& what) {
    const bool letters =
        name.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789_") == std::string::npos;
    if (name.empty() || !letters || (name.front() >= '0' && name.front() <= '9')) {
      section.problem(name, "is not a name", "use letters, digits and _, beginning with a letter");
    } else if (reserved_columns().count(name) > 0) {
      section.problem(name, "is a column that the run table keeps for itself", "choose another name");
    } else if (const auto [old, is_new] = taken.emplace(name, what); !is_new) {
      section.problem(name, fmt::format("the name is taken by {}", old->second), "choose another name");
    }
  };
  const Section parameters = root.child("parameters"), controls = root.child("controls"),
                outputs = root.child("outputs");
  for (const Parameter& item : study.parameters) {
    check(parameters, item.name, "a parameter");
    if (item.name == "chain" || item.name == "draw")
      parameters.problem(item.name, "is a dimension of the posterior's file", "choose another name");
  }
  for (const Control& item : study.controls) check(controls, item.name, "a control");
  for (const Output& item : study.outputs) {
    check(outputs, item.name, "an output");
    taken.emplace(item.name + "_se", fmt::format("the standard error of {}", item.name));
  }
  for (const Output& item : study.outputs) {
    if (taken.at(item.name + "_se").rfind("the standard", 0) != 0) {
      outputs.problem(
          item.name,
          fmt::format("the column {}_se of its standard error is {}", item.name, taken.at(item.name + "_se")),
          "choose another name");
    }
  }
}

std::map<std::string, double> read_fixed(const Section& section, const Study& study) {
  std::map<std::string, double> fixed;
  for (const Parameter& parameter : study.parameters) {
    if (section.has(parameter.name)) fixed[parameter.name] = read_value(section, parameter.name, parameter.unit);
  }
  return fixed;
}

}  // namespace data
