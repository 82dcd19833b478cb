#pragma once
// Ctrl-C and SIGTERM: the first asks the job to stop where it can be resumed, the second ends the program at once.
#include <stop_token>

namespace data {

/// Listens to SIGINT and SIGTERM while it lives; one at a time. Hand `token()` to the job.
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
