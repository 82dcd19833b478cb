// A campaign around the posterior, with results that are made up: what it asks for, when it ends, what it leaves
// behind.
#include "campaign/posterior_campaign.hpp"
#include "campaign/out_files.hpp"

#include <catch2/catch.hpp>
#include <filesystem>

#include "tests/campaign/fake_slurm.hpp"
#include "tests/temporary.hpp"

using namespace campaign;

namespace {

BatchResult result_of(const std::vector<bool>& ended, std::size_t finished) {
  BatchResult result;
  result.ended = ended;
  result.finished = finished;
  return result;
}

}  // namespace

TEST_CASE("a campaign makes no more runs than were asked for, and an interrupted one goes on with what is left") {
  const TemporaryFolder folder;
  const Workspace workspace = test::small_study(folder.path("out"));
  std::filesystem::create_directories(workspace.out);
  const PosteriorLimits limits{.batch = 2, .runs = 3, .seconds = {}};
  PosteriorCampaign campaign(workspace, limits, study_rows(workspace));
  CHECK_FALSE(campaign.continued());
  CHECK_FALSE(campaign.look());  // a surrogate needs runs first
  REQUIRE(campaign.choose(0.0));
  CHECK_FALSE(campaign.chosen());
  REQUIRE(campaign.batch().size() == 3);
  campaign.take(result_of({true, false, false}, 1));
  CHECK(campaign.batch().size() == 2);
  CHECK(campaign.runs_left() == 2);

  PosteriorCampaign next(workspace, limits, study_rows(workspace));
  CHECK(next.continued());
  CHECK(next.runs_left() == 2);
  REQUIRE(next.batch().size() == 2);
  REQUIRE(next.choose(0.0));
  next.take(result_of({true, true}, 2));
  CHECK(next.totals().finished == 2);
  next.look();
  CHECK_FALSE(next.choose(0.0));
  CHECK(next.ending() == CampaignEnding::runs_made);
  CHECK(std::filesystem::exists(posterior_runs_path(workspace)));
  next.finish();
  CHECK_FALSE(std::filesystem::exists(posterior_runs_path(workspace)));
}

TEST_CASE("a campaign ends when its time is up, or when nothing but failures comes back") {
  const TemporaryFolder folder;
  const Workspace workspace = test::small_study(folder.path("out"));
  std::filesystem::create_directories(workspace.out);
  PosteriorCampaign late(workspace, {.batch = 2, .seconds = 60.0}, study_rows(workspace));
  CHECK_FALSE(late.runs_left());
  late.look();
  CHECK(late.choose(59.0));
  CHECK_FALSE(late.choose(61.0));
  CHECK(late.ending() == CampaignEnding::time_up);

  PosteriorCampaign failing(workspace, {.batch = 2, .seconds = 60.0}, study_rows(workspace));
  for (int batch = 0; batch < 30 && !failing.ending(); ++batch) {
    failing.look();
    REQUIRE(failing.choose(0.0));
    BatchResult none = result_of(std::vector<bool>(failing.batch().size(), true), 0);
    none.failures.assign(failing.batch().size(), "the run failed");
    failing.take(none);
  }
  CHECK(failing.ending() == CampaignEnding::too_many_failed);
}
