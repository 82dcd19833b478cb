#pragma once
// Several contacts at once: lanes of the widest registers of the instruction set that is compiled for, and the few
// operations that the laws need, both for one double and for lanes. Every operation is elementwise and exactly rounded,
// so a contact's force depends neither on the width nor on its neighbours in the lanes.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <experimental/simd>

#include "dem/walls/vec3.hpp"

// What runs in lanes is one loop to the compiler. Under sanitizers, whose checks make that loop take minutes to
// compile, calls stay calls.
#ifdef __SANITIZE_ADDRESS__
#define DEMCAL_INLINE inline
#define DEMCAL_FLATTEN
#else
#define DEMCAL_INLINE [[gnu::always_inline]] inline
#define DEMCAL_FLATTEN [[gnu::flatten]]
#endif

namespace dem {

namespace stdx = std::experimental;
using Lane = stdx::native_simd<double>;
inline constexpr int lanes = static_cast<int>(Lane::size());
static_assert(lanes == 2 || lanes == 4 || lanes == 8, "rows are transposed so many at a time");

DEMCAL_INLINE double select(bool condition, double yes, double no) { return condition ? yes : no; }
DEMCAL_INLINE Lane select(Lane::mask_type condition, Lane yes, Lane no) {
  stdx::where(condition, no) = yes;
  return no;
}
DEMCAL_INLINE double square_root(double a) { return std::sqrt(a); }
DEMCAL_INLINE Lane square_root(Lane a) { return stdx::sqrt(a); }
inline double cube_root(double a) { return std::cbrt(a); }
DEMCAL_INLINE Lane cube_root(Lane a) {
  return Lane([&](auto k) { return std::cbrt(static_cast<double>(a[k])); });
}
DEMCAL_INLINE double larger(double a, double b) { return a > b ? a : b; }
DEMCAL_INLINE Lane larger(Lane a, Lane b) { return stdx::max(a, b); }
DEMCAL_INLINE double smaller(double a, double b) { return a < b ? a : b; }
DEMCAL_INLINE Lane smaller(Lane a, Lane b) { return stdx::min(a, b); }
template <class T>
T norm(Vector3<T> a) {
  return square_root(dot(a, a));
}
inline double norm(double a) { return std::abs(a); }
DEMCAL_INLINE Lane norm(Lane a) { return stdx::abs(a); }
/// The same vector in every lane.
DEMCAL_INLINE Vector3<Lane> spread(Vec3 a) { return {Lane(a.x), Lane(a.y), Lane(a.z)}; }
/// One bit per lane, the first lane lowest.
DEMCAL_INLINE unsigned bits(Lane::mask_type mask) { return static_cast<unsigned>(mask.__to_bitset().to_ulong()); }

/// 1 in the first `used` lanes, 0 beyond.
DEMCAL_INLINE Lane first_lanes(int used) {
  alignas(64) static constexpr double ones[16] = {1, 1, 1, 1, 1, 1, 1, 1};
  return Lane(ones + 8 - used, stdx::element_aligned);
}

/// Four doubles moved and added as one; lowered to what the instruction set has.
typedef double Four __attribute__((vector_size(32), may_alias));
inline const Four& four(const double& first) { return reinterpret_cast<const Four&>(first); }
inline Four& four(double& first) { return reinterpret_cast<Four&>(first); }

/// A vector, and 0.
DEMCAL_INLINE Four four(const Vec3& a) { return Four{a.x, a.y, a.z, 0.0}; }
/// The first three numbers of the four.
DEMCAL_INLINE Vec3 three(const Four& a) { return {a[0], a[1], a[2]}; }

/// A row of four doubles per lane, transposed.
struct LaneRows {
  Vector3<Lane> v;
  Lane w;
};

namespace detail {
struct Square {
  Four row[4];
};
DEMCAL_INLINE Square transpose(Four a, Four b, Four c, Four d) {
  const Four ab0 = __builtin_shufflevector(a, b, 0, 4, 2, 6), ab1 = __builtin_shufflevector(a, b, 1, 5, 3, 7);
  const Four cd0 = __builtin_shufflevector(c, d, 0, 4, 2, 6), cd1 = __builtin_shufflevector(c, d, 1, 5, 3, 7);
  return {{__builtin_shufflevector(ab0, cd0, 0, 1, 4, 5), __builtin_shufflevector(ab1, cd1, 0, 1, 4, 5),
           __builtin_shufflevector(ab0, cd0, 2, 3, 6, 7), __builtin_shufflevector(ab1, cd1, 2, 3, 6, 7)}};
}
/// One component of every lane, as fours.
template <class L>
struct Column {
  Four part[L::size() / 4];
};

template <class L, class Row>
DEMCAL_INLINE LaneRows gather(Row&& row) {
  if constexpr (L::size() % 4 == 0) {
    Column<L> column[4];
    for (std::size_t p = 0; p < L::size() / 4; ++p) {
      const int k = static_cast<int>(4 * p);
      const Square s = transpose(row(k), row(k + 1), row(k + 2), row(k + 3));
      for (int c = 0; c < 4; ++c) column[c].part[p] = s.row[c];
    }
    return {{std::bit_cast<L>(column[0]), std::bit_cast<L>(column[1]), std::bit_cast<L>(column[2])},
            std::bit_cast<L>(column[3])};
  } else {
    Four rows[L::size()];
    for (std::size_t k = 0; k < L::size(); ++k) rows[k] = row(static_cast<int>(k));
    const auto column = [&](int c) { return L([&](auto k) { return rows[k][c]; }); };
    return {{column(0), column(1), column(2)}, column(3)};
  }
}

template <class L>
DEMCAL_INLINE void scatter(const Vector3<L>& v, const L& w, Four* out) {
  if constexpr (L::size() % 4 == 0) {
    const Column<L> x = std::bit_cast<Column<L>>(v.x), y = std::bit_cast<Column<L>>(v.y),
                    z = std::bit_cast<Column<L>>(v.z), last = std::bit_cast<Column<L>>(w);
    for (std::size_t p = 0; p < L::size() / 4; ++p) {
      const Square s = transpose(x.part[p], y.part[p], z.part[p], last.part[p]);
      for (int k = 0; k < 4; ++k) out[4 * p + k] = s.row[k];
    }
  } else {
    for (std::size_t k = 0; k < L::size(); ++k) out[k] = Four{v.x[k], v.y[k], v.z[k], w[k]};
  }
}

/// `sum` plus the lanes' values, which belong to the contacts first, first + 1, ...
template <class L>
DEMCAL_INLINE Four added(Four sum, const L& lane, std::size_t first) {
  if constexpr (L::size() % 4 == 0) {
    for (const Four four_contacts : std::bit_cast<Column<L>>(lane).part) sum += four_contacts;
    return sum;
  } else {
    const double a = lane[0], b = lane[1];
    return sum + (first % 4 == 0 ? Four{a, b, 0.0, 0.0} : Four{0.0, 0.0, a, b});
  }
}
}  // namespace detail

/// A sum over contacts. It is kept as four sums, each over every fourth contact, so that it has the same bits however
/// many lanes there are.
class Tally {
 public:
  /// Adds the values of the contacts first, first + 1, ..., counted from anywhere by whole lanes.
  DEMCAL_INLINE void add(const Lane& values, std::size_t first) { sum_ = detail::added(sum_, values, first); }
  void add_to(double& total, double factor = 1.0) const {
    for (int k = 0; k < 4; ++k) total += factor * sum_[k];
  }

 private:
  Four sum_{};
};

/// The lanes' rows, transposed. `row(k)` gives lane k's four doubles.
template <class Row>
DEMCAL_INLINE LaneRows transposed(Row&& row) {
  return detail::gather<Lane>(row);
}

/// Writes lane k's four doubles of `rows` into out[k].
DEMCAL_INLINE void untransposed(const LaneRows& rows, Four* out) { detail::scatter<Lane>(rows.v, rows.w, out); }

}  // namespace dem
