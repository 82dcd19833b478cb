#pragma once
// The pair forces of a run of pairs, in two stages: which pairs are in range, then the forces of those, as many at a
// time as a register has lanes.
//
// Most pairs of the list are out of range, and stay so for a while: in a step no two spheres approach each other by
// more than twice the way of the fastest sphere. A pair out of range is therefore looked at again only when it could be
// in range, up to due_steps - 1 steps later. Simulation makes all of them due when a sphere becomes faster than was
// counted on. Pairs in range are evaluated in every step, which sees when they part. The pairs evaluated are thus the
// ones that looking at all pairs in every step would find, in the same order.
#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#include "dem/contact/contact_law.hpp"
#include "dem/contact/state.hpp"

namespace dem {

/// Sums over the contacts of one step.
struct PairSums {
  double virial = 0.0;         ///< J, sum of push * distance of the centres
  double dissipated = 0.0;     ///< J in this step
  std::uint64_t contacts = 0;  ///< pairs that touch
  std::uint64_t deep = 0;      ///< contacts whose overlap is more than PairView::deep
  double max_overlap = 0.0;    ///< largest overlap, as a share of the mean radius of the two
};

struct PairView {
  const PositionRow* position;
  const MotionRow* motion;
  const Pair* pair;
  const std::uint32_t* partner_load;
  std::uint64_t* in_range;
  std::uint64_t* due;
  std::uint64_t step;
  std::uint32_t* history_at;
  Pool<VectorRow>* history;
  LoadRow* load;
  double time_step;        ///< s
  double range;            ///< m, how far the laws reach beyond touching
  double deep;             ///< share of the mean radius of the two; deeper overlaps are counted
  double steps_per_metre;  ///< at least so many until two spheres are nearer to each other by a metre
};

/// Laws of the pairs of a bed: one law for all where spheres are equal, else a table over both materials.
template <class Law, bool Uniform>
struct PairLaws {
  const Law* table;  ///< materials x materials
  int materials;
  double mass, radius;  ///< reduced mass and radius of the one kind of pair

  double each_radius() const { return 2.0 * radius; }
  auto at_all() const {
    if constexpr (Uniform)
      return table->at(mass, radius);
    else
      return 0;
  }
};

inline constexpr std::uint32_t hit_batch = 512;  ///< pairs looked at before their hits are evaluated
inline constexpr std::uint32_t ahead = 12;       ///< hits whose rows are asked for in advance

/// The vector x_i - x_j, and the sum r_i + r_j in the fourth place.
inline Four with_sum_of_radii(const PositionRow& a, const PositionRow& b) {
  typedef long long Bits __attribute__((vector_size(32)));
  const Bits sign = reinterpret_cast<Bits>(Four{0.0, 0.0, 0.0, -0.0});
  return four(a.at.x) - reinterpret_cast<Four>(reinterpret_cast<Bits>(four(b.at.x)) ^ sign);
}

/// Lists the slots of the bits set in `bits_of_word`; `word` is the word's number.
inline std::uint32_t list_bits(std::uint64_t bits_of_word, std::uint32_t word, std::uint32_t* slots,
                               std::uint32_t count) {
  for (; bits_of_word != 0; bits_of_word &= bits_of_word - 1)
    slots[count++] = 64 * word + static_cast<std::uint32_t>(std::countr_zero(bits_of_word));
  return count;
}

/// Lets a pair rest until its spheres could have come nearer by `gap` [m], at least until the next step.
inline void sleep(const PairView& v, std::uint32_t slot, double gap) {
  const double steps = gap * v.steps_per_metre;
  const std::uint32_t later = steps < due_steps - 1 ? std::max(1u, static_cast<std::uint32_t>(steps)) : due_steps - 1;
  v.due[due_at(slot / 64, v.step + later)] |= bit_of(slot);
}

/// Looks at the pairs among the words [begin, end) that are due: those in range are marked so, the others sleep.
DEMCAL_FLATTEN inline void look_at_due(const PairView& v, std::uint32_t begin, std::uint32_t end) {
  std::uint32_t slots[hit_batch + lanes], count = 0;
  for (std::uint32_t word = begin; word < end; ++word) {
    std::uint64_t& due = v.due[due_at(word, v.step)];
    count = list_bits(due & ~v.in_range[word], word, slots, count);
    due = 0;
  }
  if (count == 0) return;
  for (std::uint32_t k = 0; k < count; ++k) __builtin_prefetch(&v.position[v.pair[slots[k]].j]);
  for (int k = 0; k < lanes; ++k) slots[count + k] = slots[count - 1];
  for (std::uint32_t base = 0; base < count; base += lanes) {
    const std::uint32_t* const slot = slots + base;
    const LaneRows apart = transposed([&](int k) {
      const Pair p = v.pair[slot[k]];
      return with_sum_of_radii(v.position[p.i], v.position[p.j]);
    });
    const Lane reach = apart.w + v.range, distance2 = dot(apart.v, apart.v);
    const Lane gap = square_root(distance2) - reach;
    const unsigned near = bits(distance2 < reach * reach);
    const std::uint32_t used = std::min<std::uint32_t>(lanes, count - base);
    for (std::uint32_t k = 0; k < used; ++k) {
      if ((near >> k) & 1u) {
        v.in_range[slot[k] / 64] |= bit_of(slot[k]);
        v.history_at[slot[k]] = v.history->take();
      } else {
        sleep(v, slot[k], gap[k]);
      }
    }
  }
}

template <class Law, bool Uniform>
DEMCAL_FLATTEN void pair_pass(const PairLaws<Law, Uniform> laws, const PairView v, std::uint32_t begin,
                              std::uint32_t end, PairSums& sums) {
  constexpr int rows = Law::history_rows;
  constexpr bool turning = Law::Resistance::present;
  const auto one = laws.at_all();
  Tally virial, dissipated;
  Lane max_overlap = 0.0;
  std::uint64_t contacts = 0, deep = 0;
  std::uint32_t hits[hit_batch + lanes];
  for (std::uint32_t from = begin; from < end; from += hit_batch) {
    const std::uint32_t first_word = from / 64, last_word = std::min(end, from + hit_batch) / 64;
    look_at_due(v, first_word, last_word);
    VectorRow* const histories = v.history->rows.data();
    std::uint32_t count = 0;
    for (std::uint32_t word = first_word; word < last_word; ++word)
      count = list_bits(v.in_range[word], word, hits, count);
    if (count == 0) continue;
    for (int k = 0; k < lanes; ++k) hits[count + k] = hits[count - 1];
    for (std::uint32_t base = 0; base < count; base += lanes) {
      const std::uint32_t* const slot = hits + base;
      Pair p[lanes];
      for (int k = 0; k < lanes; ++k) p[k] = v.pair[slot[k]];
      for (std::uint32_t k = base + ahead; k < std::min(base + ahead + lanes, count); ++k) {
        const std::uint32_t j = v.pair[hits[k]].j;
        __builtin_prefetch(&v.position[j]);
        __builtin_prefetch(&v.motion[j]);
        __builtin_prefetch(&v.load[v.partner_load[hits[k]]], 1);
        __builtin_prefetch(&histories[v.history_at[hits[k]] * rows], 1);
      }
      const auto velocity = [&](std::uint32_t row) -> Four { return four(v.motion[row].velocity.x); };
      const auto spin = [&](std::uint32_t row) -> Four { return four(v.motion[row].spin.x); };
      const LaneRows apart =
          transposed([&](int k) { return with_sum_of_radii(v.position[p[k].i], v.position[p[k].j]); });
      const LaneRows moving = transposed([&](int k) { return velocity(p[k].i) - velocity(p[k].j); });
      // Surfaces roll by r_i w_i + r_j w_j.
      const LaneRows roll = transposed([&](int k) -> Four {
        if constexpr (Uniform)
          return laws.each_radius() * (spin(p[k].i) + spin(p[k].j));
        else
          return v.position[p[k].i].radius * spin(p[k].i) + v.position[p[k].j].radius * spin(p[k].j);
      });
      const auto radius = [&](auto of) -> Lane {
        if constexpr (Uniform)
          return laws.each_radius();
        else
          return Lane([&](auto k) { return v.position[of(p[k])].radius; });
      };
      const Lane radius_i = radius([](Pair q) { return q.i; }), radius_j = radius([](Pair q) { return q.j; });
      const auto remembered = [&](int row) {
        return transposed([&](int k) -> Four { return four(histories[v.history_at[slot[k]] * rows + row].v.x); });
      };
      const LaneRows slip = remembered(0);
      History<Lane> history{slip.v, slip.w, {}, Lane(0.0)};
      if constexpr (rows == 2) {
        const LaneRows second = remembered(1);
        history.roll = second.v;
        history.twist = second.w;
      }

      const Lane distance = norm(apart.v), sum = Uniform ? Lane(2.0 * laws.each_radius()) : apart.w;
      Meeting<Lane> m;
      m.normal = Lane(1.0 / distance) * apart.v;
      m.overlap = sum - distance;
      const Lane arm =
          Uniform ? Lane(distance * (0.5 / laws.each_radius()))
                  : Lane(distance / sum);  // arms r_i d / (r_i + r_j): to the contact point, and together the distance
      m.velocity = moving.v - arm * cross(roll.v, m.normal);
      if constexpr (turning) m.spin = transposed([&](int k) { return spin(p[k].i) - spin(p[k].j); }).v;

      const auto react = [&]() -> Reaction<Lane> {
        if constexpr (Uniform) {
          return one(m, history, v.time_step);
        } else {
          const Lane mass_i([&](auto k) { return v.motion[p[k].i].mass; });
          const Lane mass_j([&](auto k) { return v.motion[p[k].j].mass; });
          const auto law_of = [&](int k) {
            const int a = static_cast<int>(v.motion[p[k].i].material), b = static_cast<int>(v.motion[p[k].j].material);
            return laws.table + a * laws.materials + b;
          };
          return Law::at_lanes(law_of, Lane(mass_i * mass_j / (mass_i + mass_j)), Lane(radius_i * radius_j / sum))(
              m, history, v.time_step);
        }
      };
      const Reaction<Lane> r = react();

      Four force[lanes], torque_i[lanes], torque_j[lanes], kept[lanes], kept_too[lanes];
      const Vector3<Lane> moment = arm * cross(m.normal, r.tangential);
      untransposed({r.push * m.normal + r.tangential, Lane(0.0)}, force);
      untransposed({r.history.slip, r.history.radius}, kept);
      if constexpr (rows == 2) untransposed({r.history.roll, r.history.twist}, kept_too);
      if constexpr (turning) {
        untransposed({r.couple - radius_i * moment, Lane(0.0)}, torque_i);
        untransposed({-r.couple - radius_j * moment, Lane(0.0)}, torque_j);
      } else if constexpr (Uniform) {
        untransposed({radius_i * moment, Lane(0.0)}, torque_i);
      } else {
        untransposed({radius_i * moment, Lane(0.0)}, torque_i);
        untransposed({radius_j * moment, Lane(0.0)}, torque_j);
      }
      const int used = static_cast<int>(std::min<std::uint32_t>(lanes, count - base));
      const Lane reach = apart.w + v.range;
      for (unsigned parted = ~bits(dot(apart.v, apart.v) < reach * reach) & ((1u << used) - 1u); parted != 0;
           parted &= parted - 1) {
        const std::uint32_t left = slot[std::countr_zero(parted)];
        v.in_range[left / 64] &= ~bit_of(left);
        v.history->give_back(v.history_at[left]);
        sleep(v, left, 0.0);
      }
      const auto add = [&](auto lanes_used) {
        for (int k = 0; k < lanes_used; ++k) {
          LoadRow &a = v.load[p[k].i], &b = v.load[v.partner_load[slot[k]]];
          VectorRow* const history_row = histories + v.history_at[slot[k]] * rows;
          four(history_row[0].v.x) = kept[k];
          if constexpr (rows == 2) four(history_row[1].v.x) = kept_too[k];
          four(a.force.x) += force[k];
          four(b.force.x) -= force[k];
          if constexpr (turning) {
            four(a.torque.x) += torque_i[k];
            four(b.torque.x) += torque_j[k];
          } else {
            four(a.torque.x) -= torque_i[k];
            four(b.torque.x) -= Uniform ? torque_i[k] : torque_j[k];
          }
        }
      };
      if (used == lanes)  // the usual case, in which the compiler knows the number of lanes
        add(std::integral_constant<int, lanes>{});
      else
        add(used);

      const unsigned lane_mask = (1u << used) - 1u;
      const Lane valid = first_lanes(used);
      virial.add(valid * (r.push * distance), base);
      dissipated.add(valid * r.dissipated, base);
      const Lane relative = Uniform ? Lane(m.overlap * (1.0 / laws.each_radius())) : Lane(2.0 * m.overlap / sum);
      max_overlap = larger(max_overlap, relative);
      contacts += static_cast<unsigned>(std::popcount(bits(r.touch > 0.0) & lane_mask));
      deep += static_cast<unsigned>(std::popcount(bits(relative > v.deep) & lane_mask));
    }
  }
  virial.add_to(sums.virial);
  dissipated.add_to(sums.dissipated);
  for (int k = 0; k < lanes; ++k) sums.max_overlap = larger(sums.max_overlap, static_cast<double>(max_overlap[k]));
  sums.contacts += contacts;
  sums.deep += deep;
}

}  // namespace dem
