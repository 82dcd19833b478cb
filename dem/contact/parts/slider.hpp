#pragma once
// A spring and a dashpot side by side, behind a slider. Tangential, rolling and twisting laws are made of it.
//
// Below the cap the force is T = -k s - c u, with the spring s. At the cap the contact slides: T has the cap's size,
// and the spring follows as fast as the dashpot lets it, ds/dt = (|T| - k s) / c. Without a dashpot s = cap / k at
// once. What is remembered is k s.
//
// The step is of second order. The spring is stored half a step ahead, and the force uses its mean over the step. The
// velocity u is extrapolated, which alone would add energy to an oscillation. The stored spring therefore leads by a
// further share a of the step's slip, a = dt^2 stiffness / inertia: the squared phase of a step. With it oscillations
// of up to eight contacts a sphere stay stable.
#include <limits>

#include "dem/contact/lanes.hpp"
#include "dem/walls/vec3.hpp"

namespace dem {

/// The force of the slider: in the contact plane and in rolling V is a vector [N], in twisting a number [N m].
template <class V>
struct SlipForce {
  V force;  ///< on the sphere
  V kept;   ///< elastic part, of opposite sign
};

/// One step of the slider. `stiffness_per_inertia` [1/s2] is that of the fastest oscillation of a free pair on this
/// spring. C is double where all contacts share the spring's coefficients.
template <class V, class T, class C>
SlipForce<V> slide(const V& before, const V& velocity, C stiffness, C damping, T cap, C stiffness_per_inertia,
                   double time_step) {
  const C lead = smaller(C(time_step * time_step * stiffness_per_inertia), C(0.5));
  const C reach = stiffness * time_step, drag = (0.5 + lead) * reach + damping;
  const V wanted = before + drag * velocity;
  const T size = norm(wanted);
  const V force = select(size > cap, T(cap / size), T(1.0)) * wanted;
  // Beyond the cap the spring no longer follows the slip; only the dashpot's share of the excess is still stored.
  const C share = reach / larger(C(reach + damping), C(std::numeric_limits<double>::min()));
  return {-force, before + reach * velocity - share * (wanted - force)};
}

}  // namespace dem
