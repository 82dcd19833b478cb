#include "data/terminal.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
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

/// Whether a stream is a terminal that may show colours (NO_COLOR: https://no-color.org).
bool takes_colours(int stream) {
  const char* const none = std::getenv("NO_COLOR");
  const char* const terminal = std::getenv("TERM");
  return ::isatty(stream) == 1 && (none == nullptr || *none == '\0') && terminal != nullptr &&
         std::string_view(terminal) != "dumb";
}

/// The words that begin a line of warning, yellow on a terminal.
std::string coloured(std::string text, int stream) {
  if (!takes_colours(stream)) return text;
  for (std::size_t at = 0; at < text.size();) {
    constexpr std::string_view word = "warning:";
    if (std::string_view(text).substr(at).starts_with(word))
      text.replace(at, word.size(), fmt::format("\x1b[33m{}\x1b[0m", word));
    at = std::min(text.find('\n', at), text.size() - 1) + 1;
  }
  return text;
}

/// A line on standard output. Returns 0 or an errno.
int write_line(std::string_view text) {
  errno = 0;
  const bool written = std::fwrite(text.data(), 1, text.size(), stdout) == text.size() && std::fputc('\n', stdout) >= 0;
  if (std::fflush(stdout) == 0 && written) return 0;
  const int error = errno != 0 ? errno : EIO;
  std::clearerr(stdout);
  return error;
}

[[noreturn]] void refuse_output(int error) {
  throw InputError(ExitStatus::cannot_write,
                   Problem{"standard output", fmt::format("cannot be written: {}", std::strerror(error)),
                           "direct it to a place with room"});
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
  const std::string shown = coloured(printable(line), STDERR_FILENO) + "\n";
  std::fwrite(shown.data(), 1, shown.size(), stderr);
  std::fflush(stderr);
  std::clearerr(stderr);
}

void print_result(std::string_view text) {
  if (const int error = write_line(text); error != 0) refuse_output(error);
}

void print_answer(std::string_view text) {
  const int error = write_line(coloured(printable(text), STDOUT_FILENO));
  if (error != 0 && error != EPIPE && error != EBADF) refuse_output(error);
}

bool answers_go_elsewhere() {
  struct stat out {
  }, err{};
  if (::fstat(STDOUT_FILENO, &out) != 0 || ::fstat(STDERR_FILENO, &err) != 0) return true;
  return out.st_dev != err.st_dev || out.st_ino != err.st_ino;
}

void guard_streams() {
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(stream, F_GETFD) < 0 && errno == EBADF) static_cast<void>(::open("/dev/null", O_RDONLY));
  std::signal(SIGPIPE, SIG_IGN);
  std::signal(SIGXFSZ, SIG_IGN);
}

}  // namespace data
