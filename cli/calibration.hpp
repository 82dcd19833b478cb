#pragma once
// What `fit`, `sample` and `calibrate` share: options from the command line, the rows to learn from, and the files
// written.
#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include "cli/command.hpp"
#include "data/progress.hpp"
#include "uq/calibrate/calibrate.hpp"

namespace cli {

/// The rows of the run table, looked at (uq/calibrate/data_check.hpp): its findings are added to theirs. Throws InputError (66)
/// when there are none, saying how to get some, and (65, 78) for what cannot be meant; prints what was left out.
StudyRows rows_to_learn_from(const Common& common, const Workspace& workspace);

/// The study's options of every surrogate, with those that OUT/surrogate.h5 holds, if it is still of this study and
/// table; if not, the user is told why.
uq::SurrogateOptions surrogate_options(const Common& common, const Workspace& workspace, const StudyRows& rows);

/// Writes OUT/surrogate.h5 if there is anything new; what it held and still holds true stays.
void keep_surrogates(const Workspace& workspace, const StudyRows& rows, const uq::SurrogateOptions& options,
                     const std::vector<uq::FittedSurrogate>& fitted);

/// What stands in the first lines of `fit` and `sample`, as `calibrate` says it: warnings, then notes. Returns the
/// warnings.
std::vector<std::string> say_warnings(const Common& common, const StudyRows& rows,
                                      const std::vector<uq::FittedSurrogate>& fitted,
                                      const std::vector<std::string>& more = {});

/// Writes OUT/next-runs.csv: points of the posteriors that lie far from the runs, a training design for any code.
void write_next_runs(const Workspace& workspace, const std::vector<uq::SupportReport>& supports);

/// How each did, and what its fit has to say.
void say_surrogates(const Common& common, const std::vector<uq::FittedSurrogate>& fitted);

/// The report's provenance and the choices behind it, as the study, the table and the DEM's settings tell them.
void add_provenance(uq::CalibrationReport& report, const Workspace& workspace, const StudyRows& rows);

/// Names of the inputs that are no longer those of the report: the study, its table, its observations.
std::vector<std::string> changed_since(const uq::CalibrationReport& report, const Workspace& workspace,
                                       const StudyRows& rows);

/// report.json, and report.html with its figures, in OUT.
void write_report(const Workspace& workspace, const uq::CalibrationReport& report);
/// The report on the terminal.
data::ExitStatus say_report(const Common& common, const Workspace& workspace, const uq::CalibrationReport& report);

/// --sampler mixture|nuts, instead of what each case says.
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
