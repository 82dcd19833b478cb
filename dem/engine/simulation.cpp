#include "dem/engine/simulation.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dem/contact/lanes.hpp"

namespace dem {
namespace {

/// A list holds one value for all spheres, or one for each; an empty one means `otherwise`.
template <class T>
T pick(const std::vector<T>& values, std::size_t i, T otherwise) {
  return values.empty() ? otherwise : values.size() == 1 ? values[0] : values[i];
}

void add(StepSums& total, const StepSums& part) {
  for (std::size_t b = 0; b < max_bodies; ++b) {
    total.body[b].force += part.body[b].force;
    total.body[b].torque += part.body[b].torque;
    total.body[b].slip += part.body[b].slip;
    total.body[b].contacts += part.body[b].contacts;
  }
  total.virial += part.virial;
  total.dissipated += part.dissipated;
  total.tool_work += part.tool_work;
  total.contacts += part.contacts;
  total.wall_contacts += part.wall_contacts;
  total.deep += part.deep;
  total.max_overlap = std::max(total.max_overlap, part.max_overlap);
}

}  // namespace

Simulation::Simulation(Setup setup) : setup_(std::move(setup)), team_(setup_.threads) {
  const Spheres& given = setup_.spheres;
  const std::size_t n = given.position.size();
  for (const double r : given.radius) largest_radius_ = std::max(largest_radius_, r);
  range_ = setup_.laws->range(largest_radius_);
  if (setup_.bodies.size() > max_bodies) throw Fault(fmt::format("more than {} bodies", max_bodies));
  for (const Body& b : setup_.bodies) {
    surface_.push_back(make_surface(b.mesh, largest_radius_ + range_ + setup_.skin));
    Reach reach;
    for (const Vec3 v : b.mesh.vertices) {
      reach.from_axis = std::max(reach.from_axis, length(cross(b.motion.axis, v - b.motion.point)));
      reach.from_point = std::max(reach.from_point, length(v - b.motion.point));
    }
    body_reach_.push_back({reach.from_axis + largest_radius_, reach.from_point + largest_radius_});
  }

  state_.position.reserve(n);
  state_.motion.reserve(n);
  state_.half.reserve(n);
  state_.load.reserve(n);
  state_.id.reserve(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double r = pick(given.radius, i, 0.0);
    const double mass = pick(given.density, i, 0.0) * 4.0 / 3.0 * std::numbers::pi * r * r * r;
    state_.position.push_back({given.position[i], r});
    MotionRow m;
    if (!given.velocity.empty()) m.velocity = given.velocity[i];
    if (!given.spin.empty()) m.spin = given.spin[i];
    m.mass = mass;
    m.material = pick(given.material, i, 0u);
    state_.motion.push_back(m);
    state_.half.push_back({m.velocity, m.spin});
    LoadRow load;
    if (pick<std::uint8_t>(given.frozen, i, 0) == 0) {
      load.inverse_mass = 1.0 / mass;
      load.inverse_inertia = 1.0 / (0.4 * mass * r * r);
    }
    state_.load.push_back(load);
    state_.id.push_back(static_cast<std::uint32_t>(i));
  }
  // Large beds in chunks of some 2,000 spheres, a number that two or four threads share out evenly.
  const std::size_t chunks =
      n < 4096 ? std::max<std::size_t>(1, n / 1024) : std::min<std::size_t>(64, (n / 2048 + 3) / 4 * 4);
  for (std::size_t c = 0; c <= chunks; ++c) state_.chunk_first.push_back(static_cast<std::uint32_t>(n * c / chunks));
  rebuild();
  compute_forces();
  // The velocities given are those at time 0; the integrator wants them half a step earlier.
  const double t = 0.5 * setup_.time_step;
  for (std::size_t i = 0; i < n; ++i) {
    const LoadRow& load = state_.load[i];
    if (load.inverse_mass == 0.0) continue;
    state_.half[i].velocity = state_.motion[i].velocity - t * (load.inverse_mass * load.force + setup_.gravity);
    state_.half[i].spin = state_.motion[i].spin - (t * load.inverse_inertia) * load.torque;
  }
}

void Simulation::restore(State state) {
  state_ = std::move(state);
  max_displacement2_ = 0.0;
  watched_speed_ = -1.0;  // the next step makes all pairs due
}

double Simulation::motion_time(std::uint64_t step) const {
  return step > setup_.rest_steps ? static_cast<double>(step - setup_.rest_steps) * setup_.time_step : 0.0;
}

std::vector<Frame> Simulation::frames() const {
  std::vector<Frame> frames;
  const double now = motion_time(state_.step), then = motion_time(state_.rebuild_step);
  for (std::size_t b = 0; b < setup_.bodies.size(); ++b) {
    const Motion& motion = setup_.bodies[b].motion;
    frames.push_back({pose(motion, now), motion.point, travelled(motion, then, now, body_reach_[b])});
  }
  return frames;
}

Surroundings Simulation::around(const std::vector<Frame>& frames) const {
  const double approach = 2.0 * watched_speed_ * setup_.time_step;
  return {surface_, frames, setup_.time_step, range_, 0.5 * setup_.overlap_limit, (1.0 - 1e-9) / approach};
}

void Simulation::compute_forces() {
  const std::vector<Frame> moving = frames();
  const Surroundings surroundings = around(moving);
  const std::size_t chunks = state_.chunks();
  chunk_sums_.assign(chunks, {});
  team_.for_each(chunks, [&](std::size_t c) { setup_.laws->chunk(state_, surroundings, c, chunk_sums_[c]); });
  add_halos();
  sums_ = {};
  for (const StepSums& part : chunk_sums_) add(sums_, part);
  state_.dissipated += sums_.dissipated;
}

/// Adds what each chunk did to others' particles, in the order of the chunks.
void Simulation::add_halos() {
  State& s = state_;
  const std::size_t n = s.particles(), chunks = s.chunks();
  team_.for_each(chunks, [&](std::size_t to) {
    for (std::size_t from = 0; from < chunks; ++from) {
      for (std::uint32_t h = s.halo_part[from * chunks + to]; h < s.halo_part[from * chunks + to + 1]; ++h) {
        LoadRow &share = s.load[n + h], &load = s.load[s.halo_owner[h]];
        four(load.force.x) += four(share.force.x);
        four(load.torque.x) += four(share.torque.x);
        share = {};
      }
    }
  });
}

void Simulation::integrate() {
  State& s = state_;
  const double dt = setup_.time_step;
  const std::size_t chunks = s.chunks();
  chunk_steps_.assign(chunks, {});
  const Channels& channels = setup_.channels;
  team_.for_each(chunks, [&](std::size_t c) {
    // Whole rows at once; what rides in the fourth places of motion and load stays as it is.
    const auto with_fourth_of = [](Four rest, Four fourth_from) {
      return __builtin_shufflevector(rest, fourth_from, 0, 1, 2, 7);
    };
    const Four step{dt, dt, dt, 0.0}, fourth{0.0, 0.0, 0.0, 1.0};
    const Four gravity{setup_.gravity.x, setup_.gravity.y, setup_.gravity.z, 0.0};
    Four late{};  // force * (v*(n) - v(n)) and the same of torque and spin
    Four momentum{}, moment{}, twice_energy{};
    double farthest = 0.0, fastest = 0.0, flow[2]{};
    for (std::uint32_t i = s.chunk_first[c]; i < s.chunk_first[c + 1]; ++i) {
      HalfRow& half = s.half[i];
      MotionRow& motion = s.motion[i];
      LoadRow& load = s.load[i];
      const Four velocity_seen = four(motion.velocity.x), spin_seen = four(motion.spin.x);
      const Four force = four(load.force.x) + motion.mass * gravity, torque = four(load.torque.x);
      const Four kick = load.inverse_mass * (step * force), twist = load.inverse_inertia * (step * torque);
      late += four(load.force.x) * (velocity_seen - four(half.velocity) - 0.5 * kick) +
              torque * (spin_seen - four(half.spin) - 0.5 * twist);
      const Four velocity = four(half.velocity) + kick, spin = four(half.spin) + twist;
      half = {three(velocity), three(spin)};
      four(motion.velocity.x) = with_fourth_of(velocity + 0.5 * kick, velocity_seen);
      four(motion.spin.x) = with_fourth_of(spin + 0.5 * twist, spin_seen);
      const Four at = four(s.position[i].at.x) + step * velocity;
      four(s.position[i].at.x) = at;
      const Four moved = at - four(s.reference[i]), squared = moved * moved;
      const double d2 = squared[0] + squared[1] + squared[2];
      farthest = d2 <= farthest ? farthest : d2;  // a NaN stays and forces a rebuild, which reports it
      const Four speeds = velocity * velocity;
      fastest = std::max(fastest, speeds[0] + speeds[1] + speeds[2]);
      const double radius = s.position[i].radius;
      momentum += motion.mass * velocity;
      moment += motion.mass * at;
      if (channels.exist()) {
        const double place = dot(channels.along, three(at));
        if (place > channels.flow_from && place < channels.flow_to)
          flow[channels.of(three(at))] += motion.mass * dot(channels.along, three(velocity));
      }
      twice_energy += motion.mass * (speeds + (0.4 * radius * radius) * (spin * spin));
      four(load.force.x) = fourth * four(load.force.x);
      four(load.torque.x) = fourth * torque;
    }
    chunk_steps_[c] = {farthest,
                       fastest,
                       late[0] + late[1] + late[2],
                       {three(momentum),
                        three(moment),
                        0.5 * (twice_energy[0] + twice_energy[1] + twice_energy[2]),
                        {flow[0], flow[1]}}};
  });
  max_displacement2_ = 0.0;
  carried_ = {};
  double fastest2 = 0.0;
  for (const ChunkStep& moved : chunk_steps_) {
    fastest2 = std::max(fastest2, moved.speed2);
    max_displacement2_ = moved.displacement2 <= max_displacement2_ ? max_displacement2_ : moved.displacement2;
    s.dissipated += dt * moved.late_power;
    carried_.momentum += moved.carried.momentum;
    carried_.moment += moved.carried.moment;
    carried_.kinetic_energy += moved.carried.kinetic_energy;
    for (std::size_t k = 0; k < carried_.flow.size(); ++k) carried_.flow[k] += moved.carried.flow[k];
  }
  fastest_ = std::sqrt(fastest2);
  ++s.step;
}

/// Ghost rows are their owners', shifted.
void Simulation::follow_owners() {
  State& s = state_;
  const std::size_t n = s.particles();
  for (std::size_t g = 0; g < s.ghost.size(); ++g) {
    const Ghost& ghost = s.ghost[g];
    s.position[n + g] = s.position[ghost.owner];
    s.position[n + g].at += ghost.shift;
    s.motion[n + g] = s.motion[ghost.owner];
  }
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
  if (list_is_stale())
    rebuild();
  else
    follow_owners();
  if (fastest_ > watched_speed_) wake_all();
  compute_forces();
  if (sums_.max_overlap > setup_.overlap_limit) report_overlap();
}

MotionRow Simulation::motion(std::size_t i) const {
  const double t = 0.5 * setup_.time_step;
  const LoadRow& load = state_.load[i];
  MotionRow m = state_.motion[i];
  m.velocity = state_.half[i].velocity;
  m.spin = state_.half[i].spin;
  if (load.inverse_mass == 0.0) return m;
  m.velocity += t * (load.inverse_mass * load.force + setup_.gravity);
  m.spin += (t * load.inverse_inertia) * load.torque;
  return m;
}

Energy Simulation::energy() const {
  Energy e;
  for (std::size_t i = 0; i < state_.particles(); ++i) {
    const MotionRow m = motion(i);
    const PositionRow& p = state_.position[i];
    if (state_.load[i].inverse_mass == 0.0) continue;
    e.translation += 0.5 * m.mass * dot(m.velocity, m.velocity);
    e.rotation += 0.2 * m.mass * p.radius * p.radius * dot(m.spin, m.spin);
    e.gravity -= m.mass * dot(setup_.gravity, p.at);
  }
  const std::vector<Frame> moving = frames();
  const ContactEnergy contacts = setup_.laws->energy(state_, around(moving));
  e.elastic = contacts.elastic;
  e.attraction = contacts.attraction;
  return e;
}

double Simulation::kinetic_energy() const {
  double sum = 0.0;
  for (std::size_t i = 0; i < state_.particles(); ++i) {
    const MotionRow& m = state_.motion[i];
    const double r = state_.position[i].radius;
    sum += 0.5 * m.mass * (dot(m.velocity, m.velocity) + 0.4 * r * r * dot(m.spin, m.spin));
  }
  return sum;
}

Vec3 Simulation::momentum() const {
  Vec3 sum;
  for (std::size_t i = 0; i < state_.particles(); ++i) sum += state_.motion[i].mass * state_.half[i].velocity;
  return sum;
}

double Simulation::bytes_per_particle() const {
  const State& s = state_;
  const auto size = [](const auto& rows) { return static_cast<double>(rows.capacity() * sizeof(rows[0])); };
  const double total = size(s.position) + size(s.motion) + size(s.half) + size(s.load) + size(s.reference) +
                       size(s.id) + size(s.ghost) + size(s.pair) + size(s.partner_load) + size(s.in_range) +
                       size(s.due) + size(s.history_at) + size(s.halo_owner) + size(s.wall) + size(s.features) +
                       size(s.feature_gap) + size(cells_.first) + size(cells_.ghost_first) + size(order_) +
                       size(place_) + size(old_ghosts_);
  double pooled = 0.0;
  for (const Pool<VectorRow>& pool : s.history) pooled += size(pool.rows) + size(pool.free);
  for (const Pool<WallMemory>& pool : s.wall_memory) pooled += size(pool.rows) + size(pool.free);
  return (total + pooled) / static_cast<double>(std::max<std::size_t>(1, s.particles()));
}

}  // namespace dem
