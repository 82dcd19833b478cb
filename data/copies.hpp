#pragma once
// Rows that are copies of each other to the last digit, which a second measurement or another run would not be.
//
// Two independent readings of standard error s, written to a resolution d (0.01: two decimals), agree in all digits
// with probability
//   p = d / (2 sqrt(pi) s)   (d: two decimals, or a meter's step; the density at 0 of their difference, of variance 2 s^2, times d),
// at most 1. Readings may scatter less than their errors say: where five or more at a point differ, s is at most the
// standard deviation of those that do. Of m pairs of rows that share a point, about m p agree by chance. Where as many
// as do agree have a Poisson probability below 0.01 at that mean, chance does not explain them, and they are copies.
#include <optional>
#include <vector>

namespace data {

struct RepeatableRow {
  std::vector<double> at;      ///< where: inputs or controls, any unit
  std::vector<double> values;  ///< as written, in the file's unit
  std::vector<double> errors;  ///< standard errors, same unit
};

/// For each row the earlier row that it copies, if any.
std::vector<std::optional<std::size_t>> copies_of(const std::vector<RepeatableRow>& rows);

/// The step of the numbers: the last decimal that any of them uses, 0.01 of {3.1, 2.25, 4}, 1e-12 at the finest. Where
/// six different numbers or more lie on a coarser grid, as those of a meter of few bits or of steps of 0.05, it is the
/// grid's.
double resolution(const std::vector<double>& numbers);

}  // namespace data
