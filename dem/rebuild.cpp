// Rebuild of the neighbour list: wrap, sort along the cells, make the ghosts of periodic faces, find pairs within reach
// + skin, carry each pair's history over to its new slot, cut chunks and halos, and list the features of the bodies
// near each sphere.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dem/pair_pass.hpp"
#include "dem/simulation.hpp"

namespace dem {
namespace {

int cell_along(double x, double low, double size, int n) {
  return std::clamp(static_cast<int>((x - low) / size), 0, n - 1);
}

double wrapped(double x, double low, double high, bool periodic) {
  if (!periodic) return x;
  const double period = high - low;
  while (x < low) x += period;
  while (x >= high) x -= period;
  return x;
}

template <class Row>
void permute(std::vector<Row>& rows, const std::vector<std::uint32_t>& order) {
  std::vector<Row> sorted(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) sorted[i] = rows[order[i]];
  rows.swap(sorted);
}

}  // namespace

/// Puts every particle back into the box along periodic axes; a particle outside ends the run.
void Simulation::wrap() {
  const Vec3 low = setup_.low, high = setup_.high;
  for (std::size_t i = 0; i < state_.particles(); ++i) {
    Vec3& p = state_.position[i].at;
    const Vec3 v = state_.half[i].velocity;
    if (!(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z) && std::isfinite(dot(v, v)))) {
      throw Fault(
          fmt::format("particle {} has a position or velocity that is not a number at {:.6g} s (a contact too stiff "
                      "for the time step, or spheres that start inside each other)",
                      state_.id[i], time()));
    }
    const Vec3 size = high - low;
    if ((setup_.periodic[0] && std::abs(p.x - low.x) > 2.0 * size.x) ||
        (setup_.periodic[1] && std::abs(p.y - low.y) > 2.0 * size.y) ||
        (setup_.periodic[2] && std::abs(p.z - low.z) > 2.0 * size.z)) {
      throw Fault(
          fmt::format("particle {} crossed the box within a few steps at {:.6g} s (a contact too stiff for the time "
                      "step)",
                      state_.id[i], time()));
    }
    p = {wrapped(p.x, low.x, high.x, setup_.periodic[0]), wrapped(p.y, low.y, high.y, setup_.periodic[1]),
         wrapped(p.z, low.z, high.z, setup_.periodic[2])};
    if (p.x < low.x || p.x > high.x || p.y < low.y || p.y > high.y || p.z < low.z || p.z > high.z) {
      throw Fault(
          fmt::format("particle {} is outside the rig, at ({:.4g}, {:.4g}, {:.4g}) m, at {:.6g} s (thrown out over the "
                      "rim, or pushed through a wall)",
                      state_.id[i], p.x, p.y, p.z, time()));
    }
  }
}

void Simulation::rebuild() {
  wrap();
  sort();
  make_ghosts();
  list_pairs();
  cut_chunks();
  list_walls();
  max_displacement2_ = 0.0;
  state_.rebuild_step = state_.step;
  ++state_.rebuilds;
}

/// Sorts the particles along the cells (counting sort, stable). Cells are at least as long as a pair's reach and cover
/// the ghosts; no more of them than a few per particle, so that a large empty box costs nothing.
void Simulation::sort() {
  State& s = state_;
  const std::size_t n = s.particles();
  const double reach = 2.0 * largest_radius_ + range_ + setup_.skin;
  const auto margin = [&](int axis) { return setup_.periodic[axis] ? reach : 0.0; };
  const Vec3 around{margin(0), margin(1), margin(2)};
  cells_.low = setup_.low - around;
  const Vec3 size = setup_.high + around - cells_.low;
  const double extent[3] = {size.x, size.y, size.z};
  const std::size_t most = std::max<std::size_t>(32768, 4 * n);
  for (double edge = reach;; edge *= 1.25) {
    for (int a = 0; a < 3; ++a) cells_.n[a] = std::clamp(static_cast<int>(extent[a] / edge), 1, 1024);
    if (cells_.total() <= most) break;
  }
  cells_.size = {size.x / cells_.n[0], size.y / cells_.n[1], size.z / cells_.n[2]};

  cells_.of.resize(n);
  cells_.first.assign(cells_.total() + 1, 0);
  for (std::size_t i = 0; i < n; ++i) ++cells_.first[(cells_.of[i] = cell_of(s.position[i].at)) + 1];
  for (std::size_t c = 1; c < cells_.first.size(); ++c) cells_.first[c] += cells_.first[c - 1];
  order_.resize(n);
  place_.resize(n);
  std::vector<std::uint32_t> fill(cells_.first.begin(), cells_.first.end() - 1);
  for (std::size_t i = 0; i < n; ++i) place_[i] = fill[cells_.of[i]]++;
  for (std::size_t i = 0; i < n; ++i) order_[place_[i]] = static_cast<std::uint32_t>(i);
  permute(s.position, order_);
  permute(s.motion, order_);
  permute(s.half, order_);
  permute(s.load, order_);
  permute(s.id, order_);
  permute(cells_.of, order_);
  s.reference.resize(n);
  std::copy_n(s.position.begin(), n, s.reference.begin());
}

std::uint32_t Simulation::cell_of(Vec3 p) const {
  const Cells& c = cells_;
  const int x = cell_along(p.x, c.low.x, c.size.x, c.n[0]), y = cell_along(p.y, c.low.y, c.size.y, c.n[1]),
            z = cell_along(p.z, c.low.z, c.size.z, c.n[2]);
  return static_cast<std::uint32_t>((static_cast<std::size_t>(x) * c.n[1] + y) * c.n[2] + z);
}

/// Each pair across a periodic face is met once: a particle has ghosts for the lexicographically positive shifts only.
void Simulation::make_ghosts() {
  State& s = state_;
  const std::size_t n = s.particles();
  const double reach = 2.0 * largest_radius_ + range_ + setup_.skin;
  const Vec3 size = setup_.high - setup_.low;
  old_ghosts_.swap(s.ghost);
  s.ghost.clear();
  const auto near = [&](double x, double low, double high, int shift) {
    return shift == 0 || (shift > 0 ? x - low < reach : high - x < reach);
  };
  std::vector<std::uint32_t> cell;
  for (int sx = 0; sx <= (setup_.periodic[0] ? 1 : 0); ++sx) {
    for (int sy = setup_.periodic[1] ? -1 : 0; sy <= (setup_.periodic[1] ? 1 : 0); ++sy) {
      for (int sz = setup_.periodic[2] ? -1 : 0; sz <= (setup_.periodic[2] ? 1 : 0); ++sz) {
        if (!(sx > 0 || (sx == 0 && (sy > 0 || (sy == 0 && sz > 0))))) continue;
        const Vec3 shift{sx * size.x, sy * size.y, sz * size.z};
        for (std::size_t i = 0; i < n; ++i) {
          const Vec3 p = s.position[i].at;
          if (near(p.x, setup_.low.x, setup_.high.x, sx) && near(p.y, setup_.low.y, setup_.high.y, sy) &&
              near(p.z, setup_.low.z, setup_.high.z, sz)) {
            s.ghost.push_back({static_cast<std::uint32_t>(i), shift});
            cell.push_back(cell_of(p + shift));
          }
        }
      }
    }
  }
  // Sorted along the cells, too.
  cells_.ghost_first.assign(cells_.total() + 1, 0);
  for (const std::uint32_t c : cell) ++cells_.ghost_first[c + 1];
  for (std::size_t c = 1; c < cells_.ghost_first.size(); ++c) cells_.ghost_first[c] += cells_.ghost_first[c - 1];
  std::vector<std::uint32_t> fill(cells_.ghost_first.begin(), cells_.ghost_first.end() - 1);
  std::vector<Ghost> sorted(s.ghost.size());
  for (std::size_t g = 0; g < s.ghost.size(); ++g) sorted[fill[cell[g]]++] = s.ghost[g];
  s.ghost.swap(sorted);
  s.position.resize(n + s.ghost.size());
  s.motion.resize(n + s.ghost.size());
  follow_owners();
}

/// Pairs within reach, with the history of the old list.
void Simulation::list_pairs() {
  State& s = state_;
  const std::size_t n = s.particles();
  const int rows = setup_.laws->history_rows();
  const double beyond = range_ + setup_.skin;
  std::vector<Pair> pair;
  std::vector<std::uint32_t> first(n + 1, 0);
  std::vector<std::uint8_t> in_range;
  std::vector<VectorRow> history;
  pair.reserve(s.pair.size() + n);
  in_range.reserve(s.pair.size() + n);
  history.reserve((s.pair.size() + n) * static_cast<std::size_t>(rows));
  const bool any = !s.pair.empty();

  // The old slot of the old pair (a, b), stored with a first.
  constexpr std::uint32_t none = ~0u;
  const auto old_slot = [&](std::uint32_t a, std::uint32_t b) {
    for (std::uint32_t slot = s.pair_first[a]; slot < s.pair_first[a + 1]; ++slot) {
      const std::uint32_t j = s.pair[slot].j;
      if ((j < n ? j : old_ghosts_[j - n].owner) == b) return slot;
    }
    return none;
  };
  const auto take_over = [&](std::uint32_t i, std::uint32_t j) {
    std::uint32_t slot = none;
    double sign = 1.0;
    if (any) {
      const std::uint32_t a = order_[i], b = order_[j];
      slot = old_slot(a, b);
      if (slot == none) {
        slot = old_slot(b, a);
        sign = -1.0;
      }
    }
    const bool known = slot != none && s.in_range[slot] != 0;
    in_range.push_back(known ? 1 : 0);
    for (int row = 0; row < rows; ++row) {
      VectorRow h;
      if (known) {
        // Seen from the other sphere forces turn round; the contact radius (row 0) and the twist (row 1) do not.
        h = s.history[slot * static_cast<std::size_t>(rows) + static_cast<std::size_t>(row)];
        h.v = sign * h.v;
      }
      history.push_back(h);
    }
  };

  const int ny = cells_.n[1], nz = cells_.n[2];
  for (std::uint32_t i = 0; i < n; ++i) {
    const PositionRow p = s.position[i];
    const auto c = static_cast<int>(cells_.of[i]);
    const int cx = c / (ny * nz), cy = c / nz % ny, cz = c % nz;
    const int z_low = std::max(cz - 1, 0), z_high = std::min(cz + 1, nz - 1);
    const auto look = [&](std::uint32_t from, std::uint32_t to) {
      for (std::uint32_t j = from; j < to; ++j) {
        const PositionRow& q = s.position[j];
        const Vec3 apart = p.at - q.at;
        const double reach = p.radius + q.radius + beyond;
        if (dot(apart, apart) >= reach * reach) continue;
        pair.push_back({i, j});
        take_over(i, j < n ? j : s.ghost[j - n].owner);
      }
    };
    // The cells around, as runs of cells that follow each other along z; particles after i, and all ghosts.
    for (int x = std::max(cx - 1, 0); x <= std::min(cx + 1, cells_.n[0] - 1); ++x) {
      for (int y = std::max(cy - 1, 0); y <= std::min(cy + 1, ny - 1); ++y) {
        const std::size_t column = (static_cast<std::size_t>(x) * ny + y) * nz;
        const std::size_t from = column + z_low, to = column + z_high + 1;
        look(std::max(cells_.first[from], i + 1), cells_.first[to]);
        const auto ghosts = static_cast<std::uint32_t>(n);
        look(ghosts + cells_.ghost_first[from], ghosts + cells_.ghost_first[to]);
      }
    }
    first[i + 1] = static_cast<std::uint32_t>(pair.size());
  }
  s.pair_first.swap(first);
  s.pair.swap(pair);
  s.in_range.swap(in_range);
  s.history.swap(history);
}

/// Chunks of about a thousand particles, and what each does to particles of others.
void Simulation::cut_chunks() {
  State& s = state_;
  const std::size_t n = s.particles(), chunks = std::clamp<std::size_t>(n / 1024, 1, 64);
  s.chunk_first.clear();
  s.chunk_pair.clear();
  for (std::size_t c = 0; c <= chunks; ++c) {
    s.chunk_first.push_back(static_cast<std::uint32_t>(n * c / chunks));
    s.chunk_pair.push_back(s.pair_first[s.chunk_first.back()]);
  }
  const std::size_t pairs = s.chunk_pair.back();
  s.pair.resize(pairs + ahead + 8);
  s.partner_load.resize(pairs);
  s.halo_owner.clear();
  s.halo_part.assign(1, 0);
  std::vector<std::uint32_t> foreign, entry(n);
  for (std::size_t c = 0; c < chunks; ++c) {
    const std::uint32_t begin = s.chunk_first[c], end = s.chunk_first[c + 1];
    const auto owner = [&](std::uint32_t j) { return j < n ? j : s.ghost[j - n].owner; };
    const auto at_home = [&](std::uint32_t j) { return j >= begin && j < end; };
    foreign.clear();
    for (std::uint32_t slot = s.chunk_pair[c]; slot < s.chunk_pair[c + 1]; ++slot) {
      const std::uint32_t j = owner(s.pair[slot].j);
      if (!at_home(j)) foreign.push_back(j);
    }
    std::sort(foreign.begin(), foreign.end());
    foreign.erase(std::unique(foreign.begin(), foreign.end()), foreign.end());
    for (std::size_t k = 0; k < foreign.size(); ++k)
      entry[foreign[k]] = static_cast<std::uint32_t>(n + s.halo_owner.size() + k);
    for (std::uint32_t slot = s.chunk_pair[c]; slot < s.chunk_pair[c + 1]; ++slot) {
      const std::uint32_t j = owner(s.pair[slot].j);
      s.partner_load[slot] = at_home(j) ? j : entry[j];
    }
    std::size_t k = 0;
    for (std::size_t to = 0; to < chunks; ++to) {
      while (k < foreign.size() && foreign[k] < s.chunk_first[to + 1]) ++k;
      s.halo_part.push_back(static_cast<std::uint32_t>(s.halo_owner.size() + k));
    }
    s.halo_owner.insert(s.halo_owner.end(), foreign.begin(), foreign.end());
  }
  s.load.resize(n);
  s.load.resize(n + s.halo_owner.size());
}

/// Features near each sphere, and the memory of the contacts it had.
void Simulation::list_walls() {
  State& s = state_;
  const std::size_t n = s.particles(), bodies = setup_.bodies.size();
  constexpr std::uint32_t none = ~0u;
  std::vector<std::uint32_t> old(n * bodies, none);
  for (std::size_t w = 0; w < s.wall.size(); ++w)
    old[place_[s.wall[w].particle] * bodies + s.wall[w].body] = static_cast<std::uint32_t>(w);
  std::vector<Pose> now;
  for (const Body& body : setup_.bodies) now.push_back(pose(body.motion, motion_time(s.step)));
  std::vector<WallSlot> wall;
  std::vector<NearFeature> near;
  s.features.clear();
  s.feature_gap.clear();
  s.chunk_wall.assign(1, 0);
  for (std::size_t c = 0; c < s.chunks(); ++c) {
    for (std::size_t b = 0; b < bodies; ++b) {
      const Vec3 point = setup_.bodies[b].motion.point;
      for (std::uint32_t i = s.chunk_first[c]; i < s.chunk_first[c + 1]; ++i) {
        const Vec3 in_body = point + rotate_back(now[b].rotation, s.position[i].at - now[b].point);
        const std::size_t before = s.features.size();
        const double touching = s.position[i].radius + range_;
        find_features(surface_[b], in_body, touching + setup_.skin, near);
        if (near.empty()) continue;
        for (const NearFeature& f : near) {
          s.features.push_back(f.feature);
          s.feature_gap.push_back(f.distance - touching);
        }
        WallSlot slot;
        if (old[i * bodies + b] != none) slot = s.wall[old[i * bodies + b]];
        slot.particle = i;
        slot.body = static_cast<std::uint32_t>(b);
        slot.feature_first = static_cast<std::uint32_t>(before);
        slot.feature_count = static_cast<std::uint32_t>(s.features.size() - before);
        wall.push_back(slot);
      }
      s.chunk_wall.push_back(static_cast<std::uint32_t>(wall.size()));
    }
  }
  s.wall.swap(wall);
}

}  // namespace dem
