#include "campaign/out_files.hpp"

#include <filesystem>

#include "campaign/workspace.hpp"

namespace campaign {
namespace {

std::string in_out(const Workspace& workspace, const std::string& name) {
  return (std::filesystem::path(workspace.out) / name).string();
}

}  // namespace

std::string training_path(const Workspace& workspace) { return in_out(workspace, "training.h5"); }
std::string training_copy_path(const Workspace& workspace) { return in_out(workspace, "training.csv"); }
std::string design_path(const Workspace& workspace) { return in_out(workspace, "design.csv"); }
std::string next_runs_path(const Workspace& workspace) { return in_out(workspace, "next-runs.csv"); }
std::string posterior_runs_path(const Workspace& workspace) { return in_out(workspace, "posterior-runs.csv"); }
std::string verify_runs_path(const Workspace& workspace) { return in_out(workspace, "verify-runs.csv"); }
std::string surrogate_path(const Workspace& workspace) { return in_out(workspace, "surrogate.h5"); }
std::string results_path(const Workspace& workspace) { return in_out(workspace, "report.json"); }
std::string page_path(const Workspace& workspace) { return in_out(workspace, "report.html"); }
std::string plan_path(const Workspace& workspace) { return in_out(workspace, "plan.json"); }

std::string posterior_path(const Workspace& workspace, const std::string& case_name) {
  return in_out(workspace, "posterior-" + case_name + ".nc");
}

}  // namespace campaign
