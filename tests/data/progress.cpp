#include "data/progress.hpp"

#include <algorithm>
#include <catch2/catch.hpp>
#include <thread>
#include <vector>

namespace {
struct Screen {
  std::string text;
  double now = 0.0;
  data::ProgressOptions options(data::ProgressStyle style) {
    return {
        .style = style, .write = [this](const std::string& more) { text += more; }, .clock = [this] { return now; }};
  }
};
}  // namespace

TEST_CASE("away from a terminal there is one line per 10 %, with rate and time left") {
  Screen screen;
  {
    data::Progress progress("training", 80, screen.options(data::ProgressStyle::lines));
    for (int i = 0; i < 80; ++i) {
      screen.now += 0.5;
      progress.advance();
    }
  }
  CHECK(std::count(screen.text.begin(), screen.text.end(), '\n') == 10);
  CHECK(screen.text.find("training: 10 % (8 of 80, 2 /s, 36 s left)\n") == 0);
  CHECK(screen.text.find("training: 100 % (80 of 80, 2 /s, took 40 s)\n") != std::string::npos);
}

TEST_CASE("shares of the whole are no things to count: the time left alone is told") {
  Screen screen;
  {
    data::ProgressOptions options = screen.options(data::ProgressStyle::lines);
    options.counted = false;
    data::Progress progress("fit", 1000, options);
    for (int i = 0; i < 5; ++i) {
      screen.now += 2.0;
      progress.advance(200);
    }
  }
  CHECK(screen.text ==
        "fit: 20 % (8 s left)\nfit: 40 % (6 s left)\nfit: 60 % (4 s left)\nfit: 80 % (2 s left)\n"
        "fit: 100 % (took 10 s)\n");
}

TEST_CASE("on a terminal the bar is redrawn in place at intervals and ends its line") {
  Screen screen;
  {
    data::Progress progress("fit", 1000, screen.options(data::ProgressStyle::bar));
    for (int i = 0; i < 1000; ++i) {
      screen.now += 0.01;
      progress.advance();
    }
  }
  CHECK(std::count(screen.text.begin(), screen.text.end(), '\n') == 1);
  CHECK(std::count(screen.text.begin(), screen.text.end(), '\r') <= 55);
  CHECK(screen.text.find("fit [########################] 100 %  1000 of 1000, 100 /s, took 10 s") != std::string::npos);
  CHECK(screen.text.back() == '\n');
}

TEST_CASE("quiet writes nothing, and a resumed job counts only what it does itself") {
  Screen screen;
  { data::Progress("x", 10, screen.options(data::ProgressStyle::quiet)).advance(10); }
  CHECK(screen.text.empty());
  data::Progress progress("x", 100, screen.options(data::ProgressStyle::lines));
  progress.set(50);
  screen.now += 10.0;
  progress.advance(10);
  CHECK(screen.text == "x: 60 % (60 of 100, 1 /s, 40 s left)\n");
}

TEST_CASE("reports from many threads are all counted") {
  Screen screen;
  data::Progress progress("x", 4000, screen.options(data::ProgressStyle::lines));
  {
    std::vector<std::jthread> threads;
    for (int t = 0; t < 4; ++t) {
      threads.emplace_back([&] {
        for (int i = 0; i < 1000; ++i) progress.advance();
      });
    }
  }
  CHECK(screen.text.find("4000 of 4000") != std::string::npos);
  CHECK(std::count(screen.text.begin(), screen.text.end(), '\n') == 10);
}

TEST_CASE("durations are written in the units that people use") {
  CHECK(data::duration_text(42.4) == "42 s");
  CHECK(data::duration_text(185.0) == "3 min 05 s");
  CHECK(data::duration_text(7800.0) == "2 h 10 min");
}
