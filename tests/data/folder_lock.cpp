#include "data/folder_lock.hpp"

#include <fmt/format.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <chrono>
#include <memory>
#include <thread>

#include "tests/temporary.hpp"

TEST_CASE("a folder is one process's at a time, and the second is told who holds it") {
  const TemporaryFolder folder;
  const std::string out = folder.path("out");
  auto lock = std::make_unique<data::FolderLock>(out, "training", "demcal train");
  const std::string told = failure_of(folder, [&] { data::FolderLock(out, "training", "demcal design"); });
  CHECK(told.find(fmt::format("73: out: is in use by process {} on {} (demcal train, since ", getpid(),
                              data::machine_name())) == 0);
  { const data::FolderLock another(out, "results", "demcal calibrate"); }
  lock.reset();
  CHECK(std::filesystem::is_empty(out));
  { const data::FolderLock again(out, "training", "demcal train"); }
}

TEST_CASE("the lock of a process that was killed is taken over") {
  const TemporaryFolder folder;
  const pid_t child = fork();
  if (child == 0) {
    const data::FolderLock lock(folder.path(), "training", "demcal train");
    std::ofstream(folder.path("ready")) << "x";
    pause();
    _exit(0);
  }
  while (!std::filesystem::exists(folder.path("ready"))) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  CHECK(failure_of(folder, [&] {
          data::FolderLock(folder.path(), "training", "x");
        }).find(fmt::format("is in use by process {}", child)) != std::string::npos);
  kill(child, SIGKILL);
  int status = 0;
  waitpid(child, &status, 0);
  CHECK(std::filesystem::exists(folder.path(".training.lock")));
  CHECK(failure_of(folder, [&] { data::FolderLock(folder.path(), "training", "x"); }).empty());
}

TEST_CASE("a folder that cannot be written to is found out by its lock") {
  const TemporaryFolder folder;
  folder.write("file", "x");
  CHECK(failure_of(folder, [&] {
          data::FolderLock(folder.path("file/out"), "run", "x");
        }).find("73: file/out: cannot be written") == 0);
}
