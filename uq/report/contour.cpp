// Contours of a density by marching squares. A crossing lies on an edge between two neighbouring nodes; each square
// joins its crossings in pairs; as two squares meet at every inner edge and the rim is below any level, the pairs chain
// into closed loops.
#include <array>
#include <map>
#include <utility>

#include "uq/report/density.hpp"

namespace uq {
namespace {

/// An edge by its lower node and its direction: 0 along x, 1 along y.
struct Edge {
  std::size_t i = 0, j = 0;
  int direction = 0;
  auto operator<=>(const Edge&) const = default;
};

/// The density with a rim of zeros at the box.
struct Nodes {
  std::vector<double> x, y, value;
  double at(std::size_t i, std::size_t j) const { return value[i * y.size() + j]; }
};

Nodes with_rim(const DensityGrid& grid, const PlotBox& box) {
  Nodes nodes;
  nodes.x.push_back(box.x_low);
  nodes.x.insert(nodes.x.end(), grid.x.begin(), grid.x.end());
  nodes.x.push_back(box.x_high);
  nodes.y.push_back(box.y_low);
  nodes.y.insert(nodes.y.end(), grid.y.begin(), grid.y.end());
  nodes.y.push_back(box.y_high);
  nodes.value.assign(nodes.x.size() * nodes.y.size(), 0.0);
  for (std::size_t i = 0; i < grid.x.size(); ++i) {
    for (std::size_t j = 0; j < grid.y.size(); ++j) {
      nodes.value[(i + 1) * nodes.y.size() + j + 1] = grid.density[i * grid.y.size() + j];
    }
  }
  return nodes;
}

/// Where the level lies on an edge. On an edge to the rim the crossing is put on the rim: the density does not fall
/// there, it is cut off.
std::pair<double, double> crossing(const Nodes& nodes, const Edge& edge, double level) {
  const std::size_t i2 = edge.i + (edge.direction == 0 ? 1 : 0), j2 = edge.j + (edge.direction == 1 ? 1 : 0);
  const auto outside = [&](std::size_t i, std::size_t j) {
    return i == 0 || j == 0 || i + 1 == nodes.x.size() || j + 1 == nodes.y.size();
  };
  double share = (level - nodes.at(edge.i, edge.j)) / (nodes.at(i2, j2) - nodes.at(edge.i, edge.j));
  if (outside(edge.i, edge.j)) share = 0.0;
  if (outside(i2, j2)) share = 1.0;
  return {nodes.x[edge.i] + share * (nodes.x[i2] - nodes.x[edge.i]),
          nodes.y[edge.j] + share * (nodes.y[j2] - nodes.y[edge.j])};
}

}  // namespace

std::vector<Loop> contour(const DensityGrid& grid, const PlotBox& box, double level) {
  if (grid.density.empty() || !(level > 0.0)) return {};
  const Nodes nodes = with_rim(grid, box);

  // Each square joins the crossings on its sides, taken round: bottom, right, top, left. Of a saddle's two readings the
  // one that keeps its high corners apart is taken.
  std::map<Edge, std::array<Edge, 2>> joined;
  std::map<Edge, int> count;
  const auto join = [&](const Edge& a, const Edge& b) {
    joined[a][count[a]++] = b;
    joined[b][count[b]++] = a;
  };
  for (std::size_t i = 0; i + 1 < nodes.x.size(); ++i) {
    for (std::size_t j = 0; j + 1 < nodes.y.size(); ++j) {
      const std::array<bool, 4> high = {nodes.at(i, j) >= level, nodes.at(i + 1, j) >= level,
                                        nodes.at(i + 1, j + 1) >= level, nodes.at(i, j + 1) >= level};
      const std::array<Edge, 4> side = {Edge{i, j, 0}, Edge{i + 1, j, 1}, Edge{i, j + 1, 0}, Edge{i, j, 1}};
      const bool saddle = high[0] == high[2] && high[1] == high[3] && high[0] != high[1];
      if (saddle) {
        // Corner k lies between side k - 1 and side k.
        const std::size_t corner = high[0] ? 0 : 1;
        join(side[(corner + 3) % 4], side[corner]);
        join(side[(corner + 1) % 4], side[corner + 2]);
        continue;
      }
      std::vector<Edge> crossed;
      for (std::size_t k = 0; k < 4; ++k) {
        if (high[k] != high[(k + 1) % 4]) crossed.push_back(side[k]);
      }
      if (crossed.size() == 2) join(crossed[0], crossed[1]);
    }
  }

  std::vector<Loop> loops;
  while (!joined.empty()) {
    Loop loop;
    Edge edge = joined.begin()->first, previous = edge;
    while (joined.contains(edge)) {
      const auto [x, y] = crossing(nodes, edge, level);
      loop.x.push_back(x);
      loop.y.push_back(y);
      const std::array<Edge, 2> ends = joined[edge];
      joined.erase(edge);
      const Edge next = ends[0] == previous ? ends[1] : ends[0];
      previous = edge;
      edge = next;
    }
    loops.push_back(std::move(loop));
  }
  return loops;
}

}  // namespace uq
