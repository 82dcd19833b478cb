#pragma once
// The moving state of a simulation as plain rows and slots. Copying it is a checkpoint: with the setup it decides every
// bit that follows.
//
// Particles are sorted along the cells of the neighbour list at each rebuild; `id` keeps who is who. The pair list is a
// half list: slots first[i] .. first[i+1] belong to particle i, hold a partner j > i and the tangential spring of the
// pair.
#include <cstdint>
#include <vector>

#include "dem/surface.hpp"
#include "dem/vec3.hpp"

namespace dem {

struct alignas(32) PositionRow {
  Vec3 at;              ///< m; wrapped into the box at rebuilds only
  double radius = 0.0;  ///< m
};
struct alignas(64) MotionRow {
  Vec3 velocity;  ///< m/s
  double unused = 0.0;
  Vec3 spin;  ///< rad/s
  double unused_too = 0.0;
};
struct alignas(64) LoadRow {
  Vec3 force;  ///< N
  double unused = 0.0;
  Vec3 torque;  ///< N m
  double unused_too = 0.0;
};
/// A vector padded to four lanes.
struct alignas(32) VectorRow {
  Vec3 v;
  double unused = 0.0;
};

/// One contact of a sphere with a body, kept in the body's frame so that it turns with the tool.
struct WallSpring {
  Vec3 normal, spring;
};
/// A sphere near a body: the features it may touch until the next rebuild, and its contacts there.
struct WallSlot {
  std::uint32_t particle = 0, body = 0;
  std::uint32_t feature_first = 0, feature_count = 0;  ///< into State::features
  std::uint32_t touching = 0;
  WallSpring contact[max_touches];
};

struct State {
  std::uint64_t step = 0;
  std::uint64_t rebuilds = 0;
  std::uint64_t rebuild_step = 0;  ///< of the last one
  std::vector<PositionRow> position;
  std::vector<MotionRow> motion;  ///< at the time of `position`: what contacts see
  std::vector<MotionRow> half;    ///< half a step earlier: what is integrated
  std::vector<LoadRow> load;      ///< without gravity
  std::vector<Vec3> reference;    ///< position at the last rebuild
  std::vector<std::uint32_t> id;
  // pairs
  std::vector<std::uint32_t> first, partner;  ///< partner | image << 27
  std::vector<std::uint8_t> in_range;
  std::vector<VectorRow> spring;
  // walls
  std::vector<WallSlot> wall;             ///< sorted by particle
  std::vector<std::uint32_t> wall_first;  ///< per block of particles
  std::vector<std::uint32_t> features;    ///< of each slot, nearest first
  std::vector<double> feature_gap;        ///< m, from the sphere to the feature at the rebuild, at least
};

inline constexpr std::uint32_t image_shift = 27;
inline constexpr std::uint32_t partner_mask = (1u << image_shift) - 1;
/// Sums over particles are made in blocks of this many, then over blocks: the same bits for any number of threads.
inline constexpr std::size_t block_size = 128;

}  // namespace dem
