// Temporary names are NAME.MACHINE-PROCESS-N.tmp. Those of processes of this machine that are gone are removed, once
// for each folder that is written to.
#include "data/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <set>

#include "data/error.hpp"
#include "data/folder_lock.hpp"
#include "data/origin.hpp"

namespace data {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void cannot_write(const std::string& path, int error) {
  throw InputError(ExitStatus::cannot_write, Problem{path, fmt::format("cannot be written: {}", std::strerror(error)),
                                                     "choose another folder with --out, or make room or rights there"});
}

/// Forces a file or folder to the disk; 0 or an errno.
int sync(const std::string& path, int flags) {
  const int descriptor = ::open(path.c_str(), flags | O_CLOEXEC);
  if (descriptor < 0) return errno;
  const int error = ::fsync(descriptor) == 0 ? 0 : errno;
  ::close(descriptor);
  return error == EINVAL || error == EROFS ? 0 : error;  // some file systems have nothing to force
}

/// Whether a file's name is that of a temporary file whose process on this machine has ended.
bool is_left_over(const std::string& name) {
  const std::string own = fmt::format(".{}-", machine_name());
  const std::size_t at = name.rfind(own);
  if (at == std::string::npos || !name.ends_with(".tmp")) return false;
  const char *begin = name.data() + at + own.size(), *end = name.data() + name.size();
  long process = 0;
  const auto [rest, error] = std::from_chars(begin, end, process);
  if (error != std::errc{} || rest == end || *rest != '-' || process <= 0) return false;
  return ::kill(static_cast<pid_t>(process), 0) != 0 && errno == ESRCH;
}

void remove_left_over(const fs::path& folder) {
  static std::mutex mutex;
  static std::set<std::string> done;
  const std::lock_guard lock(mutex);
  if (!done.insert(folder.string()).second) return;
  std::error_code failure;
  for (fs::directory_iterator entry(folder, failure), end; !failure && entry != end; entry.increment(failure)) {
    std::error_code ignored;
    if (is_left_over(entry->path().filename().string())) fs::remove(entry->path(), ignored);
  }
}

/// A failure of what was written under a temporary name, told with the file's own.
InputError renamed(const InputError& error, const std::string& temporary, const std::string& path) {
  std::vector<Problem> problems = error.problems;
  for (Problem& problem : problems) {
    if (const std::size_t at = problem.place.find(temporary); at != std::string::npos)
      problem.place.replace(at, temporary.size(), path);
    else if (error.status == ExitStatus::cannot_write && !problem.place.starts_with(path))
      problem.place = problem.place.empty() ? path : path + ": " + problem.place;
  }
  return {error.status, std::move(problems)};
}

/// Throws where it cannot be read: a file that is taken for another kind would get no mark.
bool is_hdf5(const std::string& path) {
  char start[4] = {};
  std::FILE* file = std::fopen(path.c_str(), "rbe");
  if (file == nullptr) cannot_write(path, errno);
  errno = 0;
  const std::size_t got = std::fread(start, 1, sizeof start, file);
  const int error = errno;
  std::fclose(file);
  std::error_code unknown;
  if (got < sizeof start && fs::file_size(path, unknown) >= sizeof start) cannot_write(path, error != 0 ? error : EIO);
  return std::memcmp(start, "\x89HDF", sizeof start) == 0;
}

/// Makes the folder of `path` and writes by way of a temporary file.
void write_through(const std::string& path, const std::function<void(const std::string& temporary)>& write) {
  static std::atomic<unsigned> serial{0};
  const fs::path folder = fs::path(path).has_parent_path() ? fs::path(path).parent_path() : fs::path(".");
  std::error_code made, error;
  fs::create_directories(folder, made);
  if (made && !fs::is_directory(folder, error)) cannot_write(folder.string(), made.value());
  if (fs::is_directory(path, error)) cannot_write(path, EISDIR);
  if (::access(folder.c_str(), W_OK | X_OK) != 0) cannot_write(path, errno);
  remove_left_over(folder);

  const std::string temporary = fmt::format("{}.{}-{}-{}.tmp", path, machine_name(), ::getpid(), serial++);
  try {
    write(temporary);
    if (const int failed = sync(temporary, O_RDONLY)) cannot_write(path, failed);
    if (::rename(temporary.c_str(), path.c_str()) != 0) cannot_write(path, errno);
  } catch (const InputError& failed) {
    ::unlink(temporary.c_str());
    throw renamed(failed, temporary, path);
  } catch (...) {
    ::unlink(temporary.c_str());
    throw;
  }
  if (const int failed = sync(folder.string(), O_RDONLY | O_DIRECTORY)) cannot_write(path, failed);
}

/// Opens a file to read. A pipe without a writer would wait for ever, and a device may have no end: both are refused.
int open_to_read(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  const int error = errno;
  struct stat at {};
  const auto refuse = [&](const std::string& what, const std::string& remedy) {
    if (descriptor >= 0) ::close(descriptor);
    throw InputError(ExitStatus::missing_input, Problem{shown_path(path), what, remedy});
  };
  if (descriptor < 0 && (error == ENOENT || error == ENOTDIR)) refuse("there is no such file", "check the name");
  if (descriptor < 0)
    refuse(fmt::format("cannot be read: {}", std::strerror(error)), "check its rights and that it is a file");
  ::fstat(descriptor, &at);
  if (S_ISDIR(at.st_mode)) refuse("cannot be read: it is a folder", "name a file in it");
  if (!S_ISREG(at.st_mode))
    refuse("cannot be read: it is a pipe or a device, not a file", "write it to a file first, and name that");
  return descriptor;
}

}  // namespace

void write_bytes(const std::string& path, std::string_view bytes) {
  std::FILE* file = std::fopen(path.c_str(), "wbe");
  if (file == nullptr) cannot_write(path, errno);
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), file) == bytes.size();
  const int write_error = errno;
  if (std::fclose(file) != 0 || !written) cannot_write(path, written ? errno : write_error);
}

void require_replaceable(const std::string& path, Changed changed) {
  switch (origin_of(path)) {
    case Origin::absent:
    case Origin::ours:
    case Origin::unmarked:
      return;
    case Origin::changed:
      if (changed == Changed::replace) return;
      throw InputError(ExitStatus::cannot_write,
                       Problem{path, "was changed since demcal wrote it, and is not replaced",
                               "move it away, or remove it, or choose another name or folder with --out"});
    case Origin::foreign:
      std::error_code ignored;
      if (fs::is_directory(path, ignored)) cannot_write(path, EISDIR);
      throw InputError(ExitStatus::cannot_write,
                       Problem{path, "is there already and was not written by demcal, so it is not replaced",
                               "move it away, or choose another name or folder with --out"});
  }
}

void write_atomically(const std::string& path, const std::function<void(const std::string& temporary)>& write) {
  require_replaceable(path);
  write_through(path, [&](const std::string& temporary) {
    write(temporary);
    if (!is_hdf5(temporary)) return;
    if (const int failed = append_mark(temporary)) cannot_write(path, failed);
  });
}

void write_atomically(const std::string& path, std::string_view content, Changed changed) {
  require_replaceable(path, changed);
  const std::string marked = with_mark(std::string(content), path);
  write_through(path, [&](const std::string& temporary) { write_bytes(temporary, marked); });
}

void require_file(const std::string& path) { ::close(open_to_read(path)); }

std::string read_file(const std::string& path) {
  const int descriptor = open_to_read(path);
  std::string content;
  struct stat at {};
  ::fstat(descriptor, &at);
  ssize_t got = 1;
  int error = 0;
  try {
    content.resize(static_cast<std::size_t>(at.st_size) + 1);  // one more: a file that grows goes on
    std::size_t filled = 0;
    while (got != 0) {
      if (filled == content.size()) content.resize(2 * filled);
      got = ::read(descriptor, content.data() + filled, content.size() - filled);
      if (got < 0 && errno == EINTR) continue;
      if (got < 0) {
        error = errno;
        break;
      }
      filled += static_cast<std::size_t>(got);
    }
    content.resize(filled);
  } catch (...) {
    ::close(descriptor);
    throw;
  }
  ::close(descriptor);
  if (error != 0)
    throw InputError(ExitStatus::missing_input,
                     Problem{shown_path(path), fmt::format("cannot be read: {}", std::strerror(error)),
                             "check its rights and that it is a file"});
  return content;
}

std::string shown_path(const std::string& path) {
  std::error_code error;
  const std::string near = fs::proximate(path, error).string();
  return error || near.empty() || near.rfind("..", 0) == 0 ? path : near;
}

}  // namespace data
