// Rebuild of the neighbour list: wrap, sort along the cells, find pairs within reach + skin, carry each pair's spring
// over to its new slot, and list the features of the bodies near each sphere.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "dem/simulation.hpp"

namespace dem {
namespace {

struct Cells {
  Vec3 low, size;  ///< m, origin and edge lengths of one cell
  int n[3] = {1, 1, 1};
  std::size_t total() const { return static_cast<std::size_t>(n[0]) * n[1] * n[2]; }
};

/// Cells at least `reach` long; no more of them than a few per particle, so that a large empty box costs nothing.
Cells make_cells(const Setup& setup, double reach) {
  Cells c;
  c.low = setup.low;
  const Vec3 size = setup.high - setup.low;
  const double length[3] = {size.x, size.y, size.z};
  const std::size_t most = std::max<std::size_t>(32768, 16 * setup.spheres.position.size());
  for (double edge = reach;; edge *= 1.25) {
    for (int a = 0; a < 3; ++a) c.n[a] = std::clamp(static_cast<int>(length[a] / edge), 1, 512);
    if (c.total() <= most) break;
  }
  c.size = {size.x / c.n[0], size.y / c.n[1], size.z / c.n[2]};
  return c;
}

int cell_along(double x, double low, double size, int n) {
  return std::clamp(static_cast<int>((x - low) / size), 0, n - 1);
}

/// A cell index put back into the box, and the image it came from: 0 below, 1 inside, 2 above.
struct Wrapped {
  int cell;
  std::uint32_t image;
};
Wrapped wrap_cell(int cell, int n) {
  if (cell < 0) return {cell + n, 0};
  if (cell >= n) return {cell - n, 2};
  return {cell, 1};
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
  std::vector<Row> sorted(rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) sorted[i] = rows[order[i]];
  rows.swap(sorted);
}

}  // namespace

/// Puts every particle back into the box along periodic axes; a particle outside ends the run.
void Simulation::wrap() {
  const Vec3 low = setup_.low, high = setup_.high;
  for (std::size_t i = 0; i < state_.position.size(); ++i) {
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
  State& s = state_;
  wrap();
  const std::size_t n = s.position.size();
  const double reach = 2.0 * setup_.spheres.radius + range_ + setup_.skin;
  const Cells cells = make_cells(setup_, reach);

  // Sort along the cells (counting sort, stable).
  std::vector<std::uint32_t> cell(n), start(cells.total() + 1, 0), order(n), place(n);
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3 p = s.position[i].at;
    const int x = cell_along(p.x, cells.low.x, cells.size.x, cells.n[0]),
              y = cell_along(p.y, cells.low.y, cells.size.y, cells.n[1]),
              z = cell_along(p.z, cells.low.z, cells.size.z, cells.n[2]);
    cell[i] = static_cast<std::uint32_t>((static_cast<std::size_t>(x) * cells.n[1] + y) * cells.n[2] + z);
    ++start[cell[i] + 1];
  }
  for (std::size_t c = 1; c < start.size(); ++c) start[c] += start[c - 1];
  std::vector<std::uint32_t> fill(start.begin(), start.end() - 1);
  for (std::size_t i = 0; i < n; ++i) place[i] = fill[cell[i]]++;
  for (std::size_t i = 0; i < n; ++i) order[place[i]] = static_cast<std::uint32_t>(i);
  permute(s.position, order);
  permute(s.motion, order);
  permute(s.half, order);
  permute(s.load, order);
  permute(s.id, order);
  permute(cell, order);
  s.reference.resize(n);
  for (std::size_t i = 0; i < n; ++i) s.reference[i] = s.position[i].at;

  // Pairs, with the springs of the old list.
  std::vector<std::uint32_t> first(n + 1, 0), partner;
  std::vector<std::uint8_t> in_range;
  std::vector<VectorRow> spring;
  partner.reserve(s.partner.size() + n);
  in_range.reserve(s.partner.size() + n);
  spring.reserve(s.partner.size() + n);
  const auto take_over = [&](std::uint32_t i, std::uint32_t j) {
    const std::uint32_t a = order[i], b = order[j], low = std::min(a, b), high = std::max(a, b);
    for (std::uint32_t slot = s.first[low]; slot < s.first[low + 1]; ++slot) {
      if ((s.partner[slot] & partner_mask) != high) continue;
      in_range.push_back(s.in_range[slot]);
      const double sign = s.in_range[slot] ? (a < b ? 1.0 : -1.0) : 0.0;
      spring.push_back({sign * s.spring[slot].v});
      return;
    }
    in_range.push_back(0);
    spring.push_back({});
  };
  for (std::uint32_t i = 0; i < n; ++i) {
    const Vec3 p = s.position[i].at;
    const auto c = static_cast<int>(cell[i]);
    const int cx = c / (cells.n[1] * cells.n[2]), cy = c / cells.n[2] % cells.n[1], cz = c % cells.n[2];
    // The cells around, as runs of cells that follow each other along z; only partners after i.
    const auto visit = [&](std::size_t from, std::size_t to, std::uint32_t code) {
      const std::uint32_t last = start[to + 1];
      const Vec3 from_image = p - image_[code].v;
      for (std::uint32_t j = std::max(start[from], i + 1); j < last; ++j) {
        const Vec3 apart = from_image - s.position[j].at;
        if (dot(apart, apart) >= reach * reach) continue;
        partner.push_back(j | code << image_shift);
        take_over(i, j);
      }
    };
    const int z_low = std::max(cz - 1, 0), z_high = std::min(cz + 1, cells.n[2] - 1);
    const bool wrap_low = setup_.periodic[2] && cz == 0, wrap_high = setup_.periodic[2] && cz == cells.n[2] - 1;
    for (int dx = -1; dx <= 1; ++dx) {
      const Wrapped x = wrap_cell(cx + dx, cells.n[0]);
      if (x.image != 1 && !setup_.periodic[0]) continue;
      for (int dy = -1; dy <= 1; ++dy) {
        const Wrapped y = wrap_cell(cy + dy, cells.n[1]);
        if (y.image != 1 && !setup_.periodic[1]) continue;
        const std::size_t column = (static_cast<std::size_t>(x.cell) * cells.n[1] + y.cell) * cells.n[2];
        if (start[column + cells.n[2]] <= i + 1) continue;
        const std::uint32_t code = x.image + 3 * y.image;
        visit(column + z_low, column + z_high, code + 9);
        if (wrap_low) visit(column + cells.n[2] - 1, column + cells.n[2] - 1, code);
        if (wrap_high) visit(column, column, code + 18);
      }
    }
    first[i + 1] = static_cast<std::uint32_t>(partner.size());
  }
  s.first.swap(first);
  s.partner.swap(partner);
  s.in_range.swap(in_range);
  s.spring.swap(spring);
  list_walls(place);
  index_partners();
  max_displacement2_ = 0.0;
  s.rebuild_step = s.step;
  ++s.rebuilds;
}

/// Features near each sphere, and the springs of the contacts it had; `place` maps old to new particle indices.
void Simulation::list_walls(const std::vector<std::uint32_t>& place) {
  State& s = state_;
  const std::size_t n = s.position.size(), bodies = setup_.bodies.size(), blocks = (n + block_size - 1) / block_size;
  constexpr std::uint32_t none = ~0u;
  std::vector<std::uint32_t> old(n * bodies, none);
  for (std::size_t w = 0; w < s.wall.size(); ++w)
    old[place[s.wall[w].particle] * bodies + s.wall[w].body] = static_cast<std::uint32_t>(w);
  std::vector<Pose> now;
  for (const Body& body : setup_.bodies) now.push_back(pose(body.motion, motion_time(s.step)));
  std::vector<WallSlot> wall;
  std::vector<NearFeature> near;
  s.features.clear();
  s.feature_gap.clear();
  s.wall_first.assign(1, 0);
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t b = 0; b < bodies; ++b) {
      const Vec3 in_body =
          setup_.bodies[b].motion.point + rotate_back(now[b].rotation, s.position[i].at - now[b].point);
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
      slot.particle = static_cast<std::uint32_t>(i);
      slot.body = static_cast<std::uint32_t>(b);
      slot.feature_first = static_cast<std::uint32_t>(before);
      slot.feature_count = static_cast<std::uint32_t>(s.features.size() - before);
      wall.push_back(slot);
    }
    if ((i + 1) % block_size == 0 || i + 1 == n) s.wall_first.push_back(static_cast<std::uint32_t>(wall.size()));
  }
  s.wall_first.resize(blocks + 1, static_cast<std::uint32_t>(wall.size()));
  s.wall.swap(wall);
}

/// For several threads: the slots in which each particle is the partner, ascending.
void Simulation::index_partners() {
  if (team_.size() == 1) return;
  const State& s = state_;
  const std::size_t n = s.position.size();
  reverse_first_.assign(n + 1, 0);
  for (const std::uint32_t p : s.partner) ++reverse_first_[(p & partner_mask) + 1];
  for (std::size_t i = 0; i < n; ++i) reverse_first_[i + 1] += reverse_first_[i];
  reverse_.resize(s.partner.size());
  std::vector<std::uint32_t> fill(reverse_first_.begin(), reverse_first_.end() - 1);
  for (std::uint32_t slot = 0; slot < s.partner.size(); ++slot) reverse_[fill[s.partner[slot] & partner_mask]++] = slot;
  slot_load_.resize(s.partner.size());
  wall_load_.resize(s.wall.size());
}

}  // namespace dem
