#pragma once
// Training designs: Owen-scrambled Sobol points.
//
// The sequence is GSL's gsl_qrng_sobol (Antonov & Saleev's Gray-code order, direction numbers of Bratley & Fox 1988, up
// to 40 dimensions, 30 bits) with the origin, which GSL leaves out, put back as point 0, so that the first 2^k points
// are a digital net. Scrambling is Owen's nested uniform scrambling (A. B. Owen, "Randomly permuted (t,m,s)-nets and
// (t,s)-sequences", 1995): bit b of a coordinate is flipped by a random bit that depends on the seed, the dimension and
// the b higher bits before it. That random bit is a hash (Philox keyed by data::RandomStream(seed, design_scramble,
// dimension)), so no permutation tree is stored. Below the 30 bits of the sequence the coordinate is uniform.
#include <Eigen/Core>
#include <cstdint>

namespace surrogate {

/// Largest dimension of scrambled_sobol (GSL's table of direction numbers).
inline constexpr int sobol_max_dimension = 40;

/// Points `first` ... `first + points - 1` of the scrambled sequence, one per row, in the open unit cube. A point
/// depends on its index, the dimension's index and the seed alone: a longer design starts with the shorter one.
Eigen::MatrixXd scrambled_sobol(int points, int dimension, std::uint64_t seed, int first = 0);

}  // namespace surrogate
