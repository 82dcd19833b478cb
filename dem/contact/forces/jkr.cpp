#include "dem/contact/forces/compose.hpp"

namespace dem {

std::shared_ptr<const ForcePass> compose_jkr(const BedCoefficients& bed) {
  return compose<JkrNormal, MindlinTangential>(bed);
}

}  // namespace dem
