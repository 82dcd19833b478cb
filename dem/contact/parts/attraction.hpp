#pragma once
// Attraction A between surfaces, over a gap h.
//
// Tanaka et al., PARTICLES 2011, eq. (1):  A = A_c (h_min / h)^2 with h = max(gap, h_min), and 0 beyond the cut-off. In
// contact it is A_c = H L / (12 h_min^2). The length L is proportional to R*: 4 R* (the diameter of equal spheres) or
// 2 R*.
//
// DMT:  A_c = 2 pi w R* in contact only, a cut-off of zero: B. Derjaguin, V. Muller, Y. Toporov (1975).
#include "dem/contact/lanes.hpp"

namespace dem {

struct NoAttraction {
  template <class C>
  struct At {
    template <class T>
    T operator()(T) const {
      return T(0.0);
    }
    double energy(double) const { return 0.0; }
  };
  template <class C, class Get>
  static At<C> at(Get, C) {
    return {};
  }
  static constexpr double range() { return 0.0; }
};

/// Eq. (1) with a minimum separation and an outer cut-off; DMT with a cut-off of zero.
struct ShortRangeAttraction {
  double pull_off = 0.0;            ///< N per metre of reduced radius
  double minimum_separation = 1.0;  ///< m, > 0
  double cut_off = 0.0;             ///< m

  template <class C>
  struct At {
    C pull_off, minimum_separation, cut_off;
    template <class T>
    T operator()(T gap) const {
      const T nearness = minimum_separation / larger(gap, T(minimum_separation));
      return select(gap < cut_off, T(pull_off * nearness * nearness), T(0.0));
    }
    /// Energy [J] of the attraction, zero at the cut-off.
    double energy(double gap) const {
      if (gap >= cut_off) return 0.0;
      const double beyond = larger(gap, minimum_separation), far = larger(cut_off, minimum_separation);
      const double h2 = minimum_separation * minimum_separation;
      const double constant = smaller(minimum_separation, larger(cut_off, 0.0));
      const double power = cut_off > minimum_separation ? h2 * (1.0 / beyond - 1.0 / far) : 0.0;
      return -pull_off * (power + larger(constant - gap, 0.0));
    }
  };
  template <class C, class Get>
  static At<C> at(Get get, C radius) {
    return {C(get(&ShortRangeAttraction::pull_off) * radius), get(&ShortRangeAttraction::minimum_separation),
            get(&ShortRangeAttraction::cut_off)};
  }
  double range() const { return cut_off; }
};

}  // namespace dem
