#include "data/child_process.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>

extern char** environ;

namespace data {
namespace {

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

}  // namespace

ChildResult run_child(const std::string& folder, const std::vector<std::string>& words) {
  // Its output comes through a pipe, its errors go to a file in memory, so that neither waits for the other to be read.
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

  std::vector<std::string> own = words;
  std::vector<char*> arguments;
  for (std::string& word : own) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  pid_t child = 0;
  result.start_error = posix_spawnp(&child, own.front().c_str(), &actions, nullptr, arguments.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  close(pipe_ends[1]);
  if (result.start_error == 0) {
    result.out = read_all(pipe_ends[0]);
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    result.exit_status = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    lseek(errors, 0, SEEK_SET);
    result.err = read_all(errors);
  }
  close(errors);
  close(pipe_ends[0]);
  return result;
}

}  // namespace data
