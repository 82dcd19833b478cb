#pragma once
// Scales of inputs on which a function bends alike all over.
//
// A stationary process has one length scale over the whole range of an input. A response such as a b^q bends far more
// at one end of the range than at the other. One length scale is then too long at that end, where the process claims
// more than its runs tell, and too short at the other. The process therefore learns such an input on a stretched scale
//   v(u) = log(1 + (r - 1) u) / log r,   u and v in [0, 1],
// with straight continuations outside. r is the slope dv/du at u = 0 over that at u = 1: r > 1 stretches the low end,
// r < 1 the high end, r = 1 is v = u. For an input from a to b > a > 0, r = b / a is the logarithm of the input; any
// other r is log(x + c), c = (b - r a) / (r - 1).
//
// The scales are chosen by the marginal likelihood, which weighs errors and stated widths together. Warping inputs by a
// fitted function is due to Snoek, Swersky, Zemel & Adams, ICML 2014; theirs has two free parameters an input, and this
// one a choice of a few, so that a few dozen runs can make it.
#include <Eigen/Core>
#include <vector>

#include "surrogate/fit.hpp"

namespace surrogate {

struct Stretch {
  double ratio = 1.0;  ///< r, above 0

  double place(double u) const;   ///< v
  double origin(double v) const;  ///< u
  double slope(double u) const;   ///< dv/du
  bool is_none() const { return ratio == 1.0; }
};

/// What a stretch must raise the log of the marginal likelihood by to be chosen.
inline constexpr double stretch_gain = 3.0;

/// What the log of the marginal likelihood of a gentler stretch may lack, where the runs do not resolve the strongest:
/// less is not worth more than a bare mention (R. E. Kass & A. E. Raftery, J. Am. Stat. Assoc. 90 (1995) 773).
inline constexpr double stretch_tie = 1.0;

/// Stretches of the inputs of `training`, one after the other as long as the likelihood gains by stretch_gain. Tried
/// are ratios of 10 and 100 at either end, and each input's own (b / a; 1: none). Where the best stretches an end so
/// far that the runs do not resolve it, one of half a decade less is tried too, and the gentlest within stretch_tie is
/// taken. Inputs of fewer than five values, and those in which the function is all but straight, are left as they are.
std::vector<Stretch> choose_stretches(const TrainingSet& training, const FitOptions& options,
                                      const std::vector<double>& own_ratios);

}  // namespace surrogate
