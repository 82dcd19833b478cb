#include "dem/engine/order.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace dem {
namespace {

constexpr double reach = 1.3;  // of the sum of the radii

double legendre6(double x) {
  const double x2 = x * x;
  return (((231.0 * x2 - 315.0) * x2 + 105.0) * x2 - 5.0) / 16.0;
}

double& component(Vec3& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }
double component(const Vec3& v, int axis) { return axis == 0 ? v.x : axis == 1 ? v.y : v.z; }

/// Cells at least as wide as the longest bond, and the spheres of each.
struct Grid {
  std::array<int, 3> n{1, 1, 1};
  std::vector<std::array<int, 3>> cell;      // of each sphere
  std::vector<std::uint32_t> first, member;  // of cell c: member[first[c] ... first[c + 1]]

  std::size_t number(const std::array<int, 3>& c) const {
    return (static_cast<std::size_t>(c[0]) * n[1] + c[1]) * n[2] + c[2];
  }
};

Grid make_grid(const State& state, const Box& box, double longest) {
  Grid grid;
  const std::size_t count = state.particles();
  for (int a = 0; a < 3; ++a) {
    const double cells = (component(box.high, a) - component(box.low, a)) / longest;
    grid.n[a] = static_cast<int>(std::clamp(cells, 1.0, 4.0 + std::cbrt(static_cast<double>(count))));
  }
  grid.cell.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    for (int a = 0; a < 3; ++a) {
      const double low = component(box.low, a), length = component(box.high, a) - low;
      double part = (component(state.position[i].at, a) - low) / length;
      if (box.periodic[a]) part -= std::floor(part);
      grid.cell[i][a] = std::clamp(static_cast<int>(part * grid.n[a]), 0, grid.n[a] - 1);
    }
  }
  grid.first.assign(static_cast<std::size_t>(grid.n[0]) * grid.n[1] * grid.n[2] + 1, 0);
  for (const auto& c : grid.cell) ++grid.first[grid.number(c) + 1];
  for (std::size_t c = 1; c < grid.first.size(); ++c) grid.first[c] += grid.first[c - 1];
  grid.member.resize(count);
  std::vector<std::uint32_t> at = grid.first;
  for (std::size_t i = 0; i < count; ++i) grid.member[at[grid.number(grid.cell[i])]++] = static_cast<std::uint32_t>(i);
  return grid;
}

/// Calls visit(k) for each cell along an axis that touches cell c, once.
template <class Visit>
void around(int c, int n, bool periodic, Visit&& visit) {
  for (int k = c - 1; k <= c + 1; ++k) {
    if (periodic && n >= 3)
      visit((k + n) % n);
    else if (k >= 0 && k < n)
      visit(k);  // of two cells each is the other's neighbour on both sides
  }
}

struct Bond {
  std::uint32_t to;
  Vec3 way;  // unit
};

/// Bonds of sphere i: bonds[first[i] ... first[i + 1]].
struct Bonds {
  std::vector<std::uint32_t> first{0};
  std::vector<Bond> bonds;
};

Bonds find_bonds(const State& state, const Box& box) {
  double largest = 0.0;
  for (std::size_t i = 0; i < state.particles(); ++i) largest = std::max(largest, state.position[i].radius);
  const Grid grid = make_grid(state, box, reach * 2.0 * largest);
  Bonds found;
  for (std::uint32_t i = 0; i < state.particles(); ++i) {
    const auto& c = grid.cell[i];
    const auto bond_to = [&](std::uint32_t j) {
      if (j == i) return;
      Vec3 way = state.position[j].at - state.position[i].at;
      for (int a = 0; a < 3; ++a)
        if (box.periodic[a])
          component(way, a) = std::remainder(component(way, a), component(box.high, a) - component(box.low, a));
      const double limit = reach * (state.position[i].radius + state.position[j].radius), square = dot(way, way);
      if (square < limit * limit && square > 0.0) found.bonds.push_back({j, (1.0 / std::sqrt(square)) * way});
    };
    around(c[0], grid.n[0], box.periodic[0], [&](int x) {
      around(c[1], grid.n[1], box.periodic[1], [&](int y) {
        around(c[2], grid.n[2], box.periodic[2], [&](int z) {
          const std::size_t cell = grid.number({x, y, z});
          for (std::uint32_t k = grid.first[cell]; k < grid.first[cell + 1]; ++k) bond_to(grid.member[k]);
        });
      });
    });
    found.first.push_back(static_cast<std::uint32_t>(found.bonds.size()));
  }
  return found;
}

}  // namespace

double bond_order(const State& state, const Box& box) {
  const Bonds all = find_bonds(state, box);
  const auto product = [&](std::uint32_t i, std::uint32_t j) {
    double sum = 0.0;
    for (std::uint32_t a = all.first[i]; a < all.first[i + 1]; ++a)
      for (std::uint32_t b = all.first[j]; b < all.first[j + 1]; ++b)
        sum += legendre6(dot(all.bonds[a].way, all.bonds[b].way));
    return sum;
  };
  std::vector<double> own(state.particles());
  for (std::uint32_t i = 0; i < state.particles(); ++i) own[i] = product(i, i);
  double sum = 0.0, pairs = 0.0;
  for (std::uint32_t i = 0; i < state.particles(); ++i) {
    for (std::uint32_t a = all.first[i]; a < all.first[i + 1]; ++a) {
      const std::uint32_t j = all.bonds[a].to;
      if (j <= i || !(own[i] > 0.0 && own[j] > 0.0)) continue;
      sum += product(i, j) / std::sqrt(own[i] * own[j]);
      pairs += 1.0;
    }
  }
  return pairs > 0.0 ? sum / pairs : 0.0;
}

double ordering_rise(std::span<const double> time, std::span<const double> bond_order) {
  const auto n = static_cast<double>(time.size());
  if (time.size() < 5) return 0.0;
  double t = 0.0, b = 0.0, tt = 0.0, tb = 0.0, rest = 0.0;
  for (std::size_t k = 0; k < time.size(); ++k) {
    t += time[k] / n;
    b += bond_order[k] / n;
  }
  for (std::size_t k = 0; k < time.size(); ++k) {
    tt += (time[k] - t) * (time[k] - t);
    tb += (time[k] - t) * (bond_order[k] - b);
  }
  const double slope = tb / tt, span = time.back() - time.front();
  double neighbours = 0.0, before = 0.0;  // looks hang together: their correlation makes the line's error larger
  for (std::size_t k = 0; k < time.size(); ++k) {
    const double off = bond_order[k] - b - slope * (time[k] - t);
    rest += off * off;
    if (k > 0) neighbours += before * off;
    before = off;
  }
  const double together = rest > 0.0 ? std::clamp(neighbours / rest, 0.0, 0.9) : 0.0;
  const double error = std::sqrt(rest / (n - 2.0) / tt * (1.0 + together) / (1.0 - together));
  return slope * span >= least_rise && slope >= 3.5 * error ? slope * span : 0.0;
}

}  // namespace dem
