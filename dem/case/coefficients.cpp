#include "dem/case/coefficients.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>

namespace dem {
namespace {

bool hertzian(const Contact& k) { return k.normal != NormalLaw::linear; }
bool mindlin(const Contact& k) { return k.tangential_law() == TangentialLaw::mindlin; }

std::string unread_spring(const Contact& k) {
  return hertzian(k) && mindlin(k) ? "is read by normal = \"linear\" or tangential = \"linear\" only" : "";
}
std::string unread_true_spring(const Contact& k) { return hertzian(k) ? "is read by normal = \"linear\" only" : ""; }
std::string unread_tangential_spring(const Contact& k) {
  return mindlin(k) ? "is read by tangential = \"linear\" only" : "";
}
std::string unread_modulus(const Contact& k) {
  return hertzian(k) ? "" : "is read by normal = \"hertz\" or \"jkr\" only";
}
std::string unread_resistance(const Contact& k) {
  return k.resistance == ResistanceLaw::none ? "is not read with resistance = \"none\"" : "";
}
std::string unread_rolling_spring(const Contact& k) {
  return k.resistance != ResistanceLaw::spring ? "is read by resistance = \"spring\" only" : "";
}
std::string unread_van_der_waals(const Contact& k) {
  if (k.normal == NormalLaw::jkr) return "is not read with normal = \"jkr\", which brings its own attraction";
  return k.cohesion == Cohesion::dmt ? "is read by cohesion = \"van_der_waals\" only" : "";
}
std::string unread_adhesion(const Contact& k) {
  const bool read = k.normal == NormalLaw::jkr || k.cohesion == Cohesion::dmt;
  return read ? "" : "is read by normal = \"jkr\" or cohesion = \"dmt\" only";
}

using C = Contact;
constexpr Coefficient contact_coefficients[]{
    {"friction", "1", 0.0, 10.0, "Coulomb friction between grains", &C::friction},
    {"wall_friction", "1", 0.0, 10.0, "Coulomb friction at walls; follows friction when not set", &C::friction,
     &C::wall_friction},
    {"hamaker", "J", 0.0, 1e-12, "Hamaker constant of eq. (1)", &C::hamaker, nullptr, unread_van_der_waals,
     Brings::a_force},
    {"wall_hamaker", "J", 0.0, 1e-12, "Hamaker constant at walls; follows hamaker when not set", &C::hamaker,
     &C::wall_hamaker, unread_van_der_waals, Brings::a_force},
    {"minimum_separation", "m", 1e-11, 1e-6, "minimum separation h_min of eq. (1)", &C::minimum_separation, nullptr,
     unread_van_der_waals},
    {"cut_off", "m", 0.0, 1e-4, "separation beyond which there is no attraction", &C::cut_off, nullptr,
     unread_van_der_waals},
    {"restitution", "1", 0.01, 1.0, "restitution of a head-on collision without attraction", &C::restitution},
    {"stiffness", "N/m", 1e-3, 1e9, "normal spring between grains", &C::stiffness, nullptr, unread_spring},
    {"wall_stiffness", "N/m", 1e-3, 1e9, "normal spring at walls; follows stiffness when not set", &C::stiffness,
     &C::wall_stiffness, unread_spring},
    {"tangential_ratio", "1", 0.0, 2.0, "tangential / normal stiffness", &C::tangential_ratio, nullptr,
     unread_tangential_spring},
    {"tangential_damping", "1", 0.0, 2.0, "tangential / normal dashpot", &C::tangential_damping},
    {"wall_restitution", "1", 0.01, 1.0, "restitution at walls; follows restitution when not set", &C::restitution,
     &C::wall_restitution},
    {"young_modulus", "Pa", 1e3, 1e13, "Young's modulus of a grain", &C::young_modulus, nullptr, unread_modulus},
    {"wall_young_modulus", "Pa", 1e3, 1e15, "Young's modulus of walls; follows young_modulus", &C::young_modulus,
     &C::wall_young_modulus, unread_modulus},
    {"poisson_ratio", "1", 0.0, 0.5, "Poisson's ratio of grains and walls", &C::poisson_ratio, nullptr, unread_modulus},
    {"rolling_friction", "1", 0.0, 10.0, "rolling torque / (reduced radius * load), at most", &C::rolling_friction,
     nullptr, unread_resistance, Brings::a_force},
    {"wall_rolling_friction", "1", 0.0, 10.0, "rolling friction at walls; follows rolling_friction",
     &C::rolling_friction, &C::wall_rolling_friction, unread_resistance, Brings::a_force},
    {"twisting_friction", "1", 0.0, 10.0, "torque about the normal / (reduced radius * load)", &C::twisting_friction,
     nullptr, unread_resistance, Brings::a_force},
    {"rolling_stiffness_ratio", "1", 1e-6, 10.0, "rolling / normal stiffness", &C::rolling_stiffness_ratio, nullptr,
     unread_rolling_spring},
    {"rolling_damping", "1", 0.0, 2.0, "rolling dashpot, of critical", &C::rolling_damping, nullptr,
     unread_rolling_spring},
    {"work_of_adhesion", "J/m2", 0.0, 100.0, "work of adhesion between grains, jkr and dmt", &C::work_of_adhesion,
     nullptr, unread_adhesion, Brings::a_force},
    {"wall_work_of_adhesion", "J/m2", 0.0, 100.0, "work of adhesion at walls; follows work_of_adhesion when not set",
     &C::work_of_adhesion, &C::wall_work_of_adhesion, unread_adhesion, Brings::a_force},
    {"true_stiffness", "N/m", 1e-3, 1e12,
     "stiffness of the real grain: attraction scaled by the root of stiffness / it", &C::stiffness, &C::true_stiffness,
     unread_true_spring, Brings::a_force},
    {"true_young_modulus", "Pa", 1e3, 1e13,
     "Young's modulus of the real grain: attraction scaled by (young_modulus / it)^0.4", &C::young_modulus,
     &C::true_young_modulus, unread_modulus, Brings::a_force},
};

}  // namespace

std::span<const Coefficient> coefficients() { return contact_coefficients; }

std::string unread(const Contact& k, std::string_view key) {
  const auto found = std::find_if(std::begin(contact_coefficients), std::end(contact_coefficients),
                                  [&](const Coefficient& one) { return one.key == key; });
  if (found == std::end(contact_coefficients)) throw std::out_of_range("no coefficient named " + std::string(key));
  return found->unread != nullptr ? found->unread(k) : "";
}

}  // namespace dem
