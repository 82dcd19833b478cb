#pragma once
// Contact laws, composed from parts at compile time; each part is a plain struct of coefficients for one class of
// pairs (grain-grain, grain-wall), so nothing is looked up or dispatched per contact.
//
// Geometry: unit normal n from the partner to the sphere, overlap delta = r_i + r_j - distance [m] (negative: a gap),
// u = velocity of the sphere's surface relative to the partner's at the contact point [m/s], u_n = u.n (separating >
// 0).
//
// normal      N = k delta - c u_n, c = 2 zeta sqrt(k m*), zeta = -ln e / sqrt(pi^2 + ln^2 e); with the tension of the
//             dashpot allowed, or N clamped at 0 (then the restitution is another: dem/README.md)
// tangential  spring s: projected into the contact plane (no rescaling; the loss is of second order in the turn of the
//             normal per step), then s += u_t dt. Sticking T = -kt s - ct u_t; where kt |s| > cap the contact slides:
//             T = -cap s/|s| without dashpot, and s is cut back to cap / kt. Cap = mu max(0, N + b A), b = -1, 0, +1
//             for the net force (a), the repulsion (b) and Thornton's net + 2 A (c).
// attraction  Tanaka et al., PARTICLES 2011, eq. (1): A = H L / (12 h^2), h = max(gap, h_min), zero beyond the cut-off;
//             constant H L / (12 h_min^2) in contact.
// force on the sphere = (N - A) n + T.
//
// The parts are branch-free, so that a loop over contacts is vectorised by the compiler.
#include <algorithm>
#include <cmath>
#include <concepts>

#include "dem/vec3.hpp"

namespace dem {

/// Linear spring-dashpot; `Clamped`: elastic + damping force never pulls.
template <bool Clamped>
struct LinearNormal {
  double stiffness = 0.0;  ///< N/m
  double damping = 0.0;    ///< N s/m
  double force(double overlap, double normal_velocity) const {
    const double f = stiffness * overlap - damping * normal_velocity;
    if constexpr (Clamped) return f > 0.0 ? f : 0.0;
    return f;
  }
};

/// Elastic (and history-carrying) tangential part with a Coulomb slider.
struct LinearTangential {
  double stiffness = 0.0;  ///< N/m
  double damping = 0.0;    ///< N s/m
  double friction = 0.0;   ///< Coulomb coefficient
  struct Result {
    Vec3 force, spring;
  };
  Result force(Vec3 spring, Vec3 slip_velocity, double cap) const {
    const double elastic = stiffness * length(spring);
    const bool sliding = elastic > cap;
    const double cut = sliding ? cap / elastic : 1.0;
    const double dashpot =
        (sliding ? 0.0 : 1.0) * damping;  // a product: no load under a condition, which keeps lanes apart
    const Vec3 kept = cut * spring;
    return {-stiffness * kept - dashpot * slip_velocity, kept};
  }
};

struct NoAttraction {
  static constexpr double range() { return 0.0; }
  static constexpr double force(double) { return 0.0; }
};

/// Eq. (1) with a minimum separation and an outer cut-off.
struct VanDerWaals {
  double strength = 0.0;            ///< H L / 12 [J m]
  double minimum_separation = 0.0;  ///< m
  double cut_off = 0.0;             ///< m
  double range() const { return cut_off; }
  double force(double gap) const {
    const double h = gap > minimum_separation ? gap : minimum_separation;
    return gap < cut_off ? strength / (h * h) : 0.0;
  }
};

template <class T>
concept NormalPart = requires(const T t, double d) {
  { t.force(d, d) } -> std::convertible_to<double>;
};
template <class T>
concept AttractionPart = requires(const T t, double d) {
  { t.force(d) } -> std::convertible_to<double>;
  { t.range() } -> std::convertible_to<double>;
};
template <class T>
concept TangentialPart = requires(const T t, Vec3 v, double d) {
  { t.force(v, v, d).force } -> std::convertible_to<Vec3>;
};

/// What a contact does to the sphere. `push` is N - A, `spring` the tangential spring to keep.
struct ContactForce {
  double push = 0.0;
  Vec3 tangential;
  Vec3 spring;
};

template <NormalPart Normal, TangentialPart Tangential, AttractionPart Attraction>
struct ContactLaw {
  Normal normal;
  Tangential tangential;
  Attraction attraction;
  double cap_weight = 0.0;  ///< b of the Coulomb limit

  double range() const { return attraction.range(); }

  ContactForce operator()(Vec3 n, double overlap, Vec3 surface_velocity, Vec3 spring, double time_step) const {
    const double normal_velocity = dot(surface_velocity, n);
    const Vec3 slip_velocity = surface_velocity - normal_velocity * n;
    const bool touching = overlap > 0.0;
    const double touch = touching ? 1.0 : 0.0;
    const double repulsion = touch * normal.force(overlap, normal_velocity);
    const double pull = attraction.force(-overlap);
    const double load = repulsion + cap_weight * pull;
    const double cap = tangential.friction * (load > 0.0 ? load : 0.0);
    const Vec3 turned = spring - dot(spring, n) * n;
    const auto [force, kept] = tangential.force(turned + time_step * slip_velocity, slip_velocity, cap);
    return {repulsion - pull, touch * force, touch * kept};
  }
};

template <bool Clamped, class Attraction>
using LinearLaw = ContactLaw<LinearNormal<Clamped>, LinearTangential, Attraction>;

}  // namespace dem
