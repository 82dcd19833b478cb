#pragma once
// A study opened for work: what it says, the DEM case of each material, and the folder of its results.
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "data/error.hpp"
#include "data/folder_lock.hpp"
#include "data/plan.hpp"
#include "data/study.hpp"
#include "data/study_file.hpp"
#include "dem/case/case.hpp"

namespace uq {
struct SurrogateOptions;
}

namespace campaign {

/// The study to open, and what is changed of it for this call.
struct StudyOptions {
  std::string study;                  ///< file, or folder that holds study.toml
  std::string out;                    ///< folder of results; by default ./STUDY-NAME-results
  std::optional<std::uint64_t> seed;  ///< seed that replaces the study's
  std::vector<std::string> set;       ///< "study.key=VALUE"
};

/// What becomes of runs that are not of the steady flow: [training] unsteady.
enum class Unsteady { leave_out, use };

}  // namespace campaign

template <>
inline constexpr std::array data::texts_of<campaign::Unsteady> = {"leave_out", "use"};

namespace campaign {

/// A study that was read without problems.
struct Workspace {
  data::Study study;
  std::map<std::string, dem::Case> cases;  ///< by material; empty when the study has no [rig]
  /// Options of the surrogates as the study says; the commands that fit add rows and fitted surrogates.
  std::shared_ptr<const uq::SurrogateOptions> surrogates;
  std::string out;                   ///< results folder, absolute; made by the first write
  std::vector<std::string> changes;  ///< "study.seed=3": what StudyOptions set beside the study's file
  Unsteady unsteady = Unsteady::leave_out;
  data::PlanSection plan = {};
  std::vector<std::string> notes = {};  ///< how tables were read that are not plain CSV
};

/// Reads the study and, where it has a rig, the DEM case of each material. Throws InputError with every problem.
Workspace open_workspace(const StudyOptions& options);

/// Throws InputError (78) when the study has no [rig] to simulate.
void require_rig(const Workspace& workspace);

/// Whether demcal makes the study's runs, and not another code: [training] engine.
bool own_engine(const Workspace& workspace);
/// Throws data::InputError (78): another code makes the runs, with what to do then.
void require_own_runs(const Workspace& workspace);

/// Makes the results folder. Throws InputError (73), also when it is the study's own folder or cannot be written to.
void make_out(const Workspace& workspace, const std::string& subfolder = "");

/// The files of the results folder that a command writes: two commands at once must not write the same.
enum class Writes { training, results, run };
/// Makes the folder and holds it for those files while the result lives. Throws InputError (73), also when another
/// process holds it; the message says which.
std::unique_ptr<data::FolderLock> hold_out(const Workspace& workspace, Writes files, const std::string& command);

/// "150 rpm", or the number alone when there is no unit; five digits.
std::string with_unit(double si, const data::Unit& unit);

}  // namespace campaign
