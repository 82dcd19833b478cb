#include "uq/posterior/support_words.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace uq {
namespace {

std::string percent(double share) { return fmt::format("{:.0f} %", 100.0 * share); }

std::string interval(double low, double high, const std::string& unit) {
  return fmt::format("{:.3g} to {:.3g}{}{}", low, high, unit.empty() ? "" : " ", unit);
}

}  // namespace

std::string support_sentence(const SupportReport& report, const SupportThresholds& t, const std::string& empty) {
  std::vector<std::pair<double, std::string>> reasons;
  const bool several = std::any_of(report.inputs.begin(), report.inputs.end(), [&](const InputSupport& input) {
    return input.material != report.inputs.front().material;
  });
  const auto add = [&](double share, std::string text) {
    if (std::none_of(reasons.begin(), reasons.end(), [&](const auto& known) { return known.second == text; }))
      reasons.emplace_back(share, std::move(text));  // surrogates of several outputs mostly have the same runs
  };
  for (const InputSupport& input : report.inputs) {
    const std::string name = input.name + (several ? " of " + input.material : "");
    if (input.outside > 0.5 * t.share)
      add(input.outside, fmt::format("{} beyond the runs' {}, {}", percent(input.outside), name,
                                     interval(input.runs_low, input.runs_high, input.unit)));
    if (input.gap > 0.5 * t.share)
      add(input.gap, fmt::format("{} in a gap of the runs' {}, {}", percent(input.gap), name,
                                 interval(input.gap_low, input.gap_high, input.unit)));
  }
  if (report.empty > 0.5 * t.share)
    reasons.emplace_back(report.empty,
                         fmt::format("{} in an empty part of the runs' plane of {}", percent(report.empty), empty));
  if (report.uncertain > 0.5 * t.share)
    reasons.emplace_back(report.uncertain, fmt::format("{} where the surrogate knows little more than without any runs",
                                                       percent(report.uncertain)));
  std::stable_sort(reasons.begin(), reasons.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::string text = fmt::format("{} of the posterior lies where no run speaks", percent(report.unsupported));
  for (std::size_t i = 0; i < std::min<std::size_t>(reasons.size(), 2); ++i)
    text += (i == 0 ? ": " : "; ") + reasons[i].second;
  return text;
}

std::vector<std::pair<std::string, std::string>> describe(const SupportThresholds& t) {
  return {{"unsupported share of a posterior", fmt::format("at most {:g} of the draws", t.share)},
          {"a draw beyond the runs",
           fmt::format("by more than {:g} mean spacings of their values, {:g} to {:g} of the range", t.slack_gaps,
                       t.slack_least, t.slack_most)},
          {"a gap in the runs", fmt::format("{:g} times the mean of the other spacings, and at least {:g} of the range",
                                            t.gap_factor, t.gap_least)},
          {"surrogate without support",
           fmt::format("its variance is at least {:.2g} of what it would be without runs", t.uncertain)}};
}

}  // namespace uq
