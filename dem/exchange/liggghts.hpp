#pragma once
// A case written for LIGGGHTS 3.8, the existing engine for beds that need many machines, and its results read back.
//
// The same in both: box and periodicity, meshes and how they turn, the spheres (their sizes, densities and where they
// start), gravity, the time in which the bed comes to rest, friction, restitution and stiffness of every pair. The
// linear law is LIGGGHTS's `hooke/stiffness` with `tangential history`, the Hertz law its `hertz`, constant rolling
// friction its `rolling_friction cdt`. LIGGGHTS's damping is a rate per reduced mass, so each size of each material is
// an atom type of its own, and so is each mesh.
// Different: LIGGGHTS limits the tangential spring alone, not spring and dashpot together (dem/VERIFICATION.md), and it
// does not scale the tangential force of a Hertz contact that unloads. A law that LIGGGHTS lacks is refused, with the
// nearest law that it has.
#include <cstdint>
#include <string>
#include <vector>

#include "data/error.hpp"
#include "dem/case/case.hpp"
#include "dem/run/looks.hpp"

namespace dem {

/// The parts of the case that LIGGGHTS cannot do: key, reason, and the nearest that it can.
std::vector<data::Problem> not_in_liggghts(const Case& c);

/// Writes in.liggghts, bed.data and NAME.stl of each mesh into the folder, which exists. Returns the files' names. The
/// time step is the shortest contact's duration / 50, as LIGGGHTS's integrator needs. LIGGGHTS then writes the sampled
/// torque [N m] into torque.dat, coordination and kinetic energy [J] into state.dat. Throws data::InputError: 78 for
/// what not_in_liggghts names and for random sizes, which would take a type each; 73 where a file cannot be written.
std::vector<std::string> write_liggghts(const Case& c, std::uint64_t seed, const std::string& folder);

/// The mean of the torque in LIGGGHTS's files, and whether it is that of the steady flow, by the rule of our own runs
/// (dem/run/looks.hpp). Throws data::InputError (65, 66) for a file that is missing, empty, or not what write_liggghts
/// asked for.
Measured read_liggghts(const Case& c, const std::string& folder);

}  // namespace dem
