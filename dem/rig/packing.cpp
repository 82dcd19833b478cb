#include "dem/rig/packing.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>

#include "data/error.hpp"
#include "data/random.hpp"
#include "data/shuffle.hpp"

namespace dem {
namespace {

constexpr double margin = 0.02;                            // in diameters of the largest sphere, left to the bodies
constexpr double room = site_spacing - 2.0 * site_jitter;  // for a parcel, alike

struct Lattice {
  Vec3 first;
  std::array<double, 3> step{};
  std::array<int, 3> n{};
  std::array<bool, 3> around{};  ///< the last site along this axis is beside the first
  std::size_t total() const { return static_cast<std::size_t>(n[0]) * n[1] * n[2]; }
  std::array<int, 3> index(std::size_t site) const {
    const auto s = static_cast<int>(site);
    return {s / (n[1] * n[2]), s / n[2] % n[1], s % n[2]};
  }
  std::size_t site(std::array<int, 3> k) const { return (static_cast<std::size_t>(k[0]) * n[1] + k[1]) * n[2] + k[2]; }
  Vec3 at(std::array<int, 3> k) const { return first + Vec3{k[0] * step[0], k[1] * step[1], k[2] * step[2]}; }
};

bool inside(const FillRegion& r, Vec3 p) {
  if (r.shape == FillRegion::Shape::box) {
    return p.x >= r.low.x && p.y >= r.low.y && p.z >= r.low.z && p.x <= r.high.x && p.y <= r.high.y && p.z <= r.high.z;
  }
  const Vec3 axis = r.to - r.from;
  const double along = dot(p - r.from, axis) / dot(axis, axis);
  const double rho = length(p - r.from - along * axis);
  return along >= 0.0 && along <= 1.0 && rho <= r.radius && rho >= r.inner_radius;
}

/// The box around the region, cut so that the spheres are inside the rig's box.
std::pair<Vec3, Vec3> extent(const Packable& w) {
  Vec3 low = w.region.low, high = w.region.high;
  if (w.region.shape == FillRegion::Shape::cylinder) {
    const double r = w.region.radius;
    const Vec3 a = w.region.from, b = w.region.to, along = unit(b - a);
    const auto side = [&](double cosine) { return r * std::sqrt(std::max(0.0, 1.0 - cosine * cosine)); };
    const Vec3 grow{side(along.x), side(along.y), side(along.z)};
    low = Vec3{std::min(a.x, b.x), std::min(a.y, b.y), std::min(a.z, b.z)} - grow;
    high = Vec3{std::max(a.x, b.x), std::max(a.y, b.y), std::max(a.z, b.z)} + grow;
  }
  const auto rim = [&](std::size_t axis) { return w.periodic[axis] ? 0.0 : w.clearance - margin * w.diameter; };
  const Vec3 inset{rim(0), rim(1), rim(2)}, first = w.low + inset, last = w.high - inset;
  return {{std::max(low.x, first.x), std::max(low.y, first.y), std::max(low.z, first.z)},
          {std::min(high.x, last.x), std::min(high.y, last.y), std::min(high.z, last.z)}};
}

/// Along a periodic axis that the region spans the spacing divides the box; else the sites are centred.
Lattice make_lattice(const Packable& w) {
  const auto [low, high] = extent(w);
  const std::array<double, 3> from{low.x, low.y, low.z}, to{high.x, high.y, high.z};
  const std::array<double, 3> box{w.high.x - w.low.x, w.high.y - w.low.y, w.high.z - w.low.z};
  Lattice l;
  std::array<double, 3> first{};
  for (std::size_t a = 0; a < 3; ++a) {
    const double length = to[a] - from[a];
    if (!(length >= 0.0)) return {};
    l.around[a] = w.periodic[a] && length > (1.0 - 1e-9) * box[a];
    // Along a periodic axis half a spacing is left at each end, so that the images keep clear too.
    l.n[a] = static_cast<int>(length / (site_spacing * w.diameter)) + (w.periodic[a] ? 0 : 1);
    l.step[a] = w.periodic[a] && l.n[a] > 0 ? length / l.n[a] : site_spacing * w.diameter;
    first[a] = 0.5 * (from[a] + to[a]) - 0.5 * (l.n[a] - 1) * l.step[a];
  }
  l.first = {first[0], first[1], first[2]};
  return l;
}

/// The largest set of free sites in which each has a neighbour along an axis.
std::vector<std::size_t> largest_part(const Lattice& l, const std::vector<char>& free) {
  std::vector<char> seen(free.size(), 0);
  std::vector<std::size_t> largest;
  for (std::size_t seed = 0; seed < free.size(); ++seed) {
    if (!free[seed] || seen[seed]) continue;
    std::vector<std::size_t> part{seed};
    seen[seed] = 1;
    for (std::size_t next = 0; next < part.size(); ++next) {
      const std::array<int, 3> k = l.index(part[next]);
      for (std::size_t a = 0; a < 3; ++a) {
        for (const int way : {-1, 1}) {
          std::array<int, 3> other = k;
          other[a] += way;
          if (l.around[a]) other[a] = (other[a] + l.n[a]) % l.n[a];
          if (other[a] < 0 || other[a] >= l.n[a]) continue;
          const std::size_t site = l.site(other);
          if (!free[site] || seen[site]) continue;
          seen[site] = 1;
          part.push_back(site);
        }
      }
    }
    if (part.size() > largest.size()) largest.swap(part);
  }
  return largest;
}

}  // namespace

Parcels make_parcels(const Grains& grains, std::size_t count) {
  const auto diameter = [&](std::size_t k) { return 2.0 * grains.radius[grains.radius.size() == 1 ? 0 : k]; };
  const double largest = diameter(0);
  Parcels parcels;
  parcels.first.push_back(0);
  int finest = 1;
  while (parcels.first.back() < count) {
    const std::size_t next = parcels.first.back();
    const int n = std::clamp(static_cast<int>(largest / diameter(next)), 1, 8);
    parcels.first.push_back(std::min(count, next + static_cast<std::size_t>(n * n * n)));
    parcels.along.push_back(n);
    finest = std::max(finest, n);
  }
  // The distance from a site's centre to the far side of the sphere in the corner of its parcel.
  for (int n = 1; n <= finest; ++n) {
    const double corner = std::sqrt(3.0) * 0.5 * (n - 1) * room / n + 0.5 / n;
    parcels.clearance = std::max(parcels.clearance, (corner + site_jitter + margin) * largest);
  }
  return parcels;
}

std::vector<Vec3> place(const Parcels& parcels, const std::vector<Vec3>& sites, double largest) {
  std::vector<Vec3> position;
  for (std::size_t p = 0; p < parcels.sites(); ++p) {
    const int n = parcels.along[p];
    const double step = room * largest / n, back = 0.5 * (n - 1) * step;
    for (std::size_t k = 0; k < parcels.first[p + 1] - parcels.first[p]; ++k) {
      const auto site = static_cast<int>(k);
      const int x = site % n, y = site / n % n, z = site / (n * n);
      position.push_back(sites[p] + Vec3{x * step - back, y * step - back, z * step - back});
    }
  }
  return position;
}

double depth_in_bodies(std::span<const Body> bodies, std::span<const Surface> surfaces, Vec3 center, double radius) {
  double deepest = -std::numeric_limits<double>::infinity();
  std::vector<NearFeature> near;
  std::vector<std::uint32_t> features;
  Touches touches;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Pose start = pose(bodies[b].motion, 0.0);
    const Vec3 in_body = bodies[b].motion.point + rotate_back(start.rotation, center - start.point);
    find_features(surfaces[b], in_body, radius, near);
    features.clear();
    for (const NearFeature& f : near) features.push_back(f.feature);
    find_touches(surfaces[b], features, in_body, radius, touches);
    for (int k = 0; k < touches.count; ++k) deepest = std::max(deepest, radius - touches.touch[k].distance);
  }
  return deepest;
}

namespace {

/// The whole region is searched for places: so many that they fit no memory come of a wrong unit.
void refuse_too_fine(const Packable& where) {
  constexpr double most = 1e9;
  const auto [low, high] = extent(where);
  const Vec3 size = high - low;
  const double places = size.x * size.y * size.z / std::pow(where.diameter, 3);
  if (!(places > most)) return;
  throw data::InputError(
      data::ExitStatus::bad_study,
      {"material.diameter",
       fmt::format(
           "{:.3g} mm is so small that the fill region, {:.3g} x {:.3g} x {:.3g} mm, has {:.2g} places for a sphere",
           1e3 * where.diameter, 1e3 * size.x, 1e3 * size.y, 1e3 * size.z, places),
       "check the unit of the diameter and that of the meshes; or use larger spheres (coarse_graining), or a smaller "
       "rig.region"});
}

}  // namespace

std::vector<Vec3> free_sites(const Packable& where, std::span<const Body> bodies, std::uint64_t seed) {
  refuse_too_fine(where);
  const Lattice l = make_lattice(where);
  // No body passes between two neighbouring sites that keep clear of it by half their spacing.
  const double widest = *std::max_element(l.step.begin(), l.step.end());
  const double clear = std::max(where.clearance, 0.5001 * widest);
  std::vector<Surface> surfaces;
  for (const Body& b : bodies) surfaces.push_back(make_surface(b.mesh, clear));
  std::vector<char> free(l.total(), 0);
  for (std::size_t site = 0; site < free.size(); ++site) {
    const Vec3 p = l.at(l.index(site));
    free[site] = inside(where.region, p) && depth_in_bodies(bodies, surfaces, p, clear) < 0.0;
  }

  data::RandomStream random(seed, data::Purpose::packing);
  struct Ranked {
    long long layer;
    double draw;
    Vec3 at;
  };
  std::vector<Ranked> ranked;
  for (const std::size_t site : largest_part(l, free)) {
    const Vec3 p = l.at(l.index(site));
    ranked.push_back({std::llround(-dot(where.down, p) / (1e-3 * where.diameter)), random.uniform(), p});
  }
  std::sort(ranked.begin(), ranked.end(), [](const Ranked& a, const Ranked& b) {
    return a.layer < b.layer || (a.layer == b.layer && a.draw < b.draw);
  });
  std::vector<Vec3> sites;
  for (const Ranked& r : ranked) sites.push_back(r.at);
  return sites;
}

std::vector<Vec3> jittered(std::vector<Vec3> sites, std::size_t count, double diameter, std::uint64_t seed) {
  data::RandomStream random(seed, data::Purpose::packing, 1);
  sites.resize(count);
  for (Vec3& p : sites) {
    const double x = random.uniform(-1.0, 1.0), y = random.uniform(-1.0, 1.0), z = random.uniform(-1.0, 1.0);
    p += site_jitter * diameter / std::sqrt(3.0) * Vec3{x, y, z};
  }
  data::shuffle(std::span(sites), random);
  return sites;
}

}  // namespace dem
