#include "dem/contact/forces/compose.hpp"

namespace dem {

std::shared_ptr<const ForcePass> compose_hertz_linear(const BedCoefficients& bed) {
  return compose<HertzNormal, LinearTangential>(bed);
}

}  // namespace dem
