#pragma once
// How far a bed has ordered: the mean correlation of neighbours' bond directions.
//
// P. J. Steinhardt, D. R. Nelson, M. Ronchetti, Phys. Rev. B 28 (1983) 784, eq. (1.3): the bonds r_ia of sphere i to
// its neighbours a have q_6m(i) = 1/N_i sum_a Y_6m(r_ia). P. R. ten Wolde, M. J. Ruiz-Montero, D. Frenkel, J. Chem.
// Phys. 104 (1996) 9932: neighbours i and j correlate by
//   c_ij = sum_m q_6m(i) q*_6m(j) / (|q_6(i)| |q_6(j)|)
// The addition theorem sum_m Y_6m(a) Y*_6m(b) = 13/(4 pi) P_6(a . b), P_6 Legendre's polynomial, makes it
//   c_ij = S_ij / sqrt(S_ii S_jj),  S_ij = sum_a sum_b P_6(r_ia . r_jb)
// Neighbours: centres closer than 1.3 times the sum of the radii. Bonds count alike whatever their length.
//
// A bed of equal spheres that orders shows it here first. Of 2,400 spheres one value scatters by 0.007, so that a line
// through a few tells a rise of 0.02, at which torque has lost some 2 % (dem/STEADY.md).
#include <array>
#include <span>

#include "dem/contact/state.hpp"

namespace dem {

/// The box that the spheres are in.
struct Box {
  Vec3 low, high;  ///< m
  std::array<bool, 3> periodic{false, false, false};
};

/// The mean of c_ij over all pairs of neighbours: 1 in a crystal, about a tenth in a disordered bed; 0 without pairs.
double bond_order(const State& state, const Box& box);

/// How much bond order rose over the times by a line of least squares; 0 unless that is `least_rise` and 3.5 of its
/// errors, or more. The error counts that neighbouring looks are correlated.
inline constexpr double least_rise = 0.02;
double ordering_rise(std::span<const double> time, std::span<const double> bond_order);

}  // namespace dem
