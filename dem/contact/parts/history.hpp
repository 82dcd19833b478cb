#pragma once
// The memory of a contact from one step to the next.
#include "dem/walls/vec3.hpp"

namespace dem {

/// The values that a contact keeps from step to step.
template <class T>
struct History {
  Vector3<T> slip;  ///< N, elastic tangential force (linear: stiffness times spring)
  T radius{};       ///< m, contact radius of the step before (Hertz, JKR); > 0 while it holds
  Vector3<T> roll;  ///< N, elastic rolling force
  T twist{};        ///< N m, elastic twisting torque
};

}  // namespace dem
