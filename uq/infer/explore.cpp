#include "uq/infer/explore.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "uq/infer/climb.hpp"
#include "uq/infer/factor.hpp"
#include "uq/infer/parallel.hpp"

namespace uq {
namespace {

constexpr int trees = 5, leaf = 4;

/// Log densities of all rows, in blocks over the threads.
Eigen::VectorXd evaluate_all(const Target& target, const Eigen::MatrixXd& points, int threads) {
  constexpr Eigen::Index block = 512;
  Eigen::VectorXd values(points.rows());
  const auto blocks = static_cast<int>((points.rows() + block - 1) / block);
  for_each_index(blocks, threads, [&](int b) {
    const Eigen::Index from = b * block, count = std::min(block, points.rows() - from);
    values.segment(from, count) = evaluate(target, points.middleRows(from, count));
  });
  return values;
}

/// Counts, for each leaf of a tree over `order`, the best scout in it.
void vote(std::vector<Eigen::Index>& order, const std::pair<std::size_t, std::size_t>& part,
          const std::vector<Eigen::VectorXd>& heights, const Eigen::VectorXd& value, std::vector<int>& votes) {
  const auto [from, to] = part;
  if (to - from <= leaf) {
    const auto best = std::max_element(order.begin() + static_cast<std::ptrdiff_t>(from),
                                       order.begin() + static_cast<std::ptrdiff_t>(to),
                                       [&](Eigen::Index a, Eigen::Index b) { return value[a] < value[b]; });
    ++votes[*best];
    return;
  }
  // Along the direction in which this part is widest.
  std::size_t widest = 0;
  double width = -1.0;
  for (std::size_t k = 0; k < heights.size(); ++k) {
    double low = heights[k][order[from]], high = low;
    for (std::size_t i = from; i < to; ++i) {
      low = std::min(low, heights[k][order[i]]);
      high = std::max(high, heights[k][order[i]]);
    }
    if (high - low > width) {
      width = high - low;
      widest = k;
    }
  }
  const std::size_t middle = from + (to - from) / 2;
  std::nth_element(order.begin() + static_cast<std::ptrdiff_t>(from),
                   order.begin() + static_cast<std::ptrdiff_t>(middle), order.begin() + static_cast<std::ptrdiff_t>(to),
                   [&](Eigen::Index a, Eigen::Index b) {
                     return heights[widest][a] != heights[widest][b] ? heights[widest][a] < heights[widest][b] : a < b;
                   });
  vote(order, {from, middle}, heights, value, votes);
  vote(order, {middle, to}, heights, value, votes);
}

/// A random rotation: the orthogonal factor of a matrix of normal numbers.
Eigen::MatrixXd rotation(Eigen::Index dimension, data::RandomStream& random) {
  Eigen::MatrixXd normal(dimension, dimension);
  for (double& value : normal.reshaped()) value = random.normal();
  return Eigen::HouseholderQR<Eigen::MatrixXd>(normal).householderQ();
}

/// Scouts that are the best of their leaf in every tree, the highest first.
std::vector<Eigen::Index> peaks(const Scouts& scouts) {
  const Eigen::Index n = scouts.x.rows(), d = scouts.x.cols();
  const Eigen::VectorXd width = (scouts.high - scouts.low).cwiseMax(1e-300);
  const Eigen::MatrixXd scaled = (scouts.x.rowwise() - scouts.low.transpose()) * width.cwiseInverse().asDiagonal();
  std::vector<int> votes(static_cast<std::size_t>(n), 0);
  data::RandomStream random(1, data::Purpose::search_directions);  // which directions matters to nobody
  for (int tree = 0; tree < trees; ++tree) {
    const Eigen::MatrixXd turned = tree == 0 ? scaled : Eigen::MatrixXd(scaled * rotation(d, random));
    std::vector<Eigen::VectorXd> heights;
    for (Eigen::Index k = 0; k < d; ++k) heights.emplace_back(turned.col(k));
    std::vector<Eigen::Index> order(static_cast<std::size_t>(n));
    std::iota(order.begin(), order.end(), Eigen::Index{0});
    vote(order, {0, order.size()}, heights, scouts.log_density, votes);
  }
  std::vector<Eigen::Index> found;
  for (Eigen::Index i = 0; i < n; ++i)
    if (votes[i] == trees && scouts.log_density[i] > nowhere) found.push_back(i);
  std::stable_sort(found.begin(), found.end(),
                   [&](Eigen::Index a, Eigen::Index b) { return scouts.log_density[a] > scouts.log_density[b]; });
  return found;
}

/// Maxima along lines through a point: the axes, and the diagonals of the scouts' box.
Eigen::MatrixXd line_maxima(const Target& target, const Scouts& scouts, const Eigen::VectorXd& through,
                            const ExploreOptions& options, std::int64_t& evaluations) {
  const Eigen::Index d = scouts.x.cols();
  const Eigen::VectorXd width = scouts.high - scouts.low;
  std::vector<Eigen::VectorXd> directions;
  for (Eigen::Index k = 0; k < d; ++k) directions.emplace_back(Eigen::VectorXd::Unit(d, k).cwiseProduct(width));
  constexpr unsigned diagonals_max = 8;
  for (unsigned signs = 0; d > 1 && signs < std::min(1U << std::min<Eigen::Index>(d - 1, 8), diagonals_max); ++signs) {
    Eigen::VectorXd direction = width;
    for (Eigen::Index k = 1; k < d; ++k)
      if ((signs >> (k - 1) & 1U) != 0) direction[k] = -direction[k];
    directions.push_back(direction);
  }
  const Eigen::Index points = options.line_points, count = static_cast<Eigen::Index>(directions.size());
  Eigen::MatrixXd all(count * points, d);
  for (Eigen::Index line = 0; line < count; ++line) {
    const Eigen::VectorXd& direction = directions[line];
    // The part of the line inside the scouts' box.
    double from = nowhere, to = -nowhere;
    for (Eigen::Index k = 0; k < d; ++k) {
      if (direction[k] == 0.0) continue;
      const double a = (scouts.low[k] - through[k]) / direction[k], b = (scouts.high[k] - through[k]) / direction[k];
      from = std::max(from, std::min(a, b));
      to = std::min(to, std::max(a, b));
    }
    for (Eigen::Index i = 0; i < points; ++i)
      all.row(line * points + i) =
          (through + (from + (to - from) * (static_cast<double>(i) + 0.5) / static_cast<double>(points)) * direction)
              .transpose();
  }
  const Eigen::VectorXd value = evaluate_all(target, all, options.threads);
  evaluations += all.rows();
  std::vector<Eigen::Index> kept;
  for (Eigen::Index line = 0; line < count; ++line)
    for (Eigen::Index i = 0; i < points; ++i) {
      const Eigen::Index at = line * points + i;
      const bool above = (i == 0 || value[at] > value[at - 1]) && (i + 1 == points || value[at] >= value[at + 1]);
      if (above && value[at] > nowhere) kept.push_back(at);
    }
  std::stable_sort(kept.begin(), kept.end(), [&](Eigen::Index a, Eigen::Index b) { return value[a] > value[b]; });
  kept.resize(std::min(kept.size(), static_cast<std::size_t>(options.climbs)));
  return all(kept, Eigen::all);
}

bool same(const Peak& a, const Peak& b) {
  const Eigen::VectorXd apart = a.x - b.x;
  const auto near = [&](const Eigen::MatrixXd& covariance) {
    const Eigen::LLT<Eigen::MatrixXd> factor(covariance);
    return factor.info() == Eigen::Success && factor.matrixL().solve(apart).squaredNorm() < 4.0;
  };
  return near(a.covariance) || near(b.covariance);
}

/// Square of the distance in standard deviations that is near a maximum.
double near_square(Eigen::Index dimension) { return static_cast<double>(dimension) + 4.0; }

/// Log of the mass of p about a peak where `counts(x, standard deviations from the peak, log p)`.
template <class Counts>
double log_mass_where(const Target& target, const Peak& peak, std::int64_t& evaluations, const Counts& counts) {
  constexpr Eigen::Index draws = 512;
  constexpr double wider = 4.0 / 3.0;
  const Eigen::Index d = peak.x.size();
  const Eigen::LLT<Eigen::MatrixXd> factor(peak.covariance);
  if (factor.info() != Eigen::Success) return peak.log_mass;
  data::RandomStream random(1, data::Purpose::search_directions, 1);
  Eigen::MatrixXd inside(draws, d), away(draws, d);
  Eigen::VectorXd log_proposal(draws);
  Eigen::Index count = 0;
  const double constant = -0.5 * static_cast<double>(d) * std::log(2.0 * std::numbers::pi) -
                          Eigen::MatrixXd(factor.matrixL()).diagonal().array().log().sum() -
                          static_cast<double>(d) * std::log(wider);
  for (Eigen::Index i = 0; i < draws; ++i) {
    Eigen::VectorXd z(d);
    for (double& value : z) value = random.normal();
    const Eigen::VectorXd step = factor.matrixL() * z, x = peak.x + wider * step;
    if (!target.contains(x)) continue;
    inside.row(count) = x.transpose();
    away.row(count) = wider * z.transpose();
    log_proposal[count++] = constant - 0.5 * z.squaredNorm();
  }
  if (count == 0) return nowhere;
  const Eigen::VectorXd level = evaluate(target, inside.topRows(count));
  evaluations += count;
  double mass = 0.0;
  for (Eigen::Index i = 0; i < count; ++i)
    if (level[i] > nowhere && counts(inside.row(i).transpose(), away.row(i).transpose(), level[i]))
      mass += std::exp(level[i] - log_proposal[i] - peak.log_mass);
  return mass > 0.0 ? peak.log_mass + std::log(mass / static_cast<double>(draws)) : nowhere;
}

}  // namespace

int scouts_for(int dimension) {
  constexpr std::array<int, 5> counts = {1000, 2000, 8000, 16000, 32000};
  return counts[static_cast<std::size_t>(std::clamp(dimension, 1, 5) - 1)];
}

Scouts send_scouts(const Target& target, data::RandomStream& random, const ExploreOptions& options) {
  const int count = options.scouts > 0 ? options.scouts : scouts_for(target.dimension);
  Scouts scouts{.x = Eigen::MatrixXd(count, target.dimension), .log_density = {}, .low = {}, .high = {}};
  for (int i = 0; i < count; ++i) scouts.x.row(i) = target.reference.draw(random).transpose();
  scouts.log_density = evaluate_all(target, scouts.x, options.threads);
  scouts.low = scouts.x.colwise().minCoeff();
  scouts.high = scouts.x.colwise().maxCoeff();
  return scouts;
}

Search search_unknown(const Target& target, const Scouts& scouts, const Knowledge& knowledge, const Origins& origins,
                      const ExploreOptions& options) {
  Search search;
  const std::vector<Eigen::Index> high = peaks(scouts);
  const Eigen::MatrixXd on_lines = line_maxima(target, scouts, origins.through, options, search.evaluations);
  // The highest half of what may be followed, and of the rest an even choice: a narrow mode's scouts lie in its skirts.
  std::vector<Eigen::Index> chosen;
  const auto most = static_cast<std::size_t>(options.climbs);
  for (std::size_t i = 0; i < std::min(high.size(), most / 2); ++i) chosen.push_back(high[i]);
  const std::size_t rest = high.size() - chosen.size(), wanted = std::min(rest, most - chosen.size());
  const std::size_t first = chosen.size();
  for (std::size_t i = 0; i < wanted; ++i) chosen.push_back(high[first + i * rest / wanted]);
  Eigen::MatrixXd starts(static_cast<Eigen::Index>(chosen.size()) + on_lines.rows() + origins.starts.rows(),
                         target.dimension);
  starts.topRows(static_cast<Eigen::Index>(chosen.size())) = scouts.x(chosen, Eigen::all);
  starts.middleRows(static_cast<Eigen::Index>(chosen.size()), on_lines.rows()) = on_lines;
  if (origins.starts.rows() > 0) starts.bottomRows(origins.starts.rows()) = origins.starts;

  const Eigen::VectorXd width = scouts.high - scouts.low;
  std::vector<Climb> climbs(static_cast<std::size_t>(starts.rows()));
  for_each_index(static_cast<int>(starts.rows()), options.threads,
                 [&](int i) { climbs[i] = climb(target, starts.row(i).transpose(), width, knowledge); });
  search.starts = static_cast<int>(climbs.size());
  for (const Climb& found : climbs) {
    search.evaluations += found.evaluations;
    if (found.known || !(found.log_density > nowhere)) continue;
    // Whether the peak is a maximum that was seen before: within two of its standard deviations.
    const bool seen = std::any_of(search.modes.begin(), search.modes.end(), [&](const Peak& mode) {
      const Eigen::LLT<Eigen::MatrixXd> factor(mode.covariance);
      return factor.info() == Eigen::Success && factor.matrixL().solve(found.x - mode.x).squaredNorm() < 4.0;
    });
    if (seen) continue;
    Peak mode = laplace(target, found.x, 0.25 * width);
    const bool twice =
        std::any_of(search.modes.begin(), search.modes.end(), [&](const Peak& other) { return same(mode, other); });
    if (!twice) search.modes.push_back(std::move(mode));
  }
  return search;
}

double log_unknown_mass(const Target& target, const Peak& peak, const Knowledge& knowledge, std::int64_t& evaluations) {
  return log_mass_where(target, peak, evaluations, [&](const Eigen::VectorXd& x, const Eigen::VectorXd&, double level) {
    return !knowledge.knows(x, level);
  });
}

double log_mass_near(const Target& target, const Peak& peak, std::int64_t& evaluations) {
  return log_mass_where(target, peak, evaluations, [&](const Eigen::VectorXd&, const Eigen::VectorXd& away, double) {
    return away.squaredNorm() < near_square(away.size());
  });
}

Eigen::Index draws_near(const Peak& mode, const Eigen::MatrixXd& draws) {
  const Eigen::MatrixXd root = factor_for_proposal(mode.covariance);
  const Eigen::MatrixXd away =
      root.triangularView<Eigen::Lower>().solve((draws.rowwise() - mode.x.transpose()).transpose());
  return (away.colwise().squaredNorm().array() < near_square(draws.cols())).count();
}

}  // namespace uq
