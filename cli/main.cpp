// The program: declares the commands, runs one, and turns failures into exit statuses (design: data::ExitStatus).
#include <fmt/core.h>

#include <exception>

#include "cli/command.hpp"
#include "data/provenance.hpp"

namespace {

int status(data::ExitStatus s) { return static_cast<int>(s); }

int run(int argc, char** argv) {
  CLI::App program{
      "demcal calibrates a discrete-element model of a powder in a mixer against measured torque, and says which\n"
      "parameters the measurement cannot determine."};
  program.set_version_flag("--version", "demcal " + data::program_version());
  program.require_subcommand(1);
  program.footer("Example: demcal calibrate data/developer\nHelp on a command: demcal COMMAND --help");

  std::vector<std::pair<CLI::App*, cli::Action>> commands;
  for (const auto add : {cli::add_new, cli::add_check, cli::add_simulate, cli::add_design, cli::add_train, cli::add_fit,
                         cli::add_sample, cli::add_calibrate, cli::add_report, cli::add_observe}) {
    cli::Action action = add(program);
    commands.emplace_back(program.get_subcommands({}).back(), std::move(action));
  }
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return program.exit(error) == 0 ? 0 : status(data::ExitStatus::usage);
  }
  for (const auto& [command, action] : commands)
    if (command->parsed()) return status(action());
  return status(data::ExitStatus::usage);
}

}  // namespace

int main(int argc, char** argv) {
  try {
    return run(argc, argv);
  } catch (const data::InputError& error) {
    fmt::print(stderr, "{}\n", error.what());
    return status(error.status);
  } catch (const std::exception& error) {
    fmt::print(stderr, "demcal: a defect of the program: {}\n", error.what());
    return status(data::ExitStatus::defect);
  }
}
