#include "data/interrupt.hpp"

#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <csignal>
#include <thread>

namespace {
bool stops_within_a_second(const std::stop_token& token) {
  for (int i = 0; i < 1000 && !token.stop_requested(); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  return token.stop_requested();
}
}  // namespace

TEST_CASE("the first signal requests a stop, and a guard that goes leaves no trace") {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const data::InterruptGuard guard;
    CHECK_FALSE(guard.interrupted());
    std::raise(signal);
    CHECK(stops_within_a_second(guard.token()));
  }
  { const data::InterruptGuard unused; }
  const data::InterruptGuard again;
  CHECK_FALSE(again.interrupted());
}

TEST_CASE("the second signal ends the program at once with status 75") {
  const pid_t child = fork();
  if (child == 0) {
    const data::InterruptGuard guard;
    std::raise(SIGINT);
    std::raise(SIGTERM);
    _exit(0);
  }
  int status = 0;
  REQUIRE(waitpid(child, &status, 0) == child);
  REQUIRE(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 75);
}
