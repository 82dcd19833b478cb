// A signal handler may do next to nothing: it writes a byte to a pipe, and a thread that reads the pipe requests the
// stop. The second signal ends the program with the job's exit status 75, whatever state it is in.
#include "data/interrupt.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cassert>
#include <cerrno>
#include <csignal>
#include <system_error>
#include <thread>

#include "data/error.hpp"

namespace data {
namespace {

std::atomic<int> pipe_end{-1};
std::atomic<int> signals_seen{0};
static_assert(std::atomic<int>::is_always_lock_free);

void on_signal(int) {
  const int saved = errno;
  if (signals_seen.fetch_add(1) > 0) _exit(static_cast<int>(ExitStatus::interrupted));
  const char byte = 's';
  [[maybe_unused]] const auto written = ::write(pipe_end.load(), &byte, 1);
  errno = saved;
}

}  // namespace

struct InterruptGuard::Listener {
  int ends[2] = {-1, -1};
  struct sigaction old_int {
  }, old_term{};
  std::thread thread;
};

InterruptGuard::InterruptGuard() : listener_(new Listener) {
  assert(pipe_end.load() == -1 && "one InterruptGuard at a time");
  if (::pipe2(listener_->ends, O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "pipe2");
  signals_seen = 0;
  pipe_end = listener_->ends[1];
  listener_->thread = std::thread([this] {
    char byte = 0;
    while (::read(listener_->ends[0], &byte, 1) < 0 && errno == EINTR) {
    }
    if (byte == 's') source_.request_stop();
  });
  struct sigaction action {};
  action.sa_handler = on_signal;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  sigaction(SIGINT, &action, &listener_->old_int);
  sigaction(SIGTERM, &action, &listener_->old_term);
}

InterruptGuard::~InterruptGuard() {
  sigaction(SIGINT, &listener_->old_int, nullptr);
  sigaction(SIGTERM, &listener_->old_term, nullptr);
  pipe_end = -1;
  const char byte = 'q';
  [[maybe_unused]] const auto written = ::write(listener_->ends[1], &byte, 1);
  listener_->thread.join();
  ::close(listener_->ends[0]);
  ::close(listener_->ends[1]);
  delete listener_;
}

}  // namespace data
