#include "data/atomic_file.hpp"

#include <fmt/format.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <catch2/catch.hpp>
#include <stdexcept>

#include "data/folder_lock.hpp"
#include "tests/temporary.hpp"

namespace {
std::size_t files_in(const std::string& folder) {
  return static_cast<std::size_t>(
      std::distance(std::filesystem::directory_iterator(folder), std::filesystem::directory_iterator{}));
}
}  // namespace

TEST_CASE("a file is written whole, into folders that are made for it, and replaced whole") {
  const TemporaryFolder folder;
  const std::string path = folder.path("a/b/report.json");
  data::write_atomically(path, "{\"x\": \"first, and longer\"}\n");
  data::write_atomically(path, "{\"x\": 2}\n");
  CHECK(data::read_file(path).find("\"x\": 2}\n") != std::string::npos);
  CHECK(files_in(folder.path("a/b")) == 1);
}

TEST_CASE("a write that fails midway leaves the old file and nothing else") {
  const TemporaryFolder folder;
  const std::string path = folder.write("a.txt", "old");
  CHECK_THROWS_AS(data::write_atomically(path,
                                         [](const std::string& temporary) {
                                           std::ofstream(temporary) << "half";
                                           throw std::runtime_error("stop");
                                         }),
                  std::runtime_error);
  CHECK(folder.read("a.txt") == "old");
  CHECK(files_in(folder.path()) == 1);
}

TEST_CASE("a place that cannot be written is named") {
  const TemporaryFolder folder;
  folder.write("file", "x");
  std::filesystem::create_directory(folder.path("taken"));
  CHECK(failure_of(folder, [&] {
          data::write_atomically(folder.path("file/a.txt"), "x");
        }).find("73: file: cannot be written: Not a directory") == 0);
  CHECK(failure_of(folder, [&] {
          data::write_atomically(folder.path("taken"), "x");
        }).find("73: taken: cannot be written: Is a directory") == 0);
}

TEST_CASE("what demcal did not write is never replaced, and an edited table only when that is said") {
  const TemporaryFolder folder;
  for (const std::string name : {"a.csv", "a.h5", "a.svg", "a.html", "a.json", "a.gp", "a.dat", "a.stl", "a"}) {
    const std::string path = folder.write(name, "the user's own\n");
    CHECK(failure_of(folder, [&] {
            data::write_atomically(path, "{}");
          }).find("73: " + name + ": is there already and was not written by demcal") == 0);
    CHECK(failure_of(folder, [&] {
            data::write_atomically(path, [](const std::string& temporary) { std::ofstream(temporary) << "x"; });
          }).find("73: " + name + ": is there already") == 0);
    CHECK(folder.read(name) == "the user's own\n");
  }
  CHECK(files_in(folder.path()) == 9);
  const std::string table = folder.path("t.csv");
  data::write_atomically(table, "x\n1\n");
  data::write_atomically(table, "x\n2\n", data::Changed::refuse);
  folder.write("t.csv", folder.read("t.csv") + "3\n");
  CHECK(failure_of(folder, [&] {
          data::write_atomically(table, "x\n4\n", data::Changed::refuse);
        }).find("73: t.csv: was changed since demcal wrote it, and is not replaced") == 0);
  data::write_atomically(table, "x\n5\n");
  CHECK(folder.read("t.csv").find("x\n5\n") != std::string::npos);
  data::write_atomically(folder.write("empty.csv", ""), "x\n6\n");
  CHECK(failure_of(folder, [] { data::write_atomically("/dev/null", "x"); }).find("73: /dev/null: is there already") ==
        0);
}

TEST_CASE("temporary files of processes that are gone are removed, those of living ones stay") {
  const TemporaryFolder folder;
  const pid_t child = fork();
  if (child == 0) _exit(0);
  int status = 0;
  REQUIRE(waitpid(child, &status, 0) == child);
  const std::string machine = data::machine_name();
  const std::string gone = fmt::format("t.h5.{}-{}-0.tmp", machine, child),
                    alive = fmt::format("t.h5.{}-{}-7.tmp", machine, getpid()),
                    elsewhere = fmt::format("t.h5.elsewhere-{}-0.tmp", child);
  for (const std::string& name : {gone, alive, elsewhere, std::string("mine.tmp")}) folder.write(name, "half");
  data::write_atomically(folder.path("t.csv"), "x\n1\n");
  CHECK_FALSE(std::filesystem::exists(folder.path(gone)));
  for (const std::string& name : {alive, elsewhere, std::string("mine.tmp")})
    CHECK(std::filesystem::exists(folder.path(name)));
}

TEST_CASE("pipes, devices and folders are no files to read") {
  const TemporaryFolder folder;
  REQUIRE(mkfifo(folder.path("pipe").c_str(), 0600) == 0);
  for (const std::string& path : {folder.path("pipe"), std::string("/dev/zero")})
    CHECK(failure_of(folder, [&] {
            data::read_file(path);
          }).find("cannot be read: it is a pipe or a device, not a file") != std::string::npos);
  CHECK(failure_of(folder, [&] { data::read_file(folder.path()); }).find("it is a folder") != std::string::npos);
}

TEST_CASE("reading a file that is not there is missing input") {
  const TemporaryFolder folder;
  CHECK(failure_of(folder, [&] { data::read_file(folder.path("none")); }) ==
        "66: none: there is no such file (check the name)");
  CHECK(failure_of(folder, [&] { data::read_file(folder.path()); }).find("66: ") == 0);
}
