#pragma once
// One unknown of a joint posterior: a parameter on which a verdict is asked, or a nuisance of the measurement that is
// sampled with it and integrated out.
#include <optional>
#include <string>

#include "data/study.hpp"
#include "uq/posterior/cut_law.hpp"
#include "uq/posterior/prior.hpp"

namespace uq {

struct Unknown {
  std::string label;  ///< the parameter's name, with the case's in front for another case's own
  ScaledPrior prior;
  bool own = true;  ///< a parameter that is free in the case itself; false: another case's, or a nuisance
  std::optional<data::NuisanceKind> nuisance = {};  ///< kind of nuisance of the measurement; none: a parameter
  std::string cut_from = {};                        ///< case whose posterior it has, without feedback
  std::optional<CutLaw> cut;                        ///< that posterior's law, known once that case is sampled

  /// Whether it is a nuisance that acts on the spread of readings alone, not on their mean.
  bool only_widens() const {
    using data::NuisanceKind;
    return nuisance && *nuisance != NuisanceKind::offset && *nuisance != NuisanceKind::gain &&
           *nuisance != NuisanceKind::scale && *nuisance != NuisanceKind::setting;
  }

  /// The value in SI at u, and its slope.
  double value(double u) const { return prior.parameter().axis().from_unit(u); }
  double slope(double u) const { return prior.parameter().axis().slope(u); }
};

}  // namespace uq
