#pragma once
// The moving state of a simulation as plain rows and slots. Copying it is a checkpoint: with the setup it decides every
// bit that follows.
//
// Particles are sorted along the cells of the neighbour list at each rebuild; `id` keeps who is who. Rows beyond the
// particles are their images across periodic faces ("ghosts"). The pair list is a half list, sorted by its first
// particle; the history of a pair in range has a place in its chunk's pool.
//
// Chunks. The particles are cut into chunks whose number depends on how many there are, never on the threads. A chunk's
// pairs add to the loads of its own particles directly, and to a halo of its own for partners elsewhere and ghosts;
// halos are then added to their owners in the order of the chunks. So any number of threads gives the same bits.
#include <algorithm>
#include <cstdint>
#include <vector>

#include "dem/walls/surface.hpp"
#include "dem/walls/vec3.hpp"

namespace dem {

struct alignas(32) PositionRow {
  Vec3 at;              ///< m; wrapped into the box at rebuilds only
  double radius = 0.0;  ///< m
};
struct alignas(64) MotionRow {
  Vec3 velocity;          ///< m/s
  double mass = 0.0;      ///< kg
  Vec3 spin;              ///< rad/s
  double material = 0.0;  ///< index into the tables of laws
};
struct HalfRow {
  Vec3 velocity, spin;  ///< m/s, rad/s
};
struct alignas(64) LoadRow {
  Vec3 force;                    ///< N
  double inverse_mass = 0.0;     ///< 1/kg; 0 for a sphere that keeps its velocity whatever the load
  Vec3 torque;                   ///< N m
  double inverse_inertia = 0.0;  ///< 1/(kg m2)
};
/// A vector and a number, four lanes.
struct alignas(32) VectorRow {
  Vec3 v;
  double w = 0.0;
};

/// Two rows that may touch: i < j, or j a ghost.
struct Pair {
  std::uint32_t i = 0, j = 0;
};

/// Whether the pair only fills the last word of a chunk's pairs; such a pair is never looked at.
inline bool is_padding(Pair p) { return p.i == p.j; }

/// A free list of history rows. A contact takes a place of `width` rows when it begins, and gives the place back when
/// it ends. Each chunk has a pool of its own, so that threads need no lock.
template <class Row>
struct Pool {
  std::uint32_t width = 1;
  std::vector<Row> rows;
  std::vector<std::uint32_t> free;  ///< places given back

  /// Takes a place, its rows reset.
  std::uint32_t take() {
    if (!free.empty()) {
      const std::uint32_t place = free.back();
      free.pop_back();
      std::fill_n(rows.begin() + place * width, width, Row{});
      return place;
    }
    if (rows.size() + width > rows.capacity()) rows.reserve(rows.size() + rows.size() / 32 + 16);
    rows.resize(rows.size() + width);
    return static_cast<std::uint32_t>(rows.size() / width - 1);
  }
  void give_back(std::uint32_t place) { free.push_back(place); }
};

/// One contact of a sphere with a body, kept in the body's frame so that it turns with the tool.
struct WallMemory {
  Vec3 normal;
  VectorRow slip, roll;  ///< in the form of the rows of a pair's history
};
/// A sphere near a body: the features it may touch until the next rebuild, and its contacts there.
struct WallSlot {
  std::uint32_t particle = 0, body = 0;
  std::uint32_t feature_first = 0, feature_count = 0;  ///< into State::features
  std::uint32_t touching = 0;
  std::uint32_t place[max_touches] = {};  ///< place of each contact in the chunk's wall_memory
};

/// A ghost row is its owner's, shifted.
struct Ghost {
  std::uint32_t owner = 0;
  Vec3 shift;  ///< m
};

/// The most steps between two looks at a pair out of range: such pairs are skipped until their spheres could meet, and
/// for due_steps - 1 steps at most.
inline constexpr std::uint32_t due_steps = 8;

/// Place in State::due of the pairs of a word that are to be looked at in a step. A word's steps stand side by side, in
/// one cache line.
inline std::size_t due_at(std::uint32_t word, std::uint64_t step) {
  return std::size_t{word} * due_steps + step % due_steps;
}

/// The bit of a pair within its word of 64 pairs.
inline std::uint64_t bit_of(std::uint32_t slot) { return std::uint64_t{1} << (slot % 64); }

struct State {
  std::uint64_t step = 0;
  std::uint64_t rebuilds = 0;
  std::uint64_t rebuild_step = 0;  ///< step of the last rebuild
  double dissipated = 0.0;         ///< J, since the start
  // particles, then ghosts
  std::vector<PositionRow> position;
  std::vector<MotionRow> motion;  ///< at the time of `position`: what contacts see
  // particles
  std::vector<HalfRow> half;    ///< half a step earlier than `position`: what is integrated
  std::vector<LoadRow> load;    ///< loads without gravity; the halos stand beyond the particles
  std::vector<Vec3> reference;  ///< m, position at the last rebuild
  std::vector<std::uint32_t> id;
  std::vector<Ghost> ghost;
  // pairs
  std::vector<Pair> pair;                   ///< whole words of each chunk, filled with padding
  std::vector<std::uint32_t> partner_load;  ///< where in `load` the partner's share goes
  std::vector<std::uint64_t> in_range;      ///< one bit a pair, 64 to a word
  std::vector<std::uint64_t> due;           ///< pairs to look at in each of the next `due_steps` steps (due_at)
  std::vector<std::uint32_t> history_at;    ///< place of a pair in range, in its chunk's history
  // chunks
  std::vector<Pool<VectorRow>> history;                ///< of pairs in range: slip and contact radius, roll and twist
  std::vector<Pool<WallMemory>> wall_memory;           ///< memory of contacts with bodies
  std::vector<std::uint32_t> chunk_first, chunk_pair;  ///< first particle and pair; one more
  std::vector<std::uint32_t> chunk_wall;               ///< first wall slot, at chunk * bodies + body; one more
  std::vector<std::uint32_t> halo_owner;               ///< particle of each halo entry
  std::vector<std::uint32_t> halo_part;  ///< first entry for chunk d in chunk c's halo, at c * chunks + d; one more
  // walls
  std::vector<WallSlot> wall;           ///< sorted by chunk, body, particle
  std::vector<std::uint32_t> features;  ///< features of each slot, nearest first
  std::vector<float> feature_gap;       ///< m, least distance from the sphere to the feature at the rebuild

  std::size_t particles() const { return half.size(); }
  /// Calls visit(chunk, slot) for every pair in range.
  template <class Visit>
  void each_in_range(Visit&& visit) const {
    for (std::size_t c = 0; c < chunks(); ++c) {
      for (std::uint32_t slot = chunk_pair[c]; slot < chunk_pair[c + 1]; ++slot)
        if (is_in_range(slot)) visit(c, slot);
    }
  }
  bool is_in_range(std::uint32_t slot) const { return (in_range[slot / 64] & bit_of(slot)) != 0; }
  std::size_t chunks() const { return chunk_first.size() - 1; }
};

}  // namespace dem
