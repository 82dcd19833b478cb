#pragma once
// The choice of parts, and the force pass composed of them (dem/contact/forces/) for the instruction set in use
// (isa.hpp).
#include <memory>
#include <vector>

#include "data/texts.hpp"
#include "dem/contact/force_pass.hpp"

namespace dem {

enum class NormalLaw { linear, hertz, jkr };
enum class TangentialLaw { linear, mindlin };  ///< mindlin needs a contact radius: hertz or jkr
enum class ResistanceLaw { none, constant, spring };
enum class AttractionLaw { none, short_range };

struct LawChoice {
  NormalLaw normal = NormalLaw::linear;
  TangentialLaw tangential = TangentialLaw::linear;
  ResistanceLaw resistance = ResistanceLaw::none;
  AttractionLaw attraction = AttractionLaw::none;
};

/// Coefficients of one pair of materials, resolved; a part reads what it needs (contact_law.hpp).
struct PairCoefficients {
  double stiffness = 0.0;             ///< N/m, linear
  double young_modulus = 0.0;         ///< Pa, E*
  double shear_modulus = 0.0;         ///< Pa, G*
  double damping_ratio = 0.0;         ///< zeta
  bool tension = true;                ///< whether elastic + damping force may pull
  double tangential_stiffness = 0.0;  ///< N/m, linear
  double tangential_damping = 0.0;    ///< tangential dashpot / normal dashpot
  double friction = 0.0;
  double cap_weight = 0.0;  ///< b of the Coulomb limit
  double rolling_friction = 0.0, twisting_friction = 0.0;
  double rolling_stiffness = 0.0;   ///< N/m
  double rolling_damping = 0.0;     ///< fraction of critical, of a sphere rolling in place
  double adhesion = 0.0;            ///< J/m2, work of adhesion, JKR
  double pull_off = 0.0;            ///< N per metre of reduced radius, short-range attraction in contact
  double minimum_separation = 1.0;  ///< m
  double cut_off = 0.0;             ///< m
};

struct BedCoefficients {
  LawChoice choice;
  int materials = 1;
  std::vector<PairCoefficients> grain;          ///< materials x materials
  std::vector<PairCoefficients> wall;           ///< materials x bodies
  double equal_mass = 0.0, equal_radius = 0.0;  ///< kg, m of every sphere; 0 where spheres differ
};

/// The force pass composed of the parts that the bed chooses. Throws std::invalid_argument for parts that do not go
/// together.
std::shared_ptr<const ForcePass> make_force_pass(const BedCoefficients& bed);

}  // namespace dem

template <>
inline constexpr std::array data::texts_of<dem::NormalLaw> = {"linear", "hertz", "jkr"};
template <>
inline constexpr std::array data::texts_of<dem::TangentialLaw> = {"linear", "mindlin"};
template <>
inline constexpr std::array data::texts_of<dem::ResistanceLaw> = {"none", "constant", "spring"};
