#pragma once
// Common parts of the commands: shared options, how a command is declared, and where its words go.
#include <CLI/CLI.hpp>
#include <functional>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "campaign/study_rows.hpp"
#include "campaign/workspace.hpp"
#include "data/error.hpp"

namespace cli {

using namespace campaign;  // the commands use its names all the time

/// The action of a parsed command line.
using Action = std::function<data::ExitStatus()>;

/// For ->transform or ->check of an option: a finite number from `low` to `high`. (CLI11's own ranges let nan pass.)
CLI::Validator number_in(double low, double high, const std::string& what);

/// For ->check of an option: one of these words. For any other word the message names the one that was probably meant.
CLI::Validator one_of(const std::vector<std::string>& choices);

/// Options of every command on a study.
struct Common : StudyOptions {
  bool quiet = false;
  bool json = false;
};

/// A sub-command with the common options and an example in its help.
CLI::App* add_study_command(CLI::App& program, const std::string& name, const std::string& purpose,
                            const std::string& example, Common& common);

/// Adds --isa to a command that simulates: it pins the instruction set of the contact forces.
void add_isa_option(CLI::App& command);

/// Opens the study, read without problems, and says how its tables were read.
Workspace open_workspace(const Common& common);

/// Writes a line for the user on stderr, unless --quiet: progress, notes and warnings.
void say(const Common& common, const std::string& text);
/// Writes a line of what was asked for on stdout, unless --quiet. With --json it goes to stderr, as stdout holds JSON
/// alone.
void answer(const Common& common, const std::string& text);
/// Writes the machine-readable result on stdout, when --json is given.
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
Action add_render(CLI::App& program);
Action add_export(CLI::App& program);
Action add_help(CLI::App& program);

}  // namespace cli
