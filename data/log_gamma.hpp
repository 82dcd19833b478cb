#pragma once
// The logarithm of the gamma function. std::lgamma writes the sign of the gamma function into a variable that all
// threads share; the system's lgamma_r gives the same bits, and the sign aside.
#include <math.h>  // NOLINT(modernize-deprecated-headers): lgamma_r is POSIX, not of <cmath>

namespace data {

inline double log_gamma(double x) {
  int sign = 0;
  return ::lgamma_r(x, &sign);
}

}  // namespace data
