#include "dem/rig/check_packing.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "data/error.hpp"
#include "dem/rig/packing.hpp"
#include "dem/walls/surface.hpp"

namespace dem {
namespace {

std::array<double, 3> components(Vec3 a) { return {a.x, a.y, a.z}; }
std::string short_text(Vec3 a) { return fmt::format("({:.4g}, {:.4g}, {:.4g})", a.x, a.y, a.z); }

[[noreturn]] void fail(std::string what, std::string remedy) {
  throw data::InputError(data::ExitStatus::bad_study, {"rig.packing", std::move(what), std::move(remedy)});
}

bool outside(const StlRig& rig, Vec3 p) {
  return !(p.x >= rig.low.x && p.y >= rig.low.y && p.z >= rig.low.z && p.x <= rig.high.x && p.y <= rig.high.y &&
           p.z <= rig.high.z);
}

/// The cells of a box. They are at least as wide as a sphere, so that spheres that touch lie in neighbouring cells.
class Cells {
 public:
  Cells(const StlRig& rig, double width) : low_(rig.low), size_(rig.high - rig.low), periodic_(rig.periodic) {
    const auto size = components(size_);
    for (std::size_t a = 0; a < 3; ++a) count_[a] = std::clamp(std::floor(size[a] / width), 1.0, most_cells);
  }

  using Cell = std::array<std::int64_t, 3>;
  Cell cell_of(Vec3 p) const {
    const auto at = components(p - low_), size = components(size_);
    Cell cell{};
    for (std::size_t a = 0; a < 3; ++a)
      cell[a] = static_cast<std::int64_t>(std::clamp(std::floor(at[a] / size[a] * count_[a]), 0.0, count_[a] - 1.0));
    return cell;
  }
  /// The key of the cell next to a cell; none beyond a closed face.
  std::optional<std::int64_t> key(Cell cell, const Cell& step) const {
    std::int64_t key = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      const auto n = static_cast<std::int64_t>(count_[a]);
      std::int64_t at = cell[a] + step[a];
      if (periodic_[a]) at = (at + n) % n;
      if (at < 0 || at >= n) return {};
      key = key * n + at;
    }
    return key;
  }
  double distance(Vec3 p, Vec3 q) const {
    auto apart = components(p - q);
    const auto size = components(size_);
    for (std::size_t a = 0; a < 3; ++a)
      if (periodic_[a]) apart[a] = std::remainder(apart[a], size[a]);
    return std::hypot(apart[0], apart[1], apart[2]);
  }

 private:
  static constexpr double most_cells = 1e6;  // along an axis, so that keys fit
  Vec3 low_, size_;
  std::array<bool, 3> periodic_;
  std::array<double, 3> count_{};
};

/// Given positions must keep clear of each other, but for what ends a run. Spheres that are held press on nothing.
void check_overlaps(const StlRig& rig, const GivenPacking& given) {
  const Cells cells(rig, 2.0 * given.radius(0));  // the largest
  std::unordered_map<std::int64_t, std::vector<std::size_t>> in;
  const auto held = [&](std::size_t k) { return !rig.frozen.empty() && rig.frozen[k] != 0; };
  for (std::size_t k = 0; k < rig.packing.size(); ++k) {
    const Vec3 p = rig.packing[k];
    const Cells::Cell cell = cells.cell_of(p);
    for (int step = 0; step < 27; ++step) {
      const auto key = cells.key(cell, {step % 3 - 1, step / 3 % 3 - 1, step / 9 - 1});
      const auto there = key ? in.find(*key) : in.end();
      if (there == in.end()) continue;
      for (const std::size_t other : there->second) {
        const double mean_radius = 0.5 * (given.radius(k) + given.radius(other));
        const double overlap = 2.0 - cells.distance(p, rig.packing[other]) / mean_radius;
        if (!(overlap > given.overlap_limit) || (held(k) && held(other))) continue;
        fail(
            fmt::format("has spheres {} and {} (lines {} and {}) that overlap by {:.3g} of a radius at {} m, more than "
                        "run.overlap_limit, {:g}",
                        other + 1, k + 1, rig.packing_line[other], rig.packing_line[k], overlap, short_text(p),
                        given.overlap_limit),
            "move them apart, remove one, or correct packing_unit or the diameter");
      }
    }
    in[*cells.key(cell, {0, 0, 0})].push_back(k);
  }
}

/// Given diameters must be those of the bed that the materials make.
void check_diameters(const StlRig& rig, const GivenPacking& given) {
  for (std::size_t k = 0; k < rig.diameter.size(); ++k) {
    const double here = rig.diameter[k], wanted = 2.0 * given.radius(k);
    if (std::abs(here - wanted) > 1e-6 * wanted)
      fail(fmt::format("has a sphere of {:g} m in line {}, where the bed of these materials has one of {:g} m", here,
                       rig.packing_line[k], wanted),
           "correct the diameters, or the materials' sizes and mass fractions");
  }
}

/// Given positions must lie in the box and clear of the meshes, but for a tenth of a radius.
void check_places(const StlRig& rig, const GivenPacking& given) {
  std::vector<Surface> surfaces;
  for (const Body& b : given.bodies) surfaces.push_back(make_surface(b.mesh, given.radius(0)));
  for (std::size_t k = 0; k < rig.packing.size(); ++k) {
    const Vec3 p = rig.packing[k];
    const std::string where = fmt::format("has sphere {} (line {}) at {} m", k + 1, rig.packing_line[k], short_text(p));
    if (outside(rig, p)) fail(where + ", outside the box", "move it inside, or make rig.box larger");
    const double depth = depth_in_bodies(given.bodies, surfaces, p, given.radius(k));
    if (depth > 0.1 * given.radius(k))
      fail(fmt::format("{}, {:.2g} of a radius inside a mesh", where, depth / given.radius(k)),
           "move it clear of the meshes");
  }
}

}  // namespace

void check_packing(const StlRig& rig, const GivenPacking& given) {
  check_diameters(rig, given);
  check_places(rig, given);
  check_overlaps(rig, given);
}

}  // namespace dem
