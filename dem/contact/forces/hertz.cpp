#include "dem/contact/forces/compose.hpp"

namespace dem {

std::shared_ptr<const ForcePass> compose_hertz(const BedCoefficients& bed) {
  return compose<HertzNormal, MindlinTangential>(bed);
}

}  // namespace dem
