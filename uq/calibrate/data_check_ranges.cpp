// Looks at the runs' inputs beside their ranges: columns exchanged, values in another unit, rows outside.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "uq/calibrate/data_check.hpp"
#include "uq/calibrate/data_columns.hpp"
#include "uq/findings/study_units.hpp"

namespace uq {
namespace {

using data::Finding;
using data::Severity;

double share_inside(const InputColumn& column, double low, double high, double factor = 1.0) {
  const double slack = 0.01 * (high - low);
  const auto inside = std::count_if(column.values.begin(), column.values.end(), [&](double value) {
    return factor * value >= low - slack && factor * value <= high + slack;
  });
  return static_cast<double>(inside) / static_cast<double>(column.values.size());
}

/// Share of a range that values times a factor span.
double span(const InputColumn& column, double factor = 1.0) {
  const auto [least, most] = std::minmax_element(column.values.begin(), column.values.end());
  return factor * (*most - *least) / (column.high - column.low);
}

/// A column that fills its range only when it is read in another unit.
std::optional<Finding> other_unit(const InputColumn& column) {
  const double inside = share_inside(column, column.low, column.high);
  if (!(span(column) > 0.0) || (inside > 0.5 && span(column) > 0.05)) return {};
  for (const UnitFactor& known : unit_factors(column.unit))
    for (const double factor : {known.factor, 1.0 / known.factor}) {
      if (share_inside(column, column.low, column.high, factor) < 0.95 || span(column, factor) < 0.4) continue;
      const auto [least, most] = std::minmax_element(column.values.begin(), column.values.end());
      Finding finding{.kind = data::FindingKind::unit,
                      .place = column.places.front(),
                      .severity = inside < 0.5 && column.is_parameter ? Severity::refusal : Severity::warning,
                      .what = {},
                      .remedy = {},
                      .places = {}};
      finding.what = fmt::format(
          "the runs' {} lies from {:.4g} to {:.4g}{}, and its range from {:.4g} to {:.4g}: {} {:.4g} it would fill it. "
          "Is another unit meant, {}?",
          column.name, column.shown(*least), column.shown(*most), column.unit_text(), column.shown(column.low),
          column.shown(column.high), factor > 1.0 ? "times" : "divided by", factor > 1.0 ? factor : 1.0 / factor,
          known.between);
      finding.remedy = fmt::format("write the column in the study's unit, or set {}.{}.unit",
                                   column.is_parameter ? "parameters" : "controls", column.name);
      return finding;
    }
  return {};
}

/// The unit in which some rows of a column were written, when all of them lie outside its range and fill it in that
/// one.
std::optional<UnitFactor> unit_of_some(const InputColumn& column, const std::vector<double>& outside) {
  constexpr std::size_t fewest = 3;
  if (outside.size() < fewest) return {};
  InputColumn some = column;
  some.values = outside;
  for (const UnitFactor& known : unit_factors(column.unit))
    for (const double factor : {known.factor, 1.0 / known.factor})
      if (share_inside(some, column.low, column.high, factor) == 1.0 && span(some, factor) >= 0.4) return known;
  return {};
}

/// Rows of a column that fill its range in another unit, where the others lie in it as they stand: values too small by
/// that factor, far below all others, and more than an even design has there.
std::optional<Finding> some_in_other_unit(const InputColumn& column) {
  constexpr std::size_t fewest = 3;
  constexpr double apart = 3.0;  // the smallest of the others, over the largest of these
  if (!(column.low >= 0.0)) return {};
  for (const UnitFactor& known : unit_factors(column.unit)) {
    if (known.factor < 50.0) continue;  // else an even design has values there
    std::vector<double> small;
    std::vector<std::string> places;
    double next = HUGE_VAL;
    for (std::size_t i = 0; i < column.values.size(); ++i) {
      const double value = column.values[i];
      if (value > 0.0 && value * known.factor <= 1.01 * column.high) {
        small.push_back(value);
        places.push_back(column.places[i]);
      } else if (value > 0.0) {
        next = std::min(next, value);
      }
    }
    const double expected = static_cast<double>(column.values.size()) / known.factor;
    if (small.size() < fewest || small.size() == column.values.size() ||
        static_cast<double>(small.size()) < fewest + 5.0 * expected)
      continue;
    InputColumn some = column;
    some.values = small;
    const auto [least, most] = std::minmax_element(small.begin(), small.end());
    if (span(some, known.factor) < 0.5 || next < apart * *most) continue;
    Finding finding = data::about_rows(data::FindingKind::unit, Severity::warning, places);
    finding.what = fmt::format(
        "{} of {} rows have {} from {:.4g} to {:.4g}{}, and no other is below {:.4g}: times {:.4g} they would fill its "
        "range. Is another unit meant there, {}?",
        small.size(), column.values.size(), column.name, column.shown(*least), column.shown(*most), column.unit_text(),
        column.shown(next), known.factor, known.between);
    finding.remedy = "write all rows in the study's unit, or leave these out ([training] leave_out)";
    return finding;
  }
  return {};
}

/// Two columns of which each fits the other's range and not both their own.
std::optional<Finding> exchanged(const InputColumn& a, const InputColumn& b, double share) {
  const double own = std::min(share_inside(a, a.low, a.high), share_inside(b, b.low, b.high));
  // The numbers as written: a header says nothing of units.
  const auto in_range_of = [](const InputColumn& column, const InputColumn& other) {
    const double low = other.shown(other.low), high = other.shown(other.high), slack = 0.01 * (high - low);
    const auto inside = std::count_if(column.values.begin(), column.values.end(), [&](double value) {
      return column.shown(value) >= low - slack && column.shown(value) <= high + slack;
    });
    return static_cast<double>(inside) / static_cast<double>(column.values.size());
  };
  if (own > 0.5 || in_range_of(a, b) < share || in_range_of(b, a) < share) return {};
  const auto range = [](const InputColumn& column) {
    const auto [least, most] = std::minmax_element(column.values.begin(), column.values.end());
    return fmt::format("{:.4g} to {:.4g}", column.shown(*least), column.shown(*most));
  };
  return Finding{
      .kind = data::FindingKind::exchanged_columns,
      .place = a.places.front(),
      .severity = Severity::refusal,
      .what = fmt::format("the columns {} and {} look exchanged: the runs' {} lies from {} and their {} from "
                          "{}, each in the other's range ({:.4g} to {:.4g}, and {:.4g} to {:.4g})",
                          a.name, b.name, a.name, range(a), b.name, range(b), a.shown(a.low), a.shown(a.high),
                          b.shown(b.low), b.shown(b.high)),
      .remedy = "exchange the two names in the header",
      .places = {}};
}

/// A control's column that holds what was measured of an output, and the output's column that holds the control.
std::optional<Finding> exchanged_output(const data::Study& study, const data::RunTable& table,
                                        const InputColumn& control) {
  if (share_inside(control, control.low, control.high) > 0.5) return {};
  for (std::size_t k = 0; k < study.outputs.size(); ++k) {
    const data::Unit& unit = study.outputs[k].unit;
    double low = HUGE_VAL, high = -HUGE_VAL;
    for (const data::ObservationSet& set : study.observations)
      for (std::size_t c = 0; c < set.outputs.size(); ++c)
        for (const data::Observation& point : set.points) {
          if (set.outputs[c] != k || !point.has(c)) continue;
          low = std::min(low, unit.from_si(point.values[c]));
          high = std::max(high, unit.from_si(point.values[c]));
        }
    InputColumn output{study.outputs[k].name, unit, 0.0, 1.0, false, {}, {}};
    std::size_t inside = 0;
    for (const data::RunRow& row : table.rows) {
      if (row.left_out || !std::isfinite(row.outputs[k])) continue;
      output.values.push_back(row.outputs[k]);
      const double number = unit.from_si(row.outputs[k]);
      inside += number >= control.shown(control.low) && number <= control.shown(control.high);
    }
    const auto as_measured = std::count_if(control.values.begin(), control.values.end(), [&](double value) {
      return control.shown(value) > low / 3.0 && control.shown(value) < high * 3.0;
    });
    if (output.values.empty() || 20 * inside < 19 * output.values.size() ||
        20 * static_cast<std::size_t>(as_measured) < 19 * control.values.size())
      continue;
    return Finding{
        .kind = data::FindingKind::exchanged_columns,
        .place = control.places.front(),
        .severity = Severity::refusal,
        .what = fmt::format("the columns {} and {} look exchanged: the runs' {} lies where {} was measured "
                            "({:.4g} to {:.4g}), and their {} in the range of {}",
                            control.name, output.name, control.name, output.name, low, high, output.name, control.name),
        .remedy = "exchange the two names in the header",
        .places = {}};
  }
  return {};
}

/// Findings about whole columns, and the columns that they are about: of these nothing else is said.
struct ToldColumns {
  std::vector<Finding> findings;
  std::vector<bool> told;
  void add(Finding finding, std::initializer_list<std::size_t> about) {
    findings.push_back(std::move(finding));
    for (const std::size_t column : about) told[column] = true;
  }
};

/// Columns that are exchanged or in another unit as a whole. `share`: of a column's values, for it to be exchanged.
ToldColumns whole_columns(const data::Study& study, const data::RunTable& table,
                          const std::vector<InputColumn>& columns, double share) {
  ToldColumns found{.findings = {}, .told = std::vector<bool>(columns.size(), false)};
  for (std::size_t a = 0; a < columns.size(); ++a)
    for (std::size_t b = a + 1; b < columns.size(); ++b)
      if (auto two = exchanged(columns[a], columns[b], share)) found.add(std::move(*two), {a, b});
  for (std::size_t a = 0; a < columns.size(); ++a) {
    if (found.told[a] || columns[a].is_parameter) continue;
    if (auto one = exchanged_output(study, table, columns[a])) found.add(std::move(*one), {a});
  }
  for (std::size_t a = 0; a < columns.size(); ++a) {
    if (found.told[a]) continue;
    if (auto one = other_unit(columns[a])) found.add(std::move(*one), {a});
  }
  return found;
}

/// Rows whose value lies outside a column's range.
struct RowsOutside {
  std::vector<data::RunRow*> rows;
  std::vector<double> values;
};

RowsOutside find_outside(const data::Study& study, data::RunTable& table, const InputColumn& column,
                         const data::Axis& axis, double slack) {
  RowsOutside found;
  for (data::RunRow& row : table.rows) {
    const double value = row.inputs[input_column(table, column.name)];
    if (row.left_out || is_held(study, row, column.name)) continue;
    if (axis.scale == data::Scale::log && !(value > 0.0)) continue;
    const double u = axis.to_unit(value);
    if (u >= -slack && u <= 1.0 + slack) continue;
    found.rows.push_back(&row);
    found.values.push_back(value);
  }
  return found;
}

/// The rows of a column that lie outside its range, in words. Those far outside, and all of them where they lie in the
/// range in another unit, are left out.
std::optional<Finding> rows_outside(const data::Study& study, data::RunTable& table, const InputColumn& column,
                                    const DataCheckThresholds& t) {
  const data::Axis axis = column.is_parameter ? study.parameters[*study.parameter_index(column.name)].axis()
                                              : study.controls[*study.control_index(column.name)].axis();
  const RowsOutside outside = find_outside(study, table, column, axis, t.outside);
  if (outside.rows.empty()) return {};
  const std::optional<UnitFactor> unit = unit_of_some(column, outside.values);
  std::vector<std::string> near, far;
  for (std::size_t i = 0; i < outside.rows.size(); ++i) {
    const double u = axis.to_unit(outside.values[i]);
    const bool leave_out = unit || u < -t.far_outside || u > 1.0 + t.far_outside;
    (leave_out ? far : near).push_back(outside.rows[i]->place);
    if (leave_out)
      outside.rows[i]->left_out = {
          data::LeftOut::Because::it_is_far_off,
          fmt::format("{} lies {}", column.name, unit ? "in its range in another unit only" : "far outside its range")};
  }

  std::vector<std::string> places = far;
  places.insert(places.end(), near.begin(), near.end());
  const auto [least, most] = std::minmax_element(outside.values.begin(), outside.values.end());
  Finding finding = data::about_rows(data::FindingKind::outside_the_range, Severity::warning, places);
  finding.what = fmt::format(
      "{} of {} rows have {} outside its range, {:.4g} to {:.4g}{} ({}{:.4g})", places.size(), column.values.size(),
      column.name, column.shown(column.low), column.shown(column.high), column.unit_text(),
      *least < *most ? fmt::format("from {:.4g} to ", column.shown(*least)) : "", column.shown(*most));
  if (unit)
    finding.what += fmt::format("; in another unit, {}, they would lie inside, so they are left out", unit->between);
  else if (!far.empty())
    finding.what += fmt::format("; {} of them further than the range is wide, and left out", far.size());
  finding.remedy = fmt::format("correct the rows, leave them out ([training] leave_out), or widen {}.{}",
                               column.is_parameter ? "parameters" : "controls", column.name);
  return finding;
}

}  // namespace

std::vector<Finding> check_ranges(const data::Study& study, data::RunTable& table, const DataCheckThresholds& t) {
  std::vector<InputColumn> columns = input_columns(study, table);
  std::erase_if(columns, [](const InputColumn& column) { return column.values.empty(); });
  ToldColumns whole = whole_columns(study, table, columns, t.exchanged);
  std::vector<Finding> findings = std::move(whole.findings);
  for (std::size_t a = 0; a < columns.size(); ++a) {
    if (whole.told[a]) continue;
    if (auto found = some_in_other_unit(columns[a])) findings.push_back(std::move(*found));
    if (auto found = rows_outside(study, table, columns[a], t)) findings.push_back(std::move(*found));
  }
  return findings;
}

}  // namespace uq
