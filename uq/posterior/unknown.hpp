#pragma once
// One unknown of a joint posterior: a parameter on which a verdict is asked, or a nuisance of the measurement that is
// sampled with it and integrated out.
#include <optional>
#include <string>

#include "uq/posterior/prior.hpp"

namespace uq {

/// How a nuisance acts on what is read: on its mean (a gain), or only on its spread (a noise scale).
enum class Acts { none, on_mean, on_spread };

/// A normal law of one unknown, in u.
struct NormalLaw {
  double mean = 0.0, sd = 1.0;
};

struct Unknown {
  std::string label;  ///< the parameter's name, with the case's in front for another case's own
  ScaledPrior prior;
  bool own = true;               ///< a parameter that is free in the case itself; else another's, or a nuisance
  Acts nuisance = Acts::none;    ///< none: a parameter
  std::string cut_from = {};     ///< case whose posterior it has, without feedback
  std::optional<NormalLaw> cut;  ///< that posterior's moments, known once that case is sampled

  /// In SI.
  double value(double u) const { return prior.parameter().axis().from_unit(u); }
  double slope(double u) const { return prior.parameter().axis().slope(u); }
};

}  // namespace uq
