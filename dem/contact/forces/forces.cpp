#include <stdexcept>

#include "dem/contact/forces/elastic.hpp"

namespace dem {
namespace {

std::shared_ptr<const ForcePass> chosen(const BedCoefficients& bed) {
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

}  // namespace
}  // namespace dem

/// The entry by which the rest of the program sees these files; it has another name for each instruction set
/// (CMakeLists.txt).
extern "C" void DEMCAL_FORCES_ENTRY(const dem::BedCoefficients& bed, std::shared_ptr<const dem::ForcePass>& made) {
  made = dem::chosen(bed);
}
