// Rebuild of the neighbour list, its rows: wrap them into the box, sort them along the cells, make the ghosts of
// periodic faces. The lists that follow are in lists.cpp.
//
// The team shares the work chunk by chunk, each chunk writing what is its own, so that the result is the same bits for
// any number of threads. What is left to one thread is counting along the cells, a few percent.
#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <span>

#include "dem/engine/simulation.hpp"

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
  return std::max(x, low);  // a step below low, x + period may round to high, and lands below low again
}

enum class Place { inside, not_a_number, far_outside, outside };

/// Wraps a position into the box along periodic axes; again and again gives the same.
Place wrap_into(const Setup& box, Vec3 velocity, Vec3& p) {
  if (!(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z) && std::isfinite(dot(velocity, velocity))))
    return Place::not_a_number;
  const Vec3 low = box.low, high = box.high, size = high - low;
  if ((box.periodic[0] && std::abs(p.x - low.x) > 2.0 * size.x) ||
      (box.periodic[1] && std::abs(p.y - low.y) > 2.0 * size.y) ||
      (box.periodic[2] && std::abs(p.z - low.z) > 2.0 * size.z))
    return Place::far_outside;
  p = {wrapped(p.x, low.x, high.x, box.periodic[0]), wrapped(p.y, low.y, high.y, box.periodic[1]),
       wrapped(p.z, low.z, high.z, box.periodic[2])};
  const bool outside = p.x < low.x || p.x > high.x || p.y < low.y || p.y > high.y || p.z < low.z || p.z > high.z;
  return outside ? Place::outside : Place::inside;
}

/// Counting sort, stable: puts each item's place in the order of the cells where its cell was, and returns the first
/// place of each cell, one more.
std::vector<std::uint32_t> places(std::span<std::uint32_t> cell, std::size_t cells) {
  std::vector<std::uint32_t> first(cells + 2, 0);  // counted two ahead, so that handing out places shifts it by one
  for (const std::uint32_t c : cell) ++first[c + 2];
  for (std::size_t c = 2; c < first.size(); ++c) first[c] += first[c - 1];
  for (std::uint32_t& c : cell) c = first[c + 1]++;
  first.pop_back();
  return first;
}

}  // namespace

std::array<int, 3> Cells::around(Vec3 p) const {
  return {cell_along(p.x, low.x, size.x, n[0]), cell_along(p.y, low.y, size.y, n[1]),
          cell_along(p.z, low.z, size.z, n[2])};
}

std::uint32_t Cells::of(Vec3 p) const {
  const auto [x, y, z] = around(p);
  return static_cast<std::uint32_t>((static_cast<std::size_t>(x) * n[1] + y) * n[2] + z);
}

void Simulation::rebuild() {
  wrap();
  sort();
  make_ghosts();
  list_pairs();
  list_halos();
  list_walls();
  for (std::vector<std::uint32_t>* rows : {&order_, &place_, &cells_.first, &cells_.ghost_first})
    std::vector<std::uint32_t>().swap(*rows);  // assigning {} would keep their memory
  max_displacement2_ = 0.0;
  state_.rebuild_step = state_.step;
  ++state_.rebuilds;
}

/// Puts every particle back into the box along periodic axes; a particle outside ends the run.
void Simulation::wrap() {
  State& s = state_;
  const auto wrap_one = [&](std::uint32_t i) { return wrap_into(setup_, s.half[i].velocity, s.position[i].at); };
  std::atomic<bool> all_inside = true;
  each_particle([&](std::uint32_t i) {
    if (wrap_one(i) != Place::inside) all_inside = false;
  });
  for (std::uint32_t i = 0; !all_inside; ++i) {
    const Vec3 p = s.position[i].at;
    switch (wrap_one(i)) {
      case Place::inside:
        break;
      case Place::not_a_number:
        throw Fault(
            fmt::format("particle {} has a position or velocity that is not a number at {:.6g} s (a contact too stiff "
                        "for the time step, or spheres that start inside each other)",
                        s.id[i], time()));
      case Place::far_outside:
        throw Fault(
            fmt::format("particle {} crossed the box within a few steps at {:.6g} s (a contact too stiff for the time "
                        "step)",
                        s.id[i], time()));
      case Place::outside:
        throw Fault(
            fmt::format("particle {} is outside the rig, at ({:.4g}, {:.4g}, {:.4g}) m, at {:.6g} s (thrown out over "
                        "the rim, through a mesh that demcal check finds open, or pushed through a wall)",
                        s.id[i], p.x, p.y, p.z, time()));
    }
  }
}

/// Sorts the particles along the cells. Cells are at least as long as a pair's reach and cover the ghosts; no more of
/// them than a few per particle, so that a large empty box costs nothing.
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

  order_.resize(n);
  place_.resize(n);
  each_particle([&](std::uint32_t i) { place_[i] = cells_.of(s.position[i].at); });
  cells_.first = places(place_, cells_.total());
  each_particle([&](std::uint32_t i) { order_[place_[i]] = i; });

  struct Sphere {
    MotionRow motion;
    HalfRow half;
    LoadRow load;
    PositionRow position;
    std::uint32_t id;
  };
  std::vector<std::vector<Sphere>> sorted(s.chunks());
  s.reference.resize(n);
  team_.for_each(s.chunks(), [&](std::size_t c) {
    sorted[c].reserve(s.chunk_first[c + 1] - s.chunk_first[c]);
    for (std::uint32_t i = s.chunk_first[c]; i < s.chunk_first[c + 1]; ++i) {
      const std::uint32_t old = order_[i];
      sorted[c].push_back({s.motion[old], s.half[old], s.load[old], s.position[old], s.id[old]});
    }
  });
  team_.for_each(s.chunks(), [&](std::size_t c) {
    std::uint32_t i = s.chunk_first[c];
    for (const Sphere& sphere : sorted[c]) {
      s.motion[i] = sphere.motion;
      s.half[i] = sphere.half;
      s.load[i] = sphere.load;
      s.position[i] = sphere.position;
      s.reference[i] = sphere.position.at;
      s.id[i++] = sphere.id;
    }
  });
}

/// Each pair across a periodic face is met once: a particle has ghosts for the lexicographically positive shifts only.
void Simulation::make_ghosts() {
  State& s = state_;
  const std::size_t n = s.particles();
  const double reach = 2.0 * largest_radius_ + range_ + setup_.skin;
  const Vec3 size = setup_.high - setup_.low;
  old_ghosts_.swap(s.ghost);
  const auto near = [&](double x, double low, double high, int shift) {
    return shift == 0 || (shift > 0 ? x - low < reach : high - x < reach);
  };
  std::vector<Ghost> found;
  std::vector<std::uint32_t> place;
  for (int sx = 0; sx <= (setup_.periodic[0] ? 1 : 0); ++sx) {
    for (int sy = setup_.periodic[1] ? -1 : 0; sy <= (setup_.periodic[1] ? 1 : 0); ++sy) {
      for (int sz = setup_.periodic[2] ? -1 : 0; sz <= (setup_.periodic[2] ? 1 : 0); ++sz) {
        if (!(sx > 0 || (sx == 0 && (sy > 0 || (sy == 0 && sz > 0))))) continue;
        const Vec3 shift{sx * size.x, sy * size.y, sz * size.z};
        for (std::size_t i = 0; i < n; ++i) {
          const Vec3 p = s.position[i].at;
          if (near(p.x, setup_.low.x, setup_.high.x, sx) && near(p.y, setup_.low.y, setup_.high.y, sy) &&
              near(p.z, setup_.low.z, setup_.high.z, sz)) {
            found.push_back({static_cast<std::uint32_t>(i), shift});
            place.push_back(cells_.of(p + shift));
          }
        }
      }
    }
  }
  cells_.ghost_first = places(place, cells_.total());  // sorted along the cells, too
  s.ghost.resize(found.size());
  for (std::size_t g = 0; g < found.size(); ++g) s.ghost[place[g]] = found[g];
  make_room(s.position, n + s.ghost.size());
  make_room(s.motion, n + s.ghost.size());
  s.position.resize(n + s.ghost.size());
  s.motion.resize(n + s.ghost.size());
  follow_owners();
}

}  // namespace dem
