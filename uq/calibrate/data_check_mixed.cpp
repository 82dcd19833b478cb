// Values of one output written in two units: some rows of the run table, or some readings of a set.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "uq/calibrate/data_check.hpp"
#include "uq/calibrate/data_columns.hpp"

namespace uq {
namespace {

using data::Finding;

constexpr double gap_least = 5.0;       // between the two groups, a ratio
constexpr std::size_t group_least = 3;  // rows of the smaller group
constexpr double factor_slack = 2.0;    // between the groups' medians, beside a factor between units

struct Entry {
  double value = 0.0;  ///< value of the output, SI, not 0
  const data::RunRow* row = nullptr;
};

double middle(const std::vector<Entry>& entries) { return entries[entries.size() / 2].value; }

/// Whether an input alone parts the groups: then their difference may be the model's.
bool parted_by_an_input(const std::vector<Entry>& low, const std::vector<Entry>& high) {
  for (std::size_t k = 0; k < low.front().row->inputs.size(); ++k) {
    const auto less = [k](const Entry& a, const Entry& b) { return a.row->inputs[k] < b.row->inputs[k]; };
    const auto [low_least, low_most] = std::minmax_element(low.begin(), low.end(), less);
    const auto [high_least, high_most] = std::minmax_element(high.begin(), high.end(), less);
    if (less(*low_most, *high_least) || less(*high_most, *low_least)) return true;
  }
  return false;
}

/// `entries` of one material. Two groups of sizes, further apart than either is wide, by a factor between units.
std::optional<Finding> two_units(const data::Output& output, std::vector<Entry> entries) {
  if (entries.size() < 2 * group_least) return {};
  const auto size = [](const Entry& entry) { return std::log(std::abs(entry.value)); };
  std::stable_sort(entries.begin(), entries.end(), [&](const Entry& a, const Entry& b) { return size(a) < size(b); });
  std::size_t cut = 1;
  for (std::size_t i = 1; i < entries.size(); ++i)
    if (size(entries[i]) - size(entries[i - 1]) > size(entries[cut]) - size(entries[cut - 1])) cut = i;
  const auto at = entries.begin() + static_cast<std::ptrdiff_t>(cut);
  const std::vector<Entry> low(entries.begin(), at), high(at, entries.end());
  const double gap = size(high.front()) - size(low.back());
  const double widest = std::max(size(low.back()) - size(low.front()), size(high.back()) - size(high.front()));
  if (std::min(low.size(), high.size()) < group_least || gap < std::log(gap_least) || gap < widest) return {};
  const std::optional<UnitFactor> known =
      known_factor(output.unit, std::abs(middle(low)), std::abs(middle(high)), factor_slack);
  if (!known || parted_by_an_input(low, high)) return {};
  std::vector<std::string> places;
  for (const Entry& entry : low.size() < high.size() ? low : high) places.push_back(entry.row->place);
  return Finding{.kind = data::FindingKind::unit,
                 .place = data::list_places(places),
                 .severity = data::Severity::warning,
                 .what = fmt::format("{} of {} rows have {} about {:.3g} times {} than the others, and nothing in "
                                     "between. Is another unit meant there, {}?",
                                     places.size(), entries.size(), output.name, std::abs(middle(high) / middle(low)),
                                     low.size() < high.size() ? "smaller" : "larger", known->between),
                 .remedy = "write all rows in the study's unit, or leave these out ([training] leave_out)",
                 .places = std::move(places)};
}

/// Readings far outside all runs that a factor between units takes among them, where others of the set lie there.
std::optional<Finding> other_readings(const data::Study& study, const data::RunTable& table,
                                      const data::ObservationSet& set, std::size_t column) {
  const std::size_t k = set.outputs[column];
  double least = HUGE_VAL, most = -HUGE_VAL;
  for (const data::RunRow& row : table.rows) {
    if (row.left_out || row.material != set.material || !std::isfinite(row.outputs[k])) continue;
    least = std::min(least, row.outputs[k]);
    most = std::max(most, row.outputs[k]);
  }
  if (!(least > 0.0)) return {};
  std::vector<std::string> places;
  std::optional<UnitFactor> factor;
  std::size_t inside = 0;
  const std::vector<UnitFactor> known_ones = unit_factors(study.outputs[k].unit);
  for (const data::Observation& point : set.points) {
    const double value = point.values[column];
    if (value >= least && value <= most) ++inside;
    if (!(value < least / gap_least || value > most * gap_least)) continue;
    for (const UnitFactor& known : known_ones)
      for (const double times : {known.factor, 1.0 / known.factor})
        if (value * times >= least && value * times <= most && (!factor || factor->factor == known.factor)) {
          const std::string place = place_of(set, point);
          if (places.empty() || places.back() != place) places.push_back(place);
          factor = known;
        }
  }
  if (places.empty() || inside < places.size()) return {};
  if (places.size() == 1) {
    const auto one = std::find_if(set.points.begin(), set.points.end(), [&](const data::Observation& point) {
      return place_of(set, point) == places.front();
    });
    const double value = one->values[column];
    for (const auto& [times, word] : {std::pair{10.0, "times ten"}, {0.1, "a tenth"}})
      if (value * times >= least && value * times <= most)
        return Finding{
            .kind = data::FindingKind::unit,
            .place = places.front(),
            .severity = data::Severity::warning,
            .what = fmt::format("{} lies far outside all runs, where the other readings lie among them; {} it "
                                "would, too. Is its decimal point right?",
                                study.outputs[k].name, word),
            .remedy = "correct the reading, or take its line out",
            .places = places};
  }
  return Finding{
      .kind = data::FindingKind::unit,
      .place = data::list_places(places),
      .severity = data::Severity::warning,
      .what = fmt::format("{} of {} readings of {} lie far outside all runs, where the others lie among them. "
                          "Is another unit meant there, {}?",
                          places.size(), set.points.size(), study.outputs[k].name, factor->between),
      .remedy = "write all readings in one unit",
      .places = places};
}

}  // namespace

std::vector<Finding> check_mixed_units(const data::Study& study, const data::RunTable& table) {
  std::vector<Finding> findings;
  for (std::size_t k = 0; k < study.outputs.size(); ++k) {
    std::map<std::string, std::vector<Entry>> by_material;
    for (const data::RunRow& row : table.rows)
      if (!row.left_out && std::isfinite(row.outputs[k]) && row.outputs[k] != 0.0)
        by_material[row.material].push_back({row.outputs[k], &row});
    for (auto& [material, entries] : by_material)
      if (auto found = two_units(study.outputs[k], std::move(entries))) findings.push_back(std::move(*found));
  }
  for (const data::ObservationSet& set : study.observations)
    for (std::size_t column = 0; column < set.outputs.size(); ++column)
      if (auto found = other_readings(study, table, set, column)) findings.push_back(std::move(*found));
  return findings;
}

}  // namespace uq
