#pragma once
// One function for each choice of elastic laws; each is a file of its own, so that they compile side by side.
#include <memory>

#include "dem/contact/laws.hpp"

namespace dem {

std::shared_ptr<const ForcePass> compose_linear(const BedCoefficients& bed);
std::shared_ptr<const ForcePass> compose_hertz(const BedCoefficients& bed);
std::shared_ptr<const ForcePass> compose_hertz_linear(const BedCoefficients& bed);
std::shared_ptr<const ForcePass> compose_jkr(const BedCoefficients& bed);

}  // namespace dem
