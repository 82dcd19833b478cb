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
    const auto outcome = folder.demcal({command, "study"});
    CHECK(outcome.status == 78);
    CHECK_THAT(outcome.err, Contains("study.toml:") && Contains("restitutoin") && Contains("restitution"));
  }
}

TEST_CASE("a friction of -1 is refused wherever it stands, with its bound") {
  const Folder folder;
  folder.study("developer");
  SECTION("as a setting") {
    const auto outcome = folder.demcal({"check", "study", "--set", "contact.friction=-1"});
    CHECK(outcome.status == 78);
    CHECK_THAT(outcome.err, Contains("contact.friction") && Contains("-1") && Contains("0"));
  }
  SECTION("as the low end of the parameter's range") {
    folder.replace("study/study.toml", "low = 0.1", "low = -1");
    const auto outcome = folder.demcal({"calibrate", "study"});
    CHECK(outcome.status == 78);
    CHECK_THAT(outcome.err, Contains("study.toml:") && Contains("friction") && Contains("-1"));
  }
  SECTION("as a point to simulate") {
    const auto outcome = folder.demcal({"simulate", "study", "--at", "friction=-1"});
    CHECK(outcome.status == 64);
    CHECK_THAT(outcome.err, Contains("--at friction") && Contains("-1"));
  }
}

TEST_CASE("an observation file without its standard errors is refused with file and column") {
  const Folder folder;
  folder.study("other-code");
  folder.replace("study/bench.csv", "speed,torque,torque_se", "speed,torque,torque_error");
  const auto outcome = folder.demcal({"calibrate", "study"});
  CHECK(outcome.status == 65);
  CHECK_THAT(outcome.err, Contains("bench.csv") && Contains("torque_se"));
}

TEST_CASE("a truncated training table is refused with its place") {
  const Folder folder;
  folder.study("developer");
  const std::string table = folder.read("study/training.csv");
  for (const std::size_t kept : {table.size() / 3, table.size() / 2, table.size() - 3}) {
    folder.write("study/training.csv", table.substr(0, kept));
    const auto outcome = folder.demcal({"calibrate", "study"});
    CHECK(outcome.status == 65);
    CHECK_THAT(outcome.err, Contains("training.csv"));
  }
}

TEST_CASE("a missing study, an unknown command and an unknown point each have their status") {
  const Folder folder;
  CHECK(folder.demcal({"check", "nowhere"}).status == 66);
  CHECK(folder.demcal({"calibrat"}).status == 64);
  CHECK(folder.demcal({}).status == 64);
  folder.study("developer");
  const auto outcome = folder.demcal({"simulate", "study", "--at", "frictoin=0.3"});
  CHECK(outcome.status == 64);
  CHECK_THAT(outcome.err, Contains("frictoin") && Contains("friction, hamaker, rpm"));
}

TEST_CASE("nothing is ever written into the study's own folder") {
  const Folder folder;
  folder.study("other-code");
  const auto outcome = folder.demcal({"calibrate", "study", "--out", "study"});
  CHECK(outcome.status == 73);
  CHECK_THAT(outcome.err, Contains("own folder"));
}

TEST_CASE("a study without training runs says how to get them") {
  const Folder folder;
  folder.study("quick");
  const auto outcome = folder.demcal({"calibrate", "study"});
  CHECK(outcome.status == 66);
  CHECK_THAT(outcome.err, Contains("demcal train"));
}
