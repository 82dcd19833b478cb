// Bad input: one clear message with place, value, bound and remedy, and the exit status of data::ExitStatus.
#include <catch2/catch.hpp>

#include "tests/cli/program.hpp"

using Catch::Contains;
using test::Folder;

TEST_CASE("a mistyped key is refused with file, line and the key that was meant") {
  const Folder folder;
  folder.study("developer");
  folder.replace("study/study.toml", "restitution = 0.7", "restitutoin = 0.7");
  for (const char* command : {"check", "calibrate", "simulate", "train"}) {
    CHECK_THAT(folder.says({command, "study"}, 78),
               Contains("study.toml:") && Contains("restitutoin") && Contains("restitution"));
  }
}

TEST_CASE("a friction of -1 is refused wherever it stands, with its bound") {
  const Folder folder;
  folder.study("developer");
  SECTION("as a setting") {
    CHECK_THAT(folder.says({"check", "study", "--set", "contact.friction=-1"}, 78),
               Contains("contact.friction") && Contains("-1") && Contains("0"));
  }
  SECTION("as the low end of the parameter's range") {
    folder.replace("study/study.toml", "low = 0.1", "low = -1");
    CHECK_THAT(folder.says({"calibrate", "study"}, 78),
               Contains("study.toml:") && Contains("friction") && Contains("-1"));
  }
  SECTION("as a point to simulate") {
    CHECK_THAT(folder.says({"simulate", "study", "--at", "friction=-1"}, 64),
               Contains("--at friction") && Contains("-1"));
  }
}

TEST_CASE("an observation file without its standard errors is refused with file and column") {
  const Folder folder;
  folder.study("other-code");
  folder.replace("study/bench.csv", "speed,torque,torque_se", "speed,torque,torque_error");
  CHECK_THAT(folder.says({"calibrate", "study"}, 65), Contains("bench.csv") && Contains("torque_se"));
}

TEST_CASE("a truncated training table is refused with its place") {
  const Folder folder;
  folder.study("developer");
  const std::string table = folder.read("study/training.csv");
  for (const std::size_t kept : {table.size() / 3, table.size() / 2, table.size() - 3}) {
    folder.write("study/training.csv", table.substr(0, kept));
    CHECK_THAT(folder.says({"calibrate", "study"}, 65), Contains("training.csv"));
  }
}

TEST_CASE("a missing study, an unknown command and an unknown point each have their status") {
  const Folder folder;
  CHECK(folder.demcal({"check", "nowhere"}).status == 66);
  CHECK(folder.demcal({"calibrat"}).status == 64);
  CHECK(folder.demcal({}).status == 64);
  folder.study("developer");
  CHECK_THAT(folder.says({"simulate", "study", "--at", "frictoin=0.3"}, 64),
             Contains("frictoin") && Contains("friction, hamaker, rpm"));
}

TEST_CASE("nothing is ever written into the study's own folder") {
  const Folder folder;
  folder.study("other-code");
  CHECK_THAT(folder.says({"calibrate", "study", "--out", "study"}, 73), Contains("own folder"));
}

TEST_CASE("a study without training runs says how to get them") {
  const Folder folder;
  folder.study("quick");
  CHECK_THAT(folder.says({"calibrate", "study"}, 66), Contains("demcal train"));
}

TEST_CASE("two parameters of one quantity, and one without effect, are refused by name") {
  const Folder folder;
  const std::string more = "[parameters.f2]\ntarget = \"friction\"\nlow = 0.1\nhigh = 0.5\n";
  folder.study("quick");
  folder.replace("study/study.toml", "[controls.rpm]", more + "[controls.rpm]");
  CHECK_THAT(folder.says({"check", "study"}, 78), Contains("parameters.f2.target") &&
                                                      Contains("parameters.friction sets too, as contact.friction") &&
                                                      Contains("keep one"));
  folder.replace("study/study.toml", "target = \"friction\"", "target = \"contact.wall_friction\"");
  CHECK_THAT(folder.demcal({"check", "study"}).err, !Contains("sets too"));
  folder.replace("study/study.toml", "[controls.rpm]",
                 "[[contact.pair]]\nbetween = [\"powder\", \"wall\"]\nfriction = 0.1\n[controls.rpm]");
  CHECK_THAT(folder.says({"check", "study"}, 78),
             Contains("parameters.f2.target") && Contains("contact.wall_friction has no effect"));
}

TEST_CASE("a pair of materials is the same pair in either order") {
  const Folder folder;
  folder.study("quick");
  folder.replace("study/study.toml", "[materials.powder]", R"([materials.powder]
components = [{ material = "sand-fine", mass_fraction = 0.5 }, { material = "steel", mass_fraction = 0.5 }]
[materials.sand-fine]
density = "2600 kg/m3"
diameter = "0.8 mm"
[materials.steel]
density = "7800 kg/m3"
diameter = "0.8 mm"
[materials.unused])");
  const auto parameter = [](const std::string& name, const std::string& pair) {
    return "[parameters." + name + "]\ntarget = \"contact." + pair + ".friction\"\nlow = 0.1\nhigh = 0.5\n";
  };
  folder.replace("study/study.toml", "[controls.rpm]",
                 parameter("f1", "sand-fine-steel") + parameter("f2", "steel-sand-fine") + "[controls.rpm]");
  CHECK_THAT(folder.demcal({"check", "study"}).err,
             Contains("parameters.f2.target") && Contains("parameters.f1 sets too"));
}

TEST_CASE("a study with nothing to calibrate against is refused with what to add") {
  const Folder folder;
  folder.study("other-code");
  const std::string text = folder.read("study/study.toml");
  SECTION("no observations") {
    folder.write("study/study.toml", text.substr(0, text.find("[[observe]]")));
    for (const char* command : {"calibrate", "sample"}) {
      CHECK_THAT(folder.says({command, "study", "--out", "out"}, 78),
                 Contains("has no measurements to calibrate against (add [[observe]]"));
    }
    CHECK_THAT(folder.says({"check", "study"}, 0), Contains("note: there is no [[calibrate]] case yet"));
  }
  SECTION("a case that observes nothing") {
    folder.replace("study/study.toml", "observe = [\"bench\"]", "observe = []");
    CHECK_THAT(folder.says({"calibrate", "study", "--out", "out"}, 78),
               Contains("study.toml:25: calibrate.powder.observe: is an empty list (name at least one)"));
  }
  SECTION("an observation file without rows") {
    folder.write("study/bench.csv", "speed,torque,torque_se\n");
    CHECK_THAT(folder.says({"calibrate", "study", "--out", "out"}, 65),
               Contains("bench.csv: has a header but no rows (add the measured points)"));
  }
}

TEST_CASE("an observation outside the runs is refused by check and by sample with its line") {
  const Folder folder;
  folder.study("other-code");
  folder.replace("study/bench.csv", "\n300,", "\n600,");
  CHECK_THAT(folder.says({"check", "study"}, 78),
             Contains("bench.csv:10: speed: 600 rpm is outside the training range, 50 to 300 rpm"));
  CHECK_THAT(folder.says({"sample", "study", "--out", "out"}, 78),
             Contains("bench.csv:10: speed is 600 rpm") && Contains("leave the point out, or make runs there"));
}

TEST_CASE("fewer runs than a surrogate needs are named by check and calibrate, with how to get more") {
  const Folder folder;
  folder.study("other-code");
  std::string runs = folder.read("study/runs.csv");
  std::size_t end = runs.find("friction,");
  for (int line = 0; line < 5; ++line) end = runs.find('\n', end) + 1;  // the header and four runs
  folder.write("study/runs.csv", runs.substr(0, end));
  for (const auto& [command, status] : {std::pair{"check", 2}, {"calibrate", 65}}) {
    CHECK_THAT(folder.says({command, "study", "--out", "out"}, status),
               Contains("runs.csv: the study has 4 runs of torque, fewer than the 5 that 3 inputs need") &&
                   Contains("add rows to the table"));
  }
}

TEST_CASE("a prior that the data exclude is refused before sampling, with the values it allows") {
  const Folder folder;
  folder.study("other-code");
  folder.replace("study/study.toml", "free = [\"friction\", \"cohesion\"]",
                 "free = [\"friction\"]\nfixed = { cohesion = 0.5 }\n"
                 "priors = { friction = { kind = \"normal\", mean = 0.12, sd = 0.002 } }");
  CHECK_THAT(folder.says({"sample", "study", "--out", "out"}, 78),
             Contains("bench.csv:10: case 'powder': the priors of friction only allow") &&
                 Contains("but 11.24 mN m was measured; the parameters' ranges would allow it (widen or "
                          "move the priors)"));
}

TEST_CASE(
    "a sampler that does not exist, and a number of data sets that proves nothing, are refused with what may be") {
  const Folder folder;
  const std::string study = DEMCAL_SOURCE_DIR "/data/other-code";
  for (const char* number : {"0", "19", "-5", "100001", "many", "50.5"}) {
    const auto outcome = folder.demcal({"sample", study, "--sbc", number});
    INFO(number << ": " << outcome.err);
    CHECK(outcome.status == 64);
    CHECK_THAT(outcome.err, Contains("--sbc") && Contains(number) && Contains("20 to 100000"));
  }
  for (const char* command : {"sample", "calibrate"}) {
    CHECK_THAT(folder.says({command, study, "--sampler", "gibbs"}, 64),
               Contains("--sampler") && Contains("gibbs") && Contains("mixture") && Contains("nuts"));
  }
  CHECK(folder.demcal({"sample", study, "--sbc"}).status == 64);
  CHECK_FALSE(std::filesystem::exists(folder.path / "other-code-results"));
}

TEST_CASE("an instruction set that does not exist is refused with those that do") {
  const Folder folder;
  CHECK_THAT(folder.says({"simulate", DEMCAL_SOURCE_DIR "/data/developer", "--isa", "avx"}, 64),
             Contains("--isa") && Contains("avx") && Contains("x86-64-v3"));
}
