#pragma once
// A case of each family of contact laws.
#include <string>
#include <vector>

#include "tests/dem/shot.hpp"

namespace scene {

struct Family {
  std::string name;
  dem::Case c;
};

/// One of each normal law, bare and with all that attracts and resists.
inline std::vector<Family> families(double restitution) {
  std::vector<Family> all;
  dem::Case c;
  c.run.overlap_limit = 1.0;  // the laws are looked at, not whether a rig pinches or a stir is violent
  c.contact.restitution = restitution;
  c.contact.tangential_damping = 0.5;
  all.push_back({"linear", c});
  c.contact.hamaker = 4e-18;
  c.contact.cap = dem::FrictionCap::thornton;
  all.push_back({"linear, van der Waals, cap (c)", c});
  c.contact.resistance = dem::ResistanceLaw::spring;
  c.contact.rolling_friction = c.contact.twisting_friction = 0.2;
  all.push_back({"linear, van der Waals, rolling spring", c});
  c.contact.hamaker = 0.0;
  c.contact.resistance = dem::ResistanceLaw::constant;
  c.contact.normal = dem::NormalLaw::hertz;
  all.push_back({"Hertz-Mindlin, constant rolling", c});
  c.contact.resistance = dem::ResistanceLaw::none;
  all.push_back({"Hertz-Mindlin", c});
  c.contact.cohesion = dem::Cohesion::dmt;
  c.contact.work_of_adhesion = 0.01;
  all.push_back({"Hertz-Mindlin, DMT", c});
  c.contact.tangential = dem::TangentialLaw::linear;
  all.push_back({"Hertz, linear tangential, DMT", c});
  c.contact.tangential.reset();
  c.contact.normal = dem::NormalLaw::jkr;
  c.contact.resistance = dem::ResistanceLaw::spring;
  all.push_back({"JKR, rolling spring", c});
  return all;
}

/// Seconds: of the head-on contact at this speed.
inline double contact_duration(const dem::Case& c, double speed) {
  dem::Case bare = c;
  bare.contact.hamaker = bare.contact.work_of_adhesion = 0.0;
  if (bare.contact.normal == dem::NormalLaw::jkr) bare.contact.normal = dem::NormalLaw::hertz;
  dem::Encounter e;
  e.sphere = scene::ball(c.material.density, 0.5 * c.material.diameter);
  e.partner = e.sphere;
  e.sphere.velocity.z = -speed;
  return dem::collide(*dem::make_force_pass(scene::bed_for(bare, e)), e).duration;
}

}  // namespace scene
