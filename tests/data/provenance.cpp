#include "data/provenance.hpp"

#include <catch2/catch.hpp>

#include "data/hash.hpp"
#include "tests/temporary.hpp"

TEST_CASE("version, instruction set and time say what made a result") {
  CHECK_FALSE(data::program_version().empty());
  CHECK(data::built_isa().find("x86-64") == 0);
  CHECK(data::processor_runs(data::built_isa()));  // this test runs, so the processor has it
  const std::string now = data::utc_now();
  CHECK(now.size() == 20);
  CHECK(now[10] == 'T');
  CHECK(now.back() == 'Z');
}

TEST_CASE("hashes are XXH3's with 128 bits, of a text as of a file that holds it") {
  // xxHash 0.8, XXH3_128bits of the empty input with seed 0: the specification's own test vector
  CHECK(data::hash_text("") == "99aa06d3014798d86001c324468d497f");
  const TemporaryFolder folder;
  const std::string path = folder.write("a", "torque");
  CHECK(data::hash_file(path) == data::hash_text("torque"));
  CHECK(data::hash_text("torque") != data::hash_text("torqu"));
  CHECK(failure_of(folder, [&] { data::hash_file(folder.path("b")); }).find("66: b") == 0);
}
