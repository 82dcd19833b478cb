#include "data/origin.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <memory>
#include <optional>
#include <system_error>
#include <vector>

#include "data/atomic_file.hpp"
#include "data/error.hpp"

namespace data {
namespace {

constexpr std::string_view words = "written by demcal, digest ";
constexpr std::size_t digits = 32, head = 4096, tail = 256;
constexpr std::string_view hdf5_signature = "\x89HDF\r\n\x1a\n";

/// XXH3 with 128 bits of what is added piece by piece.
class Hasher {
 public:
  Hasher() { XXH3_128bits_reset(state_.get()); }
  void add(std::string_view bytes) { XXH3_128bits_update(state_.get(), bytes.data(), bytes.size()); }
  std::string text() const {
    const XXH128_hash_t hash = XXH3_128bits_digest(state_.get());
    return fmt::format("{:016x}{:016x}", hash.high64, hash.low64);
  }

 private:
  struct Free {
    void operator()(XXH3_state_t* state) const { XXH3_freeState(state); }
  };
  std::unique_ptr<XXH3_state_t, Free> state_{XXH3_createState()};
};

/// Where the digits of a mark are: the last mark of the end, else the first of the beginning.
std::optional<std::size_t> digits_at(std::string_view beginning, std::string_view ending, std::size_t ending_at) {
  const auto whole = [](std::string_view text, std::size_t at) {
    const std::string_view found = text.substr(at + words.size(), digits);
    return found.size() == digits && found.find_first_not_of("0123456789abcdef") == std::string_view::npos;
  };
  if (const auto at = ending.rfind(words); at != std::string_view::npos && whole(ending, at))
    return ending_at + at + words.size();
  if (const auto at = beginning.find(words); at != std::string_view::npos && whole(beginning, at))
    return at + words.size();
  return {};
}

std::optional<std::size_t> digits_of(std::string_view bytes) {
  const std::size_t ending_at = bytes.size() - std::min(bytes.size(), tail);
  return digits_at(bytes.substr(0, head), bytes.substr(ending_at), ending_at);
}

std::string digest_of(std::string_view bytes, std::size_t at) {
  Hasher hasher;
  hasher.add(bytes.substr(0, at));
  hasher.add(std::string(digits, '0'));
  hasher.add(bytes.substr(at + digits));
  return hasher.text();
}

/// Whether a file ends within its mark.
bool cut_in_mark(std::string_view ending) {
  const std::string mark = "\n" + std::string(words);
  if (ending.find(mark) != std::string_view::npos) return true;
  for (std::size_t length = mark.size(); length >= 4; --length)
    if (ending.ends_with(std::string_view(mark).substr(0, length))) return true;
  return false;
}

/// The origin of a file that has no whole mark.
Origin without_mark(std::string_view beginning, std::string_view ending) {
  const bool ours = beginning.substr(0, hdf5_signature.size()) == hdf5_signature &&
                    beginning.find("demcal") != std::string_view::npos;
  if (!ours) return Origin::foreign;
  return cut_in_mark(ending) ? Origin::changed : Origin::unmarked;
}

struct Descriptor {
  int number;
  explicit Descriptor(int opened) : number(opened) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (number >= 0) ::close(number);
  }
};

/// Throws std::system_error: a file that cannot be read at the moment must not pass for a damaged one.
std::string read_part(int file, std::size_t from, std::size_t count) {
  std::string part(count, '\0');
  std::size_t got = 0;
  while (got < count) {
    const ssize_t now = ::pread(file, part.data() + got, count - got, static_cast<off_t>(from + got));
    if (now < 0 && errno == EINTR) continue;
    if (now < 0) throw std::system_error(errno, std::generic_category());
    if (now == 0) break;
    got += static_cast<std::size_t>(now);
  }
  part.resize(got);
  return part;
}

/// The digest of an open file, zeros in the place of its own.
std::string digest_of_file(int file, std::size_t size, std::size_t at) {
  constexpr std::size_t step = std::size_t{1} << 20;
  Hasher hasher;
  for (std::size_t from = 0; from < size; from += step) {
    std::string part = read_part(file, from, std::min(step, size - from));
    for (std::size_t i = std::max(at, from); i < std::min(at + digits, from + part.size()); ++i) part[i - from] = '0';
    hasher.add(part);
  }
  return hasher.text();
}

Origin origin_of_file(int file, std::size_t size) {
  if (size == 0) return Origin::absent;
  const std::size_t ending_at = size - std::min(size, tail);
  const std::string ending = read_part(file, ending_at, size - ending_at);
  const auto at = digits_at(read_part(file, 0, std::min(size, head)), ending, ending_at);
  if (at) return read_part(file, *at, digits) == digest_of_file(file, size, *at) ? Origin::ours : Origin::changed;
  return without_mark(read_part(file, 0, std::min(size, std::size_t{1} << 20)), ending);
}

}  // namespace

Origin origin_of(const std::string& path) {
  struct stat at {};
  if (::stat(path.c_str(), &at) != 0) return errno == ENOENT || errno == ENOTDIR ? Origin::absent : Origin::foreign;
  if (!S_ISREG(at.st_mode)) return Origin::foreign;
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.number < 0) return Origin::foreign;
  try {
    return origin_of_file(file.number, static_cast<std::size_t>(at.st_size));
  } catch (const std::system_error& error) {
    throw InputError(ExitStatus::missing_input, Problem{shown_path(path), "cannot be read: " + error.code().message(),
                                                        "check the disk; nothing of it is replaced"});
  }
}

Origin origin_of_bytes(std::string_view bytes) {
  if (bytes.empty()) return Origin::absent;
  if (const auto at = digits_of(bytes))
    return bytes.substr(*at, digits) == digest_of(bytes, *at) ? Origin::ours : Origin::changed;
  return without_mark(bytes.substr(0, std::size_t{1} << 20), bytes.substr(bytes.size() - std::min(bytes.size(), tail)));
}

std::string blank_mark() { return std::string(words) + std::string(digits, '0'); }

std::string with_mark(std::string content, const std::string& path) {
  const std::string blank = blank_mark(), ending = std::filesystem::path(path).extension().string();
  if (!content.empty() && content.find(blank) == std::string::npos) {
    if (ending == ".csv") {
      content.insert(0, "# " + blank + "\n");
    } else if (ending == ".dat" || ending == ".gp") {
      content += "# " + blank + "\n";
    } else if (ending == ".svg" || ending == ".html") {
      content += "<!-- " + blank + " -->\n";
    } else if (content.starts_with("\x89PNG")) {
      content += "\n" + blank + "\n";  // a picture ends before it, at its IEND chunk
    } else if (ending == ".json" && content.front() == '{') {
      content.insert(1, fmt::format("\"origin\":\"{}\"{}", blank,
                                    content.find_first_not_of(" \n", 1) == content.find('}') ? "" : ","));
    }
  }
  if (const auto at = digits_of(content)) {
    const std::string digest = digest_of(content, *at);
    content.replace(*at, digits, digest);
  }
  return content;
}

int append_mark(const std::string& path) {
  const Descriptor file(::open(path.c_str(), O_RDWR | O_APPEND | O_CLOEXEC));
  struct stat at {};
  if (file.number < 0 || ::fstat(file.number, &at) != 0) return errno;
  // The digest is of the file with the mark in it, so the blank mark is hashed behind the file's bytes.
  const auto size = static_cast<std::size_t>(at.st_size);
  const std::string blank = "\n" + blank_mark() + "\n";
  constexpr std::size_t step = std::size_t{1} << 20;
  Hasher hasher;
  try {
    for (std::size_t from = 0; from < size; from += step)
      hasher.add(read_part(file.number, from, std::min(step, size - from)));
  } catch (const std::system_error& error) {
    return error.code().value();
  }
  hasher.add(blank);
  const std::string mark = "\n" + std::string(words) + hasher.text() + "\n";
  errno = 0;
  const ssize_t written = ::write(file.number, mark.data(), mark.size());
  if (written == static_cast<ssize_t>(mark.size())) return 0;
  return errno != 0 ? errno : ENOSPC;
}

void remove_mark(const std::string& path) {
  const std::size_t length = blank_mark().size() + 2;
  std::error_code failure;
  const auto size = std::filesystem::file_size(path, failure);
  if (failure || size < length) return;
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK));
  if (file.number < 0 || read_part(file.number, size - length, words.size() + 1) != "\n" + std::string(words)) return;
  std::filesystem::resize_file(path, size - length, failure);
}

void require_unchanged(const std::string& path, const std::string& remedy, Strict strict) {
  const Origin origin = origin_of(path);
  if (origin == Origin::changed)
    throw InputError(ExitStatus::bad_data,
                     Problem{shown_path(path), "is damaged: it is not what demcal wrote, byte for byte", remedy});
  if ((origin == Origin::foreign || origin == Origin::unmarked) && strict == Strict::yes)
    throw InputError(ExitStatus::bad_data,
                     Problem{shown_path(path), "is damaged, or was not written by this demcal", remedy});
}

}  // namespace data
