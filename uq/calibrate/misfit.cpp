#include "uq/calibrate/misfit.hpp"
#include "uq/findings/study_units.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

namespace uq {
namespace {

constexpr double quantiles_apart = 3.2897072539029437;  // sds between 5 % and 95 % of a normal law
constexpr double far_off = 3.0;                         // sds
constexpr std::size_t most = 3;                         // points that are named

double deviations(const PredictivePoint& point) {
  const double sd = (point.q95 - point.q05) / quantiles_apart;
  return sd > 0.0 ? std::abs(point.observed - point.mean) / sd : 0.0;
}

}  // namespace

std::string farthest_off(const std::vector<PredictivePoint>& points) {
  std::vector<const PredictivePoint*> off;
  for (const PredictivePoint& point : points)
    if (deviations(point) > far_off) off.push_back(&point);
  if (off.empty()) return {};
  std::stable_sort(off.begin(), off.end(),
                   [](const auto* a, const auto* b) { return deviations(*a) > deviations(*b); });
  std::string text = "Farthest off:";
  for (std::size_t i = 0; i < std::min(off.size(), most); ++i) {
    const PredictivePoint& point = *off[i];
    std::string at;
    for (const auto& [name, value] : point.controls)
      at += fmt::format("{}{} {:.4g}", at.empty() ? " at " : ", ", name, value);
    text += fmt::format("{} {} {:.4g}{}{} of {}, where the model gives {:.4g} ({:.2g} sd)", i == 0 ? "" : ";",
                        point.output, point.observed, behind_number(point.unit), at, point.observation_set, point.mean,
                        deviations(point));
  }
  if (off.size() > most) text += fmt::format("; and {} more", off.size() - most);
  return text + ".";
}

}  // namespace uq
