#pragma once
// Common parts of `fit`, `sample` and `calibrate`: options from the command line, the rows to learn from, and the files
// written.
#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include "cli/command.hpp"
#include "data/progress.hpp"
#include "uq/calibrate/calibrate.hpp"

namespace cli {

/// The rows of the run table, which are checked here (uq/calibrate/data_check.hpp): the check's findings are added to
/// the rows'. Throws InputError (66) when there are no rows, saying how to get some, and (65, 78) for what cannot be
/// meant; prints what was left out.
StudyRows rows_to_learn_from(const Common& common, const Workspace& workspace);

/// The study's options of every surrogate. They hold the surrogates of OUT/surrogate.h5 if the file is still of this
/// study and table; if not, the user is told why.
uq::SurrogateOptions surrogate_options(const Common& common, const Workspace& workspace, const StudyRows& rows);

/// Writes OUT/surrogate.h5 if there is anything new; surrogates that it held and that are still valid stay.
void keep_surrogates(const Workspace& workspace, const StudyRows& rows, const uq::SurrogateOptions& options,
                     const std::vector<uq::FittedSurrogate>& fitted);

/// Says the first lines of `fit` and `sample`, as `calibrate` says them: warnings, then notes. Returns the warnings.
std::vector<std::string> say_warnings(const Common& common, const StudyRows& rows,
                                      const std::vector<uq::FittedSurrogate>& fitted,
                                      const std::vector<std::string>& more = {});

/// Writes OUT/next-runs.csv: points of the posteriors that lie far from the runs, a training design for any code.
void write_next_runs(const Workspace& workspace, const std::vector<uq::SupportReport>& supports);

/// Says how good each surrogate is, and what its fit has to say.
void say_surrogates(const Common& common, const std::vector<uq::FittedSurrogate>& fitted);

/// The report's provenance and the choices behind it, as the study, the table and the DEM's settings tell them.
void add_provenance(uq::CalibrationReport& report, const Workspace& workspace, const StudyRows& rows);

/// Names of the inputs that have changed since the report was made: the study, its table, its observations.
std::vector<std::string> changed_since(const uq::CalibrationReport& report, const Workspace& workspace,
                                       const StudyRows& rows);

/// Takes the plans of OUT/report.json into a new report where nothing that they rest on has changed; else says what
/// has. Says, too, where OUT/plan.json is of a plan that no report holds.
void keep_plans(const Common& common, const Workspace& workspace, const StudyRows& rows, uq::CalibrationReport& report);

/// Writes report.json, and report.html with its figures, into OUT.
void write_report(const Workspace& workspace, const uq::CalibrationReport& report);
/// Says the report on the terminal, and returns the exit status that follows from it.
data::ExitStatus say_report(const Common& common, const Workspace& workspace, const uq::CalibrationReport& report);

/// Adds --sampler mixture|nuts, which replaces what each case says.
std::shared_ptr<std::optional<data::Sampler>> add_sampler_option(CLI::App& command);

/// A progress display of `what`, fed by CalibrateOptions::progress.
class JobProgress {
 public:
  JobProgress(const Common& common, const std::string& what)
      : progress_(
            what, 1000,
            {.style = common.quiet ? data::ProgressStyle::quiet : data::ProgressStyle::automatic, .counted = false}) {}
  void operator()(const std::string&, double share) {
    progress_.set(static_cast<std::uint64_t>(std::lround(1000.0 * share)));
  }

 private:
  data::Progress progress_;
};

}  // namespace cli
