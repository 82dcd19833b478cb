#pragma once
// A small team of threads that stays alive between parallel passes; the caller is its first member.
#include <atomic>
#include <barrier>
#include <exception>
#include <functional>
#include <memory>
#include <thread>
#include <vector>

namespace dem {

class Team {
 public:
  explicit Team(int threads) : size_(threads < 1 ? 1 : threads) {
    if (size_ == 1) return;
    gate_ = std::make_unique<std::barrier<>>(size_);
    for (int rank = 1; rank < size_; ++rank) {
      members_.emplace_back([this, rank] {
        for (;;) {
          gate_->arrive_and_wait();
          if (done_) return;
          task_(rank);
          gate_->arrive_and_wait();
        }
      });
    }
  }
  ~Team() {
    if (size_ == 1) return;
    done_ = true;
    gate_->arrive_and_wait();
  }
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  int size() const { return size_; }

  /// Calls work(item) for every item in [0, items), each member a contiguous share. Work must not throw.
  template <class Work>
  void for_each(std::size_t items, Work&& work) {
    if (size_ == 1) {
      for (std::size_t i = 0; i < items; ++i) work(i);
      return;
    }
    const auto share = [&](int rank) {
      const auto n = static_cast<std::size_t>(size_), r = static_cast<std::size_t>(rank);
      for (std::size_t i = items * r / n; i < items * (r + 1) / n; ++i) work(i);
    };
    task_ = share;
    gate_->arrive_and_wait();
    share(0);
    gate_->arrive_and_wait();
  }

 private:
  int size_;
  bool done_ = false;
  std::function<void(int)> task_;
  std::unique_ptr<std::barrier<>> gate_;
  std::vector<std::jthread> members_;
};

}  // namespace dem
