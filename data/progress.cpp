#include "data/progress.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "data/terminal.hpp"

namespace data {
namespace {

double steady_seconds() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void to_stderr(const std::string& text) {
  std::fwrite(text.data(), 1, text.size(), stderr);
  std::fflush(stderr);
}

std::size_t terminal_width() {
  winsize size{};
  return ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 20 ? size.ws_col : 80;
}

}  // namespace

std::string duration_text(double seconds) {
  const auto whole = static_cast<long long>(std::llround(std::max(0.0, seconds)));
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole / 60 % 60);
}

std::string rough_duration_text(double seconds) {
  if (seconds < 100.0) return fmt::format("{:.2g} s", seconds);
  if (seconds < 6000.0) return fmt::format("{:.2g} min", seconds / 60.0);
  if (seconds < 360000.0) return fmt::format("{:.2g} h", seconds / 3600.0);
  return fmt::format("{:.3g} days", seconds / 86400.0);
}

Progress::Progress(std::string what, std::uint64_t total, ProgressOptions options)
    : what_(std::move(what)), total_(std::max<std::uint64_t>(1, total)), options_(std::move(options)) {
  if (!options_.write) options_.write = to_stderr;
  if (!options_.clock) options_.clock = steady_seconds;
  if (options_.style == ProgressStyle::automatic) {
    options_.style = isatty(STDERR_FILENO) == 1 ? ProgressStyle::bar : ProgressStyle::lines;
  }
  start_ = options_.clock();
}

Progress::~Progress() {
  const std::lock_guard lock(mutex_);
  if (on_screen_) {
    if (!ended_) draw(options_.clock());
    options_.write("\n");
  }
}

void Progress::advance(std::uint64_t steps) {
  const std::lock_guard lock(mutex_);
  done_ = std::min(total_, done_ + steps);
  started_ = true;
  draw(options_.clock());
}

void Progress::set(std::uint64_t done) {
  const std::lock_guard lock(mutex_);
  done_ = std::min(total_, done);
  if (!started_) {  // what a resumed job had done before says nothing about its rate
    first_ = done_;
    tenths_ = static_cast<int>(10 * done_ / total_);
    start_ = options_.clock();
    started_ = true;
  }
  draw(options_.clock());
}

void Progress::note(const std::string& line) {
  const std::lock_guard lock(mutex_);
  if (options_.style == ProgressStyle::quiet) return;
  clear_bar();
  options_.write(printable(line) + "\n");
  drawn_at_ = -1e300;
}

void Progress::clear_bar() {
  if (!on_screen_) return;
  options_.write("\r\x1b[K");
  on_screen_ = false;
}

/// "12 of 80, 1.9 /s, 36 s left"
std::string Progress::summary(double now) const {
  std::vector<std::string> parts;
  if (options_.counted) parts.push_back(fmt::format("{} of {}", done_, total_));
  const double elapsed = now - start_;
  if (done_ > first_ && elapsed > 0.0) {
    const double rate = static_cast<double>(done_ - first_) / elapsed;
    if (options_.counted)
      parts.push_back(rate >= 100.0 ? fmt::format("{:.0f} /s", rate)
                      : rate >= 0.1 ? fmt::format("{:.2g} /s", rate)
                                    : fmt::format("{:.2g} /min", 60.0 * rate));
    parts.push_back(done_ == total_ ? "took " + duration_text(elapsed)
                                    : duration_text(static_cast<double>(total_ - done_) / rate) + " left");
  }
  return fmt::format("{}", fmt::join(parts, ", "));
}

void Progress::draw(double now) {
  if (options_.style == ProgressStyle::quiet) return;
  if (options_.style == ProgressStyle::lines) {
    const auto tenths = static_cast<int>(10 * done_ / total_);
    if (tenths <= tenths_) return;
    tenths_ = tenths;
    const std::string more = summary(now);
    options_.write(fmt::format("{}: {} %{}\n", what_, 10 * tenths, more.empty() ? "" : " (" + more + ")"));
    return;
  }
  if (ended_ || (done_ < total_ && now - drawn_at_ < options_.redraw_interval)) return;
  drawn_at_ = now;
  const auto cells = static_cast<std::size_t>(24 * done_ / total_);
  std::string line = fmt::format("{} [{}{}] {:3} %  {}", what_, std::string(cells, '#'), std::string(24 - cells, '.'),
                                 100 * done_ / total_, summary(now));
  if (line.size() >= terminal_width()) line.resize(terminal_width() - 1);
  options_.write("\r" + line + "\x1b[K");
  on_screen_ = true;
  ended_ = done_ == total_;
}

}  // namespace data
