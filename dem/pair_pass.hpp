#pragma once
// The pair forces of a run of particles, in three stages: slots in range are compressed into a list of hits; hits are
// evaluated `lanes` at a time, their data gathered into arrays over which plain loops run that the compiler
// vectorises; results are handed out in slot order. Every operation is elementwise, so the instruction set does not
// change a bit.
#include <cmath>
#include <cstdint>
#include <vector>

#include "dem/state.hpp"

namespace dem {

struct PairView {
  const PositionRow* position;
  const MotionRow* motion;
  const std::uint32_t* first;
  const std::uint32_t* partner;
  std::uint8_t* in_range;
  Vec3* spring;
  const Vec3* image;  ///< [27]
  double time_step;   ///< s
  double range;       ///< m, of the attraction
};

struct Hit {
  std::uint32_t slot, i;
};

inline constexpr int lanes = 16;

/// What one contact does: `force` on i (its negative on j), torques -arm moment on both.
struct PairLoad {
  std::uint32_t slot, i, j;
  Vec3 force, moment;
  double arm_i, arm_j;
  double push, distance, overlap;
};

/// `deliver(PairLoad)` is called for each slot in range of particles [begin, end), in slot order.
template <class Law, class Deliver>
void pair_pass(Law law, PairView v, std::size_t begin, std::size_t end, Deliver&& deliver) {
  thread_local std::vector<Hit> hits;
  hits.resize(v.first[end] - v.first[begin] + lanes);
  std::size_t count = 0;
  for (std::size_t i = begin; i < end; ++i) {
    const PositionRow a = v.position[i];
    const std::uint32_t last = v.first[i + 1];
    for (std::uint32_t slot = v.first[i]; slot < last; ++slot) {
      const std::uint32_t p = v.partner[slot];
      const PositionRow& b = v.position[p & partner_mask];
      const Vec3& image = v.image[p >> image_shift];
      const double dx = a.at.x - b.at.x - image.x, dy = a.at.y - b.at.y - image.y, dz = a.at.z - b.at.z - image.z;
      const double reach = a.radius + b.radius + v.range;
      const bool near = dx * dx + dy * dy + dz * dz < reach * reach;
      // The flag of the step before rides in the top bit: a spring starts from nothing.
      hits[count] = {slot | (static_cast<std::uint32_t>(v.in_range[slot]) << 31), static_cast<std::uint32_t>(i)};
      v.in_range[slot] = near;
      count += near;
    }
  }
  for (std::size_t k = count; k < (count + lanes - 1) / lanes * lanes; ++k) hits[k] = hits[count - 1];

  struct alignas(64) Lanes {
    double dx[lanes], dy[lanes], dz[lanes], sum[lanes];                       // separation, sum of the radii
    double ux[lanes], uy[lanes], uz[lanes], wx[lanes], wy[lanes], wz[lanes];  // velocity, r spin
    double sx[lanes], sy[lanes], sz[lanes];                                   // spring
    double fx[lanes], fy[lanes], fz[lanes], mx[lanes], my[lanes], mz[lanes], push[lanes], distance[lanes];
  } l;
  for (std::size_t base = 0; base < count; base += lanes) {
    for (int k = 0; k < lanes; ++k) {
      const Hit hit = hits[base + k];
      const std::uint32_t slot = hit.slot & 0x7fffffffu, p = v.partner[slot], j = p & partner_mask;
      const PositionRow &a = v.position[hit.i], &b = v.position[j];
      const MotionRow &ma = v.motion[hit.i], &mb = v.motion[j];
      const Vec3& image = v.image[p >> image_shift];
      l.dx[k] = a.at.x - b.at.x - image.x;
      l.dy[k] = a.at.y - b.at.y - image.y;
      l.dz[k] = a.at.z - b.at.z - image.z;
      l.sum[k] = a.radius + b.radius;
      l.ux[k] = ma.velocity.x - mb.velocity.x;
      l.uy[k] = ma.velocity.y - mb.velocity.y;
      l.uz[k] = ma.velocity.z - mb.velocity.z;
      l.wx[k] = a.radius * ma.spin.x + b.radius * mb.spin.x;
      l.wy[k] = a.radius * ma.spin.y + b.radius * mb.spin.y;
      l.wz[k] = a.radius * ma.spin.z + b.radius * mb.spin.z;
      const double keep = (hit.slot >> 31) != 0 ? 1.0 : 0.0;
      l.sx[k] = keep * v.spring[slot].x;
      l.sy[k] = keep * v.spring[slot].y;
      l.sz[k] = keep * v.spring[slot].z;
    }
    for (int k = 0; k < lanes; ++k) {
      const double d = std::sqrt(l.dx[k] * l.dx[k] + l.dy[k] * l.dy[k] + l.dz[k] * l.dz[k]);
      const Vec3 n = (1.0 / d) * Vec3{l.dx[k], l.dy[k], l.dz[k]};
      const double arm = d / l.sum[k];  // arms r_i d / (r_i + r_j): to the contact point, and together the distance
      const Vec3 surface_velocity = Vec3{l.ux[k], l.uy[k], l.uz[k]} - arm * cross(Vec3{l.wx[k], l.wy[k], l.wz[k]}, n);
      const ContactForce c = law(n, l.sum[k] - d, surface_velocity, {l.sx[k], l.sy[k], l.sz[k]}, v.time_step);
      l.fx[k] = c.push * n.x + c.tangential.x;
      l.fy[k] = c.push * n.y + c.tangential.y;
      l.fz[k] = c.push * n.z + c.tangential.z;
      l.mx[k] = n.y * c.tangential.z - n.z * c.tangential.y;
      l.my[k] = n.z * c.tangential.x - n.x * c.tangential.z;
      l.mz[k] = n.x * c.tangential.y - n.y * c.tangential.x;
      l.sx[k] = c.spring.x;
      l.sy[k] = c.spring.y;
      l.sz[k] = c.spring.z;
      l.push[k] = c.push;
      l.distance[k] = d;
    }
    const int used = count - base < lanes ? static_cast<int>(count - base) : lanes;
    for (int k = 0; k < used; ++k) {
      const Hit hit = hits[base + k];
      const std::uint32_t slot = hit.slot & 0x7fffffffu, j = v.partner[slot] & partner_mask;
      v.spring[slot] = {l.sx[k], l.sy[k], l.sz[k]};
      const double arm = l.distance[k] / l.sum[k];
      deliver(PairLoad{slot,
                       hit.i,
                       j,
                       {l.fx[k], l.fy[k], l.fz[k]},
                       {l.mx[k], l.my[k], l.mz[k]},
                       v.position[hit.i].radius * arm,
                       v.position[j].radius * arm,
                       l.push[k],
                       l.distance[k],
                       l.sum[k] - l.distance[k]});
    }
  }
}

}  // namespace dem
