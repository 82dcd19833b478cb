#pragma once
// Contact laws, composed from parts at compile time. A part is a plain struct of coefficients for one pair of
// materials; its `At` holds what follows from them for a pair of given reduced mass and radius, as one double for all
// contacts of a bed of equal spheres or as lanes. Nothing is dispatched per contact, and no part branches, so that
// lanes stay together. The parts are in parts/, one file a kind.
//
// Geometry: unit normal n from the partner to the sphere, overlap delta [m] (negative: a gap), u = velocity of the
// sphere's surface relative to the partner's at the contact point [m/s], u_n = u.n (separating > 0), u_t the rest;
// w = spin of the sphere minus that of the partner [rad/s]; 1/R* = 1/r_i + 1/r_j, 1/m* = 1/m_i + 1/m_j (wall: r_i,
// m_i).
//
// The force on the sphere is (N - A) n + T: the normal law's repulsion N less the attraction A, and the tangential
// force T. What a contact dissipates in a step is the work done against T, the couples and the normal dashpot, less
// what the springs store more than before. Whatever is cut, scaled or projected is in it.
#include <concepts>

#include "dem/contact/parts/attraction.hpp"
#include "dem/contact/parts/history.hpp"
#include "dem/contact/parts/normal.hpp"
#include "dem/contact/parts/resistance.hpp"
#include "dem/contact/parts/tangential.hpp"

namespace dem {

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

  /// How far [m] beyond touching the law reaches, for spheres up to this reduced radius.
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

    /// Energy [J] in the springs beside the normal one.
    template <class T>
    T stored(const History<T>& h) const {
      return tangential.energy(h.slip, h.radius) + resistance.energy(h.roll, h.twist);
    }
    /// Energy [J] that is lost with a contact that is no more.
    double given_up(const History<double>& h) const { return normal.released(h.radius) + stored(h); }
    /// Energy [J] of the elastic force and of the attraction (whose part is negative).
    double elastic_energy(double overlap, const History<double>& h) const {
      return normal.energy(overlap, h.radius) + stored(h);
    }
    double attraction_energy(double overlap) const { return attraction.energy(-overlap); }
  };

  At<double> at(double mass, double radius) const {
    return make_at<double>([this](auto) { return this; }, mass, radius);
  }
  /// The laws of all lanes together. `laws(k)` is the law of lane k.
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
