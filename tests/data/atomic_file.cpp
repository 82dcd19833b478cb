#include "data/atomic_file.hpp"

#include <catch2/catch.hpp>
#include <stdexcept>

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
  data::write_atomically(path, "first, and longer");
  data::write_atomically(path, "second");
  CHECK(data::read_file(path) == "second");
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

TEST_CASE("reading a file that is not there is missing input") {
  const TemporaryFolder folder;
  CHECK(failure_of(folder, [&] { data::read_file(folder.path("none")); }) ==
        "66: none: there is no such file (check the name)");
  CHECK(failure_of(folder, [&] { data::read_file(folder.path()); }).find("66: ") == 0);
}
