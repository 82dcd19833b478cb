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

/// Four doubles moved and added as one; lowered to what the instruction set has.
typedef double Four __attribute__((vector_size(32), may_alias));
inline const Four& four(const double& first) { return reinterpret_cast<const Four&>(first); }
inline Four& four(double& first) { return reinterpret_cast<Four&>(first); }

struct PairView {
  const PositionRow* position;
  const MotionRow* motion;
  const std::uint32_t* first;
  const std::uint32_t* partner;
  std::uint8_t* in_range;
  VectorRow* spring;
  const VectorRow* image;  ///< [27]
  double time_step;        ///< s
  double range;            ///< m, of the attraction
};

struct Hit {
  std::uint32_t slot, i;
};

inline constexpr int lanes = 16;

/// Contacts under way: rows of four (x, y, z and padding) where whole rows are read or written, else plain arrays.
struct alignas(64) Lanes {
  double apart[lanes][4], velocity[lanes][4], roll[lanes][4], spring[lanes][4];  // roll: r_i spin_i + r_j spin_j
  double force[lanes][4], moment[lanes][4];                                      // on i; torque is -arm moment on both
  double sum[lanes], push[lanes], distance[lanes], arm[lanes];                   // sum of radii; arm / radius
};

/// `deliver(slot, i, j, lanes, k)` is called for each slot in range of particles [begin, end), in slot order.
template <class Law, class Deliver>
void pair_pass(Law law, PairView v, std::size_t begin, std::size_t end, Deliver&& deliver) {
  thread_local std::vector<Hit> hits;
  hits.resize(v.first[end] - v.first[begin] + lanes);
  Hit* const list = hits.data();
  std::size_t count = 0;
  for (std::size_t i = begin; i < end; ++i) {
    const PositionRow a = v.position[i];
    const std::uint32_t last = v.first[i + 1];
    for (std::uint32_t slot = v.first[i]; slot < last; ++slot) {
      const std::uint32_t p = v.partner[slot];
      const PositionRow& b = v.position[p & partner_mask];
      const Vec3 apart = a.at - b.at - v.image[p >> image_shift].v;
      const double reach = a.radius + b.radius + v.range;
      const bool near = dot(apart, apart) < reach * reach;
      // The flag of the step before rides in the top bit: a spring starts from nothing.
      list[count] = {slot | (static_cast<std::uint32_t>(v.in_range[slot]) << 31), static_cast<std::uint32_t>(i)};
      v.in_range[slot] = near;
      count += near;
    }
  }
  for (std::size_t k = count; k < (count + lanes - 1) / lanes * lanes; ++k) list[k] = list[count - 1];

  Lanes l;
  for (std::size_t base = 0; base < count; base += lanes) {
    for (int k = 0; k < lanes; ++k) {
      const Hit hit = list[base + k];
      const std::uint32_t slot = hit.slot & 0x7fffffffu, p = v.partner[slot], j = p & partner_mask;
      const PositionRow &a = v.position[hit.i], &b = v.position[j];
      const MotionRow &ma = v.motion[hit.i], &mb = v.motion[j];
      four(l.apart[k][0]) = four(a.at.x) - four(b.at.x) - four(v.image[p >> image_shift].v.x);
      four(l.velocity[k][0]) = four(ma.velocity.x) - four(mb.velocity.x);
      four(l.roll[k][0]) = a.radius * four(ma.spin.x) + b.radius * four(mb.spin.x);
      const double keep = static_cast<double>(hit.slot >> 31);
      four(l.spring[k][0]) = keep * four(v.spring[slot].v.x);
      l.sum[k] = a.radius + b.radius;
    }
    for (int k = 0; k < lanes; ++k) {
      const Vec3 apart{l.apart[k][0], l.apart[k][1], l.apart[k][2]};
      const double d = length(apart);
      const Vec3 n = (1.0 / d) * apart;
      const double arm = d / l.sum[k];  // arms r_i d / (r_i + r_j): to the contact point, and together the distance
      const Vec3 surface_velocity = Vec3{l.velocity[k][0], l.velocity[k][1], l.velocity[k][2]} -
                                    arm * cross(Vec3{l.roll[k][0], l.roll[k][1], l.roll[k][2]}, n);
      const ContactForce c =
          law(n, l.sum[k] - d, surface_velocity, {l.spring[k][0], l.spring[k][1], l.spring[k][2]}, v.time_step);
      const Vec3 moment = cross(n, c.tangential);
      l.force[k][0] = c.push * n.x + c.tangential.x;
      l.force[k][1] = c.push * n.y + c.tangential.y;
      l.force[k][2] = c.push * n.z + c.tangential.z;
      l.force[k][3] = 0.0;
      l.moment[k][0] = moment.x;
      l.moment[k][1] = moment.y;
      l.moment[k][2] = moment.z;
      l.moment[k][3] = 0.0;
      l.spring[k][0] = c.spring.x;
      l.spring[k][1] = c.spring.y;
      l.spring[k][2] = c.spring.z;
      l.spring[k][3] = 0.0;
      l.push[k] = c.push;
      l.distance[k] = d;
      l.arm[k] = arm;
    }
    const int used = count - base < lanes ? static_cast<int>(count - base) : lanes;
    for (int k = 0; k < used; ++k) {
      const Hit hit = list[base + k];
      const std::uint32_t slot = hit.slot & 0x7fffffffu;
      four(v.spring[slot].v.x) = four(l.spring[k][0]);
      deliver(slot, hit.i, v.partner[slot] & partner_mask, l, k);
    }
  }
}

}  // namespace dem
