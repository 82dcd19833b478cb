#include "dem/rig/grow.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "dem/walls/surface.hpp"

namespace dem {
namespace {

constexpr double more = 1.005;                      // that spheres grow beyond their size
constexpr double tolerated = 0.003;                 // overlap of the grown, of the sum of radii: less than `more` is
constexpr double slack_share = 0.4;                 // of lists, of the mean radius
constexpr double start_size = 0.5;                  // of the grown radius
constexpr double stride = 1.4;                      // of a push: more than what parts two, as relaxation goes faster so
constexpr int growing = 80, rounds = 3000;          // of which the first grow
constexpr double closest[]{0.58, 0.62, 0.66, 0.7};  // solid fractions of the lattice

/// Spheres of one octave of radii in cells as wide as the largest of them.
struct Level {
  double widest = 0.0;  ///< m, diameter
  Vec3 low;
  std::array<double, 3> cell{};
  std::array<int, 3> n{1, 1, 1};
  std::vector<std::uint32_t> members, first, sorted;
  std::vector<Vec3> at;  ///< m, of `sorted`
  std::vector<double> radius;
};

/// The region, without ends along a periodic axis that it spans.
FillRegion endless(const Packable& where) {
  FillRegion region = where.region;
  const Vec3 box = where.high - where.low, along = region.to - region.from;
  const auto extend = [&](bool periodic, double Vec3::*axis) {
    const double size = box.*axis;
    if (!periodic) return;
    if (region.shape == FillRegion::Shape::cylinder) {
      if (std::abs(along.*axis) < (1.0 - 1e-9) * std::max(size, length(along))) return;
      region.from -= along;
      region.to += along;
    } else if (region.high.*axis - region.low.*axis > (1.0 - 1e-9) * size) {
      region.low.*axis -= size;
      region.high.*axis += size;
    }
  };
  extend(where.periodic[0], &Vec3::x);
  extend(where.periodic[1], &Vec3::y);
  extend(where.periodic[2], &Vec3::z);
  return region;
}

class Bed {
 public:
  Bed(const Packable& where, std::span<const Body> bodies, std::vector<double> radius, std::vector<Vec3> at)
      : where_(where), region_(endless(where)), bodies_(bodies), radius_(std::move(radius)), at_(std::move(at)) {
    largest_ = *std::max_element(radius_.begin(), radius_.end());
    for (const double r : radius_) slack_ += slack_share * r / static_cast<double>(radius_.size());
    for (const Body& b : bodies) {
      surfaces_.push_back(make_surface(b.mesh, largest_ + slack_));
      start_.push_back(pose(b.motion, 0.0));
    }
    most_.resize(at_.size());
    make_levels();
  }

  /// Finds the push on each sphere at this share of the radii. Returns the deepest overlap, as a share of the sum of
  /// radii, or of a radius at walls.
  double push(double size) {
    if (!(2.0 * moved_ < slack_)) list();
    push_.assign(at_.size(), {});
    for (std::size_t i = 0; i < at_.size(); ++i) most_[i] = size * radius_[i];
    double deepest = 0.0;
    for (const Pair& pair : pairs_) {
      const Vec3 apart = at_[pair.first] - (at_[pair.second] + pair.shift);
      const double reach = size * (radius_[pair.first] + radius_[pair.second]), d2 = dot(apart, apart);
      if (!(d2 < reach * reach)) continue;
      const double distance = std::sqrt(d2);
      deepest = std::max(deepest, 1.0 - distance / reach);
      // Two at one point, which jitter never makes, part along x.
      const Vec3 way = distance > 0.0 ? (1.0 / distance) * apart : Vec3{1.0, 0.0, 0.0};
      const Vec3 half = 0.5 * (reach - distance) * way;
      push_[pair.first] += half;
      push_[pair.second] -= half;
    }
    for (const AtWall& w : at_walls_) deepest = std::max(deepest, push_off(w, size));
    return deepest;
  }

  void move() {
    double farthest = 0.0;
    for (std::size_t i = 0; i < at_.size(); ++i) {
      const double way = stride * length(push_[i]), most = 0.5 * most_[i];
      const Vec3 to = into_region(at_[i] + (way > most ? most / way : 1.0) * (stride * push_[i]));
      farthest = std::max(farthest, length(to - at_[i]));
      at_[i] = to;
    }
    moved_ += farthest;
  }

  std::vector<Vec3> positions() && {
    for (Vec3& p : at_) p = wrapped(p);
    return std::move(at_);
  }

 private:
  void make_levels() {
    // Finest first.
    const double smallest = *std::min_element(radius_.begin(), radius_.end());
    std::vector<Level> all(static_cast<std::size_t>(std::log2(largest_ / smallest)) + 1);
    for (std::size_t i = 0; i < radius_.size(); ++i) {
      const auto l = std::min(all.size() - 1, static_cast<std::size_t>(std::log2(radius_[i] / smallest)));
      all[l].members.push_back(static_cast<std::uint32_t>(i));
      all[l].widest = std::max(all[l].widest, 2.0 * radius_[i]);
    }
    std::erase_if(all, [](const Level& l) { return l.members.empty(); });
    levels_ = std::move(all);
    const Vec3 box = where_.high - where_.low;
    for (Level& l : levels_) {
      l.low = where_.low;
      const std::array<double, 3> edge{box.x, box.y, box.z};
      // No more cells than a few for each sphere, however large the box is beside the bed.
      const double few = std::cbrt(box.x * box.y * box.z / (4.0 * static_cast<double>(l.members.size())));
      for (std::size_t a = 0; a < 3; ++a) {
        l.n[a] = std::clamp(static_cast<int>(edge[a] / std::max(l.widest + slack_, few)), 1, 1000);
        l.cell[a] = edge[a] / l.n[a];
      }
    }
  }

  std::array<int, 3> cell_of(const Level& l, Vec3 p) const {
    const Vec3 from = p - l.low;
    const auto along = [&](double x, std::size_t a) {
      return std::clamp(static_cast<int>(std::floor(x / l.cell[a])), 0, l.n[a] - 1);
    };
    return {along(from.x, 0), along(from.y, 1), along(from.z, 2)};
  }

  void sort() {
    for (Level& l : levels_) {
      l.first.assign(static_cast<std::size_t>(l.n[0]) * l.n[1] * l.n[2] + 1, 0);
      const auto number = [&](std::uint32_t i) {
        const std::array<int, 3> c = cell_of(l, at_[i]);
        return (static_cast<std::size_t>(c[0]) * l.n[1] + c[1]) * l.n[2] + c[2];
      };
      for (const std::uint32_t i : l.members) ++l.first[number(i) + 1];
      for (std::size_t c = 1; c < l.first.size(); ++c) l.first[c] += l.first[c - 1];
      l.sorted.resize(l.members.size());
      l.at.resize(l.members.size());
      l.radius.resize(l.members.size());
      std::vector<std::uint32_t> next(l.first.begin(), l.first.end() - 1);
      for (const std::uint32_t i : l.members) {
        const std::uint32_t to = next[number(i)]++;
        l.sorted[to] = i;
        l.at[to] = at_[i];
        l.radius[to] = radius_[i];
      }
    }
  }

  /// Calls visit(cell, shift) for the cells around a point, each once; `shift` brings what is in it near.
  template <class Visit>
  void around(const Level& l, Vec3 p, Visit&& visit) const {
    const std::array<int, 3> middle = cell_of(l, p);
    const Vec3 box = where_.high - where_.low;
    struct Along {
      int count = 0;
      std::array<int, 3> cell{};
      std::array<double, 3> shift{};
    };
    std::array<Along, 3> along;
    const std::array<double, 3> edge{box.x, box.y, box.z};
    for (std::size_t a = 0; a < 3; ++a) {
      for (int off = -1; off <= 1; ++off) {
        int c = middle[a] + off;
        double shift = 0.0;
        if (where_.periodic[a] && (c < 0 || c >= l.n[a])) {
          shift = c < 0 ? -edge[a] : edge[a];
          c = (c + l.n[a]) % l.n[a];
        }
        if (c < 0 || c >= l.n[a]) continue;
        along[a].cell[along[a].count] = c;
        along[a].shift[along[a].count++] = shift;
      }
    }
    for (int i = 0; i < along[0].count; ++i)
      for (int j = 0; j < along[1].count; ++j)
        for (int k = 0; k < along[2].count; ++k)
          visit((static_cast<std::size_t>(along[0].cell[i]) * l.n[1] + along[1].cell[j]) * l.n[2] + along[2].cell[k],
                Vec3{along[0].shift[i], along[1].shift[j], along[2].shift[k]});
  }

  /// All that may touch until one has moved by half of the slack.
  void list() {
    for (Vec3& p : at_) p = wrapped(p);
    sort();
    pairs_.clear();
    for (std::size_t l = 0; l < levels_.size(); ++l) {
      for (std::size_t k = 0; k < levels_[l].sorted.size(); ++k)
        for (std::size_t other = l; other < levels_.size(); ++other) list_neighbours(l, k, other);
    }
    at_walls_.clear();
    for (std::size_t b = 0; b < bodies_.size(); ++b) {
      for (std::size_t i = 0; i < at_.size(); ++i) {
        find_features(surfaces_[b], in_body(b, at_[i]), radius_[i] + 0.5 * slack_, near_);
        if (!near_.empty()) at_walls_.push_back({b, i});
      }
    }
    moved_ = 0.0;
  }

  /// The pairs of the k-th of a level with those of a level as coarse or coarser.
  void list_neighbours(std::size_t level, std::size_t k, std::size_t other) {
    const Level &mine = levels_[level], &theirs = levels_[other];
    const Vec3 p = mine.at[k];
    const double r = mine.radius[k] + slack_;
    around(theirs, p, [&](std::size_t cell, Vec3 shift) {
      for (std::uint32_t j = theirs.first[cell]; j < theirs.first[cell + 1]; ++j) {
        if (level == other && j <= k) continue;  // once
        const Vec3 apart = p - (theirs.at[j] + shift);
        const double reach = r + theirs.radius[j];
        if (dot(apart, apart) < reach * reach) pairs_.push_back({mine.sorted[k], theirs.sorted[j], shift});
      }
    });
  }

  Vec3 in_body(std::size_t b, Vec3 p) const {
    return bodies_[b].motion.point + rotate_back(start_[b].rotation, p - start_[b].point);
  }

  struct AtWall {
    std::size_t body, sphere;
  };
  /// How deep a sphere is in a body, of its radius.
  double push_off(const AtWall& w, double size) {
    const double r = size * radius_[w.sphere];
    const Vec3 p = in_body(w.body, at_[w.sphere]);
    find_features(surfaces_[w.body], p, r, near_);
    if (near_.empty()) return 0.0;
    features_.clear();
    for (const NearFeature& f : near_) features_.push_back(f.feature);
    find_touches(surfaces_[w.body], features_, p, r, touches_);
    double deepest = 0.0;
    for (int t = 0; t < touches_.count; ++t) {
      const Touch& touch = touches_.touch[t];
      most_[w.sphere] = std::min(most_[w.sphere], touch.distance);
      deepest = std::max(deepest, 1.0 - touch.distance / r);
      push_[w.sphere] += (r - touch.distance) * rotate(start_[w.body].rotation, touch.normal);
    }
    return deepest;
  }

  Vec3 into_region(Vec3 p) const {
    const FillRegion& region = region_;
    const auto within = [](double x, double low, double high) { return std::min(std::max(x, low), high); };
    if (region.shape == FillRegion::Shape::box) {
      p = {within(p.x, region.low.x, region.high.x), within(p.y, region.low.y, region.high.y),
           within(p.z, region.low.z, region.high.z)};
    } else {
      const Vec3 axis = region.to - region.from;
      const double along = dot(p - region.from, axis) / dot(axis, axis);
      const Vec3 foot = region.from + within(along, 0.0, 1.0) * axis, out = p - region.from - along * axis;
      const double rho = length(out), wanted = within(rho, region.inner_radius, region.radius);
      p = foot + (rho > 0.0 ? wanted / rho : 1.0) * out;
    }
    return p;
  }

  Vec3 wrapped(Vec3 p) const {
    const auto wrap = [&](double x, double low, double high, std::size_t a) {
      if (!where_.periodic[a]) return std::min(std::max(x, low), high);
      return x < low ? x + (high - low) : x >= high ? x - (high - low) : x;
    };
    return {wrap(p.x, where_.low.x, where_.high.x, 0), wrap(p.y, where_.low.y, where_.high.y, 1),
            wrap(p.z, where_.low.z, where_.high.z, 2)};
  }

  const Packable& where_;
  FillRegion region_;
  std::span<const Body> bodies_;
  std::vector<Surface> surfaces_;
  std::vector<Pose> start_;
  std::vector<double> radius_;
  std::vector<Vec3> at_, push_;
  std::vector<double> most_;  ///< m, to the nearest wall, or a radius
  struct Pair {
    std::uint32_t first, second;
    Vec3 shift;  ///< m, that brings the second near the first
  };
  std::vector<Pair> pairs_;
  std::vector<AtWall> at_walls_;
  double slack_ = 0.0;                                      ///< m
  double moved_ = std::numeric_limits<double>::infinity();  ///< m, since the list was made
  double largest_ = 0.0;
  std::vector<Level> levels_;
  std::vector<NearFeature> near_;
  std::vector<std::uint32_t> features_;
  Touches touches_;
};

}  // namespace

std::vector<Vec3> grow(const Packable& where, std::span<const Body> bodies, const Grains& grains, const Grown& what) {
  if (what.count == 0) return {};
  std::vector<double> radius = grains.radius;
  if (radius.size() == 1) radius.resize(what.count, radius[0]);
  for (double& r : radius) r *= more;
  std::vector<Vec3> sites;
  Packable fine = where;
  for (const double fraction : closest) {
    const double step = std::cbrt(solid_volume(grains, what.count) / static_cast<double>(what.count) / fraction);
    fine.diameter = step / site_spacing;
    fine.clearance = 0.5 * step;
    sites = free_sites(fine, bodies, what.seed);
    if (sites.size() >= what.count) break;
  }
  if (sites.size() < what.count) return {};
  Bed bed(where, bodies, std::move(radius), jittered(std::move(sites), what.count, fine.diameter, what.seed));
  for (int k = 0; k < rounds; ++k) {
    const double size = std::min(1.0, start_size + (1.0 - start_size) * k / growing);
    if (bed.push(size) < tolerated && size == 1.0) return std::move(bed).positions();
    bed.move();
  }
  return {};
}

}  // namespace dem
