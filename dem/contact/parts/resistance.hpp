#pragma once
// Resistance against rolling and twisting.
//
// Constant:  the torque mu_r R* load against the rolling part of the spin w, and mu_t R* load against w.n. It is never
//            more than stops the spin in four steps: J. Ai et al., Powder Technol. 206:269 (2011), model A. Stopped in
//            one step, a sphere on a wall or between many would spin to and fro for ever.
//
// Spring:    a slider (slider.hpp) on the rolling velocity v_r = R* w x n, with the cap mu_r times the load. Its torque
//            is R* n x force: S. Luding, Granular Matter 10:235 (2008). Another one on w.n, with stiffness kr R*^2 and
//            the cap mu_t R* load.
#include <limits>

#include "dem/contact/parts/history.hpp"
#include "dem/contact/parts/slider.hpp"

namespace dem {

template <class T>
struct Couple {
  Vector3<T> torque;  ///< N m, on the sphere; the partner has the opposite
  Vector3<T> roll;    ///< N, kept
  T twist{};          ///< N m, kept
};

struct NoResistance {
  static constexpr bool present = false, remembers = false;
  template <class C>
  struct At {
    template <class T>
    Couple<T> operator()(const Vector3<T>&, const Vector3<T>&, const History<T>&, T, double) const {
      return {};
    }
    template <class T>
    T energy(const Vector3<T>&, T) const {
      return T(0.0);
    }
  };
  template <class C, class Get>
  static At<C> at(Get, C, C) {
    return {};
  }
};

struct ConstantResistance {
  static constexpr bool present = true, remembers = false;
  double rolling_friction = 0.0, twisting_friction = 0.0;

  template <class C>
  struct At {
    C rolling, twisting, inertia;  // m, m, 2/5 m* R*^2 [kg m2]
    template <class T>
    Couple<T> operator()(const Vector3<T>& n, const Vector3<T>& spin, const History<T>&, T load,
                         double time_step) const {
      const T along = dot(spin, n), least = T(std::numeric_limits<double>::min());
      const Vector3<T> across = spin - along * n;
      const T rate = larger(norm(across), least), turn = larger(larger(along, T(-along)), least);
      const T most = 0.25 * inertia / time_step;
      const T roll = smaller(T(rolling * load / rate), most), twist = smaller(T(twisting * load / turn), most);
      return {-(roll * across) - T(twist * along) * n, {}, T(0.0)};
    }
    template <class T>
    T energy(const Vector3<T>&, T) const {
      return T(0.0);
    }
  };
  template <class C, class Get>
  static At<C> at(Get get, C mass, C radius) {
    return {C(get(&ConstantResistance::rolling_friction) * radius),
            C(get(&ConstantResistance::twisting_friction) * radius), C(0.4 * mass * radius * radius)};
  }
};

struct SpringResistance {
  static constexpr bool present = true, remembers = true;
  double rolling_friction = 0.0, twisting_friction = 0.0;
  double stiffness = 0.0;  ///< N/m
  double damping = 0.0;    ///< N s/m for a reduced mass of 1 kg (it goes with its root)

  template <class C>
  struct At {
    C rolling, twisting, stiffness, damping, radius;
    C stiffness_per_inertia;  // 1/s2, of rolling and twisting, whose mass is 2/5 m*
    template <class T>
    Couple<T> operator()(const Vector3<T>& n, const Vector3<T>& spin, const History<T>& before, T load,
                         double time_step) const {
      const Vector3<T> velocity = T(radius) * cross(spin, n);
      const Vector3<T> turned = before.roll - dot(before.roll, n) * n;
      const C area = radius * radius;
      const SlipForce<Vector3<T>> roll =
          slide(turned, velocity, stiffness, damping, T(rolling * load), stiffness_per_inertia, time_step);
      const SlipForce<T> twist = slide(before.twist, T(dot(spin, n)), C(stiffness * area), C(damping * area),
                                       T(twisting * radius * load), stiffness_per_inertia, time_step);
      return {T(radius) * cross(n, roll.force) + twist.force * n, roll.kept, twist.kept};
    }
    template <class T>
    T energy(const Vector3<T>& roll, T twist) const {
      return (dot(roll, roll) + twist * twist / (radius * radius)) / (2.0 * stiffness);
    }
  };
  template <class C, class Get>
  static At<C> at(Get get, C mass, C radius) {
    return {get(&SpringResistance::rolling_friction),
            get(&SpringResistance::twisting_friction),
            get(&SpringResistance::stiffness),
            C(get(&SpringResistance::damping) * square_root(mass)),
            radius,
            C(2.5 * get(&SpringResistance::stiffness) / mass)};
  }
};

}  // namespace dem
