#include "uq/infer/quadrature.hpp"

#include <array>
#include <cassert>
#include <cmath>
#include <numeric>
#include <vector>

#include "uq/infer/diagnostics.hpp"
#include "uq/infer/parallel.hpp"

namespace uq {
namespace {

/// Gauss-Legendre, three points on [-1/2, 1/2]: degree 5.
const std::array<double, 3> nodes = {-0.5 * std::sqrt(0.6), 0.0, 0.5 * std::sqrt(0.6)};
constexpr std::array<double, 3> node_weights = {5.0 / 18.0, 8.0 / 18.0, 5.0 / 18.0};

struct Cell {
  std::array<double, 2> centre{}, width{};
  std::array<double, 9> log_density{};
  std::vector<int> guides = {};  // indices of those that lie inside
  bool split_before = false;
  double error = 0.0, error_top = 0.0;  // |parent's integral - its parts'| in units of exp(error_top)
  double highest() const {
    double top = nowhere;
    for (const double value : log_density) top = std::max(top, value);
    return top;
  }
};

struct Grid {
  const Target& target;
  int dimension;
  std::size_t points;  // per cell: 3 or 9
  Eigen::VectorXd point(const Cell& cell, std::size_t i) const {
    Eigen::VectorXd x(dimension);
    x[0] = cell.centre[0] + cell.width[0] * nodes[i % 3];
    if (dimension == 2) x[1] = cell.centre[1] + cell.width[1] * nodes[i / 3];
    return x;
  }
  double weight(const Cell& cell, std::size_t i) const {
    double weight = cell.width[0] * node_weights[i % 3];
    if (dimension == 2) weight *= cell.width[1] * node_weights[i / 3];
    return weight;
  }
};

void evaluate_cells(const Grid& grid, std::vector<Cell>& cells, std::size_t first, int threads) {
  constexpr std::size_t batch = 64;
  const std::size_t count = cells.size() - first;
  const int batches = static_cast<int>((count + batch - 1) / batch);
  for_each_index(batches, threads, [&](int b) {
    const std::size_t from = first + static_cast<std::size_t>(b) * batch, to = std::min(cells.size(), from + batch);
    Eigen::MatrixXd points(static_cast<Eigen::Index>((to - from) * grid.points), grid.dimension);
    for (std::size_t c = from; c < to; ++c)
      for (std::size_t i = 0; i < grid.points; ++i)
        points.row(static_cast<Eigen::Index>((c - from) * grid.points + i)) = grid.point(cells[c], i).transpose();
    const Eigen::VectorXd values = evaluate(grid.target, points);
    for (std::size_t c = from; c < to; ++c)
      for (std::size_t i = 0; i < grid.points; ++i)
        cells[c].log_density[i] = values[static_cast<Eigen::Index>((c - from) * grid.points + i)];
  });
}

/// The guides among `candidates` that lie in the cell.
std::vector<int> guides_inside(const Cell& cell, const Eigen::MatrixXd& guides, const std::vector<int>& candidates) {
  std::vector<int> inside;
  for (const int g : candidates) {
    bool in = true;
    for (Eigen::Index k = 0; k < guides.cols(); ++k)
      in = in && std::abs(guides(g, k) - cell.centre[k]) <= 0.5 * cell.width[k];
    if (in) inside.push_back(g);
  }
  return inside;
}

/// Integral of the density over the cell, in units of exp(top).
double integral(const Grid& grid, const Cell& cell, double top) {
  double sum = 0.0;
  for (std::size_t i = 0; i < grid.points; ++i) sum += grid.weight(cell, i) * std::exp(cell.log_density[i] - top);
  return sum;
}

double highest(const std::vector<Cell>& cells) {
  double top = nowhere;
  for (const Cell& cell : cells) top = std::max(top, cell.highest());
  return top;
}

/// Equal cells over the box, not evaluated yet.
std::vector<Cell> first_cells(const Grid& grid, const QuadratureOptions& options) {
  std::vector<int> everyone(static_cast<std::size_t>(options.guides.rows()));
  std::iota(everyone.begin(), everyone.end(), 0);
  std::vector<Cell> cells;
  const int per_side = grid.dimension == 1 ? 8 * options.first_cells : options.first_cells;
  for (int i = 0; i < per_side; ++i)
    for (int j = 0; j < (grid.dimension == 2 ? per_side : 1); ++j) {
      Cell cell;
      const std::array<int, 2> index = {i, j};
      for (int k = 0; k < grid.dimension; ++k) {
        cell.width[k] = (grid.target.upper[k] - grid.target.lower[k]) / per_side;
        cell.centre[k] = grid.target.lower[k] + (index[k] + 0.5) * cell.width[k];
      }
      cell.guides = guides_inside(cell, options.guides, everyone);
      cells.push_back(cell);
    }
  return cells;
}

struct Sorted {
  std::vector<Cell> settled, open;
};

/// Cells whose integral is settled, and others. A guided cell whose points span a wide range of densities has not seen
/// what the guide saw. Another is settled when nothing is in it, or when the last split no longer changed it.
Sorted sort_cells(const Grid& grid, std::vector<Cell> cells, double tolerance) {
  const double top = highest(cells);
  double total = 0.0;
  for (const Cell& cell : cells) total += integral(grid, cell, top);
  Sorted sorted;
  for (Cell& cell : cells) {
    double lowest = -nowhere;
    for (std::size_t i = 0; i < grid.points; ++i) lowest = std::min(lowest, cell.log_density[i]);
    const bool blind = !cell.guides.empty() && !(cell.highest() - lowest < 20.0);
    const bool counts = integral(grid, cell, top) > 1e-9 * total;
    const bool changing = !cell.split_before || cell.error * std::exp(cell.error_top - top) > tolerance * total;
    (blind || (counts && changing) ? sorted.open : sorted.settled).push_back(std::move(cell));
  }
  return sorted;
}

/// The settled cells, then the halves of the others (quarters in two dimensions), evaluated, each with what its
/// parent's split has changed.
std::vector<Cell> halve_open(const Grid& grid, Sorted sorted, const QuadratureOptions& options) {
  std::vector<Cell> cells = std::move(sorted.settled);
  const std::size_t first = cells.size(), parts = std::size_t{1} << grid.dimension;
  for (const Cell& parent : sorted.open)
    for (std::size_t part = 0; part < parts; ++part) {
      Cell cell = parent;
      for (int k = 0; k < grid.dimension; ++k) {
        cell.width[k] = 0.5 * parent.width[k];
        cell.centre[k] = parent.centre[k] + ((part >> k & 1) != 0 ? 0.25 : -0.25) * parent.width[k];
      }
      cell.guides = guides_inside(cell, options.guides, parent.guides);
      cells.push_back(std::move(cell));
    }
  evaluate_cells(grid, cells, first, options.threads);
  const double top = std::max(highest(cells), highest(sorted.open));
  for (std::size_t p = 0; p < sorted.open.size(); ++p) {
    double sum = 0.0;
    for (std::size_t part = 0; part < parts; ++part) sum += integral(grid, cells[first + p * parts + part], top);
    for (std::size_t part = 0; part < parts; ++part) {
      Cell& cell = cells[first + p * parts + part];
      cell.split_before = true;
      cell.error = std::abs(sum - integral(grid, sorted.open[p], top));
      cell.error_top = top;
    }
  }
  return cells;
}

/// Evidence and moments; sums relative to the largest density, in the order of the cells.
void add_moments(const Grid& grid, const std::vector<Cell>& cells, Quadrature& result) {
  const int dimension = grid.dimension;
  const double top = highest(cells);
  double total = 0.0;
  Eigen::VectorXd first = Eigen::VectorXd::Zero(dimension);
  Eigen::MatrixXd second = Eigen::MatrixXd::Zero(dimension, dimension);
  for (const Cell& cell : cells)
    for (std::size_t i = 0; i < grid.points; ++i) {
      const double mass = grid.weight(cell, i) * std::exp(cell.log_density[i] - top);
      const Eigen::VectorXd x = grid.point(cell, i);
      total += mass;
      first += mass * x;
      second += mass * x * x.transpose();
    }
  result.mean = first / total;
  const Eigen::MatrixXd covariance = second / total - result.mean * result.mean.transpose();
  result.sd = covariance.diagonal().cwiseMax(0.0).cwiseSqrt();
  if (dimension == 2) result.correlation = covariance(0, 1) / (result.sd[0] * result.sd[1]);
  result.log_evidence = top + std::log(total);
  result.fourth = Eigen::VectorXd::Zero(dimension);
  for (const Cell& cell : cells)
    for (std::size_t i = 0; i < grid.points; ++i) {
      const double share = grid.weight(cell, i) * std::exp(cell.log_density[i] - top) / total;
      result.fourth += share * (grid.point(cell, i) - result.mean).array().pow(4).matrix();
    }
}

}  // namespace

Quadrature integrate(const Target& target, const QuadratureOptions& options) {
  assert(target.dimension == 1 || target.dimension == 2);
  assert(target.lower.allFinite() && target.upper.allFinite());
  const int dimension = target.dimension;
  const Grid grid{.target = target, .dimension = dimension, .points = dimension == 1 ? std::size_t{3} : std::size_t{9}};
  std::vector<Cell> cells = first_cells(grid, options);
  evaluate_cells(grid, cells, 0, options.threads);
  Quadrature result;
  result.evaluations = static_cast<std::int64_t>(cells.size() * grid.points);
  for (int level = 0;; ++level) {
    Sorted sorted = sort_cells(grid, std::move(cells), options.tolerance);
    const auto cost = static_cast<std::int64_t>((sorted.open.size() << dimension) * grid.points);
    result.resolved = sorted.open.empty();
    if (result.resolved || level == options.levels || result.evaluations + cost > options.evaluations_max) {
      cells = std::move(sorted.settled);
      cells.insert(cells.end(), sorted.open.begin(), sorted.open.end());
      break;
    }
    cells = halve_open(grid, std::move(sorted), options);
    result.evaluations += cost;
  }
  add_moments(grid, cells, result);
  return result;
}

bool agree(const Draws& draws, const Quadrature& exact) {
  constexpr double errors = 5.0;
  for (int k = 0; k < draws.dimension(); ++k) {
    const Eigen::MatrixXd values = draws.coordinate(k), squares = (values.array() - exact.mean[k]).square();
    const double variance = exact.sd[k] * exact.sd[k];
    if (std::abs(values.mean() - exact.mean[k]) > errors * mean_mcse(values) + 0.01 * exact.sd[k]) return false;
    const double error = std::sqrt(std::max(exact.fourth[k] - variance * variance, 0.0) / mean_ess(values));
    if (std::abs(squares.mean() - variance) > errors * std::max(mean_mcse(squares), error) + 0.02 * variance)
      return false;
  }
  return true;
}

}  // namespace uq
