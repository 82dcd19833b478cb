#pragma once
// The main job: surrogates, posterior draws, verdicts and figures' data for every case of a study. Its parts are the
// commands `fit`, `sample` and `calibrate`:
//   fit_surrogates (uq/emulate/surrogates.hpp) -> sample_case -> report_case -> scan_errors
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "data/finding.hpp"
#include "data/run_table.hpp"
#include "data/study.hpp"
#include "uq/emulate/surrogates.hpp"
#include "uq/findings/results.hpp"
#include "uq/infer/cut.hpp"
#include "uq/infer/draws.hpp"
#include "uq/infer/mixture_sampler.hpp"
#include "uq/infer/nuts.hpp"
#include "uq/verdict/identifiability.hpp"

namespace uq {

struct CalibrateOptions {
  SurrogateOptions surrogates = {};
  std::optional<data::Sampler> sampler = {};  ///< sampler that replaces each case's own
  MixtureSamplerOptions mixture = {};         ///< its seed and threads are set from those below
  NutsOptions nuts = {};                      ///< seed and threads likewise
  CutOptions cut = {};                        ///< seed and threads likewise
  IdentifyOptions identify = {};
  std::vector<double> error_scan = {0.01, 0.03, 0.05};  ///< relative measurement errors to scan; empty: no scan
  bool quadrature = true;                               ///< check one- and two-dimensional posteriors by integration
  int threads = 0;                                      ///< 0: as many as the machine has
  std::optional<std::uint64_t> seed = {};               ///< seed that replaces the study's
  /// The findings of uq/calibrate/data_check.hpp and of the readers, for the report; none: the data are looked at
  /// first.
  std::optional<std::vector<data::Finding>> findings = {};
  std::function<void(const std::string& step, double share)> progress = {};  ///< share of the whole job done, 0 to 1
  std::function<void(double share)> sampling_progress = {};  ///< share of a case's draws done, whatever the sampler
};

/// One case, resolved and sampled.
struct SampledCase {
  std::shared_ptr<const CaseModel> model;
  Draws draws;
  data::Sampler sampler = data::Sampler::mixture;
  SupportReport support = {};                                        ///< of the draws; unknown where there are no draws
  std::vector<std::shared_ptr<const SampledCase>> cut_sources = {};  ///< cases whose posteriors were cut
};

struct Calibration {
  CalibrationReport report;
  std::vector<FittedSurrogate> surrogates;
  std::vector<SampledCase> cases;  ///< in the study's order
};

/// The seed of all random streams.
std::uint64_t seed_of(const data::Study& study, const CalibrateOptions& options);

/// Draws of `model`, which is the sampled case's model or the same model with other data; `draws` per chain in the
/// first round replace the sampler's own number.
Draws sample_model(const data::Study& study, const SampledCase& sampled, const std::shared_ptr<const CaseModel>& model,
                   const CalibrateOptions& options, std::optional<int> draws = {});

/// Samples a case. Where a parameter is the cut posterior of another case, that case is sampled first.
SampledCase sample_case(const data::Study& study, const std::vector<Emulator>& emulators, std::size_t case_index,
                        const CalibrateOptions& options = {});

/// Mean, quantiles and diagnostics of one unknown, in the study's unit.
NuisanceReport summary_of(const SampledCase& sampled, int unknown);

CaseReport report_case(const data::Study& study, const SampledCase& sampled, const CalibrateOptions& options = {});

/// Calibrates the case again with surrogates of fewer runs: the runs that the others contradict are left out.
WithoutRuns calibrate_without(const data::Study& study, const std::vector<FittedSurrogate>& others,
                              std::size_t case_index, const CalibrateOptions& options = {});

/// Compares the case with itself when the parameters of its `compare` are held, to see whether the data ask for them
/// (Bayes factor). None where the case has no such key, or its sampler gives no evidence.
std::vector<ModelComparison> compare_models(const data::Study& study, const SampledCase& sampled,
                                            std::size_t case_index, const CalibrateOptions& options = {});

/// The verdicts at other measurement errors. The observed numbers keep the noise that they have, so they are replaced
/// by the posterior mean of the prediction there, plus noise of the stated relative error. This noise has the same
/// standard normal numbers (from the study's seed and the case's index) at every error.
std::vector<ErrorScan> scan_errors(const data::Study& study, const SampledCase& sampled, std::size_t case_index,
                                   const CalibrateOptions& options = {});

Calibration calibrate_all(const data::Study& study, const data::RunTable& table, const CalibrateOptions& options = {});

}  // namespace uq
