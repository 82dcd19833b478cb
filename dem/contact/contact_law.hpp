#pragma once
// Contact laws, composed from parts at compile time. A part is a plain struct of coefficients for one pair of
// materials; its `At` holds what follows from them for a pair of given reduced mass and radius, as one double for all
// contacts of a bed of equal spheres or as lanes. Nothing is dispatched per contact, and no part branches, so that
// lanes stay together.
//
// Geometry: unit normal n from the partner to the sphere, overlap delta [m] (negative: a gap), u = velocity of the
// sphere's surface relative to the partner's at the contact point [m/s], u_n = u.n (separating > 0), u_t the rest;
// w = spin of the sphere minus that of the partner [rad/s]; 1/R* = 1/r_i + 1/r_j, 1/m* = 1/m_i + 1/m_j (wall: r_i,
// m_i).
//
// normal      linear: N = k delta - c u_n, c = 2 zeta sqrt(k m*), zeta = -ln e / sqrt(pi^2 + ln^2 e).
//             Hertz: N = 4/3 E* sqrt(R*) delta^(3/2) - c u_n, c = 2 sqrt(5/6) zeta sqrt(S m*), S = 2 E* a, a =
//             sqrt(R* delta); Y. Tsuji et al., Powder Technol. 71:239 (1992); that this zeta gives the restitution e at
//             every speed is D. Antypov & J. Elliott, EPL 94:50004 (2011).
//             JKR: K. Johnson, K. Kendall, A. Roberts, Proc. R. Soc. A 324:301 (1971), in terms of y = sqrt(a/a0),
//             a0 = (9 pi w R*^2 / 2 E*)^(1/3), w the work of adhesion [J/m2]:
//             delta = (a0^2 / R*) (y^4 - 2/3 y), force = 6 pi w R* (y^6 - y^3); made at delta = 0, broken at the
//             smallest delta. Counted as N - A with A = 3/2 pi w R*, its pull-off force; damped as Hertz.
//             Elastic + damping force may pull, or is clamped at 0 (`floor`; then the restitution is another).
// tangential  linear: spring s, projected into the contact plane (not rescaled: the loss is of second order in the turn
//             of the normal per step). Spring and dashpot side by side, behind a slider: T = -kt s - ct u_t while that
//             is below the cap; else the contact slides, T has the cap's size, and the spring follows as fast as the
//             dashpot lets it: ds/dt = (|T| - kt s) / ct, s = cap / kt at once without a dashpot. (The history kept is
//             kt s.) Steps: s is kept half a step ahead and its mean over the step is what pulls, second order; as u_t
//             is extrapolated that alone would feed an oscillation, so the spring leads the mean by a of a step's
//             slip more, a = 7/2 kt dt^2 / m*, the square of the phase of a step: enough for eight contacts a sphere.
//             Mindlin: kt = 8 G* a, the elastic force is kept and grows by kt u_t dt; when the contact unloads (a
//             shrinks) it is scaled by a / a_before, else unloading would create energy (C. Thornton, S. Cummins, P.
//             Cleary, Powder Technol. 233:30 (2013)); ct = damping ratio sqrt(kt m*) alike.
// cap         mu max(0, N + b A), b = -1, 0, +1: net force (a), repulsion (b), Thornton's net + 2 A (c).
// rolling     spring, dashpot and slider alike, on v_r = R* w x n (rolling slip) with the cap mu_r (cap's load); torque
//             R* n x force (S. Luding, Granular Matter 10:235 (2008)); constant torque: mu_r R* load against the
//             rolling part of w, and never more than stops it in four steps (J. Ai et al., Powder Technol. 206:269
//             (2011), A): stopped in one, a sphere on a wall, or between many, would spin to and fro for ever.
// twisting    with either: spring kr R*^2 and dashpot on w.n, or constant, cut at mu_t R* load.
// attraction  Tanaka et al., PARTICLES 2011, eq. (1): A = A_c (h_min / h)^2, h = max(gap, h_min), zero beyond the
//             cut-off, A_c = H L / (12 h_min^2) in contact; L is proportional to R* (4 R*: the diameter of equal
//             spheres, or 2 R*). DMT: A_c = 2 pi w R* in contact only (B. Derjaguin, V. Muller, Y. Toporov 1975).
//
// force on the sphere = (N - A) n + T. What a contact dissipates in a step is the work done against T, the couples and
// the normal dashpot, less what springs store more than before: whatever is cut, scaled or projected is in it.
#include <cmath>
#include <concepts>
#include <limits>
#include <numbers>

#include "dem/contact/lanes.hpp"
#include "dem/walls/vec3.hpp"

namespace dem {

/// What a contact remembers from step to step.
template <class T>
struct History {
  Vector3<T> slip;  ///< N, elastic tangential force (linear: stiffness times spring)
  T radius{};       ///< m, contact radius of the step before (Hertz, JKR); > 0 while it holds
  Vector3<T> roll;  ///< N, elastic rolling force
  T twist{};        ///< N m, elastic twisting torque
};

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

/// Spring and dashpot side by side, behind a slider: in the contact plane, in rolling (V a vector [N]) and in twisting
/// (V a number [N m]).
template <class V>
struct SlipForce {
  V force;  ///< on the sphere
  V kept;   ///< elastic part, of opposite sign
};

/// `stiffness_per_inertia` [1/s2] is that of the fastest oscillation of a free pair on this spring. C is double where
/// all contacts share the spring's coefficients.
template <class V, class T, class C>
SlipForce<V> slide(const V& before, const V& velocity, C stiffness, C damping, T cap, C stiffness_per_inertia,
                   double time_step) {
  const C lead = smaller(C(time_step * time_step * stiffness_per_inertia), C(0.5));
  const C reach = stiffness * time_step, drag = (0.5 + lead) * reach + damping;
  const V wanted = before + drag * velocity;
  const T size = norm(wanted);
  const V force = select(size > cap, T(cap / size), T(1.0)) * wanted;
  // What is beyond the cap the spring does not follow, but for what the dashpot holds.
  const C share = reach / larger(C(reach + damping), C(std::numeric_limits<double>::min()));
  return {-force, before + reach * velocity - share * (wanted - force)};
}

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

struct NoAttraction {
  template <class C>
  struct At {
    template <class T>
    T operator()(T) const {
      return T(0.0);
    }
    double energy(double) const { return 0.0; }
  };
  template <class C, class Get>
  static At<C> at(Get, C) {
    return {};
  }
  static constexpr double range() { return 0.0; }
};

/// Eq. (1) with a minimum separation and an outer cut-off; DMT with a cut-off of zero.
struct ShortRangeAttraction {
  double pull_off = 0.0;            ///< N per metre of reduced radius
  double minimum_separation = 1.0;  ///< m, > 0
  double cut_off = 0.0;             ///< m

  template <class C>
  struct At {
    C pull_off, minimum_separation, cut_off;
    template <class T>
    T operator()(T gap) const {
      const T nearness = minimum_separation / larger(gap, T(minimum_separation));
      return select(gap < cut_off, T(pull_off * nearness * nearness), T(0.0));
    }
    /// J, zero at the cut-off.
    double energy(double gap) const {
      if (gap >= cut_off) return 0.0;
      const double beyond = larger(gap, minimum_separation), far = larger(cut_off, minimum_separation);
      const double h2 = minimum_separation * minimum_separation;
      const double constant = smaller(minimum_separation, larger(cut_off, 0.0));
      const double power = cut_off > minimum_separation ? h2 * (1.0 / beyond - 1.0 / far) : 0.0;
      return -pull_off * (power + larger(constant - gap, 0.0));
    }
  };
  template <class C, class Get>
  static At<C> at(Get get, C radius) {
    return {C(get(&ShortRangeAttraction::pull_off) * radius), get(&ShortRangeAttraction::minimum_separation),
            get(&ShortRangeAttraction::cut_off)};
  }
  double range() const { return cut_off; }
};

/// Two surfaces as they meet in one step.
template <class T>
struct Meeting {
  Vector3<T> normal;    ///< unit, from the partner to the sphere
  T overlap;            ///< m
  Vector3<T> velocity;  ///< m/s, of the sphere's surface relative to the partner's
  Vector3<T> spin;      ///< rad/s, sphere minus partner; read by rolling and twisting only
};

/// What a contact does to the sphere.
template <class T>
struct Reaction {
  T push{};               ///< N, N - A, along the normal
  Vector3<T> tangential;  ///< N
  Vector3<T> couple;      ///< N m, rolling and twisting
  History<T> history;
  T touch{};       ///< 1 or 0
  T dissipated{};  ///< J in this step
};

template <class NormalPart, class TangentialPart, class ResistancePart, class AttractionPart>
struct ContactLaw {
  using Resistance = ResistancePart;
  NormalPart normal;
  TangentialPart tangential;
  ResistancePart resistance;
  AttractionPart attraction;
  double cap_weight = 0.0;  ///< b of the Coulomb limit

  static constexpr int history_rows = ResistancePart::remembers ? 2 : 1;

  /// m, beyond touching, for spheres up to this reduced radius.
  double range(double largest_radius) const { return larger(normal.range(largest_radius), attraction.range()); }

  /// The law of pairs of one reduced mass [kg] and radius [m] (C double), or of one each per lane.
  template <class C>
  struct At {
    typename NormalPart::template At<C> normal;
    typename TangentialPart::template At<C> tangential;
    typename ResistancePart::template At<C> resistance;
    typename AttractionPart::template At<C> attraction;
    C cap_weight;

    template <class T>
    Reaction<T> operator()(const Meeting<T>& m, const History<T>& before, double time_step) const {
      const T normal_velocity = dot(m.velocity, m.normal);
      const Vector3<T> slip_velocity = m.velocity - normal_velocity * m.normal;
      const NormalForce<T> push = normal(m.overlap, normal_velocity, before.radius);
      const T pull = attraction(T(-m.overlap)) + push.pull;
      const T load = push.touch * larger(T(push.total + cap_weight * pull), T(0.0));
      const Vector3<T> turned = before.slip - dot(before.slip, m.normal) * m.normal;
      const SlipForce<Vector3<T>> slip = tangential(turned, slip_velocity, push, before.radius, load, time_step);
      const Couple<T> couple = resistance(m.normal, m.spin, before, load, time_step);
      Reaction<T> r{push.total - pull,
                    push.touch * slip.force,
                    push.touch * couple.torque,
                    {push.touch * slip.kept, push.radius, push.touch * couple.roll, T(push.touch * couple.twist)},
                    push.touch,
                    T(0.0)};
      const T taken =
          (push.elastic - push.total) * normal_velocity - dot(r.tangential, slip_velocity) - dot(r.couple, m.spin);
      r.dissipated = taken * time_step + push.released + stored(before) - stored(r.history);
      return r;
    }

    /// J, of the springs beside the normal one.
    template <class T>
    T stored(const History<T>& h) const {
      return tangential.energy(h.slip, h.radius) + resistance.energy(h.roll, h.twist);
    }
    /// J, lost with a contact that is no more.
    double given_up(const History<double>& h) const { return normal.released(h.radius) + stored(h); }
    /// J, elastic, and of the attraction (which is negative).
    double elastic_energy(double overlap, const History<double>& h) const {
      return normal.energy(overlap, h.radius) + stored(h);
    }
    double attraction_energy(double overlap) const { return attraction.energy(-overlap); }
  };

  At<double> at(double mass, double radius) const {
    return make_at<double>([this](auto) { return this; }, mass, radius);
  }
  /// `laws(k)` is the law of lane k.
  template <class LawOfLane>
  static At<Lane> at_lanes(LawOfLane laws, Lane mass, Lane radius) {
    return make_at<Lane>(laws, mass, radius);
  }

 private:
  template <class C, class LawOfLane>
  static At<C> make_at(LawOfLane laws, C mass, C radius) {
    const auto coefficient = [&](auto value) {
      if constexpr (std::same_as<C, double>)
        return value(*laws(0));
      else
        return Lane([&](auto k) { return value(*laws(k)); });
    };
    const auto get = [&](auto part) {
      return [&, part](auto field) { return coefficient([&](const ContactLaw& law) { return law.*part.*field; }); };
    };
    return {NormalPart::template at<C>(get(&ContactLaw::normal), mass, radius),
            TangentialPart::template at<C>(get(&ContactLaw::tangential), mass),
            ResistancePart::template at<C>(get(&ContactLaw::resistance), mass, radius),
            AttractionPart::template at<C>(get(&ContactLaw::attraction), radius),
            coefficient([](const ContactLaw& law) { return law.cap_weight; })};
  }
};

}  // namespace dem
