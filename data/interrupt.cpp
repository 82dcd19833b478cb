// A signal handler may do next to nothing: it writes a byte to a pipe, and a thread that reads the pipe requests the
// stop. The second signal ends the program with the job's exit status 75, whatever state it is in.
#include "data/interrupt.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cassert>
#include <cerrno>
#include <csignal>
#include <system_error>
#include <thread>

#include "data/error.hpp"

namespace data {
namespace {

/// A terminal's and a system's; the last three are what batch systems send before they end a job.
constexpr std::array signals{SIGINT, SIGTERM, SIGHUP, SIGXCPU, SIGUSR1, SIGUSR2};
std::atomic<int> pipe_end{-1};
std::atomic<int> signals_seen{0};
static_assert(std::atomic<int>::is_always_lock_free);

void on_signal(int signal) {
  const int saved = errno;
  // A closing terminal may say so more than once, the kernel and then the shell.
  if (signal == SIGHUP && signals_seen.load() > 0) return;
  if (signals_seen.fetch_add(1) > 0) _exit(static_cast<int>(ExitStatus::interrupted));
  const char byte = 's';
  [[maybe_unused]] const auto written = ::write(pipe_end.load(), &byte, 1);
  errno = saved;
}

void on_signal_without_guard(int) {
  constexpr char line[] = "\ninterrupted; what was saved is whole, and the same command starts again\n";
  [[maybe_unused]] const auto written = ::write(STDERR_FILENO, line, sizeof line - 1);
  _exit(static_cast<int>(ExitStatus::interrupted));
}

/// SIGHUP stays ignored where it is, as under nohup. `old`: what was there before, or nullptr.
void listen_with(void (*handler)(int), std::array<struct sigaction, signals.size()>* old) {
  struct sigaction action {};
  action.sa_handler = handler;
  sigemptyset(&action.sa_mask);
  action.sa_flags = SA_RESTART;
  for (std::size_t k = 0; k < signals.size(); ++k) {
    struct sigaction before {};
    sigaction(signals[k], nullptr, &before);
    if (signals[k] != SIGHUP || before.sa_handler != SIG_IGN) sigaction(signals[k], &action, nullptr);
    if (old != nullptr) (*old)[k] = before;
  }
}

}  // namespace

void exit_on_interrupt() { listen_with(on_signal_without_guard, nullptr); }

struct InterruptGuard::Listener {
  int ends[2] = {-1, -1};
  std::array<struct sigaction, signals.size()> old{};
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
  listen_with(on_signal, &listener_->old);
}

InterruptGuard::~InterruptGuard() {
  for (std::size_t k = 0; k < signals.size(); ++k) sigaction(signals[k], &listener_->old[k], nullptr);
  pipe_end = -1;
  const char byte = 'q';
  [[maybe_unused]] const auto written = ::write(listener_->ends[1], &byte, 1);
  listener_->thread.join();
  ::close(listener_->ends[0]);
  ::close(listener_->ends[1]);
  delete listener_;
}

}  // namespace data
