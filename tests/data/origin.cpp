#include "data/origin.hpp"

#include <catch2/catch.hpp>

#include "data/atomic_file.hpp"
#include "data/hdf5.hpp"
#include "data/random.hpp"
#include "tests/temporary.hpp"

using data::Origin;

namespace {

/// One file of each kind that demcal writes, its name returned.
std::vector<std::string> write_all_kinds(const TemporaryFolder& folder) {
  data::write_atomically(folder.path("t.csv"), "x,y\n1,2\n");
  data::write_atomically(folder.path("r.json"), "{\"format\": 1}\n");
  data::write_atomically(folder.path("empty.json"), "{}\n");
  data::write_atomically(folder.path("p.html"), "<!doctype html>\n<p>x</p>\n");
  data::write_atomically(folder.path("f.svg"), "<svg></svg>\n");
  data::write_atomically(folder.path("f.gp"), "plot x\n");
  data::write_atomically(folder.path("f.dat"), "1 2\n");
  data::write_atomically(folder.path("picture"), "\x89PNG\r\n" + std::string(200, 'x'));
  data::write_atomically(folder.path("m.stl"), "title; " + data::blank_mark() + std::string(200, 'x'));
  data::write_atomically(folder.path("t.h5"), [](const std::string& temporary) {
    const data::Hdf5Group root = data::create_hdf5(temporary);
    root.set("demcal", "1");
    root.write("x", std::vector<double>(300, 1.25));
  });
  return {"t.csv", "r.json", "empty.json", "p.html", "f.svg", "f.gp", "f.dat", "picture", "m.stl", "t.h5"};
}

}  // namespace

TEST_CASE("every kind of file that demcal writes is known as its own, and a flipped bit anywhere in it shows") {
  const TemporaryFolder folder;
  data::RandomStream random(1, data::Purpose::test);
  for (const std::string& name : write_all_kinds(folder)) {
    INFO(name);
    const std::string whole = folder.read(name);
    CHECK(data::origin_of(folder.path(name)) == Origin::ours);
    CHECK(data::origin_of_bytes(whole) == Origin::ours);
    for (int k = 0; k < 200; ++k) {
      std::string flipped = whole;
      const auto at = static_cast<std::size_t>(random.uniform() * static_cast<double>(whole.size()));
      flipped[at] = static_cast<char>(flipped[at] ^ (1 << k % 8));
      CHECK(data::origin_of_bytes(flipped) != Origin::ours);
    }
    for (const std::size_t kept : {whole.size() / 4, whole.size() / 2, whole.size() - 1})
      CHECK(data::origin_of_bytes(whole.substr(0, kept)) != Origin::ours);
  }
}

TEST_CASE("an HDF5 file is read only as demcal wrote it, and one without a mark as it is") {
  const TemporaryFolder folder;
  write_all_kinds(folder);
  const std::string path = folder.path("t.h5"), whole = folder.read("t.h5");
  CHECK(data::open_hdf5(path).read<double>("x").values == std::vector<double>(300, 1.25));
  std::string flipped = whole;
  flipped[flipped.rfind(std::string("\xf4\x3f", 2))] ^= 1;  // of one value's bytes
  folder.write("t.h5", flipped);
  CHECK(failure_of(folder, [&] { data::open_hdf5(path); }) ==
        "65: t.h5: is damaged: it is not what demcal wrote, byte for byte (make it again)");
  CHECK(data::origin_of(path) == Origin::changed);  // may be replaced
  folder.write("t.h5", whole);
  data::remove_mark(path);
  CHECK(folder.read("t.h5").size() < whole.size());
  CHECK(data::open_hdf5(path).read<double>("x").values.size() == 300);
  CHECK(failure_of(folder, [&] {
          data::require_unchanged(path, "", data::Strict::yes);
        }).find("65: t.h5: is damaged") == 0);
}

TEST_CASE("a file of others is foreign whatever it says, and nothing is absent") {
  CHECK(data::origin_of_bytes("time,torque\n# for demcal, written by demcal or not\n1,2\n") == Origin::foreign);
  CHECK(data::origin_of_bytes("\x89HDF\r\n\x1a\n of another program") == Origin::foreign);
  CHECK(data::origin_of_bytes("") == Origin::absent);
  CHECK(data::origin_of("/no/such/file") == Origin::absent);
  CHECK(data::origin_of("/dev/null") == Origin::foreign);
  CHECK(data::origin_of("/") == Origin::foreign);
}
