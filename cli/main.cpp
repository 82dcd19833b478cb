// The program: declares the commands, runs one, and turns failures into exit statuses (design: data::ExitStatus).
#include <fmt/core.h>
#include <malloc.h>

#include <cerrno>
#include <exception>
#include <filesystem>
#include <new>
#include <sstream>
#include <stdexcept>
#include <system_error>

#include "cli/command.hpp"
#include "cli/misspelt.hpp"
#include "cli/out_of_memory.hpp"
#include "data/interrupt.hpp"
#include "data/provenance.hpp"
#include "data/terminal.hpp"

namespace {

int status(data::ExitStatus s) { return static_cast<int>(s); }

/// Keeps the memory of matrices of some hundred rows for the next one. A likelihood makes and drops them by the hundred
/// thousand, and giving each back to the system took a quarter of the time of a calibration on 400 readings.
void keep_freed_memory() {
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
  mallopt(M_TOP_PAD, 16 << 20);
}

int run(int argc, char** argv) {
  CLI::App program{
      "demcal calibrates a discrete-element model of a powder in a mixer against measured torque, and says which\n"
      "parameters the measurement cannot determine."};
  program.set_version_flag("--version", "demcal " + data::program_version());
  program.require_subcommand(1);
  program.footer(
      "Example: demcal calibrate data/developer\nHelp on a command: demcal COMMAND --help, on a key of study.toml: "
      "demcal help KEY");

  std::vector<std::pair<CLI::App*, cli::Action>> commands;
  for (const auto add : {cli::add_new, cli::add_check, cli::add_simulate, cli::add_design, cli::add_train, cli::add_fit,
                         cli::add_sample, cli::add_calibrate, cli::add_plan, cli::add_report, cli::add_observe,
                         cli::add_render, cli::add_export, cli::add_help}) {
    cli::Action action = add(program);
    commands.emplace_back(program.get_subcommands({}).back(), std::move(action));
  }
  if (argc < 2) {
    data::print_answer(program.help());
    return status(data::ExitStatus::usage);
  }
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() != 0)
      if (const std::string wrong = cli::misspelt(program, {argv + 1, argv + argc}); !wrong.empty()) {
        data::tell(wrong);
        return status(data::ExitStatus::usage);
      }
    std::ostringstream out, err;
    const int found = program.exit(error, out, err);
    const auto without_end = [](std::string text) {
      while (text.ends_with('\n')) text.pop_back();
      return text;
    };
    if (!out.str().empty()) data::print_result(without_end(out.str()));
    if (!err.str().empty()) data::tell(without_end(err.str()));
    return found == 0 ? 0 : status(data::ExitStatus::usage);
  }
  for (const auto& [command, action] : commands)
    if (command->parsed()) return status(action());
  return status(data::ExitStatus::usage);
}

int refused(data::ExitStatus exit_status, const std::string& place, const std::string& what,
            const std::string& remedy) {
  data::tell(data::describe({{place, what, remedy}}));
  return status(exit_status);
}

/// A path that the system would not follow.
int refused(const std::filesystem::filesystem_error& error) {
  const std::string path = error.path1().empty() ? "the working folder" : error.path1().string();
  const int code = error.code().value();
  const bool place_to_write = code == EROFS || code == ENOSPC || code == EDQUOT || code == EIO;
  return refused(place_to_write ? data::ExitStatus::cannot_write : data::ExitStatus::missing_input, path,
                 "cannot be used: " + error.code().message(), "check the path, its links and its rights");
}

}  // namespace

int main(int argc, char** argv) {
  data::guard_streams();
  data::exit_on_interrupt();
  cli::guard_memory();
  keep_freed_memory();
  try {
    return run(argc, argv);
  } catch (const data::InputError& error) {
    data::tell(error.what());
    return status(error.status);
  } catch (const std::bad_alloc&) {  // of a library
    cli::out_of_memory();
  } catch (const std::length_error&) {  // a vector longer than any memory
    cli::out_of_memory();
  } catch (const std::filesystem::filesystem_error& error) {
    return refused(error);
  } catch (const std::system_error& error) {
    const int code = error.code().value();
    if (code == EAGAIN || code == EMFILE || code == ENFILE)
      return refused(data::ExitStatus::bad_data, "", fmt::format("the system allows no more: {}", error.what()),
                     "use fewer --jobs or --threads, or raise the limits (ulimit -n, ulimit -u)");
    data::tell(fmt::format("demcal: a defect of the program: {}", error.what()));
    return status(data::ExitStatus::defect);
  } catch (const std::exception& error) {
    data::tell(fmt::format("demcal: a defect of the program: {}", error.what()));
    return status(data::ExitStatus::defect);
  }
}
