#pragma once
// Runs independent jobs on a few threads. Each job's result depends on its index alone, so the number of threads never
// shows in a result.
#include <algorithm>
#include <atomic>
#include <exception>
#include <thread>
#include <vector>

namespace uq {

/// Calls job(0) ... job(count - 1); `threads` 0 takes the machine's. The first exception by index is thrown again.
template <class Job>
void for_each_index(int count, int threads, const Job& job) {
  if (threads <= 0) threads = static_cast<int>(std::thread::hardware_concurrency());
  threads = std::max(1, std::min(threads, count));
  std::vector<std::exception_ptr> failures(static_cast<std::size_t>(count));
  std::atomic<int> next{0};
  auto work = [&] {
    for (int i = next++; i < count; i = next++) {
      try {
        job(i);
      } catch (...) {
        failures[i] = std::current_exception();
      }
    }
  };
  {
    std::vector<std::jthread> pool;
    for (int t = 1; t < threads; ++t) pool.emplace_back(work);
    work();
  }
  for (const auto& failure : failures)
    if (failure) std::rethrow_exception(failure);
}

}  // namespace uq
