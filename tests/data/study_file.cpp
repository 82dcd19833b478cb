#include "data/study_file.hpp"

#include <catch2/catch.hpp>

#include "data/axis.hpp"
#include "data/edit_distance.hpp"
#include "tests/temporary.hpp"

namespace {

data::StudyFile open_text(const TemporaryFolder& folder, const std::string& text,
                          const std::vector<std::string>& overrides = {}) {
  return data::StudyFile::open(folder.write("study.toml", text), overrides);
}

/// The message of finish() after `read` has asked the root for what it wants.
template <class Read>
std::string problem_of(const std::string& text, Read read, const std::vector<std::string>& overrides = {}) {
  const TemporaryFolder folder;
  return failure_of(folder, [&] {
    const data::StudyFile file = open_text(folder, text, overrides);
    read(file.root());
    file.finish();
  });
}

}  // namespace

TEST_CASE("a value out of its range is named with file, line, key, value and bound") {
  const auto read = [](const data::Section& root) {
    root.child("parameters").child("friction").number("low", {.low = 0.0, .high = 10.0});
  };
  CHECK(problem_of("[study]\n[parameters.friction]\nlow = -1\n",
                   [&](const data::Section& root) {
                     read(root);
                     root.child("study");
                   }) ==
        "78: study.toml:3: parameters.friction.low: -1 is below the smallest value 0 allowed (choose a value from 0 up "
        "to 10)");
  CHECK(problem_of("[parameters.friction]\nlow = 11\n", read) ==
        "78: study.toml:2: parameters.friction.low: 11 is above the largest value 10 allowed (choose a value from 0 up "
        "to 10)");
  CHECK(problem_of("[parameters.friction]\nlow = nan\n", read) ==
        "78: study.toml:2: parameters.friction.low: nan is not a finite number (choose a value from 0 up to 10)");
  CHECK(problem_of("x = 0", [](const data::Section& root) { root.number("x", data::positive); }) ==
        "78: study.toml:1: x: 0 is not above 0 (choose a value above 0)");
}

TEST_CASE("a key that nobody asks for is an error that names its line and the nearest known key") {
  const auto read = [](const data::Section& root) {
    const data::Section contact = root.child("contact");
    contact.number("friction", data::any_number, 0.4);
    contact.number("stiffness", data::any_number, 1.0);
  };
  CHECK(problem_of("[contact]\nstiffness = 3.0\nfricton = 0.4\n", read) ==
        "78: study.toml:3: contact.fricton: is not a key that demcal knows (did you mean 'friction'?)");
  CHECK(problem_of("[contact]\ngravity = 0.4\n", read) ==
        "78: study.toml:2: contact.gravity: is not a key that demcal knows (known here: friction, stiffness)");
  CHECK(problem_of("[contcat]\nfriction = 0.4\n", read) ==
        "78: study.toml:1: contcat: is not a key that demcal knows (did you mean 'contact'?)");
  CHECK(problem_of("contact = { friction = 0.4,  stifness = 2 }\n", read) ==
        "78: study.toml:1: contact.stifness: is not a key that demcal knows (did you mean 'stiffness'?)");
}

TEST_CASE("a documented key of the DEM in a study without a rig is told what it lacks") {
  const auto read = [](const data::Section& root) {
    for (const auto& [name, material] : root.child("materials").children()) material.text("powder", "");
  };
  CHECK(problem_of("[materials.sand]\ncoarse_graining = 8\n", read) ==
        "78: study.toml:2: materials.sand.coarse_graining: is read of a study that has a [rig], and this one has none "
        "(remove it, or give a [rig])");
}

TEST_CASE("a name with a point that is not in quotes is explained") {
  CHECK(problem_of("[materials.sand-0.5]\ndensity = 1.0\n",
                   [](const data::Section& root) {
                     for (const auto& [name, material] : root.child("materials").children())
                       material.number("density", data::any_number, 1.0);
                   }) ==
        "78: study.toml:1: materials.sand-0.5: is not a key that demcal knows (known here: density; a name "
        "with a point stands in quotes: [materials.\"sand-0.5\"])");
}

TEST_CASE("an unknown key inside a list of tables or an opened but unread section is found") {
  CHECK(
      problem_of("[[observe]]\nname = \"a\"\n[[observe]]\nname = \"b\"\nfiel = \"x\"\n", [](const data::Section& root) {
        for (const data::Section& item : root.array("observe")) {
          item.text("name");
          item.text("file", "");
        }
      }) == "78: study.toml:5: observe.b.fiel: is not a key that demcal knows (did you mean 'file'?)");
  CHECK(problem_of("[rig]\nkind = 1\n", [](const data::Section& root) { root.child("rig"); }) ==
        "78: study.toml:2: rig.kind: is not a key that demcal knows (remove the line)");
}

TEST_CASE("quantities are read with their units into SI") {
  const TemporaryFolder folder;
  const data::StudyFile file = open_text(
      folder, "d = \"800 um\"\nspeed = [\"60 rpm\", 120]\nmu = 0.4\nfill = \"30 %\"\nh = \"2.0e-18 J\"\ne = 5\n");
  const data::Section root = file.root();
  const data::Unit rpm = data::parse_unit("rpm"), surface = data::parse_unit("mJ/m2");
  CHECK(root.quantity("d", "m", data::positive) == Approx(800e-6));
  const std::vector<double> speeds = root.quantities("speed", "rad/s", data::positive, &rpm);
  REQUIRE(speeds.size() == 2);
  CHECK(speeds[1] == Approx(2.0 * speeds[0]));
  CHECK(root.quantity("mu", "1", data::non_negative) == 0.4);
  CHECK(root.quantity("fill", "1", data::non_negative) == Approx(0.3));
  CHECK(root.quantity("h", "J", data::non_negative) == Approx(2e-18));
  CHECK(root.quantity("e", "J/m2", data::non_negative, {}, &surface) == Approx(0.005));
  CHECK(root.quantity("missing", "m", data::positive, 0.25) == 0.25);
  CHECK_NOTHROW(file.finish());
}

TEST_CASE("a quantity without unit, of another dimension, unknown or not a number is an error") {
  const auto read = [](const data::Section& root) { root.quantity("d", "m", data::positive); };
  CHECK(problem_of("d = 0.8", read) ==
        "78: study.toml:1: d: 0.8 has no unit (write it with a unit of m, like \"0.8 m\")");
  CHECK(problem_of("d = \"3 s\"", read) ==
        "78: study.toml:1: d: '3 s' has the wrong unit: 's' does not measure what 'm' does (write it like \"1 m\")");
  CHECK(problem_of("d = \"3 umm\"", read) ==
        "78: study.toml:1: d: '3 umm' has an unknown unit: 'umm' is not a unit that UDUNITS-2 knows (write it like \"1 "
        "m\")");
  CHECK(problem_of("d = \"big\"", read) ==
        "78: study.toml:1: d: 'big' is not a quantity (write a number with its unit, like \"1 m\")");
  CHECK(problem_of("d = \"-3 um\"", read) ==
        "78: study.toml:1: d: '-3 um' is not above 0 m (choose a value above 0 m)");
  CHECK(problem_of("", read) == "78: study.toml: d: is missing (add a line like d = \"1 m\")");
}

TEST_CASE("a value of the wrong type is an error that says what is wanted") {
  const auto lines = "n = 1.5\nt = 3\nf = \"true\"\nl = \"a\"\nc = \"sphre\"\ns = 1\n[[a]]\n[b]\n";
  const std::string found = problem_of(lines, [](const data::Section& root) {
    root.integer("n", data::any_number);
    root.text("t");
    root.flag("f", false);
    root.texts("l");
    root.choice("c", {"sphere", "clump"});
    root.child("s");
    root.child("a");
    root.array("b");
  });
  CHECK(found ==
        "78: study.toml:1: n: 1.5 is not a whole number (write a whole number without quotes)\n"
        "study.toml:2: t: 3 is not text (write it in quotes)\n"
        "study.toml:3: f: 'true' is neither true nor false (write true or false without quotes)\n"
        "study.toml:4: l: 'a' is not a list of texts (write it like [\"a\", \"b\"])\n"
        "study.toml:5: c: 'sphre' is not one of the choices (choose one of 'sphere', 'clump'; did you mean 'sphere'?)\n"
        "study.toml:6: s: 1 is not a table (write [s] above its keys, or s = { ... })\n"
        "study.toml:7: a: a list is not a table (write [a] above its keys, or a = { ... })\n"
        "study.toml:8: b: a table is not a list of tables (write [[b]], with two brackets, above each)");
}

TEST_CASE("a choice of an enum's values is read by its texts, and another text leaves the fallback") {
  const auto read = [](data::Scale& found, data::Scale fallback) {
    return [&found, fallback](const data::Section& root) { found = root.choice("scale", fallback); };
  };
  data::Scale found = data::Scale::linear;
  CHECK(problem_of("scale = \"log\"", read(found, data::Scale::linear)).empty());
  CHECK(found == data::Scale::log);
  CHECK(problem_of("", read(found, data::Scale::linear)).empty());
  CHECK(found == data::Scale::linear);
  CHECK(
      problem_of("scale = \"lag\"", read(found, data::Scale::log)) ==
      "78: study.toml:1: scale: 'lag' is not one of the choices (choose one of 'linear', 'log'; did you mean 'log'?)");
  CHECK(found == data::Scale::log);
}

TEST_CASE("a syntax error names file, line and column, and a missing file is missing input") {
  const TemporaryFolder folder;
  const std::string syntax = failure_of(folder, [&] { open_text(folder, "[study]\nname = = 3\n"); });
  CHECK(syntax.find("78: study.toml:2:8: ") == 0);
  CHECK(failure_of(folder, [&] { data::StudyFile::open(folder.path("none.toml")); }) ==
        "66: none.toml: there is no such file (give a study file, or a folder that holds study.toml)");
  const TemporaryFolder empty;
  CHECK(failure_of(empty, [&] { data::StudyFile::open(empty.path()); }).find("66: study.toml: there is no such file") ==
        0);
}

TEST_CASE("a folder opens the study.toml in it") {
  const TemporaryFolder folder;
  folder.write("study.toml", "x = 1\n");
  const data::StudyFile file = data::StudyFile::open(folder.path());
  CHECK(file.root().integer("x", data::any_number) == 1);
  CHECK(file.folder() == folder.path());
  CHECK(file.path() == folder.path("study.toml"));
}

TEST_CASE("overrides replace and add keys, also in lists by name or place, as TOML values or as text") {
  const TemporaryFolder folder;
  const data::StudyFile file = open_text(
      folder, "[training]\nruns = 8\n[[observe]]\nname = \"bench\"\nfile = \"a.csv\"\n[[observe]]\nname = \"b\"\n",
      {"training.runs=80", "training.note=800 um", "observe.bench.file=b.csv", "observe.1.file=\"c.csv\"",
       "new.part.x=[1, 2]"});
  const data::Section root = file.root();
  CHECK(root.child("training").integer("runs", data::any_number) == 80);
  CHECK(root.child("training").text("note") == "800 um");
  const auto observe = root.array("observe");
  CHECK(observe[0].text("file") == "b.csv");
  CHECK(observe[1].text("file") == "c.csv");
  CHECK(root.child("new").child("part").quantities("x", "1", data::any_number).size() == 2);
}

TEST_CASE("a problem in an override names the override") {
  const auto read = [](const data::Section& root) {
    root.child("training").integer("runs", data::positive, 1);
    root.array("observe");
  };
  CHECK(problem_of("", read, {"training.runs=-3"}) ==
        "78: --set training.runs=-3: training.runs: -3 is not above 0 (choose a value above 0)");
  CHECK(problem_of("", read, {"training.run=3"}) ==
        "78: --set training.run=3: training.run: is not a key that demcal knows (did you mean 'runs'?)");
  CHECK(problem_of("", read, {"training.runs"}) ==
        "64: --set training.runs: is not KEY=VALUE (write it like --set training.runs=80)");
  CHECK(problem_of("[[observe]]\n", read, {"observe.bench.file=x"}) ==
        "78: --set observe.bench.file=x: 'observe.bench' is not in the study (name a key of the study file)");
  CHECK(problem_of("[[calibrate]]\nname = \"powder\"\n", [](const data::Section&) {}, {"calibrate.noise=unknown"}) ==
        "78: --set calibrate.noise=unknown: 'calibrate' has one entry (name it, or its place from 0: "
        "calibrate.powder.noise)");
}

TEST_CASE("a problem in a table or a list that an override brings names the override, too") {
  const auto read = [](const data::Section& root) {
    root.child("prior").number("sd", data::positive, 1.0);
    for (const data::Section& size : root.array("sizes")) size.number("share", data::positive, 1.0);
  };
  CHECK(problem_of("", read, {"prior={ sd = -1.0 }"}) ==
        "78: --set prior={ sd = -1.0 }: prior.sd: -1 is not above 0 (choose a value above 0)");
  CHECK(problem_of("", read, {"sizes=[{ share = -2.0 }]"}).starts_with("78: --set sizes=[{ share = -2.0 }]: "));
}

TEST_CASE("named tables come in the order of the file") {
  const TemporaryFolder folder;
  const data::StudyFile file = open_text(folder, "[p.zeta]\n[p.alpha]\n[p.mid]\n");
  std::string order;
  for (const auto& [name, section] : file.root().child("p").children()) order += name + " " + section.name() + " ";
  CHECK(order == "zeta p.zeta alpha p.alpha mid p.mid ");
}

TEST_CASE("the edit distance counts insertions, deletions, substitutions and swaps") {
  CHECK(data::edit_distance("friction", "fricton") == 1);
  CHECK(data::edit_distance("friction", "fritcion") == 1);
  CHECK(data::edit_distance("kitten", "sitting") == 3);
  CHECK(data::edit_distance("", "abc") == 3);
  CHECK(data::edit_distance("speed", "SPEED") == 0);
  CHECK(data::nearest("speed", {"torque", "SPEED"}) == "SPEED");
  CHECK_FALSE(data::nearest("zzz", {"friction", "low"}).has_value());
}
