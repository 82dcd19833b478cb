#pragma once
// Which spheres a case's bed is made of.
//
// Mass fractions f_c of classes (one material and size, or one material with log-normal sizes) become numbers of
// spheres n_c ~ f_c / m_c, m_c the mean mass of a sphere of the class; whole numbers by largest remainders, so that the
// bed depends on no random number where sizes are listed. Log-normal sizes have the mass below a diameter d as
// Phi(ln(d / median) / s), s = ln geometric_sd, cut off at low and high; the number below d is then log-normal too,
// with ln median' = ln median - 3 s^2 (T. Hatch & S. Choate, J. Franklin Inst. 207:369 (1929)). They are drawn one from
// each n-th part of the numbers, which keeps the mass of a bed close to what was asked for.
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "dem/case/case.hpp"

namespace dem {

/// Volume of spheres / volume of the bed that they settle to, for estimates. It lies between random loose packing,
/// 0.555 (G. Onoda & E. Liniger, Phys. Rev. Lett. 64:2727 (1990)), and random close packing, 0.64.
inline constexpr double packing_fraction = 0.6;
/// The packing fraction of a bed looser than any powder makes. A tool that misses even this bed meets no powder.
inline constexpr double loosest_bed = 0.5;

/// The components of a bed; a bed of one material has one.
std::vector<Component> components_of(const Case& c);
std::vector<std::string> grain_names(const Case& c);

/// Spheres of one component, of one size or of its log-normal distribution.
struct GrainClass {
  std::size_t component = 0;
  double diameter = 0.0;   ///< m; 0 where sizes are drawn
  double mean_mass = 0.0;  ///< kg
  std::size_t count = 0;
};

struct BedSummary {
  std::vector<GrainClass> classes;
  std::size_t spheres = 0;
  double mass = 0.0, volume = 0.0;       ///< kg, m3, of all spheres; expected values where sizes are drawn
  double smallest = 0.0, largest = 0.0;  ///< m, diameters
  bool equal = false;                    ///< one class of one size
};
BedSummary summarise_bed(const Case& c);

/// Smallest diameter of a material [m].
double smallest_diameter(const Material& m);
/// Diameter of a sphere of mean mass [m].
double mean_diameter(const Material& m);

/// a b / (a + b) of two radii or masses. Exactly a / 2 where both are equal, so that equal spheres get the same bits.
inline double reduced_value(double a, double b) { return a == b ? 0.5 * a : a * b / (a + b); }

/// The spheres of a bed, largest first. A list holds one value for all of them, or one for each.
struct Grains {
  std::vector<double> radius;           ///< m
  std::vector<double> density;          ///< kg/m3
  std::vector<std::uint32_t> material;  ///< index of the component; empty: all 0
};
Grains draw_grains(const Case& c, std::uint64_t seed);

/// The volume [m3] and the mass [kg] of the first `count` spheres.
double solid_volume(const Grains& grains, std::size_t count);
double solid_mass(const Grains& grains, std::size_t count);

}  // namespace dem
