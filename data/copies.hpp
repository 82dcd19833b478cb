#pragma once
// Rows that are copies of each other to the last digit, which a second measurement or another run would not be.
//
// Two independent readings of standard error s, written to a resolution d (0.01: two decimals), agree in all digits
// with probability
//   p = d / (2 sqrt(pi) s)   (the density at 0 of their difference, of variance 2 s^2, times d),
// at most 1. Of m pairs of rows that share a point, about m p agree by chance. Where as many as do agree have a Poisson
// probability below 0.01 at that mean, chance does not explain them, and they are copies.
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

/// The last decimal that any of the numbers uses: 0.01 of {3.1, 2.25, 4}; 1e-12 at the finest.
double resolution(const std::vector<double>& numbers);

}  // namespace data
