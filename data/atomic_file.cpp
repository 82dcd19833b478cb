#include "data/atomic_file.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "data/error.hpp"

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

}  // namespace

void write_atomically(const std::string& path, const std::function<void(const std::string& temporary)>& write) {
  static std::atomic<unsigned> serial{0};
  const fs::path folder = fs::path(path).has_parent_path() ? fs::path(path).parent_path() : fs::path(".");
  std::error_code error;
  fs::create_directories(folder, error);
  if (error && !fs::is_directory(folder)) cannot_write(folder.string(), error.value());
  if (fs::is_directory(path, error)) cannot_write(path, EISDIR);
  if (::access(folder.c_str(), W_OK | X_OK) != 0) cannot_write(path, errno);

  const std::string temporary = fmt::format("{}.{}-{}.tmp", path, ::getpid(), serial++);
  try {
    write(temporary);
    if (const int failed = sync(temporary, O_RDONLY)) cannot_write(path, failed);
    if (::rename(temporary.c_str(), path.c_str()) != 0) cannot_write(path, errno);
  } catch (...) {
    ::unlink(temporary.c_str());
    throw;
  }
  if (const int failed = sync(folder.string(), O_RDONLY | O_DIRECTORY)) cannot_write(path, failed);
}

void write_atomically(const std::string& path, std::string_view content) {
  write_atomically(path, [&](const std::string& temporary) {
    std::FILE* file = std::fopen(temporary.c_str(), "wbe");
    if (file == nullptr) cannot_write(path, errno);
    const bool written = std::fwrite(content.data(), 1, content.size(), file) == content.size();
    const int write_error = errno;
    if (std::fclose(file) != 0 || !written) cannot_write(path, written ? errno : write_error);
  });
}

std::string read_file(const std::string& path) {
  std::ifstream stream(path, std::ios::binary);
  std::error_code ignored;
  if (!stream || fs::is_directory(path, ignored)) {
    const bool there = fs::exists(path, ignored);
    throw InputError(ExitStatus::missing_input,
                     Problem{shown_path(path), there ? "cannot be read" : "there is no such file",
                             there ? "check its rights and that it is a file" : "check the name"});
  }
  std::ostringstream content;
  content << stream.rdbuf();
  return content.str();
}

std::string shown_path(const std::string& path) {
  std::error_code error;
  const std::string near = fs::proximate(path, error).string();
  return error || near.empty() || near.rfind("..", 0) == 0 ? path : near;
}

}  // namespace data
