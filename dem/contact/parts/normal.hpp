#pragma once
// Normal laws: the repulsion N along the contact normal, its damping, and an attraction that belongs to the law.
// Symbols are those of contact_law.hpp: overlap delta, normal velocity u_n (separating > 0), reduced mass m* and radius
// R*, restitution e.
//
// Damping. All laws take the ratio zeta = -ln e / sqrt(pi^2 + ln^2 e). Elastic and damping force together may pull.
// With a `floor` of 0 they may not, and then the restitution is another one.
//
// Linear:  N = k delta - c u_n,  c = 2 zeta sqrt(k m*).
//
// Hertz:   N = 4/3 E* sqrt(R*) delta^(3/2) - c u_n,  c = 2 sqrt(5/6) zeta sqrt(S m*),  S = 2 E* a,  a = sqrt(R* delta).
//          Y. Tsuji et al., Powder Technol. 71:239 (1992). This zeta gives the restitution e at every speed: D. Antypov
//          & J. Elliott, EPL 94:50004 (2011).
//
// JKR:     K. Johnson, K. Kendall, A. Roberts, Proc. R. Soc. A 324:301 (1971). With the work of adhesion w [J/m2], the
//          radius a0 = (9 pi w R*^2 / 2 E*)^(1/3) and y = sqrt(a / a0):
//            delta = (a0^2 / R*) (y^4 - 2/3 y),   force = 6 pi w R* (y^6 - y^3).
//          A contact is made at delta = 0 and broken at the smallest delta. The force is counted as N - A, where A =
//          3/2 pi w R* is its pull-off force. It is damped as Hertz's.
#include <cmath>
#include <limits>
#include <numbers>

#include "dem/contact/lanes.hpp"

namespace dem {

template <class T>
struct NormalForce {
  T elastic{}, total{};  ///< N, without and with damping; positive pushes
  T radius{};            ///< m, of the contact; 0 for laws that know none
  T touch{};             ///< 1 or 0
  T pull{};              ///< N, attraction that belongs to the normal law
  T released{};          ///< J, given up where the contact breaks in this step
};

template <class T, class C>
NormalForce<T> damped(T elastic, T touch, T damping, T normal_velocity, C floor) {
  const T total = touch * larger(T(elastic - damping * normal_velocity), T(floor));
  return {touch * elastic, total, T(0.0), touch, T(0.0), T(0.0)};
}

struct LinearNormal {
  double stiffness = 0.0;                                   ///< N/m
  double damping = 0.0;                                     ///< 2 zeta sqrt(stiffness) [kg^1/2/s]
  double floor = -std::numeric_limits<double>::infinity();  ///< N, least elastic + damping force

  template <class C>
  struct At {
    C stiffness, damping, floor;
    template <class T>
    NormalForce<T> operator()(T overlap, T normal_velocity, T /*radius_before*/) const {
      return damped<T, C>(stiffness * overlap, select(overlap > 0.0, T(1.0), T(0.0)), T(damping), normal_velocity,
                          floor);
    }
    double energy(double overlap, double) const { return overlap > 0.0 ? 0.5 * stiffness * overlap * overlap : 0.0; }
    double released(double) const { return 0.0; }
  };
  template <class C, class Get>
  static At<C> at(Get get, C mass, C) {
    return {get(&LinearNormal::stiffness), C(get(&LinearNormal::damping) * square_root(mass)),
            get(&LinearNormal::floor)};
  }
  double range(double) const { return 0.0; }
};

struct HertzNormal {
  double modulus = 0.0;        ///< Pa, E*
  double damping_ratio = 0.0;  ///< 2 sqrt(5/6) zeta
  double floor = -std::numeric_limits<double>::infinity();

  template <class C>
  struct At {
    C modulus, damping, radius, floor;  // damping: ratio sqrt(2 E* m*)
    template <class T>
    NormalForce<T> operator()(T overlap, T normal_velocity, T /*radius_before*/) const {
      const T touch = select(overlap > 0.0, T(1.0), T(0.0));
      const T in_contact = touch * overlap;
      const T a = square_root(T(radius * in_contact));
      NormalForce<T> f = damped<T, C>(4.0 / 3.0 * modulus * a * in_contact, touch, T(damping * square_root(a)),
                                      normal_velocity, floor);
      f.radius = a;
      return f;
    }
    double energy(double overlap, double) const {
      return overlap > 0.0 ? 8.0 / 15.0 * modulus * std::sqrt(radius * overlap) * overlap * overlap : 0.0;
    }
    double released(double) const { return 0.0; }
  };
  template <class C, class Get>
  static At<C> at(Get get, C mass, C radius) {
    const C e = get(&HertzNormal::modulus);
    return {e, C(get(&HertzNormal::damping_ratio) * square_root(C(2.0 * e * mass))), radius, get(&HertzNormal::floor)};
  }
  double range(double) const { return 0.0; }
};

struct JkrNormal {
  double modulus = 0.0;        ///< Pa, E*
  double damping_ratio = 0.0;  ///< 2 sqrt(5/6) zeta
  double floor = -std::numeric_limits<double>::infinity();
  double adhesion = 0.0;  ///< J/m2, work of adhesion w (twice the surface energy of equal materials)

  static constexpr double break_root = 0.5503212081491045;  // y where delta is smallest: (1/6)^(1/3)

  template <class C>
  struct At {
    C damping, radius, floor;
    C scale;     // m, a0^2 / R*
    C a0;        // m
    C pull_off;  // N, 3/2 pi w R*
    /// y of y^4 - 2/3 y = d on the upper branch. At break-off, y = b, the root is double, where Newton's method creeps.
    /// With y = b + e the quartic is e^2 (6 b^2 + 4 b e + e^2) = d - d(b). The root of both sides, e s(e) =
    /// sqrt(d - d(b)), s = sqrt(6 b^2 + 4 b e + e^2), is convex and has no double root: four steps of Newton from above
    /// leave rounding at any d.
    template <class T>
    static T root(T d) {
      constexpr double b = break_root;
      const T rest = square_root(larger(T(d + 0.5 * b), T(0.0)));
      T e = smaller(T(rest / (b * std::numbers::sqrt2 * std::numbers::sqrt3)), square_root(rest));
      for (int k = 0; k < 4; ++k) {
        const T s = square_root(T(6.0 * b * b + (4.0 * b + e) * e));
        e = e - (e * s - rest) * s / (6.0 * b * b + (6.0 * b + 2.0 * e) * e);
      }
      return b + e;
    }
    template <class T>
    NormalForce<T> operator()(T overlap, T normal_velocity, T radius_before) const {
      const T d = overlap / scale;
      const T held = select(radius_before > 0.0, T(1.0), T(0.0));
      const T touch = select(d > held * (-0.5 * break_root), T(1.0), T(0.0));
      const T y = root(larger(d, T(-0.5 * break_root))), y3 = y * y * y;
      const T a = touch * (y * y * a0);
      // Elastic + attraction = 4 pull_off (y^6 - y^3); the repulsion counted is that plus the pull-off force.
      NormalForce<T> f = damped<T, C>(pull_off * (4.0 * (y3 * y3 - y3) + 1.0), touch, T(damping * square_root(a)),
                                      normal_velocity, floor);
      f.radius = a;
      f.pull = touch * pull_off;
      f.released = held * (1.0 - touch) * energy_at(break_root);
      return f;
    }
    /// J, of elastic force and attraction together, since the contact was made at delta = 0.
    double energy(double overlap, double radius_before) const {
      return radius_before > 0.0 ? energy_at(root(larger(overlap / scale, -0.5 * break_root))) : 0.0;
    }
    /// J, of the broken contact.
    double released(double radius_before) const { return radius_before > 0.0 ? energy_at(break_root) : 0.0; }
    C energy_at(double y) const {
      const auto integral = [](double r) {  // of (y^6 - y^3) d(y^4 - 2/3 y)
        return 2.0 / 5.0 * std::pow(r, 10) - 2.0 / 3.0 * std::pow(r, 7) + 1.0 / 6.0 * std::pow(r, 4);
      };
      return 4.0 * pull_off * scale * (integral(y) - integral(std::cbrt(2.0 / 3.0)));
    }
  };
  template <class C, class Get>
  static At<C> at(Get get, C mass, C radius) {
    const C e = get(&JkrNormal::modulus), w = get(&JkrNormal::adhesion);
    const C cubed = 4.5 * std::numbers::pi * w * radius * radius / e;
    const C a0 = cube_root(cubed);
    return {C(get(&JkrNormal::damping_ratio) * square_root(C(2.0 * e * mass))),
            radius,
            get(&JkrNormal::floor),
            C(a0 * a0 / radius),
            a0,
            C(1.5 * std::numbers::pi * w * radius)};
  }
  double range(double largest_radius) const {
    const double a0 = std::cbrt(4.5 * std::numbers::pi * adhesion * largest_radius * largest_radius / modulus);
    return 0.5 * break_root * a0 * a0 / largest_radius;
  }
};

}  // namespace dem
