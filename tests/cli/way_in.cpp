// The first minutes of a new user: what the program says where, what it takes for a slip of the keys, and what it
// keeps apart.
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "tests/cli/program.hpp"

using Catch::Contains;
using test::Folder;
namespace fs = std::filesystem;

namespace {

const std::string other_code = DEMCAL_SOURCE_DIR "/data/other-code";

}  // namespace

TEST_CASE("the program without arguments shows its commands, and that nothing was done") {
  const Folder folder;
  const auto outcome = folder.demcal({});
  CHECK(outcome.status == 64);
  for (const char* command : {"new", "check", "train", "calibrate", "observe", "Example: demcal"})
    CHECK_THAT(outcome.out, Contains(command));
}

TEST_CASE("a mistyped command, option or value is answered with the one that was meant") {
  const Folder folder;
  const auto said = [&](const std::vector<std::string>& words) {
    const auto outcome = folder.demcal(words);
    CHECK(outcome.status == 64);
    CHECK(outcome.out.empty());
    return outcome.err;
  };
  CHECK(said({"calibrat", "x"}) == "calibrat: is not a command of demcal (did you mean 'calibrate'?)\n");
  CHECK(said({"calibrate", other_code, "--sed", "3"}) ==
        "--sed: is not an option of demcal calibrate (did you mean '--seed'?)\n");
  CHECK(said({"calibrate", other_code, "--sede=3"}) ==
        "--sede: is not an option of demcal calibrate (did you mean '--seed'?)\n");
  CHECK(said({"--verson"}) == "--verson: is not an option of demcal (did you mean '--version'?)\n");
  CHECK_THAT(said({"calibrate", other_code, "--sampler", "nutz"}), Contains("did you mean 'nuts'?"));
  CHECK_THAT(said({"zzzzzzzz"}), Contains("demcal --help lists them"));
}

TEST_CASE("a quantity set twice at a point, and a camera that stands nowhere, are refused before anything is read") {
  const Folder folder;
  const std::string quick = DEMCAL_SOURCE_DIR "/data/quick";
  CHECK_THAT(folder.says({"simulate", quick, "--at", "friction=0.5,rpm=150,friction=0.6"}, 64),
             Contains("--at friction") && Contains("set twice") && Contains("keep one"));
  for (const char* from : {"0,0,0", "nan,1,1", "inf,0,0"})
    CHECK_THAT(folder.says({"render", "no.vtkhdf", "--from", from}, 64),
               Contains("--from") && Contains("no direction"));
  CHECK_THAT(folder.says({"render", "no.vtkhdf", "--out", "bed.jpg"}, 64), Contains("bed.jpg") && Contains(".png"));
}

TEST_CASE("the answer of a command is on stdout, and its progress and warnings are on stderr") {
  const Folder folder;
  CHECK_THAT(folder.demcal({"new", "my-mixer"}).out, Contains("my-mixer/study.toml: edit it"));
  const auto check = folder.demcal({"check", "my-mixer"});
  CHECK_THAT(check.out, Contains("time step") && Contains("no problems"));
  CHECK_THAT(check.err, Contains("note: bench.csv") && !Contains("time step"));
  CHECK_THAT(folder.demcal({"design", other_code}).out, Contains("points to simulate"));

  const auto fit = folder.demcal({"fit", other_code});
  CHECK_THAT(fit.out, Contains("surrogate of torque: good"));
  CHECK(fit.err.empty());
  CHECK(folder.demcal({"fit", other_code, "--quiet"}).out.empty());
  const auto json = folder.demcal({"fit", other_code, "--json"});
  CHECK(nlohmann::json::parse(json.out)["status"] == "ok");
  CHECK_THAT(json.err, Contains("surrogate of torque: good"));
}

TEST_CASE("colours are for terminals that want them") {
  const Folder folder;
  folder.study("other-code");
  const std::string runs = folder.read("study/runs.csv");
  folder.write("study/runs.csv",
               runs + runs.substr(runs.rfind('\n', runs.size() - 2) + 1));  // the last row again: a copy
  const auto screen = [&](const std::string& environment) {                 // script gives the program a terminal
    return folder.shell(environment + " script -qec \"$demcal fit study --out out\" /dev/null").out;
  };
  const std::string yellow = "\x1b[33mwarning:";
  CHECK_THAT(screen("TERM=xterm NO_COLOR="), Contains(yellow));
  CHECK_THAT(screen("TERM=xterm NO_COLOR=1"), Contains("warning:") && !Contains("\x1b["));
  CHECK_THAT(screen("TERM=dumb NO_COLOR="), Contains("warning:") && !Contains("\x1b["));
}

TEST_CASE("an answer that finds no room is a failure, and one that nobody waits for is none") {
  const Folder folder;
  const auto full = folder.shell("\"$demcal\" fit " + other_code + " >/dev/full");
  CHECK(full.status == 73);
  CHECK_THAT(full.err, Contains("standard output: cannot be written"));
  CHECK(folder.shell("(\"$demcal\" fit " + other_code + "; echo $? >left) | true; sleep 0.1; cat left").out == "0\n");
}

TEST_CASE("what the command line sets stands in the report, and gives the study another hash", "[slow]") {
  const Folder folder;
  const auto study_line = [&](const std::vector<std::string>& more) {
    std::vector<std::string> words{"calibrate", other_code, "--out", "out", "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    const int status = folder.demcal(words).status;
    CHECK((status == 0 || status == 2));
    const nlohmann::json report = nlohmann::json::parse(folder.read("out/report.json"));
    return report["provenance"];
  };
  const nlohmann::json plain = study_line({});
  CHECK_FALSE(plain.contains("set on the command line"));
  const nlohmann::json set = study_line({"--set", "parameters.friction.high=0.85", "--seed", "3"});
  CHECK(set["set on the command line"] == "parameters.friction.high=0.85; study.seed=3");
  CHECK(set["study"] != plain["study"]);
  CHECK_THAT(folder.read("out/report.html"), Contains("Set on the command line: parameters.friction.high=0.85"));
  const auto again = folder.demcal({"report", other_code, "--out", "out"});
  CHECK_THAT(again.out, Contains("Set on the command line: parameters.friction.high=0.85; study.seed=3"));
}

TEST_CASE("two studies of one name do not replace each other's results", "[slow]") {
  const Folder folder;
  folder.study("other-code");
  CHECK(folder.demcal({"calibrate", "study", "--quiet"}).status == 0);
  const std::string kept = folder.read("other-code-results/report.json");
  CHECK_THAT(folder.says({"calibrate", other_code, "--quiet"}, 73),
             Contains("holds the results of another study") && Contains("study/study.toml") && Contains("--out DIR"));
  CHECK(folder.read("other-code-results/report.json") == kept);
  // A study that moved is still the same one.
  fs::rename(folder.path / "study", folder.path / "elsewhere");
  CHECK(folder.demcal({"calibrate", "elsewhere", "--quiet"}).status == 0);
}

TEST_CASE("the template's torque is no measurement until its rows are replaced") {
  const Folder folder;
  CHECK(folder.demcal({"new", "my-mixer"}).status == 0);
  const std::string words = "still holds the example that demcal new wrote";
  folder.write("my-mixer/bench.csv", "# mine\nrpm, torque, torque_se\n50,100,3\n150,98,3\n300,95,3\n");
  CHECK_THAT(folder.demcal({"check", "my-mixer"}).err, Contains(words));
  folder.write("my-mixer/bench.csv", "rpm,torque,torque_se\n50,100,3\n150,98,3\n300,96,3\n");
  CHECK_THAT(folder.demcal({"check", "my-mixer"}).err, !Contains(words));
}
