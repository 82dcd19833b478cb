#include "uq/calibrate/without_runs.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "data/error.hpp"
#include "uq/findings/study_units.hpp"
#include "uq/findings/thresholds.hpp"
#include "uq/findings/wording.hpp"
#include "uq/posterior/support.hpp"

namespace uq {
namespace {

/// The places of the runs that a case rests on, and that the others contradict.
std::vector<std::string> contradicted_places(const CaseModel& model, const std::vector<FittedSurrogate>& surrogates) {
  std::vector<std::string> places;
  for (const RowGroup& group : model.groups)
    for (const FittedSurrogate& one : surrogates)
      if (one.rows.material == group.emulator.material && one.rows.output == group.emulator.output)
        for (const OutlyingRun& run : one.report.outlying)  // a run may be contradicted in several outputs
          if (std::find(places.begin(), places.end(), run.place) == places.end()) places.push_back(run.place);
  return places;
}

}  // namespace

ParameterAgain again(const ParameterReport& parameter) {
  return {.name = parameter.name,
          .verdict = parameter.verdict,
          .reason = parameter.reason,
          .borderline = parameter.borderline,
          .mean = parameter.mean,
          .sd = parameter.sd};
}

std::vector<FittedSurrogate> without_outlying(const data::Study& study, const data::RunTable& table,
                                              SurrogateOptions options, const std::vector<FittedSurrogate>& fitted) {
  std::set<std::string> places;
  options.known.clear();
  for (const FittedSurrogate& one : fitted) {
    for (const OutlyingRun& run : one.report.outlying) places.insert(run.place);
    if (one.report.outlying.empty()) options.known.push_back(one);
  }
  if (places.empty()) return {};
  data::RunTable rest = table;
  for (data::RunRow& row : rest.rows)
    if (!row.left_out && places.contains(row.place))
      row.left_out = {data::LeftOut::Because::others_contradict, "contradicted by the others"};
  if (data::used_rows(rest) == data::used_rows(table)) return {};
  try {
    return fit_surrogates(study, rest, options);
  } catch (const data::InputError&) {
    return {};
  }
}

WithoutRuns calibrate_without(const data::Study& study, const std::vector<FittedSurrogate>& others,
                              std::size_t case_index, const CalibrateOptions& options) {
  WithoutRuns found;
  const SampledCase sampled = sample_case(study, emulators_of(others), case_index, options);
  if (sampled.draws.chains.empty()) {
    found.sentence = "the posterior could not be sampled: " + sampled.draws.reason;
    return found;
  }
  IdentifyOptions judged = options.identify;
  judged.unsupported = unsupported_parameters(*sampled.model, sampled.support);
  const Identification identified = identify(*sampled.model, sampled.draws.pooled(), judged);
  found.fits = identified.fits;
  for (const ParameterReport& parameter : identified.parameters) {
    found.parameters.push_back(again(parameter));
    found.sentence += fmt::format("{}{} {} ({})", found.sentence.empty() ? "" : ", ", parameter.name,
                                  format_with_error(parameter.mean, parameter.sd, parameter.unit, Typography::ascii),
                                  to_text(parameter.verdict));
  }
  if (!sampled.draws.converged) found.sentence += "; the chains have not converged";
  found.sentence += ".";
  return found;
}

std::optional<WithoutRuns> without_runs(const data::Study& study, const BothSurrogates& surrogates,
                                        const SampledCase& sampled, std::size_t case_index,
                                        const CalibrateOptions& options) {
  if (surrogates.others.empty()) return {};
  const std::vector<std::string> places = contradicted_places(*sampled.model, surrogates.all);
  if (places.empty()) return {};
  WithoutRuns without = calibrate_without(study, surrogates.others, case_index, options);
  without.places = places;
  without.sentence = fmt::format("Without {}: {}", data::list_places(places), without.sentence);
  return without;
}

bool depends_on_runs(const SampledCase& sampled, const WithoutRuns& without) {
  if (sampled.draws.chains.empty()) return false;
  const Eigen::MatrixXd draws = sampled.draws.pooled();
  for (std::size_t k = 0; k < without.parameters.size(); ++k) {
    const ParameterAgain& other = without.parameters[k];
    const Unknown& unknown = sampled.model->unknowns[k];
    Eigen::VectorXd values = draws.col(k);
    for (double& value : values) value = in_study_unit(unknown.prior.parameter(), value);
    const double sd = std::sqrt((values.array() - values.mean()).square().mean());
    if (std::abs(values.mean() - other.mean) > decided_shift * other.sd || sd > decided_factor * other.sd ||
        sd < other.sd / decided_factor)
      return true;
  }
  return false;
}

}  // namespace uq
