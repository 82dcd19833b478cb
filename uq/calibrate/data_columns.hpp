#pragma once
// The run table by columns, for uq/data_check*.cpp alone: an input's values over the rows that are learnt from.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "data/run_table.hpp"
#include "data/study.hpp"
#include "uq/calibrate/data_check.hpp"
#include "uq/findings/study_units.hpp"

namespace uq {

struct InputColumn {
  std::string name;
  data::Unit unit;
  double low = 0.0, high = 1.0;  ///< the range, SI
  bool is_parameter = true;
  std::vector<double> values;  ///< SI
  std::vector<std::string> places;

  double shown(double si) const { return unit.from_si(si); }
  std::string unit_text() const { return behind_number(unit.symbol); }
};

/// Whether the row's material holds the parameter ([materials.X] fixed): its range does not concern the row.
bool is_held(const data::Study& study, const data::RunRow& row, const std::string& name);

/// The columns of every parameter and control. Rows left out, or whose material holds the parameter, are not in them.
std::vector<InputColumn> input_columns(const data::Study& study, const data::RunTable& table,
                                       const std::string* material = nullptr);

/// Place of a name in RunRow::inputs. The table has all of the study's names, or reading it failed.
std::size_t input_column(const data::RunTable& table, const std::string& name);

/// "bench.csv", without its folder.
inline std::string file_of(const data::ObservationSet& set) { return set.file.substr(set.file.rfind('/') + 1); }

/// "bench.csv:7"
std::string place_of(const data::ObservationSet& set, const data::Observation& point);

/// Values and how far they reach.
struct Extent {
  double low = HUGE_VAL, high = -HUGE_VAL;
  std::vector<double> values;
  void add(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
    values.push_back(value);
  }
};

/// Looks at a set with points beside the runs of its material; adds what it finds.
void check_beside_runs(const data::Study& study, const data::RunTable& table, const data::ObservationSet& set,
                       std::vector<data::Finding>& findings);

/// Looks at what the errors of a set's readings share; adds what it finds.
void check_shared_errors(const data::Study& study, const data::ObservationSet& set,
                         std::vector<data::Finding>& findings);
/// The same of sets beside each other: of one meter, and readings that agree too well.
void check_errors_of_sets(const data::Study& study, std::vector<data::Finding>& findings);

/// Factors between units that a quantity of this unit is written in by mistake, the likeliest first.
std::vector<UnitFactor> unit_factors(const data::Unit& unit);

}  // namespace uq
