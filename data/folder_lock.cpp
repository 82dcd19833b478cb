// The file is removed while the lock is held. One who opened it before must therefore see, once the lock is theirs,
// that the file at the path is still the one they hold, and else start over.
#include "data/folder_lock.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <sstream>

#include "data/error.hpp"
#include "data/provenance.hpp"

namespace data {
namespace {

namespace fs = std::filesystem;

struct Holder {
  long process = 0;
  std::string machine, rest;
};

Holder read_holder(int file) {
  std::array<char, 512> text{};
  const ssize_t got = ::pread(file, text.data(), text.size() - 1, 0);
  std::istringstream words(std::string(text.data(), got > 0 ? static_cast<std::size_t>(got) : 0));
  Holder holder;
  words >> holder.process >> holder.machine >> std::ws;
  std::getline(words, holder.rest);
  return holder;
}

[[noreturn]] void cannot_lock(const std::string& path, int error) {
  throw InputError(ExitStatus::cannot_write, Problem{path, fmt::format("cannot be written: {}", std::strerror(error)),
                                                     "choose another folder with --out, or make room or rights there"});
}

[[noreturn]] void held(const std::string& folder, const Holder& holder) {
  const std::string who = holder.process > 0
                              ? fmt::format("process {} on {} ({})", holder.process, holder.machine, holder.rest)
                              : std::string("another process");
  throw InputError(ExitStatus::cannot_write, Problem{folder, fmt::format("is in use by {}", who),
                                                     "wait for it, or choose another folder with --out"});
}

/// A file system without locks: whether the process in the file is gone, as far as this machine can tell.
bool is_gone(const Holder& holder) {
  return holder.process <= 0 ||
         (holder.machine == machine_name() && ::kill(static_cast<pid_t>(holder.process), 0) != 0 && errno == ESRCH);
}

}  // namespace

std::string machine_name() {
  std::array<char, 256> name{};
  if (::gethostname(name.data(), name.size() - 1) != 0 || name[0] == '\0') return "localhost";
  std::string text(name.data());
  for (char& c : text)
    if (c == '/' || c == ' ') c = '_';
  return text;
}

FolderLock::FolderLock(const std::string& folder, const std::string& name, const std::string& doing)
    : path_((fs::path(folder) / ("." + name + ".lock")).string()) {
  std::error_code failure;
  fs::create_directories(folder, failure);
  if (failure) cannot_lock(folder, failure.value());
  for (;;) {
    file_ = ::open(path_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC | O_NOFOLLOW, 0666);
    if (file_ < 0) cannot_lock(folder, errno);
    struct stat mine {
    }, there{};
    ::fstat(file_, &mine);
    const bool locked = S_ISREG(mine.st_mode) && ::flock(file_, LOCK_EX | LOCK_NB) == 0;
    const int error = locked ? 0 : errno;
    const Holder holder = read_holder(file_);
    const bool no_locks = !locked && error != EWOULDBLOCK;
    if (!locked && !(no_locks && is_gone(holder))) {
      ::close(file_);
      held(folder, holder);
    }
    if (::stat(path_.c_str(), &there) == 0 && there.st_ino == mine.st_ino && there.st_dev == mine.st_dev) break;
    ::close(file_);  // its holder ended in between and took the file away
  }
  const std::string text = fmt::format("{} {} {}, since {}\n", ::getpid(), machine_name(), doing, utc_now());
  if (::ftruncate(file_, 0) != 0 || ::pwrite(file_, text.data(), text.size(), 0) != static_cast<ssize_t>(text.size())) {
    const int error = errno;
    ::unlink(path_.c_str());
    ::close(file_);
    cannot_lock(folder, error != 0 ? error : ENOSPC);
  }
}

FolderLock::~FolderLock() {
  ::unlink(path_.c_str());
  ::close(file_);
}

}  // namespace data
