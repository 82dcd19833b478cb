#include "uq/emulate/scale_hint.hpp"

#include <fmt/format.h>

namespace uq {

std::string scale_hint(const data::Study& study, const std::map<std::size_t, std::pair<double, double>>& covered) {
  std::string text;
  for (const auto& [index, range] : covered) {
    const data::Control& control = study.controls[index];
    if (control.scale == data::Scale::log || !(range.first > 0.0) || range.second < wide_control * range.first)
      continue;
    text += fmt::format(
        "{}If the response bends at low {}, the surrogate misses that on a linear scale: try [controls.{}] scale = "
        "\"log\".",
        text.empty() ? "" : " ", control.name, control.name);
  }
  return text;
}

}  // namespace uq
