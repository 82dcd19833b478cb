#pragma once
// A mesh as CAD programs hand it out, made fit for contacts: corners welded, triangles without area and triangles given
// twice left out, orientation made one and outward. What was done, and what cannot be repaired, is said.
//
// Tolerance: 1e-6 of the largest extent, or 4 roundings of single precision at the largest coordinate, whichever is
// more.
// Orientation: neighbours at an edge that two triangles share must run along it in opposite directions; of each
// connected part the smaller side is turned. A closed part of negative volume V = sum a.(b x c) / 6 is turned inside
// out, unless it lies within the box of another closed part: that is a cavity.
// Contacts see both sides of every triangle, so open edges and edges of more than two triangles are allowed.
#include <string>
#include <vector>

#include "dem/walls/mesh.hpp"

namespace dem {

struct CheckedMesh {
  TriangleMesh mesh;
  double tolerance = 0.0;             ///< m, of the welding
  std::vector<std::string> warnings;  ///< "auger: 3 triangles ...", one per kind of finding
};

/// `name` is how the warnings call the mesh; an edge where an image of the mesh, shifted along `periods` [m], goes on
/// is not open. Throws data::InputError (65) when no triangle is left.
CheckedMesh check_mesh(const TriangleMesh& mesh, const std::string& name, const std::vector<Vec3>& periods = {});

}  // namespace dem
