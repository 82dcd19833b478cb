#include "uq/report/gnuplot.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <stdexcept>
#include <utility>

#include "data/atomic_file.hpp"
#include "data/error.hpp"
#include "data/file_name.hpp"
#include "uq/findings/wording.hpp"

extern char** environ;

namespace uq {
namespace {

struct ChildResult {
  int start_error = 0;  ///< errno of the start
  int exit_status = 0;  ///< of the program; 128 + signal when it was killed
  std::string drawn;    ///< on its standard output
  std::string said;     ///< on its standard error
};

/// Everything that comes out of a pipe until its last writer has closed it, or that a file in memory holds.
std::string read_all(int descriptor) {
  std::string text;
  std::array<char, 4096> buffer{};
  for (;;) {
    const ssize_t got = read(descriptor, buffer.data(), buffer.size());
    if (got > 0) text.append(buffer.data(), static_cast<std::size_t>(got));
    if (got == 0 || (got < 0 && errno != EINTR)) return text;
  }
}

/// Runs `program -d -e to_stdout=1 STEM.gp` in `folder`; the picture comes through a pipe, which no full disk cuts off.
/// "-d" keeps the user's and the system's start-up files out of the figures.
ChildResult run_in(const std::string& folder, const std::string& program, const std::string& script) {
  std::array<int, 2> pipe_ends{};
  ChildResult result;
  const int errors = memfd_create("demcal", MFD_CLOEXEC);
  if (errors < 0 || pipe2(pipe_ends.data(), O_CLOEXEC) != 0) {
    result.start_error = errno;
    close(errors);
    return result;
  }
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, pipe_ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, errors, STDERR_FILENO);

  std::string name = program, defaults = "-d", command = "-e", to_stdout = "to_stdout=1", file = script;
  std::array<char*, 6> arguments{name.data(), defaults.data(), command.data(), to_stdout.data(), file.data(), nullptr};
  pid_t child = 0;
  result.start_error = posix_spawnp(&child, program.c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(pipe_ends[1]);
  if (result.start_error == 0) {
    result.drawn = read_all(pipe_ends[0]);
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    result.exit_status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    lseek(errors, 0, SEEK_SET);
    result.said = read_all(errors);
  }
  close(errors);
  close(pipe_ends[0]);
  return result;
}

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
    text.replace(at, from.size(), to);
  }
}

/// Cuts out every element `name`, with what it holds.
void remove_elements(std::string& text, const std::string& name) {
  const std::string closing = "</" + name + ">";
  for (std::size_t at = 0; (at = text.find("<" + name, at)) != std::string::npos;) {
    const std::size_t end = text.find(closing, at);
    if (end == std::string::npos) return;
    text.erase(at, end + closing.size() - at);
  }
}

}  // namespace

std::string gnuplot_text(std::string_view text) {
  std::string literal = "'";
  for (const char c : text) {
    if (c == '\'') literal += '\'';
    literal += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return literal + "'";
}

std::string inline_svg(std::string_view svg, std::string_view prefix, std::string_view alt) {
  const std::size_t start = svg.find("<svg");
  if (start == std::string_view::npos) return {};
  std::string text(svg.substr(start));
  remove_elements(text, "script");
  remove_elements(text, "title");
  remove_elements(text, "desc");
  const std::string id = std::string(prefix) + "-";
  for (const char quote : {'"', '\''}) {
    replace_all(text, fmt::format(" id={}", quote), fmt::format(" id={}{}", quote, id));
    replace_all(text, fmt::format("href={}#", quote), fmt::format("href={}#{}", quote, id));
  }
  replace_all(text, "url(#", "url(#" + id);
  text.insert(4, fmt::format(" role=\"img\" aria-label=\"{}\"", escape_html(alt)));
  return text;
}

std::string draw(const Figure& figure, const std::string& folder, const GnuplotOptions& options) {
  namespace fs = std::filesystem;
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure) {
    throw data::InputError(data::ExitStatus::cannot_write,
                           {folder, "cannot make the folder: " + failure.message(), "choose another --out"});
  }
  if (!data::is_file_name(figure.stem)) throw std::invalid_argument("a figure's stem is no slug: " + figure.stem);
  const std::string script = fmt::format(
      "set encoding utf8\n"
      "set terminal svg size {},{} dynamic noenhanced font 'sans-serif,13' linewidth 1.2 background rgb 'white'\n"
      "if (!exists('to_stdout')) set output '{}.svg'\n{}\nunset output\n",
      figure.width, figure.height, figure.stem, figure.script);
  const std::string base = (fs::path(folder) / figure.stem).string();
  for (const char* ending : {".dat", ".gp", ".svg"}) data::require_replaceable(base + ending);
  data::write_atomically(base + ".dat", figure.data);
  data::write_atomically(base + ".gp", script);

  const ChildResult result = run_in(folder, options.program, figure.stem + ".gp");
  if (result.start_error != 0) {
    throw data::InputError(data::ExitStatus::missing_program,
                           {options.program,
                            fmt::format("cannot be started ({}), but the report's figures are drawn with it",
                                        std::strerror(result.start_error)),
                            "install it: apt-get install gnuplot-nox"});
  }
  const std::string& svg = result.drawn;
  if (result.exit_status != 0 || svg.find("</svg>") == std::string::npos) {
    throw data::InputError(
        data::ExitStatus::missing_program,
        {base + ".gp", fmt::format("gnuplot failed (exit status {}) and said: {}", result.exit_status, result.said),
         "demcal needs gnuplot 5.2 or later with the svg terminal: apt-get install gnuplot-nox"});
  }
  data::write_atomically(base + ".svg", svg);
  return inline_svg(svg, figure.stem, figure.alt);
}

}  // namespace uq
