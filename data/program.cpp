#include "data/program.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>

extern char** environ;

namespace data {
namespace {

/// Everything that comes out of a pipe until its last writer has closed it, or that a file in memory holds. What cannot
/// be read to its end is nothing, and `error` says why.
std::string read_all(int descriptor, int& error) {
  std::string text;
  std::array<char, 4096> buffer{};
  for (;;) {
    const ssize_t got = read(descriptor, buffer.data(), buffer.size());
    if (got > 0) text.append(buffer.data(), static_cast<std::size_t>(got));
    if (got == 0) return text;
    if (got < 0 && errno != EINTR) {
      error = errno;
      return {};
    }
  }
}

std::vector<char*> environment(const std::vector<std::string>& without) {
  std::vector<char*> kept;
  for (char** variable = environ; *variable != nullptr; ++variable)
    if (std::none_of(without.begin(), without.end(),
                     [&](const std::string& start) { return std::string_view(*variable).starts_with(start); }))
      kept.push_back(*variable);
  kept.push_back(nullptr);
  return kept;
}

}  // namespace

ProgramEnd run_program(const ProgramCall& call) {
  std::array<int, 2> pipe_ends{};
  ProgramEnd result;
  // The errors go to a file in memory: of two pipes one could be full while the other is read.
  const int errors = memfd_create("demcal", MFD_CLOEXEC);
  if (errors < 0 || pipe2(pipe_ends.data(), O_CLOEXEC) != 0) {
    result.start_error = errno;
    close(errors);
    return result;
  }
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  if (!call.folder.empty()) posix_spawn_file_actions_addchdir_np(&actions, call.folder.c_str());
  posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_adddup2(&actions, pipe_ends[1], STDOUT_FILENO);
  posix_spawn_file_actions_adddup2(&actions, errors, STDERR_FILENO);
  posix_spawnattr_t attributes;
  posix_spawnattr_init(&attributes);
  if (call.spared) posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);  // a group of its own

  std::vector<std::string> words = call.words;
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  std::vector<char*> variables = environment(call.without);
  pid_t child = 0;
  result.start_error =
      posix_spawnp(&child, arguments.front(), &actions, &attributes, arguments.data(), variables.data());
  posix_spawnattr_destroy(&attributes);
  posix_spawn_file_actions_destroy(&actions);
  close(pipe_ends[1]);
  if (result.start_error == 0) {
    int unread = 0;
    result.out = read_all(pipe_ends[0], unread);
    close(pipe_ends[0]);  // who still writes into it ends
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    result.exit_status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    lseek(errors, 0, SEEK_SET);
    result.err = read_all(errors, unread);
    result.start_error = unread;
  } else {
    close(pipe_ends[0]);
  }
  close(errors);
  return result;
}

InputError cannot_start(const std::string& program, const ProgramEnd& end, const std::string& remedy) {
  const bool is_there = end.start_error != ENOENT && end.start_error != EACCES;
  return {
      ExitStatus::missing_program,
      Problem{program, fmt::format("cannot be run ({})", std::strerror(end.start_error)),
              is_there ? "try again when the system has room for another program (memory, processes, files)" : remedy}};
}

}  // namespace data
