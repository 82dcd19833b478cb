#pragma once
// A small team of threads that stays alive between parallel passes; the caller is its first member.
//
// A step is a few passes of tens of microseconds each. Waking a thread costs about as much, so members wait for the
// next pass at the ready for a while before they sleep. A pass waits for nobody who has not come to it: where the
// machine is busy otherwise, a member that has no core leaves its items to the others.
//
// The gate. A pass begins by opening it and ends by closing it; its number tells passes apart. A member counts itself
// in, and looks at the gate once more: if it is that of the same open pass, the caller sees it inside and waits for it;
// else it has come too late and touches nothing.
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
    open_gate();
    take_items();
    gate_.fetch_add(1);  // closed; who sleeps is not woken for that
    wait_until(inside_, [](std::uint64_t inside) { return inside == 0; });
  }

 private:
  static constexpr int looks = 2000;  ///< looks at a number before sleeping until it changes: some tens of microseconds

  static bool is_open(std::uint64_t gate) { return gate % 2 == 1; }

  /// What a member does: takes part in the passes that it comes to until the team is dismissed.
  void serve() {
    std::uint64_t last = 0;
    while (!done_) {
      last = wait_until(gate_, [last](std::uint64_t gate) { return is_open(gate) && gate != last; });
      inside_.fetch_add(1);
      if (gate_ == last && !done_) take_items();
      if (inside_.fetch_sub(1) == 1) inside_.notify_one();
    }
  }
  void dismiss() {
    done_ = true;
    open_gate();
  }
  /// Opens the gate, for a pass or for good.
  void open_gate() {
    gate_.fetch_add(1);
    gate_.notify_all();
  }
  void take_items() {
    for (std::size_t i = next_.fetch_add(1); i < items_; i = next_.fetch_add(1)) work_(i);
  }
  /// The number, once it is as wanted. Loads are in one order with all changes: the gate is closed before `inside_` is
  /// looked at.
  template <class Wanted>
  static std::uint64_t wait_until(const std::atomic<std::uint64_t>& number, Wanted&& wanted) {
    for (int look = 0; look < looks; ++look) {
      if (const std::uint64_t now = number; wanted(now)) return now;
#ifdef __x86_64__
      __builtin_ia32_pause();
#endif
    }
    std::uint64_t now = number;
    for (; !wanted(now); now = number) number.wait(now);
    return now;
  }

  int size_;
  std::atomic<bool> done_ = false;
  std::function<void(std::size_t)> work_;
  std::size_t items_ = 0;
  alignas(64) std::atomic<std::size_t> next_ = 0;      ///< the next item
  alignas(64) std::atomic<std::uint64_t> gate_ = 0;    ///< odd while a pass is open
  alignas(64) std::atomic<std::uint64_t> inside_ = 0;  ///< members that look at the pass, beside the caller
  std::vector<std::jthread> members_;
};

}  // namespace dem
