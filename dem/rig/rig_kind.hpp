#pragma once
// The description that every kind of rig gives of itself. A new kind is a file that defines one of these and its two
// lines at the end of this one; its data are a member of Rig (dem/case/case.hpp).
#include <array>
#include <span>
#include <string>
#include <vector>

#include "data/study_file.hpp"
#include "dem/rig/rig.hpp"

namespace dem {

/// A quantity of a kind of rig that a study may set, calibrate or control, as rig.KEY.
struct RigQuantity {
  const char* key;
  const char* unit;     ///< SI
  double low, high;     ///< SI, values that a simulation can take
  const char* meaning;  ///< one line
  double (*get)(const Case& c);
  void (*set)(Case& c, double si);
};

/// Whether a kind reads a level beside a fill: one of them says how much powder there is.
enum class FillBy { fill, fill_or_level };

/// The outlook of a run, as far as a rig's dimensions give it in closed form. Oddities in it are found by
/// dem/forecast/forecast.cpp, the same for all kinds.
struct RigOutlook {
  struct Passage {
    std::string between;  ///< "blade and trough"
    double width = 0.0;   ///< m
  };
  struct Tool {
    std::string name;
    double lowest = 0.0;  ///< m, height of its lowest point, counted as the surface
  };
  double fill = 0.0;     ///< share of what the vessel holds up to `full_at`
  double surface = 0.0;  ///< m, of the bed at rest, counted along `up`
  std::string up, full_at;
  std::vector<std::string> bodies;  ///< one line each
  std::vector<Passage> passages;    ///< between bodies that move against each other
  std::vector<Tool> tools;          ///< tools that must dip into the bed
  std::vector<std::string> warnings;
  std::vector<data::Problem> problems;
};

struct RigKind {
  const char* name;           ///< as rig.kind says
  bool (*is)(const Case& c);  ///< whether the case's rig is of this kind; the slice's always says yes
  FillBy fill_by;
  std::span<const RigQuantity> quantities;  ///< beside angular velocity and fill, which all kinds have
  /// Makes the case's rig one of this kind, with what no quantity names. Problems are recorded in the study.
  void (*read)(const data::Section& rig, const std::string& folder, Case& c);
  /// Throws data::InputError (78) when the spheres do not fit or start outside.
  BuiltRig (*build)(const Case& c, std::uint64_t seed);
  std::vector<NamedMesh> (*meshes)(const Case& c);        ///< one box length of each
  std::vector<std::string> (*warnings)(const Case& c);    ///< the same for every run
  std::vector<data::Problem> (*problems)(const Case& c);  ///< problems of the rig alone
  std::string (*settings)(const Case& c);                 ///< settings that no target names, one "name = value" a line
  std::vector<RigBody> (*bodies)(const Case& c);          ///< the bodies that `build` makes, in their order
  std::vector<std::size_t> (*measured)(const Case& c);    ///< indices of the bodies whose torques make the output
  Channels (*channels)(const Case& c);                    ///< of two bodies side by side; length 0 where there are none
  bool (*has_picture)(const Case& c);                     ///< whether the picture along its axis shows_bed
  double (*tool_speed)(const Case& c);                    ///< m/s, highest speed of any point of a moving body
  double (*fill_depth)(const Case& c, double volume);     ///< m, of a lattice of this volume in a box without bodies
  RigOutlook (*outlook)(const Case& c);                   ///< null: it is found out from the meshes
};

extern const RigKind slice_rig;    ///< dem/rig/slice.cpp
extern const RigKind machine_rig;  ///< dem/rig/machine.cpp
extern const RigKind drum_rig;     ///< dem/rig/drum.cpp
extern const RigKind stl_rig;      ///< dem/rig/build_stl_rig.cpp

/// All kinds of rig; the first is the kind of a study that names none.
inline constexpr std::array rig_kinds{&slice_rig, &machine_rig, &drum_rig, &stl_rig};
const RigKind& kind_of(const Case& c);

}  // namespace dem
