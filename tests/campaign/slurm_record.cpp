// What is remembered of the runs that are with Slurm.
#include "campaign/slurm_record.hpp"

#include <catch2/catch.hpp>
#include <filesystem>

#include "tests/temporary.hpp"

using namespace campaign;

TEST_CASE("what is remembered comes back, without the jobs that have no run any more") {
  const TemporaryFolder folder;
  SlurmRecord record = load_slurm_record(folder.path(), "my study");
  CHECK(record.prefix.starts_with("demcal-my-study-"));
  record.next = 4;
  record.jobs = {{"a-1", {.id = "12", .tasks = 3}}, {"a-2", {.id = "", .tasks = 1}}, {"a-3", {.id = "14", .tasks = 2}}};
  record.runs = {{"run-1", {.job = "a-1", .task = 2, .tries = 2, .steps = 123456789012345}},
                 {"run-2", {.job = "a-2", .task = 0, .tries = 1, .steps = 0}}};
  save_slurm_record(folder.path(), record);
  const SlurmRecord back = load_slurm_record(folder.path(), "my study");
  CHECK(back.prefix == record.prefix);
  CHECK(back.next == 4);
  CHECK(back.jobs.size() == 2);
  CHECK(back.jobs.at("a-1").id == "12");
  CHECK(back.jobs.at("a-2").id.empty());
  CHECK(back.runs.size() == 2);
  CHECK(back.runs.at("run-1").task == 2);
  CHECK(back.runs.at("run-1").tries == 2);
  CHECK(back.runs.at("run-1").steps == 123456789012345);
  CHECK(job_ids(back) == std::vector<std::string>{"12"});
}

TEST_CASE("a damaged memory is a new campaign under another name, so that no job is taken for another") {
  const TemporaryFolder folder;
  SlurmRecord record = load_slurm_record(folder.path(), "study");
  record.jobs = {{"a-1", {.id = "12", .tasks = 3}}};
  record.runs = {{"run-1", {.job = "a-1"}}};
  save_slurm_record(folder.path(), record);
  const std::string file = "slurm/campaign.json";
  folder.write(file, folder.read(file).substr(0, 90));
  const SlurmRecord fresh = load_slurm_record(folder.path(), "study");
  CHECK(fresh.runs.empty());
  CHECK(fresh.prefix != record.prefix);
}
