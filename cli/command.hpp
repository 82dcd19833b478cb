#pragma once
// What the commands share: common options, the opened study, and how a command is declared.
#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "data/error.hpp"
#include "data/finding.hpp"
#include "data/folder_lock.hpp"
#include "data/plan.hpp"
#include "data/run_table.hpp"
#include "data/study.hpp"
#include "data/study_file.hpp"
#include "dem/case.hpp"

namespace uq {
struct SurrogateOptions;
}

namespace cli {

/// What a parsed command line does.
using Action = std::function<data::ExitStatus()>;

/// For ->transform or ->check of an option: a finite number from `low` to `high`. (CLI11's own ranges let nan pass.)
CLI::Validator number_in(double low, double high, const std::string& what);

/// For ->check of an option: one of these words; for another, the one that was meant.
CLI::Validator one_of(const std::vector<std::string>& choices);

/// Options of every command on a study.
struct Common {
  std::string study;                  ///< file, or folder that holds study.toml
  std::string out;                    ///< results; by default ./STUDY-NAME
  std::optional<std::uint64_t> seed;  ///< instead of the study's
  bool quiet = false;
  bool json = false;
  std::vector<std::string> set;  ///< "study.key=VALUE"
};

/// A sub-command with the common options and an example in its help.
CLI::App* add_study_command(CLI::App& program, const std::string& name, const std::string& purpose,
                            const std::string& example, Common& common);

/// --isa of a command that simulates: pins the instruction set of the contact forces.
void add_isa_option(CLI::App& command);

/// What becomes of runs that are not of the steady flow: [training] unsteady.
enum class Unsteady { leave_out, use };

/// A study that was read without problems.
struct Workspace {
  data::Study study;
  std::map<std::string, dem::Case> cases;  ///< by material; empty when the study has no [rig]
  /// As the study says; rows and fitted surrogates are added by the commands that fit.
  std::shared_ptr<const uq::SurrogateOptions> surrogates;
  std::string out;                   ///< results folder, absolute; made by the first write
  std::vector<std::string> changes;  ///< "study.seed=3": what the command line sets beside the study's file
  Unsteady unsteady = Unsteady::leave_out;
  data::PlanSection plan = {};
};

/// Reads the study and, where it has a rig, the DEM case of each material. Throws InputError with every problem.
Workspace open_workspace(const Common& common);

/// Throws InputError (78) when the study has no [rig] to simulate.
void require_rig(const Workspace& workspace);

/// Makes the results folder. Throws InputError (73), also when it is the study's own folder or cannot be written to.
void make_out(const Workspace& workspace, const std::string& subfolder = "");

/// Which files of the results folder a command writes: two commands at once must not write the same.
enum class Writes { training, results, run };
/// Makes the folder and holds it for those files while the result lives. Throws InputError (73), also when another
/// process holds it; the message says which.
std::unique_ptr<data::FolderLock> hold_out(const Workspace& workspace, Writes files, const std::string& command);

/// The rows shipped with the study and those in OUT/training.h5, merged; rows of other settings are left out.
struct TrainingRows {
  data::RunTable all;                   ///< whatever their state
  data::RunTable table;                 ///< to fit: of the steady flow, without outputs whose errors are not known
  std::optional<data::RunTable> low;    ///< rows of the cheaper level, where the study names some
  std::vector<std::string> notes;       ///< rows left out and why
  std::vector<data::RunRow> kept;       ///< rows of OUT/training.h5 under other settings: left out, and written back
  std::vector<data::Finding> findings;  ///< of who read the tables
};
TrainingRows training_rows(const Workspace& workspace);

/// "150 rpm", or the number alone when there is no unit; five digits.
std::string with_unit(double si, const data::Unit& unit);

/// A line for the user on stderr, unless --quiet: progress, notes and warnings.
void say(const Common& common, const std::string& text);
/// A line of what was asked for on stdout, unless --quiet. With --json it goes to stderr, as stdout holds JSON alone.
void answer(const Common& common, const std::string& text);
/// The machine-readable result on stdout, when --json.
void print_json(const Common& common, const nlohmann::json& result);

Action add_new(CLI::App& program);
Action add_check(CLI::App& program);
Action add_simulate(CLI::App& program);
Action add_design(CLI::App& program);
Action add_train(CLI::App& program);
Action add_fit(CLI::App& program);
Action add_sample(CLI::App& program);
Action add_calibrate(CLI::App& program);
Action add_plan(CLI::App& program);
Action add_report(CLI::App& program);
Action add_observe(CLI::App& program);
Action add_help(CLI::App& program);

}  // namespace cli
