// The verdicts of a case at other measurement errors (calibrate.hpp).
#include <fmt/core.h>

#include <algorithm>

#include "data/random.hpp"
#include "uq/calibrate/calibrate.hpp"
#include "uq/calibrate/without_runs.hpp"
#include "uq/posterior/predictive.hpp"

namespace uq {
namespace {

constexpr int scan_scouts = 8000;  // of each measurement error that is tried, at most

}  // namespace

std::vector<ErrorScan> scan_errors(const data::Study& study, const SampledCase& sampled, std::size_t case_index,
                                   const CalibrateOptions& options) {
  std::vector<ErrorScan> scans;
  if (sampled.draws.chains.empty()) return scans;
  const Eigen::VectorXd truth = mean_prediction(*sampled.model, sampled.draws.pooled());
  data::RandomStream random(seed_of(study, options), data::Purpose::measurement_noise,
                            static_cast<std::uint32_t>(case_index));
  Eigen::VectorXd normal(truth.size());
  for (double& value : normal) value = random.normal();
  std::uint32_t index = 0;
  for (const double error : options.error_scan) {
    CalibrateOptions own = options;
    const double before = static_cast<double>(index) / static_cast<double>(options.error_scan.size());
    if (options.progress)
      own.sampling_progress = [&, before](double share) {
        options.progress(fmt::format("errors of {:g} %", 100.0 * error),
                         before + 0.9 * share / static_cast<double>(options.error_scan.size()));
      };
    own.seed = data::child_seed(seed_of(study, options), data::Purpose::error_scan_seed,
                                static_cast<std::uint32_t>(case_index << 8) + index++);
    // Words alone are asked of it, and the case's own search has looked for maxima.
    own.mixture.explore.scouts = std::min(scouts_for(sampled.model->dimension()), scan_scouts);
    const Eigen::VectorXd sd = error * truth.cwiseAbs();
    const Eigen::VectorXd y = truth + own_errors(sd.cwiseAbs2(), sampled.model->linked_errors, normal);
    const auto model = std::make_shared<const CaseModel>(with_data(*sampled.model, y, sd.cwiseAbs2()));
    const Draws draws = sample_model(study, sampled, model, own, 500);
    ErrorScan scan;
    scan.case_name = model->name;
    scan.relative_error = error;
    if (!draws.chains.empty()) {
      const Identification found = identify(*model, draws.pooled(), options.identify);
      scan.ppp = found.check.predictive_p;
      for (const ParameterReport& parameter : found.parameters) scan.parameters.push_back(again(parameter));
    }
    scans.push_back(std::move(scan));
  }
  return scans;
}

}  // namespace uq
