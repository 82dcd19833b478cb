#include "dem/laws.hpp"

#include <stdexcept>

#include "dem/compose.hpp"

namespace dem {

std::shared_ptr<const ForcePass> make_force_pass(const BedCoefficients& bed) {
  const LawChoice& choice = bed.choice;
  const bool mindlin = choice.tangential == TangentialLaw::mindlin;
  switch (choice.normal) {
    case NormalLaw::linear:
      if (mindlin) break;
      return compose_linear(bed);
    case NormalLaw::hertz:
      return mindlin ? compose_hertz(bed) : compose_hertz_linear(bed);
    case NormalLaw::jkr:
      if (!mindlin || choice.attraction != AttractionLaw::none) break;
      return compose_jkr(bed);
  }
  throw std::invalid_argument("contact laws that do not go together");
}

}  // namespace dem
