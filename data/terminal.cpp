#include "data/terminal.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>

#include "data/error.hpp"
#include "data/text_encoding.hpp"

namespace data {
namespace {

/// Controls of C1, and those that turn the direction of writing or hide.
bool acts(std::uint32_t code) {
  return code < 0x20 || (code >= 0x7f && code < 0xa0) || (code >= 0x200b && code <= 0x200f) ||
         (code >= 0x2028 && code <= 0x202e) || (code >= 0x2060 && code <= 0x206f) || code == 0xfeff;
}

}  // namespace

std::string printable(std::string_view text) {
  std::string shown;
  shown.reserve(text.size());
  for (std::size_t at = 0; at < text.size();) {
    const CodePoint next = utf8_at(text, at);
    if (!next.valid) {
      shown += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[at]));
    } else if (acts(next.code) && text[at] != '\n' && text[at] != '\t') {
      shown += next.code < 0x80 ? fmt::format("\\x{:02x}", next.code) : fmt::format("\\u{:04x}", next.code);
    } else {
      shown += text.substr(at, next.length);
    }
    at += next.length;
  }
  return shown;
}

void tell(std::string_view line) {
  const std::string shown = printable(line) + "\n";
  std::fwrite(shown.data(), 1, shown.size(), stderr);
  std::fflush(stderr);
  std::clearerr(stderr);
}

void print_result(std::string_view text) {
  errno = 0;
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fputc('\n', stdout) >= 0;
  if (std::fflush(stdout) == 0 && written) return;
  const int error = errno;
  std::clearerr(stdout);
  throw InputError(ExitStatus::cannot_write,
                   Problem{"standard output", fmt::format("cannot be written: {}", std::strerror(error)),
                           "direct it to a place with room"});
}

void guard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(stream, F_GETFD) < 0 && errno == EBADF) static_cast<void>(::open("/dev/null", O_RDONLY));
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

}  // namespace data
