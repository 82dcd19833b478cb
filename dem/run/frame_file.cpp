#include "dem/run/frame_file.hpp"

#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <vector>

#include "data/atomic_file.hpp"
#include "data/error.hpp"
#include "data/hash.hpp"
#include "data/hdf5.hpp"
#include "data/provenance.hpp"

namespace dem {
namespace {

enum VtkCell : std::uint8_t { vtk_vertex = 1, vtk_triangle = 5 };

/// The grid's arrays, filled sphere by sphere and facet by facet.
struct Grid {
  std::vector<float> points, velocity, radius, force;
  std::vector<std::int32_t> material, coordination;
  std::vector<std::int64_t> connectivity, offsets{0};
  std::vector<std::uint8_t> types;

  std::int64_t count() const { return static_cast<std::int64_t>(radius.size()); }

  void add_point(Vec3 at, Vec3 moving, double size, int of) {
    for (const double x : {at.x, at.y, at.z}) points.push_back(static_cast<float>(x));
    for (const double v : {moving.x, moving.y, moving.z}) velocity.push_back(static_cast<float>(v));
    radius.push_back(static_cast<float>(size));
    material.push_back(of);
    coordination.push_back(0);
    force.push_back(0.0f);
  }

  void add_cell(std::initializer_list<std::int64_t> of, VtkCell type) {
    connectivity.insert(connectivity.end(), of);
    offsets.push_back(static_cast<std::int64_t>(connectivity.size()));
    types.push_back(type);
  }
};

void add_spheres(Grid& grid, const Simulation& simulation) {
  const State& s = simulation.state();
  std::vector<std::uint32_t> row_of(s.particles());
  for (std::uint32_t row = 0; row < s.particles(); ++row) row_of[s.id[row]] = row;
  for (const std::uint32_t row : row_of) {
    grid.add_point(s.position[row].at, simulation.motion(row).velocity, s.position[row].radius,
                   static_cast<int>(s.motion[row].material));
    grid.force.back() = static_cast<float>(length(s.load[row].force));
    grid.add_cell({grid.count() - 1}, vtk_vertex);
  }
  s.each_in_range([&](std::size_t, std::uint32_t slot) {
    const Pair pair = s.pair[slot];
    const PositionRow &a = s.position[pair.i], &b = s.position[pair.j];
    if (length(a.at - b.at) >= a.radius + b.radius) return;
    for (const std::uint32_t row : {pair.i, pair.j})
      ++grid.coordination[s.id[row < s.particles() ? row : s.ghost[row - s.particles()].owner]];
  });
}

void add_bodies(Grid& grid, const Simulation& simulation, double time) {
  const std::vector<Body>& bodies = simulation.setup().bodies;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const Pose now = pose(bodies[b].motion, time);
    const std::int64_t first = grid.count();
    for (const Vec3 vertex : bodies[b].mesh.vertices) {
      const Vec3 arm = rotate(now.rotation, vertex - bodies[b].motion.point);
      grid.add_point(now.point + arm, now.velocity + cross(now.spin, arm), 0.0, -1 - static_cast<int>(b));
    }
    for (const auto& facet : bodies[b].mesh.triangles)
      grid.add_cell({first + facet[0], first + facet[1], first + facet[2]}, vtk_triangle);
  }
}

std::string digest_of(const FrameTag& tag) {
  return data::hash_text(fmt::format("{} {} {} {}", tag.settings, tag.seed, tag.index, tag.count));
}

}  // namespace

void write_frame(const std::string& path, const Simulation& simulation, double time, const FrameTag& tag) {
  Grid grid;
  add_spheres(grid, simulation);
  add_bodies(grid, simulation, time);
  data::write_atomically(path, [&](const std::string& temporary) {
    const data::Hdf5Group file = data::create_hdf5(temporary);
    for (const auto& [name, value] : data::provenance()) file.set(name, value);
    file.set("frame", digest_of(tag));
    file.set("time_s", time);
    const data::Hdf5Group vtk = file.create_group("VTKHDF");
    vtk.set("Version", std::vector<std::int64_t>{1, 0});
    vtk.set_ascii("Type", "UnstructuredGrid");
    vtk.write("NumberOfPoints", std::vector<std::int64_t>{grid.count()});
    vtk.write("NumberOfCells", std::vector<std::int64_t>{static_cast<std::int64_t>(grid.types.size())});
    vtk.write("NumberOfConnectivityIds",
              std::vector<std::int64_t>{static_cast<std::int64_t>(grid.connectivity.size())});
    const auto points = static_cast<std::size_t>(grid.count());
    vtk.write("Points", grid.points, {points, 3});
    vtk.write("Connectivity", grid.connectivity);
    vtk.write("Offsets", grid.offsets);
    vtk.write("Types", grid.types);
    const data::Hdf5Group data = vtk.create_group("PointData");
    data.write("radius", grid.radius);
    data.write("velocity", grid.velocity, {points, 3});
    data.write("material", grid.material);
    data.write("coordination", grid.coordination);
    data.write("force", grid.force);
    vtk.create_group("CellData");
    file.flush();
  });
}

bool is_frame(const std::string& path, const FrameTag& tag) {
  if (!std::filesystem::exists(path)) return false;
  try {
    const data::Hdf5Group file = data::open_hdf5(path);
    return file.has_attribute("frame") && file.text("frame") == digest_of(tag);
  } catch (const data::InputError&) {  // damaged, or not ours
    return false;
  }
}

std::string frame_path(const std::string& folder, int index) {
  return (std::filesystem::path(folder) / fmt::format("{:04d}.vtkhdf", index)).string();
}

}  // namespace dem
