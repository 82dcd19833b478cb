#pragma once
// What every kind of rig says of itself. A new kind is a file that defines one of these, a line below, and a line in
// rig.cpp, which chooses.
#include "dem/rig/rig.hpp"

namespace dem {

struct RigKind {
  const char* name;  ///< as rig.kind says
  /// Throws data::InputError (78) when the spheres do not fit or start outside.
  BuiltRig (*build)(const Case& c, std::uint64_t seed);
  std::vector<NamedMesh> (*meshes)(const Case& c);        ///< one box length of each
  std::vector<std::string> (*warnings)(const Case& c);    ///< the same for every run
  std::vector<data::Problem> (*problems)(const Case& c);  ///< what of the rig alone cannot be simulated
  std::string (*settings)(const Case& c);                 ///< that no target names, one "name = value" a line
  std::vector<BodyLabel> (*labels)(const Case& c);        ///< of the bodies, in their order
  std::size_t (*measured_bodies)(const Case& c);          ///< whose torques make the output
  Channels (*channels)(const Case& c);                    ///< of two bodies side by side; of length 0 where none are
  double (*tool_speed)(const Case& c);                    ///< m/s, highest of any point of a moving body
  double (*fill_depth)(const Case& c, double volume);     ///< m, of a lattice of this volume in the box without bodies
};

extern const RigKind slice_rig;    ///< dem/rig/slice.cpp
extern const RigKind machine_rig;  ///< dem/rig/machine.cpp
extern const RigKind drum_rig;     ///< dem/rig/drum.cpp
extern const RigKind stl_rig;      ///< dem/rig/build_stl_rig.cpp

}  // namespace dem
