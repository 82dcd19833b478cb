#pragma once
// Tangential laws: friction in the contact plane, against the slip velocity u_t. The history has been projected into
// the plane before. It is not rescaled: the loss is of second order in the turn of the normal in a step.
//
// The cap of both is the friction mu times the load: mu max(0, N + b A), where the weight b is -1 for the net force
// (a), 0 for the repulsion (b), and +1 for Thornton's net force + 2 A (c).
//
// Linear:   a slider (slider.hpp) of stiffness kt and dashpot ct.
//
// Mindlin:  kt = 8 G* a follows the contact radius a. The elastic force is kept, and grows by kt u_t dt. Where the
//           contact unloads (a shrinks) that force is scaled by a / a_before, since unloading would create energy
//           otherwise: C. Thornton, S. Cummins, P. Cleary, Powder Technol. 233:30 (2013). ct is a damping ratio times
//           sqrt(kt m*).
#include <limits>

#include "dem/contact/parts/normal.hpp"
#include "dem/contact/parts/slider.hpp"

namespace dem {

struct LinearTangential {
  double stiffness = 0.0;  ///< N/m
  double damping = 0.0;    ///< N s/m for a reduced mass of 1 kg (it goes with its root)
  double friction = 0.0;

  template <class C>
  struct At {
    C stiffness, half_softness, damping, friction, stiffness_per_inertia;
    template <class T>
    SlipForce<Vector3<T>> operator()(Vector3<T> before, Vector3<T> velocity, const NormalForce<T>&, T /*radius_before*/,
                                     T load, double time_step) const {
      return slide(before, velocity, stiffness, damping, T(friction * load), stiffness_per_inertia, time_step);
    }
    template <class T>
    T energy(const Vector3<T>& kept, T /*radius*/) const {
      return dot(kept, kept) * half_softness;
    }
  };
  template <class C, class Get>
  static At<C> at(Get get, C mass) {
    const C k = get(&LinearTangential::stiffness);
    return {k, C(0.5 / larger(k, C(std::numeric_limits<double>::min()))),
            C(get(&LinearTangential::damping) * square_root(mass)), get(&LinearTangential::friction),
            C(3.5 * k / mass)};
  }
};

struct MindlinTangential {
  double modulus = 0.0;        ///< Pa, G*
  double damping_ratio = 0.0;  ///< 2 sqrt(5/6) zeta times the share of the normal dashpot
  double friction = 0.0;

  template <class C>
  struct At {
    C modulus, damping, friction;  // damping: ratio sqrt(8 G* m*)
    C mobility;                    // 1/kg, 7/2 1/m*
    template <class T>
    SlipForce<Vector3<T>> operator()(Vector3<T> before, Vector3<T> velocity, const NormalForce<T>& normal,
                                     T radius_before, T load, double time_step) const {
      const T a = larger(normal.radius, T(std::numeric_limits<double>::min()));
      const T scale = select(normal.radius < radius_before, T(normal.radius / radius_before), T(1.0));
      const T stiffness = 8.0 * modulus * a;
      return slide(Vector3<T>(scale * before), velocity, stiffness, T(damping * square_root(a)), T(friction * load),
                   T(mobility * stiffness), time_step);
    }
    template <class T>
    T energy(const Vector3<T>& kept, T radius) const {
      return dot(kept, kept) / (16.0 * modulus * larger(radius, T(std::numeric_limits<double>::min())));
    }
  };
  template <class C, class Get>
  static At<C> at(Get get, C mass) {
    const C g = get(&MindlinTangential::modulus);
    return {g, C(get(&MindlinTangential::damping_ratio) * square_root(C(8.0 * g * mass))),
            get(&MindlinTangential::friction), C(3.5 / mass)};
  }
};

}  // namespace dem
