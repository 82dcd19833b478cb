#include "dem/forecast/room.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <queue>

#include "dem/rig/packing.hpp"

namespace dem {
namespace {

constexpr double most_cells = 150000.0;

std::array<double, 3> parts(Vec3 a) { return {a.x, a.y, a.z}; }

/// Marks the links along axis a that a triangle cuts: it meets the line through the centres of a row of cells. A line
/// through an edge meets both triangles there. What lies outside the box by less than `reach` [m], a sphere's radius,
/// still keeps the centres of spheres in.
void cut_links(Room& room, const std::array<Vec3, 3>& corner, std::size_t a, double reach) {
  const std::size_t b = (a + 1) % 3, c = (a + 2) % 3;
  const auto low = parts(room.low), cell = parts(room.cell);
  std::array<std::array<double, 3>, 3> p;
  for (std::size_t k = 0; k < 3; ++k) p[k] = parts(corner[k]);
  // Coordinates are in units of cells, with centres of rows at whole numbers.
  const auto unit = [&](std::size_t k, std::size_t axis) { return (p[k][axis] - low[axis]) / cell[axis] - 0.5; };
  double x[3], y[3], z[3];
  for (std::size_t k = 0; k < 3; ++k) x[k] = unit(k, b), y[k] = unit(k, c), z[k] = unit(k, a);
  const double area = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
  if (!(std::abs(area) > 1e-14)) return;  // along the lines
  const auto range = [](const double* v, int n) {
    const auto [least, most] = std::minmax({v[0], v[1], v[2]});
    return std::pair{std::max(0, static_cast<int>(std::ceil(std::max(least, -1.0) - 1e-9))),
                     std::min(n - 1, static_cast<int>(std::floor(std::min(most, n + 1.0) + 1e-9)))};
  };
  const auto [j_first, j_last] = range(x, room.n[b]);
  const auto [k_first, k_last] = range(y, room.n[c]);
  for (int j = j_first; j <= j_last; ++j) {
    for (int k = k_first; k <= k_last; ++k) {
      double weight[3], along = 0.0;
      bool meets = true;
      for (int v = 0; v < 3; ++v) {
        const int s = (v + 1) % 3, t = (v + 2) % 3;
        weight[v] = ((x[s] - j) * (y[t] - k) - (x[t] - j) * (y[s] - k)) / area;
        meets = meets && weight[v] >= -1e-9;
        along += weight[v] * z[v];
      }
      const double first = -0.5, last = room.n[a] - 0.5, slack = room.periodic[a] ? 1e-9 : reach / cell[a];
      if (!meets || !(along > first - slack && along < last + slack)) continue;
      along = std::clamp(along, first, last);
      const auto mark = [&](int i, unsigned side) {
        if (room.periodic[a]) i = (i + room.n[a]) % room.n[a];
        if (i < 0 || i >= room.n[a]) return;
        std::array<int, 3> at{};
        at[a] = i, at[b] = j, at[c] = k;
        room.walled[(static_cast<std::size_t>(at[0]) * room.n[1] + at[1]) * room.n[2] + at[2]] |=
            static_cast<std::uint8_t>(1u << (2 * a + side));
      };
      // A surface at a centre is on both sides of it.
      for (const double at : {along - 1e-9, along + 1e-9}) {
        const int before = static_cast<int>(std::floor(at));
        mark(before, 1);
        mark(before + 1, 0);
      }
    }
  }
}

void find_narrow(Room& room, const BuiltRig& rig, double reach) {
  std::vector<Surface> surfaces;
  for (const Body& b : rig.bodies) surfaces.push_back(make_surface(b.mesh, reach));
  for (std::size_t k = 0; k < room.total(); ++k)
    room.narrow[k] = depth_in_bodies(rig.bodies, surfaces, room.centre(k), reach) > 0.0;
}

/// A cell that waits to be filled, lowest first; of equals the one found first.
struct Waiting {
  double height;
  std::size_t order, cell;
  int steps;  ///< since the last wide cell; -1 where the flood starts, whatever that cell is
  bool operator<(const Waiting& other) const {
    return height > other.height || (height == other.height && order > other.order);
  }
};

class Flood {
 public:
  Flood(const Room& room, std::size_t start) : room_(room), seen_(room.total(), 0) { add(start, -1); }

  bool empty() const { return waiting_.empty(); }
  Waiting next() {
    const Waiting w = waiting_.top();
    waiting_.pop();
    const bool wide = !room_.narrow[w.cell];
    open_ = false;
    for (int side = 0; side < 6; ++side) {
      if (room_.walled[w.cell] >> side & 1u) continue;
      const std::size_t other = room_.beyond(w.cell, side);
      if (other == room_.total())
        open_ = open_ || wide;
      else if (room_.narrow[other] && w.steps < room_.rim)
        add(other, std::max(w.steps, 0) + 1);
      else if (!room_.narrow[other] && (wide || w.steps < 0))
        add(other, 0);
    }
    return w;
  }
  /// Whether a face of the box is open beside the last cell.
  bool open() const { return open_; }

 private:
  void add(std::size_t cell, int steps) {
    if (seen_[cell]) return;
    seen_[cell] = 1;
    waiting_.push({room_.height(cell), order_++, cell, steps});
  }
  const Room& room_;
  std::vector<std::uint8_t> seen_;
  std::priority_queue<Waiting> waiting_;
  std::size_t order_ = 0;
  bool open_ = false;
};

}  // namespace

std::vector<std::uint8_t> reached_from(const Room& room, std::size_t start) {
  std::vector<std::uint8_t> reached(room.total(), 0);
  for (Flood flood(room, start); !flood.empty();) reached[flood.next().cell] = 1;
  return reached;
}

std::array<int, 3> Room::index(std::size_t k) const {
  const auto s = static_cast<int>(k);
  return {s / (n[1] * n[2]), s / n[2] % n[1], s % n[2]};
}

Vec3 Room::centre(std::size_t k) const {
  const auto i = index(k);
  return low + Vec3{(i[0] + 0.5) * cell.x, (i[1] + 0.5) * cell.y, (i[2] + 0.5) * cell.z};
}

std::size_t Room::at(Vec3 point) const {
  const auto p = parts(point - low), size = parts(cell);
  std::size_t k = 0;
  for (std::size_t a = 0; a < 3; ++a) {
    double i = std::floor(p[a] / size[a]);
    if (periodic[a]) i -= n[a] * std::floor(i / n[a]);
    if (!(i >= 0.0 && i < n[a])) return total();
    k = k * static_cast<std::size_t>(n[a]) + static_cast<std::size_t>(i);
  }
  return k;
}

std::size_t Room::beyond(std::size_t k, int side) const {
  std::array<int, 3> i = index(k);
  const auto a = static_cast<std::size_t>(side / 2);
  i[a] += side % 2 == 1 ? 1 : -1;
  if (periodic[a]) i[a] = (i[a] + n[a]) % n[a];
  if (i[a] < 0 || i[a] >= n[a]) return total();
  return (static_cast<std::size_t>(i[0]) * n[1] + i[1]) * n[2] + i[2];
}

Room make_room(const BuiltRig& rig, double smallest) {
  Room room;
  const Vec3 size = rig.high - rig.low;
  room.low = rig.low;
  room.periodic = rig.periodic;
  room.down = rig.down;
  const double edge = std::max(0.4 * smallest, std::cbrt(size.x * size.y * size.z / most_cells));
  const auto length = parts(size);
  for (std::size_t a = 0; a < 3; ++a)
    room.n[a] = std::clamp(static_cast<int>(std::ceil(length[a] / edge)), 1, static_cast<int>(most_cells));
  room.cell = {size.x / room.n[0], size.y / room.n[1], size.z / room.n[2]};
  const double reach = 0.45 * smallest;
  room.rim = static_cast<int>(std::ceil(reach / std::min({room.cell.x, room.cell.y, room.cell.z})));
  const std::size_t total = static_cast<std::size_t>(room.n[0]) * room.n[1] * room.n[2];
  room.walled.assign(total, 0);
  room.narrow.assign(total, 0);
  for (const Body& b : rig.bodies) {
    const Pose start = pose(b.motion, 0.0);
    std::vector<Vec3> at;
    for (const Vec3 v : b.mesh.vertices) at.push_back(start.point + rotate(start.rotation, v - b.motion.point));
    for (const auto& t : b.mesh.triangles)
      for (std::size_t a = 0; a < 3; ++a) cut_links(room, {at[t[0]], at[t[1]], at[t[2]]}, a, reach);
  }
  find_narrow(room, rig, reach);
  return room;
}

namespace {

/// Where powder from a cell first stands: the lowest wide cell that it runs down to, since it does not flow on from the
/// narrow ones under it. `open`: the wide cell from which it leaves the box before.
struct Bottom {
  std::size_t cell;
  std::optional<std::size_t> open;
};

Bottom bottom_under(const Room& room, std::size_t start) {
  std::optional<std::size_t> lowest;
  for (Flood flood(room, start); !flood.empty();) {
    const Waiting w = flood.next();
    if (room.narrow[w.cell]) continue;
    if (lowest && w.height > room.height(*lowest) + 1e-9 * room.cell.z) break;
    if (!lowest || w.height < room.height(*lowest)) lowest = w.cell;
    if (flood.open()) return {w.cell, w.cell};
  }
  return {lowest.value_or(start), {}};
}

/// The height of a layer of cells.
double layer_of(const Room& room) {
  return std::abs(room.down.x) * room.cell.x + std::abs(room.down.y) * room.cell.y +
         std::abs(room.down.z) * room.cell.z;
}

bool overlap(const std::vector<std::uint8_t>& a, const std::vector<std::uint8_t>& b) {
  for (std::size_t k = 0; k < a.size(); ++k)
    if (a[k] != 0 && b[k] != 0) return true;
  return false;
}

/// The cells that fill up from a bottom before the powder runs over into a place lower than its surface.
std::vector<std::uint8_t> chamber_of(const Room& room, std::size_t bottom) {
  std::vector<std::uint8_t> chamber(room.total(), 0);
  const double layer = layer_of(room);
  double top = room.height(bottom);
  for (Flood flood(room, bottom); !flood.empty();) {
    const Waiting w = flood.next();
    if (!room.narrow[w.cell] && w.height < top - 0.5 * layer) break;
    top = std::max(top, w.height);
    chamber[w.cell] = 1;
    if (flood.open()) break;
  }
  return chamber;
}

}  // namespace

Poured pour(const Room& room, std::size_t start, double volume) {
  Poured bed;
  bed.wet.assign(room.total(), 0);
  const Bottom stands = bottom_under(room, start);
  if (stands.open) {
    bed.leaves = true;
    bed.leaves_at = room.centre(*stands.open);
    return bed;
  }
  const std::size_t bottom = stands.cell;
  // Up from there: `wet` as far as the powder goes, and on until the vessel runs over.
  const double cell = room.volume(), layer = layer_of(room);
  double filled = 0.0, top = room.height(bottom), level = top, in_layer = 0.0, of_layer = 0.0;
  for (Flood flood(room, bottom); !flood.empty();) {
    const Waiting w = flood.next();
    const bool rises = w.height > top + 1e-6 * layer, at_top = rises || w.height > top - 0.5 * layer;
    top = std::max(top, w.height);
    if (filled < volume) {
      if (rises) in_layer = of_layer = 0.0;
      if (at_top) in_layer += cell;
      if (at_top) of_layer += cell;
      level = top;
      bed.wet[w.cell] = 1;
      bed.leaves = flood.open();
      bed.leaves_at = room.centre(w.cell);
    } else if (top < level + 0.5 * layer && std::abs(w.height - level) < 0.5 * layer) {
      of_layer += cell;  // not of another chamber, which fills once this one has run over
    }
    filled += cell;
    // Powder that has run over a rim is below the top: it does not count as held, unless it fills up to the top again.
    if (at_top) bed.held = filled;
    if (flood.open()) break;
  }
  bed.surface = level - 0.5 * layer + layer * (of_layer > 0.0 ? in_layer / of_layer : 0.0);
  return bed;
}

Poured pour(const Room& room, const std::vector<std::size_t>& starts, double volume) {
  Poured whole = pour(room, starts.front(), volume);
  if (whole.leaves) return whole;
  struct Pool {
    std::size_t bottom;
    double volume;
    std::vector<std::uint8_t> chamber;
  };
  std::vector<Pool> pools;
  for (const std::size_t start : starts) {
    const std::size_t bottom = bottom_under(room, start).cell;
    auto pool = std::find_if(pools.begin(), pools.end(), [&](const Pool& one) { return one.chamber[bottom] != 0; });
    if (pool == pools.end()) pool = pools.insert(pool, Pool{bottom, 0.0, chamber_of(room, bottom)});
    pool->volume += volume / static_cast<double>(starts.size());
  }
  if (pools.size() == 1) return whole;
  // Pools that run over into another one's chamber are one with it.
  std::vector<Poured> beds;
  for (std::size_t k = 0; k < pools.size();) {
    beds.resize(k);
    beds.push_back(pour(room, pools[k].bottom, pools[k].volume));
    const auto met = std::find_if(pools.begin(), pools.end(), [&](const Pool& other) {
      return &other != &pools[k] && overlap(beds[k].wet, other.chamber);
    });
    if (met == pools.end()) {
      ++k;
      continue;
    }
    const std::size_t other = static_cast<std::size_t>(met - pools.begin()), kept = std::min(k, other);
    pools[kept].volume += pools[std::max(k, other)].volume;
    pools.erase(pools.begin() + static_cast<std::ptrdiff_t>(std::max(k, other)));
    k = kept;  // and from there on again
  }
  whole.wet.assign(room.total(), 0);
  whole.surface = 0.0;
  for (std::size_t k = 0; k < pools.size(); ++k) {
    for (std::size_t cell = 0; cell < room.total(); ++cell) whole.wet[cell] |= beds[k].wet[cell];
    whole.surface += pools[k].volume / volume * beds[k].surface;
  }
  return whole;
}

bool falls_out(const Room& room, Vec3 point) {
  const auto along = parts(room.down);
  std::size_t a = 0;
  for (std::size_t k = 1; k < 3; ++k)
    if (std::abs(along[k]) > std::abs(along[a])) a = k;
  const int side = static_cast<int>(2 * a) + (along[a] > 0.0 ? 1 : 0);
  std::size_t k = room.at(point);
  for (int step = 0; k != room.total() && step <= room.n[a]; ++step) {
    if (room.walled[k] >> side & 1u) return false;
    k = room.beyond(k, side);
  }
  return k == room.total();
}

}  // namespace dem
