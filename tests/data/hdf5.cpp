#include "data/hdf5.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <limits>

#include "data/atomic_file.hpp"
#include "tests/temporary.hpp"

TEST_CASE("numbers, texts and attributes come back from HDF5 as they went in") {
  const TemporaryFolder folder;
  const std::vector<double> values{0.1, -1e-300, std::numeric_limits<double>::max(), 1.0 / 3.0, 0.0, 2e-18};
  data::write_atomically(folder.path("a.h5"), [&](const std::string& temporary) {
    const data::Hdf5Group root = data::create_hdf5(temporary);
    root.set("title", "größer 800 µm");
    root.set("step", 9.5e-6);
    root.set("seed", std::int64_t{7});
    root.set("Version", std::vector<std::int64_t>{1, 0});
    const data::Hdf5Group group = root.create_group("zeta").create_group("inner");
    group.write("values", values, {2, 3});
    group.set("unit", "N m", "values");
    group.write("counts", std::vector<std::int64_t>{1, -2, 3});
    group.write("types", std::vector<std::uint8_t>{12, 12});
    group.write("none", std::vector<double>{});
    group.write_texts("names", {"friction", "", "µ"});
    group.set_ascii("Type", "UnstructuredGrid");
    root.create_group("alpha");
    root.flush();
  });
  const data::Hdf5Group root = data::open_hdf5(folder.path("a.h5"));
  CHECK(root.text("title") == "größer 800 µm");
  CHECK(root.number("step") == 9.5e-6);
  CHECK(root.integer("seed") == 7);
  CHECK(root.names() == std::vector<std::string>{"zeta", "alpha"});  // the order of creation
  const data::Hdf5Group group = root.group("zeta").group("inner");
  const data::Array<double> read = group.read<double>("values");
  CHECK(read.values == values);
  CHECK(read.shape == std::vector<std::size_t>{2, 3});
  CHECK(group.text("unit", "values") == "N m");
  CHECK(group.read<std::int64_t>("counts").values == std::vector<std::int64_t>{1, -2, 3});
  CHECK(group.read<double>("types").values == std::vector<double>{12.0, 12.0});
  CHECK(group.read<double>("none").values.empty());
  CHECK(group.read_texts("names") == std::vector<std::string>{"friction", "", "µ"});
  CHECK(group.text("Type") == "UnstructuredGrid");
  CHECK(group.has_attribute("unit", "values"));
  CHECK_FALSE(group.has_attribute("unit"));
  CHECK_FALSE(group.has("elsewhere"));
  CHECK(std::filesystem::directory_iterator(folder.path())->path().filename() == "a.h5");  // nothing temporary left
}

TEST_CASE("an existing HDF5 file can be added to, and an attribute replaced") {
  const TemporaryFolder folder;
  const std::string path = folder.path("a.h5");
  data::create_hdf5(path).set("complete", std::int64_t{0});
  const data::Hdf5Group root = data::open_hdf5_to_write(path);
  root.write("more", std::vector<double>{1.0});
  root.set("complete", std::int64_t{1});
  CHECK(root.integer("complete") == 1);
  CHECK(root.has("more"));
}

TEST_CASE("what is missing or of another kind in an HDF5 file is named with file and object") {
  const TemporaryFolder folder;
  {
    const data::Hdf5Group root = data::create_hdf5(folder.path("a.h5"));
    root.create_group("runs").write_texts("names", {"a"});
    root.set("title", "x");
  }
  const data::Hdf5Group root = data::open_hdf5(folder.path("a.h5"));
  const auto failure = [&](auto action) { return failure_of(folder, action); };
  CHECK(failure([&] { root.group("rows"); }).find("65: a.h5: /rows: the group is missing") == 0);
  CHECK(failure([&] {
          root.group("runs").read<double>("torque");
        }).find("65: a.h5: /runs/torque: the dataset is missing") == 0);
  CHECK(failure([&] {
          root.group("runs").read<double>("names");
        }).find("65: a.h5: /runs/names: the dataset does not hold numbers") == 0);
  CHECK(failure([&] { root.text("unit"); }).find("65: a.h5: /@unit: the attribute is missing") == 0);
  CHECK(root.group("runs").read_texts("names") == std::vector<std::string>{"a"});
  CHECK(failure([&] { root.number("title"); }).find("65: a.h5: /@title: the attribute is not of the expected type") ==
        0);
}

TEST_CASE("a missing, foreign or truncated HDF5 file gives one clear message") {
  const TemporaryFolder folder;
  CHECK(failure_of(folder, [&] { data::open_hdf5(folder.path("a.h5")); }) ==
        "66: a.h5: there is no such file (check the name)");
  folder.write("b.h5", "friction,speed\n");
  CHECK(failure_of(folder, [&] { data::open_hdf5(folder.path("b.h5")); }) ==
        "65: b.h5: is not an HDF5 file, or its beginning is damaged (make it again)");
  data::create_hdf5(folder.path("c.h5")).write("x", std::vector<double>(10000, 1.0));
  const std::string whole = folder.read("c.h5");
  for (const std::size_t kept : {std::size_t{600}, whole.size() / 2, whole.size() - 1}) {
    folder.write("c.h5", whole.substr(0, kept));
    CHECK(failure_of(folder, [&] { data::open_hdf5(folder.path("c.h5")); }) ==
          "65: c.h5: is a truncated or damaged HDF5 file (make it again)");
  }
}
