#include "dem/run/picture.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <vector>

#include "data/atomic_file.hpp"
#include "data/error.hpp"
#include "data/hdf5.hpp"
#include "data/program.hpp"
#include "dem/walls/vec3.hpp"

namespace dem {
namespace {

struct Scene {
  std::vector<Vec3> point;
  std::vector<double> radius, speed, coordination, force;
  std::vector<int> material;
  std::vector<std::array<std::size_t, 3>> facets;
};

Scene read_frame(const std::string& path) {
  const data::Hdf5Group file = data::open_hdf5(path);
  if (!file.has("VTKHDF") || !file.has_attribute("frame"))
    throw data::InputError(data::ExitStatus::bad_data,
                           {path, "is no frame of a run", "give a file that demcal simulate --frames N has written"});
  const data::Hdf5Group vtk = file.group("VTKHDF"), values = vtk.group("PointData");
  Scene frame;
  frame.radius = values.read<double>("radius").values;
  frame.coordination = values.read<double>("coordination").values;
  frame.force = values.read<double>("force").values;
  const std::size_t count = frame.radius.size();
  const auto points = vtk.read<double>("Points").values, velocity = values.read<double>("velocity").values,
             material = values.read<double>("material").values;
  const auto connectivity = vtk.read<std::int64_t>("Connectivity").values,
             offsets = vtk.read<std::int64_t>("Offsets").values;
  if (points.size() != 3 * count || velocity.size() != 3 * count || material.size() != count ||
      frame.coordination.size() != count || frame.force.size() != count)
    throw data::InputError(data::ExitStatus::bad_data,
                           {path, "has arrays of different lengths", "write the frame again"});
  for (std::size_t i = 0; i < count; ++i) {
    frame.point.push_back({points[3 * i], points[3 * i + 1], points[3 * i + 2]});
    frame.speed.push_back(std::hypot(velocity[3 * i], velocity[3 * i + 1], velocity[3 * i + 2]));
    frame.material.push_back(static_cast<int>(material[i]));
  }
  for (std::size_t cell = 0; cell + 1 < offsets.size(); ++cell) {
    if (offsets[cell + 1] - offsets[cell] != 3) continue;
    std::array<std::size_t, 3> corners{};
    for (std::size_t k = 0; k < 3; ++k)
      corners[k] = static_cast<std::size_t>(connectivity[static_cast<std::size_t>(offsets[cell]) + k]);
    if (std::all_of(corners.begin(), corners.end(), [&](std::size_t i) { return i < count; }))
      frame.facets.push_back(corners);
  }
  return frame;
}

std::string text(Vec3 a) { return fmt::format("<{:.6g},{:.6g},{:.6g}>", a.x, a.y, a.z); }

/// Colours of materials: Okabe and Ito's, told apart by colour-blind readers.
constexpr std::array<std::array<double, 3>, 6> palette{{{0.90, 0.62, 0.0},
                                                        {0.34, 0.71, 0.91},
                                                        {0.0, 0.62, 0.45},
                                                        {0.80, 0.47, 0.65},
                                                        {0.94, 0.89, 0.26},
                                                        {0.84, 0.37, 0.0}}};

/// From blue over grey to yellow, dark to light.
std::array<double, 3> scale_colour(double share) {
  const double s = std::clamp(share, 0.0, 1.0);
  return {0.05 + 0.93 * s, 0.15 + 0.70 * s, 0.45 - 0.10 * s - 0.15 * s * s};
}

/// The values by which spheres are coloured, between those of 1 and 99 % of them.
struct Shades {
  const std::vector<double>* values = nullptr;
  double low = 0.0, high = 1.0;
};

Shades shades_of(const Scene& frame, ColourBy by) {
  Shades shades;
  shades.values = by == ColourBy::speed ? &frame.speed : by == ColourBy::force ? &frame.force : &frame.coordination;
  std::vector<double> sorted;
  for (std::size_t i = 0; i < frame.point.size(); ++i)
    if (frame.material[i] >= 0) sorted.push_back((*shades.values)[i]);
  if (sorted.empty()) return shades;
  std::sort(sorted.begin(), sorted.end());
  shades.low = sorted[sorted.size() / 100];
  shades.high = sorted[sorted.size() - 1 - sorted.size() / 100];
  return shades;
}

std::string spheres_text(const Scene& frame, const PictureOptions& options) {
  const Shades shades = shades_of(frame, options.by);
  std::string scene;
  for (std::size_t i = 0; i < frame.point.size(); ++i) {
    if (frame.material[i] < 0) continue;
    const auto colour =
        options.by == ColourBy::material
            ? palette[static_cast<std::size_t>(frame.material[i]) % palette.size()]
            : scale_colour(((*shades.values)[i] - shades.low) / std::max(shades.high - shades.low, 1e-300));
    scene += fmt::format("sphere {{ {}, {:.6g} pigment {{ rgb <{:.3g},{:.3g},{:.3g}> }} finish {{ Grain }} }}\n",
                         text(frame.point[i]), frame.radius[i], colour[0], colour[1], colour[2]);
  }
  return scene;
}

/// A body at a time: those that move nearly opaque, those that rest like glass.
std::string bodies_text(const Scene& frame) {
  const int bodies = frame.material.empty() ? 0 : -*std::min_element(frame.material.begin(), frame.material.end());
  std::string scene;
  for (int body = 1; body <= bodies; ++body) {
    double fastest = 0.0;
    std::string facets;
    for (const auto& corners : frame.facets) {
      if (frame.material[corners[0]] != -body) continue;
      for (const std::size_t i : corners) fastest = std::max(fastest, frame.speed[i]);
      facets += fmt::format("triangle {{ {}, {}, {} }}\n", text(frame.point[corners[0]]), text(frame.point[corners[1]]),
                            text(frame.point[corners[2]]));
    }
    if (facets.empty()) continue;
    scene += "mesh {\n" + facets +
             fmt::format("pigment {{ rgbt <{}> }} finish {{ Wall }} no_shadow }}\n",
                         fastest > 0.0 ? "0.55,0.58,0.62,0.1" : "0.62,0.70,0.80,0.8");
  }
  return scene;
}

}  // namespace

std::string povray_scene(const std::string& path, const PictureOptions& options) {
  const Scene frame = read_frame(path);
  Vec3 low{1e300, 1e300, 1e300}, high{-1e300, -1e300, -1e300};
  double size = 1e-12;  // a lone sphere has no extent of centres
  for (std::size_t i = 0; i < frame.point.size(); ++i) {
    if (frame.material[i] < 0) continue;  // bodies may reach far above the powder
    const Vec3 p = frame.point[i];
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x), std::max(high.y, p.y), std::max(high.z, p.z)};
    size = std::max(size, 4.0 * frame.radius[i]);
  }
  size = std::max(size, length(high - low));
  const Vec3 centre = 0.5 * (low + high);
  const Vec3 direction{options.from[0], options.from[1], options.from[2]};
  const Vec3 at = centre + (3.1 * size / std::max(length(direction), 1e-12)) * direction;
  // The picture's right is turned round: POV-Ray's axes are left-handed.
  return fmt::format(
             "#version 3.7;\nglobal_settings {{ assumed_gamma 1.0 }}\nbackground {{ rgb 1 }}\n"
             "#declare Grain = finish {{ ambient 0.25 diffuse 0.7 specular 0.15 roughness 0.05 }}\n"
             "#declare Wall = finish {{ ambient 0.3 diffuse 0.6 specular 0.1 }}\n"
             "camera {{ perspective sky <0,0,1> right -x*image_width/image_height angle 24 location {} look_at {} }}\n"
             "light_source {{ {} rgb 0.8 parallel point_at {} }}\nlight_source {{ {} rgb 0.35 shadowless }}\n",
             text(at), text(centre), text(at + Vec3{0.0, 0.0, 2.0 * size}), text(centre), text(at)) +
         spheres_text(frame, options) + bodies_text(frame);
}

void draw_frame(const std::string& frame, const std::string& png, const PictureOptions& options) {
  namespace fs = std::filesystem;
  const std::string scene = povray_scene(frame, options);
  data::require_replaceable(png);
  const std::string folder = fs::temp_directory_path().string(), name = fmt::format("demcal-{}", ::getpid());
  const fs::path pov = fs::path(folder) / (name + ".pov"), drawn = fs::path(folder) / (name + ".png");
  data::write_atomically(pov.string(), scene);
  const data::ProgramEnd result = data::run_program(
      {.words = {"povray", "+I" + pov.string(), "+O" + drawn.string(), fmt::format("+W{}", options.width),
                 fmt::format("+H{}", options.height), "+A0.2", "-D", "+FN"},
       .folder = folder});
  fs::remove(pov);
  if (result.start_error != 0) throw data::cannot_start("povray", result, "install it: apt-get install povray");
  if (result.exit_status != 0 || !fs::exists(drawn))
    throw data::InputError(
        data::ExitStatus::missing_program,
        {frame, "povray failed: " + result.err.substr(result.err.size() > 600 ? result.err.size() - 600 : 0),
         "its message says why; demcal draws with POV-Ray 3.7"});
  const std::string picture = data::read_file(drawn.string());
  fs::remove(drawn);
  data::write_atomically(png, picture);
}

}  // namespace dem
