#pragma once
// The force pass of one composed law: pairs in lanes (pair_pass.hpp), then the walls.
#include <algorithm>
#include <cmath>
#include <utility>

#include "dem/contact/force_pass.hpp"
#include "dem/contact/forces/pair_pass.hpp"

namespace dem {

inline History<double> history_of(const VectorRow& slip, const VectorRow& roll) {
  return {slip.v, slip.w, roll.v, roll.w};
}

/// How many of the slot's features the sphere may have reached since the rebuild; they are sorted by their gap at that
/// time.
inline std::uint32_t features_in_question(const State& s, const WallSlot& slot, const Frame& frame) {
  const PositionRow& at = s.position[slot.particle];
  const double moved = length(at.at - s.reference[slot.particle]) + frame.moved + 1e-9 * at.radius;
  const float* gap = s.feature_gap.data() + slot.feature_first;
  std::uint32_t asked = 0;
  while (asked < slot.feature_count && gap[asked] <= moved) ++asked;
  return asked;
}

/// The index of the slot's contact that had this normal, or -1. Of several it is the one whose normal is nearest.
inline int remembered(const Pool<WallMemory>& memory, const WallSlot& slot, Vec3 normal) {
  int best = -1;
  double cosine = merge_cosine;
  for (std::uint32_t k = 0; k < slot.touching; ++k) {
    const double c = dot(memory.rows[slot.place[k]].normal, normal);
    if (c > cosine) {
      cosine = c;
      best = static_cast<int>(k);
    }
  }
  return best;
}

template <class Law>
class LawPass final : public ForcePass {
 public:
  explicit LawPass(LawTables<Law> tables) : tables_(std::move(tables)) {}

  double range(double largest_radius) const override {
    double far = 0.0;
    for (const Law& law : tables_.grain) far = std::max(far, law.range(0.5 * largest_radius));
    for (const Law& law : tables_.wall) far = std::max(far, law.range(largest_radius));
    return far;
  }

  int history_rows() const override { return Law::history_rows; }

  void chunk(State& s, const Surroundings& around, std::size_t chunk, StepSums& sums) const override {
    const PairView view{.position = s.position.data(),
                        .motion = s.motion.data(),
                        .pair = s.pair.data(),
                        .partner_load = s.partner_load.data(),
                        .in_range = s.in_range.data(),
                        .due = s.due.data(),
                        .step = s.step,
                        .history_at = s.history_at.data(),
                        .history = &s.history[chunk],
                        .load = s.load.data(),
                        .time_step = around.time_step,
                        .range = around.range,
                        .deep = around.deep,
                        .steps_per_metre = around.steps_per_metre};
    const std::uint32_t begin = s.chunk_pair[chunk], end = s.chunk_pair[chunk + 1];
    PairSums pairs;
    if (equal()) {
      pair_pass(PairLaws<Law, true>{tables_.grain.data(), 1, 0.5 * tables_.equal_mass, 0.5 * tables_.equal_radius},
                view, begin, end, pairs);
    } else {
      pair_pass(PairLaws<Law, false>{tables_.grain.data(), tables_.materials, 0.0, 0.0}, view, begin, end, pairs);
    }
    sums.virial += pairs.virial;
    sums.dissipated += pairs.dissipated;
    sums.contacts += pairs.contacts;
    sums.deep += pairs.deep;
    sums.max_overlap = std::max(sums.max_overlap, pairs.max_overlap);
    const std::size_t bodies = around.frames.size();
    for (std::size_t b = 0; b < bodies; ++b)
      meet_body(s, s.wall_memory[chunk], around,
                std::span(s.chunk_wall).subspan(chunk * bodies + b).template first<2>(), sums);
  }

  ContactEnergy energy(const State& s, const Surroundings& around) const override {
    ContactEnergy total;
    const auto add = [&](const auto& law, double overlap, const History<double>& h) {
      total.elastic += law.elastic_energy(overlap, h);
      total.attraction += law.attraction_energy(overlap);
    };
    s.each_in_range([&](std::size_t c, std::uint32_t slot) {
      const Pair p = s.pair[slot];
      const PositionRow &a = s.position[p.i], &b = s.position[p.j];
      const MotionRow &ma = s.motion[p.i], &mb = s.motion[p.j];
      constexpr int rows = Law::history_rows;
      const VectorRow* const history = &s.history[c].rows[s.history_at[slot] * rows];
      add(grain(ma, mb).at(ma.mass * mb.mass / (ma.mass + mb.mass), a.radius * b.radius / (a.radius + b.radius)),
          a.radius + b.radius - length(a.at - b.at),
          history_of(history[0], rows == 2 ? history[rows - 1] : VectorRow{}));
    });
    Touches touches;
    const std::size_t bodies = around.frames.size();
    for (std::size_t c = 0; c < s.chunks(); ++c) {
      for (std::uint32_t w = s.chunk_wall[c * bodies]; w < s.chunk_wall[(c + 1) * bodies]; ++w) {
        const WallSlot& slot = s.wall[w];
        const PositionRow& at = s.position[slot.particle];
        find(s, around, slot, touches);
        for (int t = 0; t < touches.count; ++t) {
          const int known = remembered(s.wall_memory[c], slot, touches.touch[t].normal);
          const WallMemory m = known < 0 ? WallMemory{} : s.wall_memory[c].rows[slot.place[known]];
          add(wall(s.motion[slot.particle], slot.body).at(s.motion[slot.particle].mass, at.radius),
              at.radius - touches.touch[t].distance, history_of(m.slip, m.roll));
        }
      }
    }
    return total;
  }

  Reaction<double> react(const Who& who, const Meeting<double>& meeting, const History<double>& before,
                         double time_step) const override {
    return law_of(who).at(who.mass, who.radius)(meeting, before, time_step);
  }
  double holds(const Who& who) const override { return law_of(who).normal.range(who.radius); }

 private:
  bool equal() const { return tables_.materials == 1 && tables_.equal_mass > 0.0; }
  const Law& grain(const MotionRow& a, const MotionRow& b) const {
    return tables_
        .grain[static_cast<std::size_t>(a.material) * tables_.materials + static_cast<std::size_t>(b.material)];
  }
  const Law& wall(const MotionRow& a, std::size_t body) const {
    const std::size_t bodies = tables_.wall.size() / static_cast<std::size_t>(tables_.materials);
    return tables_.wall[static_cast<std::size_t>(a.material) * bodies + body];
  }
  const Law& law_of(const Who& who) const {
    MotionRow a, b;
    a.material = static_cast<double>(who.material);
    b.material = static_cast<double>(who.other);
    return who.partner == Partner::sphere ? grain(a, b) : wall(a, who.other);
  }

  void find(const State& s, const Surroundings& around, const WallSlot& slot, Touches& found) const {
    const Frame& frame = around.frames[slot.body];
    const std::uint32_t asked = features_in_question(s, slot, frame);
    found.count = 0;
    if (asked == 0) return;
    const PositionRow& at = s.position[slot.particle];
    find_touches(around.surfaces[slot.body], {s.features.data() + slot.feature_first, asked},
                 frame.point + (frame.now.turned ? rotate_back(frame.now.rotation, at.at - frame.now.point)
                                                 : at.at - frame.now.point),
                 at.radius + around.range, found);
  }

  /// A contact found, waiting to be evaluated.
  struct WallHit {
    std::uint32_t slot, place;
    VectorRow normal;      ///< the normal in the body's frame, and the distance [m]
    VectorRow slip, roll;  ///< the contact's history, in the body's frame
  };

  /// Energy [J] in the memories of a slot that no contact takes over.
  double given_up(const State& s, const Pool<WallMemory>& memory, const WallSlot& slot, std::uint32_t lost) const {
    const auto law =
        wall(s.motion[slot.particle], slot.body).at(s.motion[slot.particle].mass, s.position[slot.particle].radius);
    double sum = 0.0;
    for (std::uint32_t k = 0; k < slot.touching; ++k) {
      const WallMemory& m = memory.rows[slot.place[k]];
      if ((lost >> k & 1u) != 0) sum += law.given_up(history_of(m.slip, m.roll));
    }
    return sum;
  }

  /// Evaluates the contacts of the chunk's spheres with one body. They are found one by one and evaluated in lanes.
  void meet_body(State& s, Pool<WallMemory>& memory, const Surroundings& around,
                 std::span<const std::uint32_t, 2> slots, StepSums& sums) const {
    constexpr std::size_t batch = 64;
    WallHit hits[batch + max_touches + lanes];
    std::size_t count = 0;
    Touches touches;
    for (std::uint32_t w = slots[0]; w < slots[1]; ++w) {
      WallSlot& slot = s.wall[w];
      find(s, around, slot, touches);
      const std::size_t first = count;
      std::uint32_t lost = (1u << slot.touching) - 1u;
      for (int t = 0; t < touches.count; ++t) {
        const Touch& touch = touches.touch[t];
        WallHit& hit = hits[count++];
        hit = {w, 0, {touch.normal, touch.distance}, {}, {}};
        if (const int known = remembered(memory, slot, touch.normal); known >= 0) {
          hit.slip = memory.rows[slot.place[known]].slip;
          hit.roll = memory.rows[slot.place[known]].roll;
          lost &= ~(1u << known);
        }
      }
      if (lost != 0) sums.dissipated += given_up(s, memory, slot, lost);
      const auto touching = static_cast<std::uint32_t>(touches.count);
      while (slot.touching > touching) memory.give_back(slot.place[--slot.touching]);
      while (slot.touching < touching) slot.place[slot.touching++] = memory.take();
      for (std::size_t k = first; k < count; ++k) {
        hits[k].place = slot.place[k - first];
        memory.rows[hits[k].place].normal = hits[k].normal.v;
      }
      if (count >= batch) {
        evaluate(s, memory, around, hits, count, sums);
        count = 0;
      }
    }
    if (count > 0) evaluate(s, memory, around, hits, count, sums);
  }

  DEMCAL_FLATTEN void evaluate(State& s, Pool<WallMemory>& memory, const Surroundings& around, WallHit* hits,
                               std::size_t count, StepSums& sums) const {
    const std::size_t body = s.wall[hits[0].slot].body;
    const Frame& frame = around.frames[body];
    const auto one = wall(MotionRow{}, body).at(tables_.equal_mass, tables_.equal_radius);
    for (int k = 0; k < lanes; ++k) hits[count + k] = hits[count - 1];
    Vector3<Tally> body_force, body_torque;
    Tally tool_work, dissipated, slipping;
    unsigned touching = 0;
    Lane max_overlap = 0.0;
    const auto add = [](Vector3<Tally>& tally, const Vector3<Lane>& values, std::size_t first) {
      tally.x.add(values.x, first);
      tally.y.add(values.y, first);
      tally.z.add(values.z, first);
    };
    for (std::size_t base = 0; base < count; base += lanes) {
      const WallHit* const hit = hits + base;
      std::uint32_t particle[lanes];
      for (int k = 0; k < lanes; ++k) particle[k] = s.wall[hit[k].slot].particle;
      const auto turned = [&](const Vector3<Lane>& a) { return frame.now.turned ? rotate(frame.now.rotation, a) : a; };
      const auto turned_back = [&](const Vector3<Lane>& a) {
        return frame.now.turned ? rotate_back(frame.now.rotation, a) : a;
      };
      const LaneRows at = transposed([&](int k) -> Four { return four(s.position[particle[k]].at.x); });
      const LaneRows velocity = transposed([&](int k) -> Four { return four(s.motion[particle[k]].velocity.x); });
      const LaneRows spin = transposed([&](int k) -> Four { return four(s.motion[particle[k]].spin.x); });
      const LaneRows normal = transposed([&](int k) -> Four { return four(hit[k].normal.v.x); });
      const LaneRows slip = transposed([&](int k) -> Four { return four(hit[k].slip.v.x); });
      History<Lane> history{turned(slip.v), slip.w, {}, Lane(0.0)};
      if constexpr (Law::history_rows == 2) {
        const LaneRows roll = transposed([&](int k) -> Four { return four(hit[k].roll.v.x); });
        history.roll = turned(roll.v);
        history.twist = roll.w;
      }
      const Vector3<Lane> n = turned(normal.v);
      const Lane distance = normal.w, radius = at.w;
      const Vector3<Lane> arm =
          at.v - spread(frame.now.point) - distance * n;  // from the motion's point to the contact point
      const Vector3<Lane> of_wall = spread(frame.now.velocity) + cross(spread(frame.now.spin), arm);
      const Meeting<Lane> m{n, radius - distance, velocity.v - distance * cross(spin.v, n) - of_wall,
                            spin.v - spread(frame.now.spin)};
      const auto react = [&]() -> Reaction<Lane> {
        if (equal()) return one(m, history, around.time_step);
        const auto law_of = [&](int k) { return &wall(s.motion[particle[k]], body); };
        return Law::at_lanes(law_of, velocity.w, radius)(m, history, around.time_step);
      };
      const Reaction<Lane> r = react();

      const Vector3<Lane> force = r.push * n + r.tangential;
      const int used = static_cast<int>(std::min<std::size_t>(lanes, count - base));
      Four forces[lanes], torques[lanes], slips[lanes], rolls[lanes];
      untransposed({force, Lane(0.0)}, forces);
      untransposed({r.couple - distance * cross(n, r.tangential), Lane(0.0)}, torques);
      untransposed({turned_back(r.history.slip), r.history.radius}, slips);
      if constexpr (Law::history_rows == 2) untransposed({turned_back(r.history.roll), r.history.twist}, rolls);
      for (int k = 0; k < used; ++k) {
        LoadRow& load = s.load[particle[k]];
        four(load.force.x) += forces[k];
        four(load.torque.x) += torques[k];
        WallMemory& kept = memory.rows[hit[k].place];
        four(kept.slip.v.x) = slips[k];
        if constexpr (Law::history_rows == 2) four(kept.roll.v.x) = rolls[k];
      }

      const Lane valid = first_lanes(used);
      add(body_force, -valid * force, base);
      add(body_torque, -valid * (cross(arm, force) + r.couple), base);
      tool_work.add(valid * (dot(force, of_wall) + dot(r.couple, spread(frame.now.spin))), base);
      dissipated.add(valid * r.dissipated, base);
      const Lane relative = m.overlap / radius;
      max_overlap = larger(max_overlap, relative);
      const unsigned lane_mask = (1u << used) - 1u;
      const auto touch = r.touch > 0.0;
      touching += static_cast<unsigned>(std::popcount(bits(touch) & lane_mask));
      slipping.add(select(touch, valid * norm(m.velocity - dot(m.velocity, n) * n), Lane(0.0)), base);
      sums.deep += static_cast<unsigned>(std::popcount(bits(relative > around.deep) & lane_mask));
    }
    BodyLoad& load = sums.body[body];
    const auto add_to = [](Vec3& total, const Vector3<Tally>& tally) {
      tally.x.add_to(total.x);
      tally.y.add_to(total.y);
      tally.z.add_to(total.z);
    };
    add_to(load.force, body_force);
    add_to(load.torque, body_torque);
    slipping.add_to(load.slip);
    load.contacts += touching;
    sums.wall_contacts += touching;
    tool_work.add_to(sums.tool_work, around.time_step);
    dissipated.add_to(sums.dissipated);
    for (int k = 0; k < lanes; ++k) sums.max_overlap = std::max(sums.max_overlap, static_cast<double>(max_overlap[k]));
  }

  LawTables<Law> tables_;
};

}  // namespace dem
