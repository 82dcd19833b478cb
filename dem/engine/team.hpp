#pragma once
// A small team of threads that stays alive between parallel passes; the caller is its first member.
//
// A step is a few passes of tens of microseconds each. Waking a thread costs about as much, so members wait for the
// next pass at the ready for a while before they sleep; a machine that is busy otherwise has them back soon.
#include <atomic>
#include <cstdint>
#include <functional>
#include <thread>
#include <vector>

namespace dem {

class Team {
 public:
  /// Throws std::system_error where the system has no thread left for a member.
  explicit Team(int threads) : size_(threads < 1 ? 1 : threads) {
    try {
      for (int member = 1; member < size_; ++member) members_.emplace_back([this] { serve(); });
    } catch (...) {
      dismiss();  // those that are there wait, and would for ever
      throw;
    }
  }
  ~Team() { dismiss(); }
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  /// Calls work(item) once for every item in [0, items), in any order and by any member. Work must not throw.
  template <class Work>
  void for_each(std::size_t items, Work&& work) {
    if (size_ == 1) {
      for (std::size_t i = 0; i < items; ++i) work(i);
      return;
    }
    work_ = std::ref(work);
    items_ = items;
    next_ = 0;
    busy_ = static_cast<std::uint64_t>(size_) - 1;
    begin_pass();
    take_items();
    wait_until(busy_, [](std::uint64_t busy) { return busy == 0; });
  }

 private:
  static constexpr int looks = 2000;  ///< looks at a number before sleeping until it changes: some tens of microseconds

  /// What a member does: takes part in every pass until the team is dismissed.
  void serve() {
    for (std::uint64_t pass = 1;; ++pass) {
      wait_until(passes_, [pass](std::uint64_t begun) { return begun >= pass; });
      if (done_) return;
      take_items();
      if (busy_.fetch_sub(1) == 1) busy_.notify_one();
    }
  }
  void dismiss() {
    done_ = true;
    begin_pass();
  }
  void begin_pass() {
    passes_.fetch_add(1);
    passes_.notify_all();
  }
  void take_items() {
    for (std::size_t i = next_.fetch_add(1); i < items_; i = next_.fetch_add(1)) work_(i);
  }
  template <class Done>
  static void wait_until(const std::atomic<std::uint64_t>& number, Done&& done) {
    for (int look = 0; look < looks; ++look) {
      if (done(number.load(std::memory_order_acquire))) return;
#ifdef __x86_64__
      __builtin_ia32_pause();
#endif
    }
    for (std::uint64_t now = number; !done(now); now = number) number.wait(now);
  }

  int size_;
  bool done_ = false;
  std::function<void(std::size_t)> work_;
  std::size_t items_ = 0;
  alignas(64) std::atomic<std::size_t> next_ = 0;      ///< the next item
  alignas(64) std::atomic<std::uint64_t> passes_ = 0;  ///< passes begun
  alignas(64) std::atomic<std::uint64_t> busy_ = 0;    ///< members that have not finished this pass, beside the caller
  std::vector<std::jthread> members_;
};

}  // namespace dem
