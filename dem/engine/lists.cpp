// Rebuild of the neighbour list, its lists: pairs within reach + skin with each pair's history in its new slot, what
// each chunk does to particles of others (halos), and the features of the bodies near each sphere.
//
// Each list is made in two passes that the team shares chunk by chunk: every chunk finds its entries and, once it is
// known how many come before them, puts them in their place. So a list is as long as it has to be, and its order is
// that of the chunks, whatever the number of threads.
#include <algorithm>
#include <cmath>
#include <limits>

#include "dem/engine/simulation.hpp"

namespace dem {
namespace {

constexpr std::uint32_t none = ~0u;

/// The list until now, in which histories are looked up.
struct OldPairs {
  std::vector<Pair> pair;
  std::vector<std::uint32_t> first;
  std::vector<std::uint64_t> in_range;
  std::vector<std::uint32_t> history_at, chunk_pair;
  std::vector<Pool<VectorRow>> history;
  std::size_t particles;
  const std::vector<Ghost>& ghost;

  /// The slot of (a, b), stored with a first.
  std::uint32_t slot_of(std::uint32_t a, std::uint32_t b) const {
    for (std::uint32_t slot = first[a]; slot < first[a + 1]; ++slot) {
      const std::uint32_t j = pair[slot].j;
      if ((j < particles ? j : ghost[j - particles].owner) == b) return slot;
    }
    return none;
  }
  const VectorRow* history_of(std::uint32_t slot) const {
    const auto after = std::upper_bound(chunk_pair.begin(), chunk_pair.end(), slot);
    const Pool<VectorRow>& pool = history[after - chunk_pair.begin() - 1];
    return pool.rows.data() + history_at[slot] * pool.width;
  }
};

/// Numbers after each other: where each chunk's entries begin, one more.
template <class Found, class Count>
std::vector<std::uint32_t> starts(const std::vector<Found>& found, Count&& count) {
  std::vector<std::uint32_t> first(1, 0);
  for (const Found& f : found) first.push_back(first.back() + static_cast<std::uint32_t>(count(f)));
  return first;
}

float rounded_down(double a) { return std::nextafter(static_cast<float>(a), -std::numeric_limits<float>::infinity()); }

}  // namespace

/// The pairs of the chunk's particles with the particles after them, and with all ghosts.
std::vector<Pair> Simulation::pairs_of(std::size_t chunk) const {
  const State& s = state_;
  const auto ghosts = static_cast<std::uint32_t>(s.particles());
  const double beyond = range_ + setup_.skin;
  const int ny = cells_.n[1], nz = cells_.n[2];
  std::vector<Pair> found;
  std::size_t count = 0;
  for (std::uint32_t i = s.chunk_first[chunk]; i < s.chunk_first[chunk + 1]; ++i) {
    const PositionRow p = s.position[i];
    const auto add_near = [&](std::uint32_t from, std::uint32_t to) {
      if (from >= to) return;
      if (found.size() < count + (to - from)) found.resize(2 * count + (to - from) + 1024);
      for (std::uint32_t j = from; j < to; ++j) {
        const PositionRow& q = s.position[j];
        const Vec3 apart = p.at - q.at;
        const double reach = p.radius + q.radius + beyond;
        found[count] = {i, j};
        count += dot(apart, apart) >= reach * reach ? 0 : 1;
      }
    };
    // The cells around, as runs of cells that follow each other along z.
    const auto [cx, cy, cz] = cells_.around(p.at);
    const int z_low = std::max(cz - 1, 0), z_high = std::min(cz + 1, nz - 1);
    for (int x = std::max(cx - 1, 0); x <= std::min(cx + 1, cells_.n[0] - 1); ++x) {
      for (int y = std::max(cy - 1, 0); y <= std::min(cy + 1, ny - 1); ++y) {
        const std::size_t column = (static_cast<std::size_t>(x) * ny + y) * nz;
        const std::size_t from = column + z_low, to = column + z_high + 1;
        add_near(std::max(cells_.first[from], i + 1), cells_.first[to]);
        add_near(ghosts + cells_.ghost_first[from], ghosts + cells_.ghost_first[to]);
      }
    }
  }
  found.resize(count);
  return found;
}

/// First pair of each particle in a list, one more.
std::vector<std::uint32_t> Simulation::first_of_each(const std::vector<Pair>& pairs,
                                                     const std::vector<std::uint32_t>& chunk_pair) {
  const State& s = state_;
  if (chunk_pair.empty()) return {};
  std::vector<std::uint32_t> first(s.particles() + 1, chunk_pair.back());
  team_.for_each(s.chunks(), [&](std::size_t c) {
    std::uint32_t i = s.chunk_first[c];
    for (std::uint32_t slot = chunk_pair[c]; slot < chunk_pair[c + 1]; ++slot)
      while (i <= pairs[slot].i) first[i++] = slot;
    while (i < s.chunk_first[c + 1]) first[i++] = chunk_pair[c + 1];
  });
  return first;
}

/// Pairs within reach, with the history of the old list.
void Simulation::list_pairs() {
  State& s = state_;
  const std::size_t n = s.particles(), chunks = s.chunks();
  const auto rows = static_cast<std::uint32_t>(setup_.laws->history_rows());
  std::vector<std::vector<Pair>> found(chunks);
  team_.for_each(chunks, [&](std::size_t c) { found[c] = pairs_of(c); });
  std::vector<std::uint32_t> old_chunk_pair = std::move(s.chunk_pair);
  std::vector<std::uint32_t> old_first = first_of_each(s.pair, old_chunk_pair);
  // Whole words of bits are a chunk's own.
  s.chunk_pair = starts(found, [](const std::vector<Pair>& f) { return (f.size() + 63) / 64 * 64; });
  const std::size_t pairs = s.chunk_pair.back();

  const OldPairs old{std::move(s.pair),
                     std::move(old_first),
                     std::move(s.in_range),
                     std::move(s.history_at),
                     std::move(old_chunk_pair),
                     std::move(s.history),
                     n,
                     old_ghosts_};
  s.pair = std::vector<Pair>(pairs);
  s.in_range = std::vector<std::uint64_t>(pairs / 64);
  s.history_at = std::vector<std::uint32_t>(pairs);
  s.history = std::vector<Pool<VectorRow>>(chunks, Pool<VectorRow>{.width = rows, .rows = {}, .free = {}});
  const auto take_over = [&](Pool<VectorRow>& pool, std::uint32_t slot) {
    const Pair p = s.pair[slot];
    const std::uint32_t a = order_[p.i], b = order_[p.j < n ? p.j : s.ghost[p.j - n].owner];
    std::uint32_t before = old.slot_of(a, b);
    double sign = 1.0;
    if (before == none) {
      before = old.slot_of(b, a);
      sign = -1.0;
    }
    if (before == none || (old.in_range[before / 64] & bit_of(before)) == 0) return;
    s.in_range[slot / 64] |= bit_of(slot);
    s.history_at[slot] = pool.take();
    // Seen from the other sphere forces turn round; the contact radius (row 0) and the twist (row 1) do not.
    for (std::size_t row = 0; row < rows; ++row) {
      const VectorRow& h = old.history_of(before)[row];
      pool.rows[s.history_at[slot] * rows + row] = {sign * h.v, h.w};
    }
  };
  team_.for_each(chunks, [&](std::size_t c) {
    const auto padding = std::copy(found[c].begin(), found[c].end(), s.pair.begin() + s.chunk_pair[c]);
    std::fill(padding, s.pair.begin() + s.chunk_pair[c + 1], Pair{s.chunk_first[c + 1] - 1, s.chunk_first[c + 1] - 1});
    if (old.first.empty()) return;
    for (std::uint32_t slot = s.chunk_pair[c]; slot < s.chunk_pair[c + 1]; ++slot) take_over(s.history[c], slot);
  });
  wake_all();
}

/// Makes all pairs due in this step.
void Simulation::wake_all() {
  State& s = state_;
  s.due.assign(s.in_range.size() * due_steps, 0);
  for (std::uint32_t word = 0; word < s.in_range.size(); ++word) s.due[due_at(word, s.step)] = ~std::uint64_t{0};
  for (std::size_t c = 0; c < s.chunks(); ++c) {
    for (std::uint32_t slot = s.chunk_pair[c + 1]; slot-- > s.chunk_pair[c] && is_padding(s.pair[slot]);)
      s.due[due_at(slot / 64, s.step)] &= ~bit_of(slot);
  }
  watched_speed_ = 1.25 * fastest_;
}

/// Which particles of others each chunk's pairs push, and where in `load` they do so.
void Simulation::list_halos() {
  State& s = state_;
  const std::size_t n = s.particles(), chunks = s.chunks();
  const auto owner = [&](std::uint32_t slot) {
    const std::uint32_t j = s.pair[slot].j;
    return j < n ? j : s.ghost[j - n].owner;
  };
  const auto at_home = [&](std::size_t c, std::uint32_t j) {
    return j >= s.chunk_first[c] && j < s.chunk_first[c + 1];
  };
  std::vector<std::vector<std::uint32_t>> foreign(chunks);
  team_.for_each(chunks, [&](std::size_t c) {
    std::vector<std::uint32_t>& found = foreign[c];
    for (std::uint32_t slot = s.chunk_pair[c]; slot < s.chunk_pair[c + 1]; ++slot)
      if (const std::uint32_t j = owner(slot); !at_home(c, j)) found.push_back(j);
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
  });
  const std::vector<std::uint32_t> first = starts(foreign, [](const auto& f) { return f.size(); });
  s.halo_owner = std::vector<std::uint32_t>(first.back());
  s.halo_part = std::vector<std::uint32_t>(chunks * chunks + 1);
  s.partner_load = std::vector<std::uint32_t>(s.chunk_pair.back());
  team_.for_each(chunks, [&](std::size_t c) {
    const std::vector<std::uint32_t>& found = foreign[c];
    const auto entry = [&](std::uint32_t j) {
      return first[c] + static_cast<std::uint32_t>(std::lower_bound(found.begin(), found.end(), j) - found.begin());
    };
    for (std::uint32_t slot = s.chunk_pair[c]; slot < s.chunk_pair[c + 1]; ++slot) {
      const std::uint32_t j = owner(slot);
      s.partner_load[slot] = at_home(c, j) ? j : static_cast<std::uint32_t>(n) + entry(j);
    }
    std::copy(found.begin(), found.end(), s.halo_owner.begin() + first[c]);
    for (std::size_t to = 0; to < chunks; ++to) s.halo_part[c * chunks + to + 1] = entry(s.chunk_first[to + 1]);
  });
  s.load.resize(n);
  make_room(s.load, n + first.back());
  s.load.resize(n + first.back());
}

namespace {

/// The features near a chunk's spheres: slots by body, of each body by sphere.
struct NearWalls {
  std::vector<WallSlot> slot;  ///< features counted from the chunk's first
  Pool<WallMemory> memory;
  std::vector<std::uint32_t> body;    ///< first slot of each body, one more
  std::vector<NearFeature> features;  ///< features of each slot, nearest first

  /// A slot of the list until now, its memories moved into this chunk's pool.
  WallSlot keep(const State& s, std::uint32_t w, std::size_t bodies) {
    WallSlot kept = s.wall[w];
    const auto after = std::upper_bound(s.chunk_wall.begin(), s.chunk_wall.end(), w);
    const auto chunk_before = static_cast<std::size_t>(after - s.chunk_wall.begin() - 1) / bodies;
    for (std::uint32_t k = 0; k < kept.touching; ++k) {
      const WallMemory& m = s.wall_memory[chunk_before].rows[kept.place[k]];
      kept.place[k] = memory.take();
      memory.rows[kept.place[k]] = m;
    }
    return kept;
  }

  /// Adds a slot with its features.
  void add(WallSlot one, const std::vector<NearFeature>& near) {
    one.feature_first = static_cast<std::uint32_t>(features.size());
    one.feature_count = static_cast<std::uint32_t>(near.size());
    slot.push_back(one);
    features.insert(features.end(), near.begin(), near.end());
  }
};

/// The slot that each sphere had at each body, by the sphere's new place; none where it was near no feature.
std::vector<std::uint32_t> slots_until_now(const State& s, const std::vector<std::uint32_t>& place,
                                           std::size_t bodies) {
  std::vector<std::uint32_t> slots(s.particles() * bodies, none);
  for (std::size_t w = 0; w < s.wall.size(); ++w)
    slots[place[s.wall[w].particle] * bodies + s.wall[w].body] = static_cast<std::uint32_t>(w);
  return slots;
}

}  // namespace

/// Features near each sphere, and the memory of the contacts it had.
void Simulation::list_walls() {
  State& s = state_;
  const std::size_t chunks = s.chunks(), bodies = setup_.bodies.size();
  const std::vector<std::uint32_t> old = slots_until_now(s, place_, bodies);
  std::vector<Pose> now;
  for (const Body& body : setup_.bodies) now.push_back(pose(body.motion, motion_time(s.step)));

  // Each chunk finds the features near its spheres.
  std::vector<NearWalls> found(chunks);
  team_.for_each(chunks, [&](std::size_t c) {
    NearWalls& f = found[c];
    std::vector<NearFeature> near;
    f.body.push_back(0);
    for (std::size_t b = 0; b < bodies; ++b) {
      const Vec3 point = setup_.bodies[b].motion.point;
      for (std::uint32_t i = s.chunk_first[c]; i < s.chunk_first[c + 1]; ++i) {
        const Vec3 in_body = point + rotate_back(now[b].rotation, s.position[i].at - now[b].point);
        find_features(surface_[b], in_body, s.position[i].radius + range_ + setup_.skin, near);
        if (near.empty()) continue;
        const std::uint32_t w = old[i * bodies + b];
        WallSlot slot = w != none ? f.keep(s, w, bodies) : WallSlot{};
        slot.particle = i;
        slot.body = static_cast<std::uint32_t>(b);
        f.add(slot, near);
      }
      f.body.push_back(static_cast<std::uint32_t>(f.slot.size()));
    }
  });

  // The lists have room for what all chunks found.
  const std::vector<std::uint32_t> first = starts(found, [](const NearWalls& f) { return f.slot.size(); });
  const std::vector<std::uint32_t> first_feature = starts(found, [](const NearWalls& f) { return f.features.size(); });
  s.wall = std::vector<WallSlot>(first.back());
  s.wall_memory.clear();
  for (NearWalls& f : found) s.wall_memory.push_back(std::move(f.memory));
  s.features = std::vector<std::uint32_t>(first_feature.back());
  s.feature_gap = std::vector<float>(first_feature.back());
  s.chunk_wall = std::vector<std::uint32_t>(chunks * bodies + 1);

  // Each chunk puts what it found in its place.
  team_.for_each(chunks, [&](std::size_t c) {
    const NearWalls& f = found[c];
    for (std::size_t b = 0; b < bodies; ++b) s.chunk_wall[c * bodies + b + 1] = first[c] + f.body[b + 1];
    for (std::size_t k = 0; k < f.slot.size(); ++k) {
      WallSlot& slot = s.wall[first[c] + k] = f.slot[k];
      const double touching = s.position[slot.particle].radius + range_;
      slot.feature_first += first_feature[c];
      for (std::uint32_t t = 0; t < slot.feature_count; ++t) {
        const NearFeature& near = f.features[f.slot[k].feature_first + t];
        s.features[slot.feature_first + t] = near.feature;
        s.feature_gap[slot.feature_first + t] = rounded_down(near.distance - touching);
      }
    }
  });
}

}  // namespace dem
