#pragma once
// A moment of a run as a file that ParaView opens: spheres and bodies in one VTKHDF 1.0 UnstructuredGrid (Kitware, "VTK
// HDF File Format").
//
// Points are the spheres' centres, by their number, then the vertices of the bodies as they stand. Cells are a vertex
// per sphere and a triangle per facet. Point data:
//   radius        m, 0 of bodies                velocity  m/s, of bodies that of their surface
//   material      index of the component; of a body -1 - its place among the bodies
//   coordination  spheres that touch it         force     N, magnitude of all contact forces' sum; both 0 of bodies
#include <cstdint>
#include <string>

#include "dem/engine/simulation.hpp"

namespace dem {

/// The identity of a frame: number `index` of `count`, of a run with these settings and this seed.
struct FrameTag {
  int index = 0, count = 0;
  std::uint64_t seed = 0;
  std::string settings;  ///< as settings_text
};

/// Writes a frame. `time`: s of turning. Throws data::InputError (73).
void write_frame(const std::string& path, const Simulation& simulation, double time, const FrameTag& tag);

/// Whether the file is that frame, as it was written.
bool is_frame(const std::string& path, const FrameTag& tag);

/// FOLDER/0007.vtkhdf.
std::string frame_path(const std::string& folder, int index);

}  // namespace dem
