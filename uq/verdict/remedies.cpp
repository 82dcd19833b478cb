#include "uq/verdict/remedies.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "uq/findings/listed.hpp"
#include "uq/findings/thresholds.hpp"

namespace uq {
namespace {

/// A remedy and what share of all widths asks for it.
struct Remedy {
  double weight = 0.0;
  std::string text;
};
using Remedies = std::vector<Remedy>;
constexpr double behind_others = 0.999;  // of the same weight

std::string sentence(std::string text) {
  if (!text.empty() && text.front() >= 'a' && text.front() <= 'z')
    text.front() = static_cast<char>(text.front() - 'a' + 'A');
  return text + ".";
}

/// How it is found by itself.
std::string found_by(const CommonError& error) {
  switch (error.kind) {
    case CommonErrorKind::offset:
      return fmt::format("read the meter without load (the offset {})", error.name);
    case CommonErrorKind::gain:
      return fmt::format("calibrate the meter (the gain {})", error.name);
    case CommonErrorKind::scale:
      return "find the rig's scale with a powder whose parameters are known";
    case CommonErrorKind::setting:
      return error.name.empty() ? "measure the true settings, or measure at more settings"
                                : "measure the true " + error.name;
    case CommonErrorKind::meter:
      return "calibrate the meter";
    case CommonErrorKind::discrepancy:
      break;
  }
  return "measure a quantity that the model gives without a discrepancy";
}

/// `names`: parameters whose width such errors decide; none: they hold a part of some.
std::string common_remedy(const CommonShare& common, const Names& names) {
  const std::string part = common.share >= whole_share
                               ? "nearly all"
                               : fmt::format("{}{:.0f} %", names.size() == 1 ? "" : "up to ", 100.0 * common.share);
  return sentence(
      fmt::format("{}: {} of the variance{} is held by errors that repeated readings share, and neither "
                  "repeats nor smaller errors of each take that away",
                  remedy_of(common.errors), part, names.empty() ? "" : " of " + listed(names)));
}

/// `share`: of the posterior variance, the surrogate's; of the parameter that has most of it.
std::string surrogate_remedy(double share, bool own_engine) {
  const std::string how =
      own_engine ? "demcal train STUDY --until posterior" : "next-runs.csv beside the report has points";
  const std::string runs = fmt::format("Make more training runs where the posterior lies ({}): ", how);
  return runs + (share < whole_share
                     ? fmt::format("up to {:.0f} % of the posterior variance is the surrogate's.", 100.0 * share)
                     : "the surrogate's error decides the widths.");
}

/// Sets of traded parameters with one in `names`, as "friction and hamaker"; of those names alone where there are none.
std::string partners(const CaseFacts& facts, const Names& names) {
  Names together;
  for (const TradedPair& traded : facts.traded)
    if (std::any_of(traded.parameters.begin(), traded.parameters.end(), [&](const std::string& member) {
          return std::find(names.begin(), names.end(), member) != names.end();
        }))
      for (const std::string& member : traded.parameters) add_name(together, member);
  return together.empty() ? std::string() : listed(together);
}

/// Whether parameters of both kinds are traded against each other, so that what parts the one parts the other.
bool of_one_tie(const CaseFacts& facts, const Names& some, const Names& others) {
  if (some.empty() || others.empty()) return false;
  const std::string together = partners(facts, some);
  return !together.empty() && together == partners(facts, others);
}

Remedies part_values(const CaseFacts& facts, const SortedParameters& sorted) {
  if (sorted.several.empty()) return {};
  return {{static_cast<double>(sorted.several.size()),
           facts.parted_by.empty() ? "Measure a quantity, or at a setting, that differs between the values."
                                   : sentence(facts.parted_by)}};
}

Remedies break_structure(const CaseFacts& facts, const SortedParameters& sorted) {
  const Names& names = sorted.structural;
  if (names.empty()) return {};
  const std::string together = partners(facts, names);
  const std::string one = together.empty() ? one_or(names, "it", "one of them") : "one of them";
  const std::string quantity = together.empty()
                                   ? "one that " + listed(names) + " alone " + one_or(names, "changes", "change")
                                   : "one that responds differently to " + together;
  return {
      {sorted.of_structure,
       fmt::format("Measure another kind of quantity, {}, or fix {} by an independent experiment: a smaller error of "
                   "the same measurement will not part them.",
                   quantity, one)}};
}

/// Before the noise is blamed: runs come first where the surrogate has most of a variance, last where it has a part.
Remedies sharpen_surrogate(const CaseFacts& facts, const SortedParameters& sorted) {
  const bool hidden =
      !sorted.practical.empty() || !sorted.surrogate.empty() || !sorted.traded.empty() || !sorted.bound.empty();
  const double variance = sorted.of_measurement + sorted.of_surrogate;
  const double share = variance > 0.0 ? sorted.of_surrogate / variance : 0.0;
  constexpr double a_little = 1e-9;  // beside a measurement's weight
  if (!sorted.surrogate.empty() || (hidden && share >= mostly_share))
    return {{std::max(sorted.of_surrogate, sorted.of_measurement + a_little),
             surrogate_remedy(sorted.largest_surrogate, facts.own_engine)}};
  if (hidden && share >= notable_share)
    return {
        {a_little, fmt::format("More training runs would help, too: up to {:.0f} % of the posterior variance is the "
                               "surrogate's.",
                               100.0 * sorted.largest_surrogate)}};
  return {};
}

Remedies lower_noise(const CaseFacts& facts, const SortedParameters& sorted) {
  if (sorted.practical.empty() || of_one_tie(facts, sorted.structural, sorted.practical)) return {};
  const std::string together = partners(facts, sorted.practical);
  if (of_one_tie(facts, sorted.traded, sorted.practical))  // part_traded says what parts them
    return {{behind_others * sorted.of_measurement,
             fmt::format("A smaller measurement error would do for {} alone.", listed(sorted.practical))}};
  return {{sorted.of_measurement,
           together.empty() ? "Reduce the measurement error, or measure at more settings."
                            : fmt::format("Measure a quantity that responds differently to {}, fix one of them by an "
                                          "independent experiment, or reduce the measurement error.",
                                          together)}};
}

Remedies find_common_error(const CaseFacts&, const SortedParameters& sorted) {
  if (!sorted.common.empty()) return {{sorted.of_common, common_remedy(sorted.largest_common, sorted.common)}};
  if (sorted.largest_common.share < named_share) return {};
  return {{sorted.of_measurement * sorted.largest_common.share, common_remedy(sorted.largest_common, {})}};
}

Remedies part_traded(const CaseFacts& facts, const SortedParameters& sorted) {
  const Names& names = sorted.traded;
  if (names.empty() || of_one_tie(facts, sorted.structural, names)) return {};
  const std::string together = partners(facts, names);
  const std::string one = together.empty() ? one_or(names, "it", "one of them") : "one of them";
  const std::string quantity = together.empty() ? "another kind of quantity, one that " + listed(names) + " alone " +
                                                      one_or(names, "changes", "change")
                                                : "a quantity that responds differently to " + together;
  return {{sorted.of_measurement,
           fmt::format("Measure {}, or fix {} by an independent experiment: that parts them, whatever a smaller error "
                       "of the same measurement would do.",
                       quantity, one)}};
}

Remedies widen_range(const CaseFacts&, const SortedParameters& sorted) {
  if (sorted.one_sided.empty()) return {};
  return {
      {sorted.of_range, fmt::format("Widen the range of {}, with training runs there, or measure where the response "
                                    "still changes with {}.",
                                    listed(sorted.one_sided), one_or(sorted.one_sided, "it", "them"))}};
}

Remedies run_beyond(const CaseFacts& facts, const SortedParameters& sorted) {
  if (sorted.wanted_runs.empty()) return {};
  return {{sorted.of_range, fmt::format("Make training runs {}{}: the range goes on there, and the runs do not.",
                                        listed(sorted.wanted_runs), facts.own_engine ? "" : " with your code")}};
}

Remedies widen_range_of_other(const CaseFacts& facts, const SortedParameters& sorted) {
  const bool widened = std::all_of(sorted.ends_of.begin(), sorted.ends_of.end(), [&](const std::string& name) {
    return std::find(sorted.one_sided.begin(), sorted.one_sided.end(), name) != sorted.one_sided.end();
  });
  if (sorted.conditional.empty() || widened) return {};
  Names parameters, nuisances;  // no run varies a nuisance of the measurement
  for (const std::string& name : sorted.ends_of) {
    const bool parameter = std::any_of(facts.parameters.begin(), facts.parameters.end(),
                                       [&](const ParameterReport& one) { return one.name == name; });
    add_name(parameter ? parameters : nuisances, name);
  }
  Remedies remedies;
  if (!parameters.empty())
    remedies.push_back(
        {sorted.of_range, fmt::format("Widen the range of {}, with training runs there.", listed(parameters))});
  if (!nuisances.empty())
    remedies.push_back({sorted.of_range, fmt::format("Widen the range of {}, or find {} by a calibration of the meter.",
                                                     listed(nuisances), one_or(nuisances, "it", "them"))});
  return remedies;
}

Remedies move_bound(const CaseFacts&, const SortedParameters& sorted) {
  if (sorted.bound.empty()) return {};
  return {{sorted.of_measurement,
           fmt::format(
               "A smaller measurement error would lower the limit of {0} or show a value, as far as what is measured "
               "changes with {1} below the limit; where it does not, measure at other settings, or another quantity.",
               listed(sorted.bound), one_or(sorted.bound, "it", "them"))}};
}

/// Last, whatever the widths: what was measured has nothing to do with these.
Remedies move_silent(const CaseFacts& facts, const SortedParameters&) {
  Names silent;
  for (const ParameterReport& parameter : facts.parameters)
    if (parameter.reason == Reason::no_influence) silent.push_back(parameter.name);
  if (silent.empty()) return {};
  return {
      {0.0, fmt::format("Measure another quantity, or at other settings, that {} {}; or fix {}: what was measured does "
                        "not depend on {}.",
                        listed(silent), one_or(silent, "moves", "move"), one_or(silent, "it", "them"),
                        one_or(silent, "it", "them"))}};
}

}  // namespace

std::string remedy_of(const std::vector<CommonError>& errors) {
  Names ways;
  for (const CommonError& error : errors) add_name(ways, found_by(error));
  return ways.empty() ? std::string() : listed(ways);
}

std::vector<std::string> find_remedies(const CaseFacts& facts, const SortedParameters& sorted) {
  if (sorted.known.size() == facts.parameters.size()) return {};
  Remedies remedies;
  for (const auto rule : {part_values, break_structure, sharpen_surrogate, lower_noise, find_common_error, part_traded,
                          widen_range, run_beyond, widen_range_of_other, move_bound, move_silent})
    for (Remedy& remedy : rule(facts, sorted)) remedies.push_back(std::move(remedy));
  std::stable_sort(remedies.begin(), remedies.end(),
                   [](const Remedy& a, const Remedy& b) { return a.weight > b.weight; });
  std::vector<std::string> sentences;
  for (Remedy& remedy : remedies) sentences.push_back(std::move(remedy.text));
  return sentences;
}

}  // namespace uq
