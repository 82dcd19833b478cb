#pragma once
// One DEM case as plain data: the rig, the materials, the contact law and how long to run. SI units throughout.
// Everything a study may calibrate or control is reached by name (dem/reading/target.hpp).
#include <memory>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "data/texts.hpp"
#include "dem/case/stl_rig.hpp"
#include "dem/contact/laws.hpp"

namespace dem {

enum class EndPlates { turning, resting, none };  ///< with the shell; beside it; the drum repeats along its axis

/// A horizontal drum without lifters, its axis along y (dem/rig/drum.hpp).
struct Drum {
  double radius = 42e-3;  ///< m, inside
  double length = 20e-3;  ///< m, between the end plates
  EndPlates end_plates = EndPlates::turning;

  double volume() const { return std::numbers::pi * radius * radius * length; }  ///< m3
};

/// Dimensions of a machine of two augers beside the slice's cross-section (dem/rig/machine.hpp).
struct Machine {
  double length = 330e-3;           ///< m, between the end walls
  double opening = 30e-3;           ///< m along the axes, opening of the partition at each end
  double partition = 1e-3;          ///< m, thickness of the partition
  double partition_height = 12e-3;  ///< m above the axes, upper edge of the partition
  double sill = -3.5e-3;            ///< m above the axes, lower edge of the openings
};

/// The horizontal auger slice: shaft and helical blade, turning about +x in an open U-trough; periodic along x. When
/// `machine` is set, two such augers in a double trough. When `drum` is set, that drum, and when `stl` is set, the
/// user's meshes; then only fill and angular velocity are used here, and of a drum the level.
struct Rig {
  std::shared_ptr<const StlRig> stl;
  std::optional<Drum> drum;
  std::optional<Machine> machine;
  double shaft_radius = 2.5e-3;                  ///< m
  double blade_radius = 6.0e-3;                  ///< m
  double blade_thickness = 1.0e-3;               ///< m, along the axis
  double pitch = 12.0e-3;                        ///< m, right-handed
  double trough_radius = 7.1e-3;                 ///< m, half circle below the axis; vertical side walls above
  int pitches = 1;                               ///< periods of the helix in the box
  double fill = 2400.0;                          ///< number of spheres in the box, rounded
  std::optional<double> fill_mass;               ///< kg in the box; when set, the number follows from it
  std::optional<double> level;                   ///< bed / room (level_volume); when set, the number follows from it
  double angular_velocity = 15.707963267948966;  ///< rad/s about +x (150 rpm), of a drum about -y, or the meshes' axes

  double clearance() const { return trough_radius - blade_radius; }  ///< m, between blade and trough
};

/// A share of a material's mass that is in spheres of one diameter.
struct SizeShare {
  double diameter = 0.0;  ///< m
  double mass_fraction = 0.0;
};

/// Log-normal sizes: the logarithm of the diameter is normal by mass, and none lies outside [low, high]
/// (dem/case/grains.hpp).
struct LogNormalSizes {
  double geometric_sd = 1.2;     ///< exp of the standard deviation of the logarithm
  double low = 0.0, high = 0.0;  ///< m
};

struct Material {
  std::string name = "grain";
  double density = 6090.0;                             ///< kg/m3
  double diameter = 0.8e-3;                            ///< m; the median by mass of log-normal sizes
  double coarse_graining = 1.0;                        ///< l: diameter here / diameter of the original grain
  std::vector<SizeShare> sizes;                        ///< instead of one diameter
  std::optional<LogNormalSizes> log_normal;            ///< log-normal sizes, instead of one diameter
  std::optional<double> young_modulus, poisson_ratio;  ///< Pa, 1; the contact's where not set
};

/// A material that makes up part of the bed.
struct Component {
  Material material;
  double mass_fraction = 1.0;  ///< of the bed; relative to the sum over the components
};

enum class LengthScale { diameter, radius };          ///< what L of eq. (1) is
enum class WallAttraction { as_grains, derjaguin };   ///< as_grains: eq. (1); derjaguin: twice that (sphere on plane)
enum class HamakerOf { simulation, original };        ///< whether `hamaker` is H* or H = H*/l^n
enum class FrictionCap { net, repulsion, thornton };  ///< load of the Coulomb limit: options (a), (b), (c)
enum class DashpotTension { allowed, clamped };       ///< whether elastic + damping force may pull

enum class Cohesion { van_der_waals, dmt };  ///< attraction beside the normal law; `jkr` brings its own

/// The contact law (dem/contact/contact_law.hpp). A coefficient of a wall that is not set follows that of the grains.
struct Contact {
  NormalLaw normal = NormalLaw::linear;
  std::optional<TangentialLaw> tangential;  ///< follows normal: linear, or mindlin with hertz and jkr
  ResistanceLaw resistance = ResistanceLaw::none;
  double stiffness = 100.0;                  ///< N/m, linear, grain-grain
  std::optional<double> wall_stiffness;      ///< N/m
  double young_modulus = 5e6;                ///< Pa, of a grain; read by hertz and jkr
  double poisson_ratio = 0.25;               ///< of grains and walls
  std::optional<double> wall_young_modulus;  ///< Pa; may be infinite
  double restitution = 0.7;                  ///< in a head-on collision without attraction, tension allowed
  std::optional<double> wall_restitution;
  std::optional<double> restitution_at;  ///< m/s; when set, restitution holds at this speed, attraction included
  double tangential_ratio = 2.0 / 7.0;   ///< kt / k, linear
  double tangential_damping = 0.5;       ///< tangential dashpot / normal dashpot
  double friction = 0.4;                 ///< Coulomb coefficient, grain-grain
  std::optional<double> wall_friction;
  DashpotTension tension = DashpotTension::allowed;
  FrictionCap cap = FrictionCap::repulsion;
  double rolling_friction = 0.0;  ///< rolling torque at most this times R* times the cap's load
  std::optional<double> wall_rolling_friction;
  double twisting_friction = 0.0;              ///< twisting torque at most this times R* times the cap's load
  double rolling_stiffness_ratio = 2.0 / 7.0;  ///< rolling spring / normal stiffness (hertz: at 1 % overlap)
  double rolling_damping = 0.3;                ///< fraction of critical
  Cohesion cohesion = Cohesion::van_der_waals;
  double hamaker = 0.0;                ///< J, H* (or H with hamaker_of = original)
  std::optional<double> wall_hamaker;  ///< J
  HamakerOf hamaker_of = HamakerOf::simulation;
  double hamaker_power = 3.0;  ///< n of H* = l^n H; 3: the source paper's eq. (2)
  LengthScale length_scale = LengthScale::diameter;
  WallAttraction wall_attraction = WallAttraction::as_grains;
  double minimum_separation = 1.5e-9;           ///< m, h_min of eq. (1); constant attraction below it and in contact
  double cut_off = 100e-9;                      ///< m, no attraction beyond
  double work_of_adhesion = 0.0;                ///< J/m2, w = 2 gamma of equal materials: jkr and dmt
  std::optional<double> wall_work_of_adhesion;  ///< J/m2
  std::optional<double> true_stiffness;         ///< N/m (linear) of the real grain: attraction scaled by sqrt(k / it)
  std::optional<double> true_young_modulus;  ///< Pa (hertz, jkr) of the real grain: attraction scaled by (E / it)^0.4

  TangentialLaw tangential_law() const {
    return tangential.value_or(normal == NormalLaw::linear ? TangentialLaw::linear : TangentialLaw::mindlin);
  }
};

/// Coefficients of the contacts between two materials; what is not set is the contact law's. The names are those of
/// materials in the bed, of a body or its material, or "wall" for every body.
struct PairContact {
  std::string first, second;
  std::optional<double> stiffness;    ///< N/m
  std::optional<double> restitution;  ///< as Contact's
  std::optional<double> friction, rolling_friction, twisting_friction;
  std::optional<double> hamaker;           ///< J, as Contact's
  std::optional<double> work_of_adhesion;  ///< J/m2
};

struct RunControl {
  double gravity = 9.81;            ///< m/s2 along -z
  double steps_per_contact = 30.0;  ///< shortest contact duration / time step
  std::optional<double> time_step;  ///< s, when set; at most a fifteenth of that duration
  double overlap_limit = 0.1;       ///< share of a radius; a deeper contact ends the run, one half as deep is counted
  double skin = 0.12;               ///< skin of the neighbour list, in diameters
  double settle = 0.08;             ///< s, time in which the filling comes to rest before the tool turns
  double start_up = 0.2;            ///< s of turning dropped at least, before means are taken, and
  double start_up_turns = 2.0;      ///< turns at least (dem/STEADY.md)
  double sample_interval = 0.2e-3;  ///< s between samples; each is the mean over the steps since the last
  double window = 20e-3;            ///< s, torque_fluctuation is the deviation of torque averaged over it
  double standard_error = 0.02;     ///< wanted relative standard error of the mean torque
  double shortest = 1.0;            ///< s of measured turning at least, and
  double shortest_turns = 2.0;      ///< turns at least
  double longest = 6.0;             ///< s of turning at most, start-up included
  std::vector<std::string> known;   ///< outputs beside the torque: the run goes on until their errors are known
};

struct Case {
  Rig rig;
  Material material;                  ///< the bed, unless it has components; then only its name and coarse graining
  std::vector<Component> components;  ///< what a mixture is made of
  Contact contact;
  std::vector<PairContact> pairs;  ///< later ones win
  RunControl run;
};

}  // namespace dem

// The texts as the study's keys and the settings of a run spell them.
template <>
inline constexpr std::array data::texts_of<dem::EndPlates> = {"turning", "resting", "none"};
template <>
inline constexpr std::array data::texts_of<dem::LengthScale> = {"diameter", "radius"};
template <>
inline constexpr std::array data::texts_of<dem::WallAttraction> = {"as_grains", "derjaguin"};
template <>
inline constexpr std::array data::texts_of<dem::HamakerOf> = {"simulation", "original"};
template <>
inline constexpr std::array data::texts_of<dem::FrictionCap> = {"net", "repulsion", "thornton"};
template <>
inline constexpr std::array data::texts_of<dem::DashpotTension> = {"allowed", "clamped"};
template <>
inline constexpr std::array data::texts_of<dem::Cohesion> = {"van_der_waals", "dmt"};
