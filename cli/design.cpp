// demcal design: the points that demcal train would simulate next.
#include <fmt/core.h>

#include <filesystem>

#include "campaign/design.hpp"
#include "campaign/out_files.hpp"
#include "cli/command.hpp"

namespace cli {

Action add_design(CLI::App& program) {
  struct Options {
    Common common;
    int runs = 0;
  };
  const auto options = std::make_shared<Options>();
  CLI::App* command = add_study_command(program, "design", "the training design, extended from what exists",
                                        "demcal design data/developer --runs 12", options->common);
  command
      ->add_option("--runs", options->runs,
                   "so many points: those still missing, or, when there are none, further ones")
      ->check(CLI::Range(1, 100000));
  return [options] {
    const Common& common = options->common;
    const Workspace workspace = open_workspace(common);
    const auto held = hold_out(workspace, Writes::training, "design");
    const StudyRows rows = study_rows(workspace);
    for (const std::string& note : rows.notes) say(common, "note: " + note);
    const Campaign campaign = plan_campaign(workspace, rows.all, options->runs);
    write_design(workspace, campaign.listed(campaign.points));
    const std::string path = design_path(workspace);
    answer(common, fmt::format("{} to simulate, {} exist: {}", data::counted(campaign.points.size(), "point"),
                               data::counted(rows.all.rows.size(), "row"), path));
    print_json(common, {{"points", campaign.points.size()}, {"rows", rows.all.rows.size()}, {"design", path}});
    return data::ExitStatus::done;
  };
}

}  // namespace cli
