#pragma once
// Ctrl-C, SIGTERM and a terminal that closes (SIGHUP): the first asks the job to stop where it can be resumed, the
// second ends the program at once.
#include <stop_token>

namespace data {

/// Makes jobs without an InterruptGuard end at once, with a line that says so and the status of an interruption (75).
/// What they had saved by then is whole.
void exit_on_interrupt();

/// Listens to SIGINT, SIGTERM and SIGHUP (unless it is ignored, as under nohup) while it lives; one at a time. Hand
/// `token()` to the job.
class InterruptGuard {
 public:
  InterruptGuard();
  InterruptGuard(const InterruptGuard&) = delete;
  InterruptGuard& operator=(const InterruptGuard&) = delete;
  ~InterruptGuard();

  std::stop_token token() const { return source_.get_token(); }
  bool interrupted() const { return source_.stop_requested(); }

 private:
  std::stop_source source_;
  struct Listener;
  Listener* listener_;
};

}  // namespace data
