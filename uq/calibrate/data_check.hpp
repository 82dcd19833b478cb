#pragma once
// A check of rows and observations before anything is fitted: it finds what cannot be meant, and what would silently
// give a wrong answer. `check` reports it; `fit`, `sample` and `calibrate` report the same and stop at what they
// refuse.
//
//   refused   contradictions between the study, the runs and the observations, as building the cases finds them
//             (uq/posterior/build_case.cpp): a control that the runs hold at another value than the measured one, a
//             parameter fixed where no run is; one file observed twice in a case; two columns exchanged; a column in
//             another unit
//   warned    copies, rows outside the ranges, standard errors of 0 among others, an output that no run changes, inputs
//             that move together, a column that nothing reads and that moves an output, ranges that the runs do not
//             cover, magnitudes that suggest another unit, standard errors that suggest a percentage
//   noted     a parameter over decades whose prior, uniform in its value, nobody stated
// A factor between units is suspected in two cases: where the values fill their range, or meet the runs, only when
// multiplied by the factor, and where some rows or readings of one output differ by such a factor from the others.
#include <optional>
#include <vector>

#include "data/finding.hpp"
#include "data/run_table.hpp"
#include "data/study.hpp"

namespace uq {

struct DataCheckThresholds {
  double outside = 1e-3;      ///< of a parameter's range: a row further out is named
  double far_outside = 1.0;   ///< of the range: a row further out is not learnt from
  double covered = 0.5;       ///< of a parameter's range, in u: runs that cover less are named
  double together = 0.98;     ///< correlation of two inputs over the runs, of values or of ranks
  double multiple = 0.98;     ///< squared multiple correlation of an input with all others
  double exchanged = 0.95;    ///< share of values in the other column's range
  double unread_own = 0.3;    ///< R^2 of a column that nothing reads on the inputs: above it is no input of its own
  double unread_share = 0.1;  ///< of what the inputs leave of an output: a column that takes more is named
  double unread_p = 1e-6;     ///< chance of that share where the column has no influence
  double unlikely_scatter = 2e-3;  ///< probability that errors as stated scatter as little
};

/// All findings about the data; nothing is thrown. A row that lies far outside is marked in `table`.
std::vector<data::Finding> check_data(const data::Study& study, data::RunTable& table,
                                      const std::optional<data::RunTable>& low = {},
                                      const std::vector<std::string>& log_outputs = {},
                                      const DataCheckThresholds& thresholds = {});

// The parts of check_data, each with its own kind of finding.
std::vector<data::Finding> check_ranges(const data::Study& study, data::RunTable& table,
                                        const DataCheckThresholds& thresholds);
std::vector<data::Finding> check_outputs(const data::Study& study, const data::RunTable& table,
                                         const std::vector<std::string>& log_outputs);
std::vector<data::Finding> check_mixed_units(const data::Study& study, const data::RunTable& table);
std::vector<data::Finding> check_design(const data::Study& study, const data::RunTable& table,
                                        const DataCheckThresholds& thresholds);
std::vector<data::Finding> check_unread_inputs(const data::Study& study, const data::RunTable& table,
                                               const DataCheckThresholds& thresholds);
std::vector<data::Finding> check_observations(const data::Study& study, const data::RunTable& table,
                                              const DataCheckThresholds& thresholds);
std::vector<data::Finding> check_saturated(const data::Study& study, const data::RunTable& table);
std::vector<data::Finding> check_priors(const data::Study& study);
std::vector<data::Finding> check_cases(const data::Study& study, const data::RunTable& table,
                                       const std::optional<data::RunTable>& low);

/// A factor between two ways to write a number, and the names of the two.
struct UnitFactor {
  double factor = 1.0;
  std::string between;  ///< "a prefix (m against none)"
};

/// The known factor between units of that quantity that takes values of about `typical` to about `expected`, within
/// `slack` (a ratio); none where there is no such factor.
std::optional<UnitFactor> known_factor(const data::Unit& unit, double typical, double expected, double slack);

}  // namespace uq
