#pragma once
// How far a long job is, on stderr: on a terminal a bar with rate and time left, redrawn a few times a second;
// elsewhere one line per 10 %. Any number of threads may report.
#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>

namespace data {

enum class ProgressStyle { automatic, bar, lines, quiet };

struct ProgressOptions {
  ProgressStyle style = ProgressStyle::automatic;  ///< automatic: a bar when stderr is a terminal, else lines
  bool counted = true;           ///< steps are things that a user counts; else shares of the whole, and no rate is told
  double redraw_interval = 0.2;  ///< s, between two drawings of the bar
  std::function<void(const std::string&)> write = {};  ///< where lines go, instead of stderr
  std::function<double()> clock = {};                  ///< time [s], instead of the steady clock's
};

/// One job of `total` steps. The destructor ends the bar's line.
class Progress {
 public:
  Progress(std::string what, std::uint64_t total, ProgressOptions options = {});
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();

  void advance(std::uint64_t steps = 1);
  void set(std::uint64_t done);        ///< `done` may go backwards, on a resumed job
  void note(const std::string& line);  ///< a line of its own, above the bar

 private:
  void draw(double now);  ///< the caller holds mutex_
  void clear_bar();
  std::string summary(double now) const;

  std::mutex mutex_;
  std::string what_;
  std::uint64_t total_, done_ = 0, first_ = 0;
  ProgressOptions options_;
  double start_ = 0.0, drawn_at_ = -1e300;
  int tenths_ = 0;
  bool on_screen_ = false, ended_ = false, started_ = false;
};

/// "42 s", "3 min 05 s", "2 h 10 min".
std::string duration_text(double seconds);

/// The duration of an estimate: "2.2 min", "5.3 h".
std::string rough_duration_text(double seconds);

}  // namespace data
