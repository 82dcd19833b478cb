// What must not happen whatever the input, the disk or the terminal does: nothing lost, nothing silently wrong, no
// crash, no hang, and a message with the place.
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <set>

#include "data/folder_lock.hpp"
#include "data/hdf5.hpp"
#include "data/origin.hpp"
#include "tests/cli/program.hpp"

using Catch::Contains;
using test::Folder;
namespace fs = std::filesystem;

namespace {

/// A log of one constant speed, 20 s, with a little noise.
std::string log_text() {
  std::string text = "time [s],torque [mN m],rpm\n";
  for (int i = 0; i < 400; ++i)
    text += fmt::format("{:.2f},{:.5f},100\n", 0.05 * i, 2.0 + 0.01 * ((i * 7919) % 101 - 50) / 50.0);
  return text;
}

/// Few of the rows, so that a calibration takes a second or two.
void make_study(const Folder& folder) {
  folder.study("other-code");
  std::string runs = folder.read("study/runs.csv"), few;
  std::size_t at = 0;
  for (int line = 0; line < 44 && at < runs.size(); ++line) at = runs.find('\n', at) + 1;
  folder.write("study/runs.csv", runs.substr(0, at));
}

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) names.push_back(entry.path().filename().string());
  return names;
}

}  // namespace

TEST_CASE("observe replaces neither a log nor anything else that demcal did not write") {
  const Folder folder;
  for (const char* victim : {"bench.dat", "bench.gp", "bench.svg", "bench.csv"}) {
    INFO(victim);
    folder.write("log.csv", log_text());
    folder.write(victim, "mine\n");
    CHECK_THAT(folder.says({"observe", "log.csv", "--out", "bench.csv"}, 73),
               Contains(victim) && Contains("was not written by demcal"));
    CHECK(folder.read(victim) == "mine\n");
    fs::remove(folder.path / victim);
  }
  folder.write("bench.dat", log_text());
  CHECK(folder.demcal({"observe", "bench.dat", "--out", "bench.csv"}).status == 73);
  CHECK(folder.read("bench.dat") == log_text());
  for (const char* out : {"o.svg", "o.gp", "o.dat"})
    CHECK(folder.demcal({"observe", "log.csv", "--out", out}).status == 64);
  // Its own result is replaced, unless it was edited since.
  CHECK(folder.demcal({"observe", "log.csv", "--out", "seen.csv"}).status == 0);
  CHECK(folder.demcal({"observe", "log.csv", "--out", "seen.csv"}).status == 0);
  folder.write("seen.csv", folder.read("seen.csv") + "# corrected by hand\n");
  CHECK(folder.demcal({"observe", "log.csv", "--out", "seen.csv"}).status == 73);
}

TEST_CASE("a file's name runs no command and breaks no picture") {
  const std::vector<std::string> names{"a'; system('touch PWNED'); set output 'b.csv",
                                       "< touch PIPED; cat x.csv",
                                       "O'Brien.csv",
                                       "-e.csv",
                                       "$(touch SHELL).csv",
                                       "`touch TICK`.csv",
                                       "a\"b.csv",
                                       "a\nsystem('touch LINE').csv",
                                       "\x1b]0;title\x07.csv",
                                       "<script>.csv",
                                       "Mischer \xc3\x9f 2.csv"};
  for (const std::string& name : names) {
    INFO(name);
    const Folder folder;
    folder.write("log.csv", log_text());
    const auto outcome = folder.demcal({"observe", "log.csv", "--out=" + name});
    INFO(outcome.err);
    CHECK(outcome.status == 0);
    CHECK(outcome.err.find('\x1b') == std::string::npos);
    CHECK(fs::exists(folder.path / name));
    const std::vector<std::string> there = names_in(folder.path);
    CHECK(std::count_if(there.begin(), there.end(), [](const std::string& one) { return one.ends_with(".svg"); }) == 1);
    const std::set<std::string> never{"PWNED", "PIPED", "SHELL", "TICK", "LINE"};
    for (const std::string& one : there) CHECK(never.count(one) == 0);
    CHECK(there.size() == 7);  // log, observations, three of the picture, two streams
  }
}

TEST_CASE("a new study takes no measurement's place, and its name passes its own check") {
  const Folder folder;
  fs::create_directory(folder.path / "m");
  folder.write("m/bench.csv", "rpm,torque,torque_se\n50,1,0.1\n");
  CHECK(folder.demcal({"new", "m"}).status == 73);
  CHECK(folder.read("m/bench.csv") == "rpm,torque,torque_se\n50,1,0.1\n");
  CHECK_FALSE(fs::exists(folder.path / "m/study.toml"));
  CHECK_THAT(folder.says({"new", ""}, 64), Contains("FOLDER: is empty"));
  for (const std::string name : {"Mischer \xc3\x9f 2", "a b", "O'Brien", "back\\slash", "\"quoted\""}) {
    INFO(name);
    CHECK(folder.demcal({"new", name}).status == 0);
    const auto checked = folder.demcal({"check", name});
    INFO(checked.err);
    CHECK((checked.status == 0 || checked.status == 2));
  }
}

TEST_CASE("options that are no numbers are refused") {
  const Folder folder;
  folder.write("log.csv", log_text());
  const std::vector<std::vector<std::string>> options{
      {"--tolerance", "nan"}, {"--idle", "nan"},        {"--idle", "inf"}, {"--dead-time", "nan"},
      {"--shortest", "nan"},  {"--window", "nan", "5"}, {"--rate", "0"},   {"--constant-speed", "nan"}};
  for (const std::vector<std::string>& option : options) {
    std::vector<std::string> words{"observe", "log.csv"};
    words.insert(words.end(), option.begin(), option.end());
    INFO(option[0]);
    CHECK(folder.demcal(words).status == 64);
  }
  for (const char* seed : {"-1", "18446744073709551616", "1.5", "x", ""})
    CHECK(folder.demcal({"check", DEMCAL_SOURCE_DIR "/data/other-code", "--seed", seed}).status == 64);
  for (const auto& [fill, why] : {std::pair{"-5", "-5 is not above 0"},
                                  {"\"-5 kg\"", "'-5 kg' is not above 0"},
                                  {"\"-5\"", "'-5' has no unit"}}) {
    const auto outcome =
        folder.demcal({"check", DEMCAL_SOURCE_DIR "/data/quick", "--set", std::string("rig.fill=") + fill});
    CHECK(outcome.status == 78);
    CHECK_THAT(outcome.err, Contains(std::string("rig.fill: ") + why));
  }
}

TEST_CASE("pipes, devices, loops and folders that are gone are named, and nothing waits") {
  const Folder folder;
  make_study(folder);
  REQUIRE(mkfifo((folder.path / "pipe").c_str(), 0600) == 0);
  REQUIRE(symlink("loop", (folder.path / "loop").c_str()) == 0);
  for (const char* input : {"pipe", "/dev/zero", "loop", "loop/study.toml"}) {
    INFO(input);
    for (const char* command : {"check", "observe"}) {
      const auto outcome = folder.demcal({command, input});
      INFO(outcome.err);
      CHECK(outcome.status == 66);
    }
  }
  for (const char* key : {"training.table", "observe.bench.file"}) {
    const auto outcome = folder.demcal({"check", "study", "--set", std::string(key) + "=../pipe"});
    INFO(outcome.err);
    CHECK(outcome.status == 66);
  }
  const auto gone = folder.shell("mkdir gone; cd gone; rmdir ../gone; \"$demcal\" check ../study; echo $? >&2");
  CHECK(gone.err.find("defect") == std::string::npos);
  CHECK(folder.demcal({"check", "study", "--set", "observe.bench.file="}).status == 78);
}

TEST_CASE("a terminal that is full or closed loses no result, and a result that cannot be given is no success") {
  const Folder folder;
  make_study(folder);
  for (const char* streams : {"2>/dev/full", "2>&-", "2>&- >&-"}) {
    INFO(streams);
    fs::remove_all(folder.path / "other-code-results");
    const auto outcome = folder.shell(std::string("\"$demcal\" calibrate study ") + streams);
    CHECK((outcome.status == 0 || outcome.status == 2));
    CHECK(fs::exists(folder.path / "other-code-results/report.json"));
    CHECK(fs::exists(folder.path / "other-code-results/report.html"));
  }
  for (const char* streams : {">/dev/full", ">&-"}) {
    const auto outcome = folder.shell(std::string("\"$demcal\" check study --json ") + streams);
    CHECK(outcome.status == 73);
    CHECK_THAT(outcome.err, Contains("standard output: cannot be written"));
  }
  CHECK(folder.shell("\"$demcal\" --help >/dev/full").status == 73);
  CHECK(folder.shell("\"$demcal\" check study 2>&1 | head -c 1 >/dev/null; echo done").out == "done\n");
}

TEST_CASE("control characters of a study do not reach the terminal") {
  const Folder folder;
  make_study(folder);
  folder.replace("study/study.toml", "[training]", "[training]\n\"\\u001b]0;owned\\u0007\" = 1");
  const auto outcome = folder.demcal({"check", "study"});
  CHECK(outcome.status == 78);
  CHECK(outcome.err.find('\x1b') == std::string::npos);
  CHECK_THAT(outcome.err, Contains("\\x1b]0;owned\\x07"));
}

TEST_CASE("a comment that is not UTF-8 changes nothing, not even in JSON") {
  const Folder plain, latin;
  make_study(plain);
  make_study(latin);
  latin.write("study/bench.csv",
              "# Ger\xe4t: R\xfchrwerk, 20 \xb0"
              "C\n" +
                  latin.read("study/bench.csv"));
  const auto first = plain.demcal({"calibrate", "study", "--json"}),
             second = latin.demcal({"calibrate", "study", "--json"});
  CHECK(second.status == first.status);
  const nlohmann::json a = nlohmann::json::parse(first.out), b = nlohmann::json::parse(second.out);
  CHECK(a["cases"][0]["parameters"] == b["cases"][0]["parameters"]);
}

TEST_CASE(
    "runs and observations of a German spreadsheet give the numbers of plain ones, and it is said how they were read") {
  const Folder plain, german;
  make_study(plain);
  make_study(german);
  for (const char* file : {"study/runs.csv", "study/bench.csv"}) {
    std::string text = german.read(file), changed;
    bool comment = true;
    for (std::size_t i = 0; i < text.size(); ++i) {
      if (i == 0 || text[i - 1] == '\n') comment = text[i] == '#';
      changed += comment ? text[i] : text[i] == ',' ? ';' : text[i] == '.' ? ',' : text[i];
    }
    german.write(file, changed);
  }
  const auto first = plain.demcal({"check", "study"}), second = german.demcal({"check", "study"});
  CHECK(second.status == first.status);
  CHECK_THAT(second.err, Contains("bench.csv: read as: separated by semicolons, decimal commas"));
  const auto a = plain.demcal({"fit", "study", "--json"}), b = german.demcal({"fit", "study", "--json"});
  REQUIRE(a.status == b.status);
  CHECK(nlohmann::json::parse(a.out) == nlohmann::json::parse(b.out));
}

TEST_CASE("a results folder is one calibration's at a time, and the second is told whose") {
  const Folder folder;
  make_study(folder);
  const data::FolderLock lock((folder.path / "other-code-results").string(), "results", "demcal calibrate");
  for (const char* command : {"calibrate", "fit", "sample"}) {
    CHECK_THAT(folder.says({command, "study"}, 73),
               Contains(fmt::format("is in use by process {}", getpid())) && Contains("demcal calibrate"));
  }
  const data::FolderLock training((folder.path / "quick-results").string(), "training", "demcal train");
  CHECK(folder.demcal({"train", DEMCAL_SOURCE_DIR "/data/quick"}).status == 73);
}

TEST_CASE("damage to a saved result is found, named and made good where it can be") {
  const Folder folder;
  make_study(folder);
  const auto first = folder.demcal({"calibrate", "study", "--json"});
  REQUIRE((first.status == 0 || first.status == 2));
  const auto flip = [&](const std::string& file, std::size_t at) {
    std::string bytes = folder.read(file);
    bytes[at % bytes.size()] = static_cast<char>(bytes[at % bytes.size()] ^ 4);
    folder.write(file, bytes);
  };
  const std::size_t middle = folder.read("other-code-results/report.json").size() / 2;
  flip("other-code-results/report.json", middle);
  const auto report = folder.demcal({"report", "study"});
  CHECK(report.status == 65);
  CHECK_THAT(report.err, Contains("report.json") && Contains("is damaged"));
  flip("other-code-results/surrogate.h5", folder.read("other-code-results/surrogate.h5").size() / 2);
  const auto again = folder.demcal({"calibrate", "study", "--json"});
  CHECK(again.status == first.status);
  CHECK_THAT(again.err, Contains("surrogate.h5 is fitted again"));
  CHECK(nlohmann::json::parse(again.out)["cases"] == nlohmann::json::parse(first.out)["cases"]);
  CHECK((folder.demcal({"report", "study"}).status == first.status));
}

TEST_CASE("a full disk ends no command with a signal: the file is named, and nothing half is left") {
  const Folder folder;
  make_study(folder);
  // A limit on the size of files stands for the disk: the n-th kilobyte is the one that does not fit.
  for (const int kilobytes : {1, 4, 12, 40, 120}) {
    INFO(kilobytes);
    fs::remove_all(folder.path / "other-code-results");
    const auto outcome =
        folder.shell(fmt::format("(ulimit -f {}; exec \"$demcal\" calibrate study --quiet)", 2 * kilobytes));
    INFO(outcome.err);
    CHECK(outcome.status == 73);  // the report alone is larger
    CHECK_THAT(outcome.err, Contains("other-code-results/") && Contains("cannot be written"));
    for (const std::string& name : names_in(folder.path)) CHECK_FALSE(name.ends_with(".tmp"));
  }
}

TEST_CASE("an --out that cannot be written is found at the start") {
  const Folder folder;
  make_study(folder);
  folder.write("file", "x");
  fs::create_directory(folder.path / "foreign");
  folder.write("foreign/report.html", "<p>the user's own</p>");
  for (const char* out : {"file/out", "foreign"}) {
    const auto outcome = folder.demcal({"calibrate", "study", "--out", out});
    INFO(outcome.err);
    CHECK(outcome.status == 73);
    CHECK(outcome.err.find("calibrating") == std::string::npos);
  }
  CHECK(folder.read("foreign/report.html") == "<p>the user's own</p>");
  CHECK_FALSE(fs::exists(folder.path / "foreign/surrogate.h5"));
}

TEST_CASE("rows of other settings stay in the table, and runs of other points stay beside run.h5", "[slow]") {
  const Folder folder;
  const auto train = [&](const std::string& restitution, const char* runs) {
    return folder.demcal({"train", DEMCAL_SOURCE_DIR "/data/quick", "--runs", runs, "--set", "rig.fill=200", "--set",
                          "run.longest=\"0.4 s\"", "--set", "run.start_up_turns=0.25", "--set",
                          "training.unsteady=\"use\"", "--set", "contact.restitution=" + restitution, "--out", "o"});
  };
  const auto rows = [&] {
    return data::open_hdf5((folder.path / "o/training.h5").string()).group("runs").read_texts("settings");
  };
  REQUIRE(train("0.7", "2").status == 0);
  REQUIRE(train("0.5", "1").status == 0);
  CHECK(rows().size() == 3);
  CHECK(std::set<std::string>{rows()[0], rows()[1], rows()[2]}.size() == 2);
  REQUIRE(train("0.7", "1").status == 0);
  CHECK(rows().size() == 4);

  // A damaged table is read from its copy, and written again whole.
  const std::string whole = folder.read("o/training.h5");
  std::string flipped = whole;
  flipped[flipped.size() / 2] ^= 1;
  folder.write("o/training.h5", flipped);
  const auto again = train("0.7", "1");
  CHECK(again.status == 0);
  CHECK_THAT(again.err, Contains("training.h5 is damaged; its rows are read from training.csv"));
  CHECK(rows().size() == 5);

  const auto simulate = [&](const char* rpm, const char* longest = "0.4 s") {
    return folder.demcal({"simulate", DEMCAL_SOURCE_DIR "/data/quick", "--set", "rig.fill=200", "--set",
                          fmt::format("run.longest=\"{}\"", longest), "--set", "run.start_up_turns=0.25", "--at",
                          std::string("rpm=") + rpm, "--out", "s"});
  };
  simulate("100");
  const auto other = simulate("200");
  CHECK_THAT(other.err, Contains("run.h5 holds another run and is kept"));
  CHECK(names_in(folder.path / "s").size() == 2);
  const auto longer = simulate("100", "0.5 s");
  CHECK_THAT(longer.err,
             Contains("run.h5 holds this run with another length and is kept; this one goes on from it, in run-"));
  CHECK(names_in(folder.path / "s").size() == 3);
}

#ifndef __SANITIZE_ADDRESS__
TEST_CASE("memory that the system does not give ends a command with words, and nothing half is left", "[slow]") {
  const Folder folder;
  make_study(folder);
  int refused = 0;
  for (int megabytes = 84; megabytes <= 132; megabytes += 2) {
    INFO(megabytes);
    fs::remove_all(folder.path / "out");
    const auto outcome =
        folder.shell(fmt::format("(ulimit -v {}; exec \"$demcal\" fit study --out out --quiet)", 1000 * megabytes));
    INFO(outcome.err);
    if (outcome.status == 127) continue;  // not even the libraries fit
    CHECK((outcome.status == 65 || outcome.status == 0));
    if (outcome.status == 65) {
      ++refused;
      CHECK_THAT(outcome.err, Contains("needs more memory than the system gives"));
      CHECK_FALSE(fs::exists(folder.path / "out/surrogate.h5"));
    }
  }
  CHECK(refused > 0);
}
#endif

TEST_CASE("a run table is read from its copy where it is gone, and never from a damaged copy", "[slow]") {
  const Folder folder;
  const auto tiny = [&](const std::string& command, std::vector<std::string> more) {
    std::vector<std::string> words{command, DEMCAL_SOURCE_DIR "/data/quick", "--out", "o"};
    for (const char* key : {"rig.fill=200", "run.longest=\"0.4 s\"", "run.start_up_turns=0.25",
                            "training.unsteady=\"use\"", "training.runs=2"})
      words.insert(words.end(), {"--set", key});
    words.insert(words.end(), more.begin(), more.end());
    return folder.demcal(words);
  };
  REQUIRE(tiny("train", {}).status == 0);
  const std::string table = folder.read("o/training.csv");
  fs::remove(folder.path / "o/training.h5");
  const auto again = tiny("train", {});
  CHECK(again.status == 0);
  CHECK_THAT(again.err, Contains("training.h5 is not there; its rows are read from training.csv"));
  CHECK(folder.read("o/training.csv") == table);

  fs::remove(folder.path / "o/training.h5");
  std::string flipped = table;
  flipped[flipped.rfind('1')] = '2';
  folder.write("o/training.csv", flipped);
  const auto refused = tiny("train", {});
  CHECK(refused.status == 65);
  CHECK_THAT(refused.err, Contains("training.csv: is damaged"));
  CHECK(folder.read("o/training.csv") == flipped);
}

TEST_CASE("lists of points and exported points that were changed are said or refused") {
  const Folder folder;
  const std::string quick = DEMCAL_SOURCE_DIR "/data/quick";
  REQUIRE(folder.demcal({"design", quick, "--out", "o", "--runs", "3"}).status == 0);
  CHECK(folder.demcal({"check", quick, "--out", "o"}).err.find("design.csv") == std::string::npos);
  std::string list = folder.read("o/design.csv");
  list[list.rfind('1')] = '2';
  folder.write("o/design.csv", list);
  CHECK_THAT(folder.demcal({"check", quick, "--out", "o"}).err,
             Contains("o/design.csv: was changed since demcal wrote it"));

  REQUIRE(folder.demcal({"export", quick, "case", "--to", "liggghts", "--at", "hamaker=0"}).status == 0);
  std::string point = folder.read("case/point.json");
  point[point.find("friction=0.") + 11] ^= 1;
  folder.write("case/point.json", point);
  const auto outcome = folder.demcal({"export", quick, "case", "--collect"});
  CHECK(outcome.status == 65);
  CHECK_THAT(outcome.err, Contains("case/point.json: is damaged"));
}

TEST_CASE("training at the posterior that was interrupted does what was left, and no further points", "[slow]") {
  const Folder folder;
  const auto call = [&](std::vector<std::string> words) {
    words.insert(words.begin() + 1, {DEMCAL_SOURCE_DIR "/data/quick", "--out", "o"});
    for (const char* key :
         {"rig.fill=200", "run.longest=\"0.4 s\"", "run.start_up_turns=0.25", "training.unsteady=\"use\""})
      words.insert(words.end(), {"--set", key});
    return folder.demcal(words);
  };
  REQUIRE(call({"design", "--runs", "3"}).status == 0);
  const std::string list = folder.read("o/design.csv");
  folder.write("o/next-runs.csv", list);
  // Two of three points were asked for, and the last one of the list is what an interrupted call left to do.
  const std::size_t heading = list.find('\n', list.find("\nmaterial,") + 1) + 1;
  const std::size_t last = list.rfind('\n', list.size() - 2) + 1;
  folder.write("o/design.csv", list.substr(0, heading) + list.substr(last));
  const auto outcome = call({"train", "--at-posterior", "2"});
  INFO(outcome.err);
  CHECK(outcome.status == 0);
  CHECK_THAT(outcome.err, Contains("1 run to make, left by an unfinished campaign"));
}

TEST_CASE("a file that cannot be written is named once") {
  const Folder folder;
  const auto outcome = folder.shell("(ulimit -f 2; exec \"$demcal\" new mixer)");  // the study is longer
  CHECK(outcome.status == 73);
  CHECK_THAT(outcome.err, Contains("study.toml: cannot be written: File too large"));
  CHECK(outcome.err.find("study.toml") == outcome.err.rfind("study.toml"));
}

TEST_CASE("names of a study lead to no file outside the results folder") {
  const Folder folder;
  folder.study("quick");
  folder.replace("study/study.toml", "[materials.powder]", "[materials.\"../../../EVIL\"]");
  folder.replace("study/study.toml", "material = \"powder\"", "material = \"../../../EVIL\"");
  const auto outcome = folder.demcal({"train",  "study",
                                      "--runs", "1",
                                      "--set",  "rig.fill=200",
                                      "--set",  "run.settle=\"0.002 s\"",
                                      "--set",  "run.start_up=\"0.002 s\"",
                                      "--set",  "run.shortest=\"0.002 s\"",
                                      "--set",  "run.longest=\"0.004 s\"",
                                      "--set",  "run.shortest_turns=0",
                                      "--set",  "run.start_up_turns=0",
                                      "--set",  "run.window=\"0.2 ms\"",
                                      "--set",  "run.sample_interval=\"0.1 ms\"",
                                      "--out",  "a/b/c/o"});
  INFO(outcome.err);
  int found = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder.path)) {
    const std::string inside = entry.path().lexically_relative(folder.path).string();
    if (inside.find("EVIL") == std::string::npos) continue;
    CHECK(inside.find("a/b/c/o/runs/") == 0);
    ++found;
  }
  CHECK(found == 1);
  CHECK(fs::exists(folder.path / "a/b/c/o/runs"));
}
