#pragma once
// The results folder: what each file in it is called. A run's own file is run_path (design.hpp), figures are
// uq/report's.
#include <string>

namespace campaign {

struct Workspace;

std::string training_path(const Workspace& workspace);       ///< training.h5: all rows that were made
std::string training_copy_path(const Workspace& workspace);  ///< training.csv: the same, to read
std::string design_path(const Workspace& workspace);         ///< design.csv: points to simulate
std::string next_runs_path(const Workspace& workspace);      ///< next-runs.csv: points that would sharpen the posterior
std::string posterior_runs_path(const Workspace& workspace);  ///< posterior-runs.csv: points that are being made
std::string verify_runs_path(const Workspace& workspace);     ///< verify-runs.csv: points that confirm the posterior
std::string surrogate_path(const Workspace& workspace);       ///< surrogate.h5: the fitted surrogates
std::string results_path(const Workspace& workspace);         ///< report.json: all that was found
std::string page_path(const Workspace& workspace);            ///< report.html: the same as a page
std::string plan_path(const Workspace& workspace);            ///< plan.json: what to measure next
/// posterior-CASE.nc: draws and data of a case.
std::string posterior_path(const Workspace& workspace, const std::string& case_name);

}  // namespace campaign
