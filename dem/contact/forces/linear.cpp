#include "dem/contact/forces/compose.hpp"

namespace dem {

std::shared_ptr<const ForcePass> compose_linear(const BedCoefficients& bed) {
  return compose<LinearNormal, LinearTangential>(bed);
}

}  // namespace dem
