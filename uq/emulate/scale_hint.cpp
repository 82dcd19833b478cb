#include "uq/emulate/scale_hint.hpp"

#include <fmt/format.h>

namespace uq {
namespace {

bool log_is_worth_a_try(data::Scale scale, std::pair<double, double> covered) {
  return scale != data::Scale::log && covered.first > 0.0 && covered.second >= wide_control * covered.first;
}

}  // namespace

std::string scale_hint(const data::Study& study, const std::map<std::size_t, std::pair<double, double>>& covered) {
  std::string text;
  for (const auto& [index, range] : covered) {
    const data::Control& control = study.controls[index];
    if (!log_is_worth_a_try(control.scale, range)) continue;
    text += fmt::format(
        "{}If the response bends at low {}, the surrogate misses that on a linear scale: try [controls.{}] scale = "
        "\"log\".",
        text.empty() ? "" : " ", control.name, control.name);
  }
  return text;
}

std::string bend_hint(const data::Study& study, const EmulatorInput& input, std::pair<double, double> covered,
                      bool low) {
  const bool control = input.kind == InputKind::control;
  const std::string& name = control ? study.controls[input.index].name : study.parameters[input.index].name;
  const data::Scale scale = control ? study.controls[input.index].scale : study.parameters[input.index].scale;
  if (low && log_is_worth_a_try(scale, covered))
    return fmt::format("Try [{}.{}] scale = \"log\" first.", control ? "controls" : "parameters", name);
  return fmt::format("Make more runs at {} {} first.", low ? "low" : "high", name);
}

}  // namespace uq
