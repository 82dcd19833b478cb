#pragma once
// Triangle meshes from and to STL, the only format that every CAD program writes.
//
// ASCII and binary are told apart by size, as many binary files begin with "solid": a binary file is 84 bytes and 50
// per triangle of the count at byte 80, and perhaps more behind that which belongs to no triangle. The facet normals of
// the file are not used; the order of the corners is. Names of solids may be in any encoding, lines may end in any way,
// and the last "endsolid" may be missing.
#include <string>
#include <string_view>

#include "dem/walls/mesh.hpp"

namespace dem {

/// Reads a mesh, with three vertices of its own per triangle, not welded (dem/walls/mesh_check.hpp). STL has no unit:
/// `unit` [m] is the length that 1 in the file stands for. Throws data::InputError: 66 missing; 65 with line or
/// triangle for what is truncated, not finite, empty, not STL, or too far from its origin for single precision.
TriangleMesh read_stl(const std::string& path, double unit);

/// Reads a mesh from the bytes of a file; `name` is how messages call it.
TriangleMesh parse_stl(std::string_view bytes, const std::string& name, double unit);

/// Writes binary STL in metres (single precision, by that format). Throws data::InputError when the file cannot be
/// written.
void write_stl(const TriangleMesh& mesh, const std::string& path);

}  // namespace dem
