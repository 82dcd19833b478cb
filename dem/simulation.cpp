#include "dem/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "dem/pair_pass.hpp"

namespace dem {
namespace {

std::size_t blocks_of(std::size_t particles) { return (particles + block_size - 1) / block_size; }

/// A body as this step sees it.
struct Frame {
  Pose now;
  Vec3 point;          ///< m, the motion's point in the body's frame
  double moved = 0.0;  ///< m, how far any point of the body came since the rebuild, at most

  Vec3 to_lab(Vec3 a) const { return now.turned ? rotate(now.rotation, a) : a; }
  Vec3 to_body(Vec3 a) const { return now.turned ? rotate_back(now.rotation, a) : a; }
};

/// Contacts of one sphere with one body: finds them, carries their springs over, returns the load on the sphere.
template <class Law>
LoadRow wall_contact(const Law& law, const Surface& surface, const Frame& frame, const State& s, WallSlot& slot,
                     double time_step, StepSums& sums) {
  const PositionRow& at = s.position[slot.particle];
  LoadRow load;
  // Features are sorted by their gap at the rebuild: those that the sphere and the body cannot have closed are not
  // asked.
  const double moved = length(at.at - s.reference[slot.particle]) + frame.moved + 1e-9 * at.radius;
  const double* gap = s.feature_gap.data() + slot.feature_first;
  std::uint32_t asked = 0;
  while (asked < slot.feature_count && gap[asked] <= moved) ++asked;
  if (asked == 0) {
    slot.touching = 0;
    return load;
  }
  const Vec3 arm_of_body = at.at - frame.now.point;
  const Vec3 in_body = frame.point + frame.to_body(arm_of_body);
  const Touches touches =
      find_touches(surface, {s.features.data() + slot.feature_first, asked}, in_body, at.radius + law.range());
  if (touches.count == 0) {
    slot.touching = 0;
    return load;
  }
  WallSpring kept[max_touches];
  const MotionRow& motion = s.motion[slot.particle];
  for (int t = 0; t < touches.count; ++t) {
    const Touch& touch = touches.touch[t];
    // The contact's history is that of the old contact whose normal is nearest.
    Vec3 spring;
    double best = merge_cosine;
    for (std::uint32_t k = 0; k < slot.touching; ++k) {
      const double cosine = dot(slot.contact[k].normal, touch.normal);
      if (cosine > best) {
        best = cosine;
        spring = slot.contact[k].spring;
      }
    }
    const Vec3 n = frame.to_lab(touch.normal);
    const Vec3 arm = arm_of_body - touch.distance * n;  // from the motion's point to the contact point
    const double overlap = at.radius - touch.distance;
    const Vec3 surface_velocity =
        motion.velocity - touch.distance * cross(motion.spin, n) - cross(frame.now.spin, arm) - frame.now.velocity;
    const ContactForce c = law(n, overlap, surface_velocity, frame.to_lab(spring), time_step);
    const Vec3 force = c.push * n + c.tangential;
    load.force += force;
    load.torque -= touch.distance * cross(n, c.tangential);
    sums.body[slot.body].force -= force;
    sums.body[slot.body].torque -= cross(arm, force);
    kept[t] = {touch.normal, frame.to_body(c.spring)};
    if (overlap > 0.0) ++sums.wall_contacts;
    if (overlap > 0.1 * at.radius) ++sums.deep;
    sums.max_overlap = std::max(sums.max_overlap, overlap / at.radius);
  }
  std::copy(kept, kept + touches.count, slot.contact);
  slot.touching = static_cast<std::uint32_t>(touches.count);
  return load;
}

void add(StepSums& total, const StepSums& part) {
  for (std::size_t b = 0; b < max_bodies; ++b) {
    total.body[b].force += part.body[b].force;
    total.body[b].torque += part.body[b].torque;
  }
  total.virial += part.virial;
  total.contacts += part.contacts;
  total.wall_contacts += part.wall_contacts;
  total.deep += part.deep;
  total.max_overlap = std::max(total.max_overlap, part.max_overlap);
}

}  // namespace

Simulation::Simulation(Setup setup) : setup_(std::move(setup)), team_(setup_.threads) {
  const Spheres& given = setup_.spheres;
  const double r = given.radius;
  mass_ = given.density * 4.0 / 3.0 * std::numbers::pi * r * r * r;
  inertia_ = 0.4 * mass_ * r * r;
  range_ = std::visit([](const auto& a, const auto& b) { return std::max(a.range(), b.range()); }, setup_.grain,
                      setup_.wall);
  if (setup_.grain.index() != setup_.wall.index()) throw Fault("grain and wall laws must be of one kind");
  if (setup_.bodies.size() > max_bodies) throw Fault(fmt::format("more than {} bodies", max_bodies));

  const Vec3 size = setup_.high - setup_.low;
  for (int k = 0; k < 27; ++k) image_[k].v = {(k % 3 - 1) * size.x, (k / 3 % 3 - 1) * size.y, (k / 9 - 1) * size.z};
  for (const Body& b : setup_.bodies) {
    surface_.push_back(make_surface(b.mesh, r + range_ + setup_.skin));
    Reach reach;
    for (const Vec3 v : b.mesh.vertices) {
      reach.from_axis = std::max(reach.from_axis, length(cross(b.motion.axis, v - b.motion.point)));
      reach.from_point = std::max(reach.from_point, length(v - b.motion.point));
    }
    body_reach_.push_back({reach.from_axis + r, reach.from_point + r});
  }

  const std::size_t n = given.position.size();
  for (std::size_t i = 0; i < n; ++i) {
    state_.position.push_back({given.position[i], r});
    MotionRow m;
    if (!given.velocity.empty()) m.velocity = given.velocity[i];
    if (!given.spin.empty()) m.spin = given.spin[i];
    state_.motion.push_back(m);
    state_.id.push_back(static_cast<std::uint32_t>(i));
  }
  state_.half = state_.motion;
  state_.load.resize(n);
  state_.first.assign(n + 1, 0);
  rebuild();
  compute_forces();
  // The velocities given are those at time 0; the integrator wants them half a step earlier.
  for (std::size_t i = 0; i < n; ++i) {
    const double t = 0.5 * setup_.time_step;
    state_.half[i].velocity = state_.motion[i].velocity - t * ((1.0 / mass_) * state_.load[i].force + setup_.gravity);
    state_.half[i].spin = state_.motion[i].spin - (t / inertia_) * state_.load[i].torque;
  }
}

void Simulation::restore(State state) {
  state_ = std::move(state);
  max_displacement2_ = 0.0;
  index_partners();
}

double Simulation::motion_time(std::uint64_t step) const {
  return step > setup_.rest_steps ? static_cast<double>(step - setup_.rest_steps) * setup_.time_step : 0.0;
}

template <class Law>
void Simulation::contacts(const Law& grain, const Law& wall) {
  State& s = state_;
  const std::size_t n = s.position.size(), blocks = blocks_of(n);
  std::array<Frame, max_bodies> frames;
  for (std::size_t b = 0; b < setup_.bodies.size(); ++b) {
    const Motion& motion = setup_.bodies[b].motion;
    const double now = motion_time(s.step);
    frames[b] = {pose(motion, now), motion.point, travelled(motion, motion_time(s.rebuild_step), now, body_reach_[b])};
  }
  const PairView view{s.position.data(), s.motion.data(), s.first.data(),   s.partner.data(), s.in_range.data(),
                      s.spring.data(),   image_.data(),   setup_.time_step, grain.range()};
  block_sums_.assign(blocks, {});
  const bool direct = team_.size() == 1;

  const auto count_contact = [](StepSums& sums, const Lanes& l, int k) {
    const double overlap = l.sum[k] - l.distance[k], relative = 2.0 * overlap / l.sum[k];
    sums.virial += l.push[k] * l.distance[k];
    sums.contacts += overlap > 0.0;
    sums.deep += relative > 0.1;
    sums.max_overlap = std::max(sums.max_overlap, relative);
  };

  // One thread adds each pair's load where it belongs at once. Several threads write it into the pair's slot, and each
  // particle then adds its slots in the order in which the one thread would: as partner by ascending slot, then its
  // own.
  team_.for_each(blocks, [&](std::size_t block) {
    StepSums& sums = block_sums_[block];
    const std::size_t begin = block * block_size, end = std::min(n, begin + block_size);
    if (direct) {
      pair_pass(grain, view, begin, end, [&](std::uint32_t, std::uint32_t i, std::uint32_t j, const Lanes& l, int k) {
        LoadRow &a = s.load[i], &b = s.load[j];
        const Four force = four(l.force[k][0]), moment = l.arm[k] * four(l.moment[k][0]);
        four(a.force.x) += force;
        four(a.torque.x) -= s.position[i].radius * moment;
        four(b.force.x) -= force;
        four(b.torque.x) -= s.position[j].radius * moment;
        count_contact(sums, l, k);
      });
    } else {
      pair_pass(grain, view, begin, end,
                [&](std::uint32_t slot, std::uint32_t i, std::uint32_t j, const Lanes& l, int k) {
                  SlotLoad& to = slot_load_[slot];
                  const Four moment = l.arm[k] * four(l.moment[k][0]);
                  four(to.force.v.x) = four(l.force[k][0]);
                  four(to.torque_i.v.x) = s.position[i].radius * moment;
                  four(to.torque_j.v.x) = s.position[j].radius * moment;
                  count_contact(sums, l, k);
                });
    }
    for (std::uint32_t w = s.wall_first[block]; w < s.wall_first[block + 1]; ++w) {
      WallSlot& slot = s.wall[w];
      const LoadRow load = wall_contact(wall, surface_[slot.body], frames[slot.body], s, slot, setup_.time_step, sums);
      if (slot.touching == 0) continue;
      LoadRow& to = direct ? s.load[slot.particle] : wall_load_[w];
      if (direct) {
        to.force += load.force;
        to.torque += load.torque;
      } else {
        to = load;
      }
    }
  });
  if (!direct) {
    team_.for_each(blocks, [&](std::size_t block) {
      const std::size_t begin = block * block_size, end = std::min(n, begin + block_size);
      for (std::size_t p = begin; p < end; ++p) {
        LoadRow& to = s.load[p];
        for (std::uint32_t k = reverse_first_[p]; k < reverse_first_[p + 1]; ++k) {
          const std::uint32_t slot = reverse_[k];
          if (!s.in_range[slot]) continue;
          to.force -= slot_load_[slot].force.v;
          to.torque -= slot_load_[slot].torque_j.v;
        }
        for (std::uint32_t slot = s.first[p]; slot < s.first[p + 1]; ++slot) {
          if (!s.in_range[slot]) continue;
          to.force += slot_load_[slot].force.v;
          to.torque -= slot_load_[slot].torque_i.v;
        }
      }
      for (std::uint32_t w = s.wall_first[block]; w < s.wall_first[block + 1]; ++w) {
        if (s.wall[w].touching == 0) continue;
        s.load[s.wall[w].particle].force += wall_load_[w].force;
        s.load[s.wall[w].particle].torque += wall_load_[w].torque;
      }
    });
  }
  sums_ = {};
  for (const StepSums& part : block_sums_) add(sums_, part);
}

void Simulation::compute_forces() {
  std::visit([this](const auto& grain) { contacts(grain, std::get<std::decay_t<decltype(grain)>>(setup_.wall)); },
             setup_.grain);
}

void Simulation::integrate() {
  State& s = state_;
  const std::size_t n = s.position.size(), blocks = blocks_of(n);
  const double dt = setup_.time_step, per_mass = dt / mass_, per_inertia = dt / inertia_;
  const Vec3 fall = dt * setup_.gravity;
  block_displacement2_.assign(blocks, 0.0);
  const std::vector<std::uint8_t>& frozen = setup_.spheres.frozen;
  team_.for_each(blocks, [&](std::size_t block) {
    double farthest = 0.0;
    for (std::size_t i = block * block_size; i < std::min(n, (block + 1) * block_size); ++i) {
      if (!frozen.empty() && frozen[s.id[i]] != 0) {
        s.load[i].force = s.load[i].torque = Vec3{};
        s.half[i] = s.motion[i] = {};
        continue;
      }
      const Vec3 kick = per_mass * s.load[i].force + fall, twist = per_inertia * s.load[i].torque;
      MotionRow& half = s.half[i];
      half.velocity += kick;
      half.spin += twist;
      s.motion[i].velocity = half.velocity + 0.5 * kick;
      s.motion[i].spin = half.spin + 0.5 * twist;
      s.position[i].at += dt * half.velocity;
      const Vec3 moved = s.position[i].at - s.reference[i];
      const double d2 = dot(moved, moved);
      farthest = d2 <= farthest ? farthest : d2;  // a NaN stays and forces a rebuild, which reports it
      s.load[i].force = s.load[i].torque = Vec3{};
    }
    block_displacement2_[block] = farthest;
  });
  max_displacement2_ = 0.0;
  for (const double d2 : block_displacement2_) max_displacement2_ = d2 <= max_displacement2_ ? max_displacement2_ : d2;
  ++s.step;
}

bool Simulation::list_is_stale() const {
  const double moved = std::sqrt(max_displacement2_);
  if (!(moved < 0.5 * setup_.skin)) return true;
  for (std::size_t b = 0; b < setup_.bodies.size(); ++b) {
    const double came =
        travelled(setup_.bodies[b].motion, motion_time(state_.rebuild_step), motion_time(state_.step), body_reach_[b]);
    if (!(moved + came < setup_.skin)) return true;
  }
  return false;
}

void Simulation::step() {
  integrate();
  if (list_is_stale()) rebuild();
  compute_forces();
}

MotionRow Simulation::motion(std::size_t i) const {
  const double t = 0.5 * setup_.time_step;
  MotionRow m = state_.half[i];
  m.velocity += t * ((1.0 / mass_) * state_.load[i].force + setup_.gravity);
  m.spin += (t / inertia_) * state_.load[i].torque;
  return m;
}

double Simulation::kinetic_energy() const {
  double sum = 0.0;
  for (const MotionRow& m : state_.motion)
    sum += 0.5 * mass_ * dot(m.velocity, m.velocity) + 0.5 * inertia_ * dot(m.spin, m.spin);
  return sum;
}

Vec3 Simulation::momentum() const {
  Vec3 sum;
  for (std::size_t i = 0; i < state_.half.size(); ++i) sum += mass_ * state_.half[i].velocity;
  return sum;
}

}  // namespace dem
