// Rows of a run table that are not learnt from, and what is said of them.
#include <catch2/catch.hpp>

#include "data/run_table.hpp"
#include "data/run_table_files.hpp"
#include "tests/temporary.hpp"

using Catch::Contains;

namespace {

const std::string header = "friction,speed,torque,torque_se";

data::TableRead read(const std::string& rows, const std::string& training = "", const std::string& head = header) {
  const TemporaryFolder folder;
  folder.write("runs.csv", head + "\n" + rows);
  const auto path = folder.write("study.toml",
                                 "[study]\nname = \"s\"\n[parameters.friction]\nlow = 0.1\nhigh = 0.8\n"
                                 "[controls.speed]\nunit = \"rpm\"\nlow = 50\nhigh = 300\n[outputs.torque]\n"
                                 "unit = \"mN m\"\n[training]\ntable = \"runs.csv\"\n" +
                                     training);
  const data::StudyFile file = data::StudyFile::open(path);
  const data::Study study = data::read_study(file);
  file.finish();
  return data::read_table(study.training.table, study);
}

const data::Finding* find(const data::TableRead& read, const std::string& kind) {
  for (const data::Finding& finding : read.findings)
    if (data::to_text(finding.kind) == kind) return &finding;
  return nullptr;
}

}  // namespace

TEST_CASE("rows of one point with one seed are replicates, and all are kept") {
  const auto found = read("0.4,100,8.1,0.1,1\n0.4,100,8.2,0.1,1\n0.5,100,9.0,0.1,1\n", "", header + ",seed");
  CHECK(data::used_rows(found.table) == 3);
  REQUIRE(find(found, "seed column"));
  CHECK(find(found, "seed column")->severity == data::Severity::note);
  const data::RunTable merged = data::merge({.rows = {}}, found.table);
  CHECK(merged.rows.size() == 3);
}

TEST_CASE("runs equal to the last digit count once, whatever their seeds, and the copies are named") {
  const auto found =
      read("0.4,100,8.13579,0.1,1\n0.5,100,9.02468,0.1,1\n0.4,100,8.13579,0.1,2\n", "", header + ",seed");
  CHECK(data::used_rows(found.table) == 2);
  CHECK(found.table.rows[2].left_out.words == "a copy of runs.csv:2");
  const data::Finding* copies = find(found, "copied rows");
  REQUIRE(copies);
  CHECK(copies->severity == data::Severity::warning);
  CHECK(copies->places == std::vector<std::string>{"runs.csv:4"});
}

TEST_CASE("a deterministic code's equal rows are no warning: nothing is counted twice where there is no noise") {
  const auto found = read("0.4,100,8.13579,0\n0.4,100,8.13579,0\n0.5,100,9,0\n");
  REQUIRE(find(found, "copied rows"));
  CHECK(find(found, "copied rows")->severity == data::Severity::note);
}

TEST_CASE("an output of 0 with a standard error of 0 among others that have errors is a run that failed") {
  const auto found = read("0.4,100,8.1,0.1\n0.5,100,0,0\n0.6,100,9,0.1\n0.7,100,9.5,0.1\n");
  CHECK(data::used_rows(found.table) == 3);
  REQUIRE(find(found, "failed runs"));
  CHECK(find(found, "failed runs")->severity == data::Severity::warning);
  CHECK_THAT(find(found, "failed runs")->place, Contains("runs.csv:3"));
  // A zero with an error, or where no run has one, is a value like any other.
  CHECK(data::used_rows(read("0.4,100,8.1,0.1\n0.5,100,0,0.1\n0.6,100,9,0.1\n").table) == 3);
  CHECK(data::used_rows(read("0.4,100,8.1,0\n0.5,100,0,0\n0.6,100,9,0\n").table) == 3);
}

TEST_CASE("one number in the place of several results is no result, whatever its error") {
  const std::string good = "0.2,100,8,0.1\n0.3,150,9,0.1\n0.5,120,8.5,0.1\n0.7,250,7,0.1\n";
  const auto left_out = [&](const std::string& more) {
    const auto found = read(good + more);
    const data::Finding* failed = find(found, "failed runs");
    CHECK((failed != nullptr) == (data::used_rows(found.table) == 4));
    return failed == nullptr ? std::vector<std::string>() : failed->places;
  };
  CHECK(left_out("0.4,100,1e30,1e30\n0.25,200,1e30,1e30\n0.6,90,1e30,1e30\n").size() == 3);
  CHECK(left_out("0.4,100,9999,0.1\n0.25,200,9999,0.1\n0.6,90,9999,0.1\n").size() == 3);
  CHECK(left_out("0.4,100,1.7e308,0.1\n").size() == 1);
  CHECK(left_out("0.4,100,0,0.1\n0.25,200,0,0.1\n0.6,90,0,0.1\n").size() == 3);
  CHECK(left_out("0.4,100,-1,0.1\n0.25,200,-1,0.1\n0.6,90,-1,0.1\n").size() == 3);
  CHECK(left_out("0.4,100,-1,0.1\n0.25,200,-1.1,0.1\n0.6,90,-1,0.1\n").empty());  // not the same to the last digit
  CHECK(left_out("0.4,100,80,0.1\n").empty());                               // an outlier, for the surrogate to name
  CHECK(left_out("0.1,100,0,0.1\n0.1,200,0,0.1\n0.15,90,0,0.1\n").empty());  // where friction is low: the model's
  CHECK(left_out("0.4,100,9.5,0.1\n0.25,200,9.5,0.1\n0.6,90,9.5,0.1\n").empty());  // rounded
}

TEST_CASE("a word of failure instead of a result leaves the row out, and another word is no number") {
  const auto found = read("0.2,100,8,0.1\n0.3,150,FAILED,\n0.5,120,diverged,0.1\n0.7,250,7,0.1\n");
  CHECK(data::used_rows(found.table) == 2);
  CHECK_THAT(found.left_out.at(0), Contains("runs.csv:3: torque") && Contains("says 'FAILED'"));
  CHECK_THROWS_WITH(read("0.2,100,eight,0.1\n"), Contains("'eight' is not a number"));
}

TEST_CASE("words of failure in a status column leave the row out, and a column use is the user's own choice") {
  const auto status = read("0.4,100,8.1,0.1,ok\n0.5,100,3,0.1,FAILED\n0.6,100,9,0.1,done\n", "", header + ",status");
  CHECK(data::used_rows(status.table) == 2);
  REQUIRE(find(status, "failed runs"));
  CHECK_THAT(find(status, "failed runs")->what, Contains("status says 'FAILED'"));
  for (const auto& [heading, well, badly] : {std::tuple{"run_status", "completed", "lost particles"},
                                             {"Run Status", "ok", "failed"},
                                             {"exit_code", "0", "137"},
                                             {"ReturnCode", "0", "1"},
                                             {"Job-Status", "done", "timeout"}}) {
    const auto row = [](const char* front, const char* word) { return std::string(front) + "," + word + "\n"; };
    const auto other = read(row("0.4,100,8.1,0.1", well) + row("0.5,100,3,0.1", badly) + row("0.6,100,9,0.1", well), "",
                            header + "," + heading);
    INFO(heading);
    CHECK(data::used_rows(other.table) == 2);
    CHECK(find(other, "failed runs"));
  }
  const auto converged = read("0.4,100,8.1,0.1,1\n0.5,100,3,0.1,0\n", "", header + ",converged");
  CHECK(data::used_rows(converged.table) == 1);
  const auto use = read("0.4,100,8.1,0.1,1\n0.5,100,3,0.1,0\n", "", header + ",use");
  CHECK(data::used_rows(use.table) == 1);
  REQUIRE(use.findings.size() == 1);
  CHECK(use.findings[0].severity == data::Severity::note);
}

TEST_CASE("the study leaves rows out by their line or by file and line, and they keep their place") {
  const auto found = read("0.4,100,8.1,0.1\n0.5,100,80,0.1\n0.6,100,9,0.1\n", "leave_out = [3, \"runs.csv:4\"]\n");
  CHECK(found.table.rows.size() == 3);
  CHECK(data::used_rows(found.table) == 1);
  CHECK(found.table.rows[1].place == "runs.csv:3");
  REQUIRE(find(found, "rows left out"));
  CHECK(find(found, "rows left out")->severity == data::Severity::note);
  CHECK(data::names_row("runs.csv:31", "runs.csv:31"));
  CHECK(data::names_row("31", "runs.csv:31"));
  CHECK_FALSE(data::names_row("1", "runs.csv:31"));
  CHECK_FALSE(data::names_row("other.csv:31", "runs.csv:31"));
}

TEST_CASE("columns that nothing reads are named with what they hold") {
  const auto found = read("0.4,100,8.1,0.1,200,a\n0.5,100,8.6,0.1,300,b\n", "", header + ",fill,remark_of_mine");
  REQUIRE(find(found, "unread columns"));
  CHECK_THAT(find(found, "unread columns")->what,
             Contains("fill (from 200 to 300)") && Contains("remark_of_mine (text)"));
  CHECK(data::used_rows(found.table) == 2);
}
