#include "uq/report/json.hpp"

#include <cmath>

#include "data/atomic_file.hpp"
#include "uq/findings/headline.hpp"
#include "uq/findings/results_file.hpp"
#include "uq/findings/wording.hpp"

namespace uq {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json number(const std::optional<double>& value) { return value ? number(*value) : Json(nullptr); }

Json numbers(const std::vector<double>& values) {
  Json array = Json::array();
  for (const double value : values) array.push_back(number(value));
  return array;
}

Json numbers(const std::map<std::string, double>& values) {
  Json object = Json::object();
  for (const auto& [name, value] : values) object[name] = number(value);
  return object;
}

Json pairs(const std::vector<std::pair<std::string, std::string>>& values) {
  Json object = Json::object();
  for (const auto& [name, value] : values) object[name] = value;
  return object;
}

Json outlying_json(const std::vector<OutlyingRun>& runs) {
  Json array = Json::array();
  for (const OutlyingRun& run : runs)
    array.push_back({{"place", run.place},
                     {"observed", number(run.observed)},
                     {"expected", number(run.expected)},
                     {"deviations", number(run.deviations)}});
  return array;
}

Json surrogate_json(const SurrogateReport& surrogate) {
  return {{"output", surrogate.output},
          {"material", surrogate.material},
          {"q2", number(surrogate.q2)},
          {"coverage95", number(surrogate.coverage95)},
          {"runs", surrogate.runs},
          {"verdict", to_text(surrogate.verdict)},
          {"q2_held_out", number(surrogate.q2_held_out)},
          {"nugget_sd", number(surrogate.nugget_sd)},
          {"unit", surrogate.unit},
          {"inputs", surrogate.inputs},
          {"length_scales", numbers(surrogate.length_scales)},
          {"sobol",
           {{"first", numbers(surrogate.first_order)},
            {"first_sd", numbers(surrogate.first_order_sd)},
            {"total", numbers(surrogate.total_order)},
            {"total_sd", numbers(surrogate.total_order_sd)}}},
          {"coverage",
           {{"left_out", numbers(surrogate.coverage_left_out)}, {"held_out", numbers(surrogate.coverage_held_out)}}},
          {"folds",
           {{"mahalanobis", numbers(surrogate.fold_distance)},
            {"runs", numbers(surrogate.fold_runs)},
            {"probability", numbers(surrogate.fold_probability)},
            {"pivoted_cholesky_errors", numbers(surrogate.pivoted_errors)}}},
          {"standardised_errors", numbers(surrogate.standardised)},
          {"finding", surrogate.finding},
          {"consequence", surrogate.consequence},
          {"remedy", surrogate.remedy},
          {"notes", surrogate.notes},
          {"converged", surrogate.converged},
          {"low_runs", surrogate.low_runs},
          {"rho", surrogate.low_runs > 0 ? number(surrogate.rho) : Json(nullptr)},
          {"rho_sd", surrogate.low_runs > 0 ? number(surrogate.rho_sd) : Json(nullptr)},
          {"outlying_runs", outlying_json(surrogate.outlying)}};
}

Json support_json(const SupportReport& support) {
  if (!support.known) return nullptr;
  Json inputs = Json::array(), next = Json::array();
  for (const InputSupport& input : support.inputs)
    inputs.push_back({{"name", input.name},
                      {"unit", input.unit},
                      {"runs", Json::array({number(input.runs_low), number(input.runs_high)})},
                      {"outside", number(input.outside)},
                      {"gap", number(input.gap)},
                      {"gap_between", input.gap > 0.0 ? Json::array({number(input.gap_low), number(input.gap_high)})
                                                      : Json(nullptr)}});
  for (const NextRun& run : support.next_runs)
    next.push_back({{"material", run.material}, {"point", numbers(run.point)}});
  return {{"supported", support.supported},       {"unsupported", number(support.unsupported)},
          {"outside", number(support.outside)},   {"gap", number(support.gap)},
          {"empty", number(support.empty)},       {"uncertain", number(support.uncertain)},
          {"distance", number(support.distance)}, {"variance_ratio", number(support.variance_ratio)},
          {"inputs", std::move(inputs)},          {"sentence", support.sentence},
          {"next_runs", std::move(next)}};
}

/// Parameters of a case that was calibrated again, as lists of equal length; `word` makes the text of each verdict.
template <class Word>
Json again_json(const std::vector<ParameterAgain>& parameters, Word word) {
  Json json{{"parameters", Json::array()}, {"verdicts", Json::array()}, {"mean", Json::array()}, {"sd", Json::array()}};
  for (const ParameterAgain& parameter : parameters) {
    json["parameters"].push_back(parameter.name);
    json["verdicts"].push_back(word(parameter));
    json["mean"].push_back(number(parameter.mean));
    json["sd"].push_back(number(parameter.sd));
  }
  return json;
}

Json without_json(const std::optional<WithoutRuns>& without) {
  if (!without) return nullptr;
  Json json{{"places", without->places}};
  json.update(again_json(without->parameters, [](const ParameterAgain& one) { return to_text(one.verdict); }));
  json.update({{"fits", without->fits}, {"sentence", without->sentence}});
  return json;
}

Json finding_json(const DataFinding& finding) {
  return {{"kind", finding.kind}, {"place", finding.place},   {"severity", to_text(finding.severity)},
          {"what", finding.what}, {"remedy", finding.remedy}, {"places", finding.places}};
}

Json intervals_json(const ParameterReport& parameter) {
  Json array = Json::array();
  for (const ValueRange& part : parameter.intervals)
    array.push_back({{"low", number(part.low)},
                     {"high", number(part.high)},
                     {"low_open", part.low_open},
                     {"high_open", part.high_open},
                     {"weight", number(part.weight)},
                     {"mean", number(part.mean)},
                     {"sd", number(part.sd)}});
  return array;
}

Json holes_json(const ParameterReport& parameter) {
  Json array = Json::array();
  for (const ProfileHole& hole : parameter.holes)
    array.push_back({{"low", number(hole.low)},
                     {"high", number(hole.high)},
                     {"deviance", number(hole.deviance)},
                     {"within_surrogate_error", hole.in_doubt}});
  return array;
}

Json words_json(const ParameterReport& parameter) {
  Json object = Json::object();
  for (const WordProbability& word : parameter.word_probabilities)
    object[to_text(word.verdict)] = number(word.probability);
  return object;
}

Json modes_json(const CaseReport& result) {
  Json array = Json::array();
  for (const ModeReport& mode : result.modes)
    array.push_back({{"weight", number(mode.weight)}, {"mean", numbers(mode.mean)}, {"sd", numbers(mode.sd)}});
  return array;
}

Json parameter_json(const CaseReport& result, const ParameterReport& parameter) {
  const Verdict verdict = shown_verdict(result, parameter);
  return {
      {"name", parameter.name},
      {"unit", parameter.unit},
      {"mean", number(parameter.mean)},
      {"sd", number(parameter.sd)},
      {"q05", number(parameter.q05)},
      {"q50", number(parameter.q50)},
      {"q95", number(parameter.q95)},
      {"rhat", number(parameter.rhat)},
      {"ess_bulk", number(parameter.ess_bulk)},
      {"ess_tail", number(parameter.ess_tail)},
      {"contraction", number(parameter.contraction)},
      {"profile95", Json::array({number(parameter.profile_low), number(parameter.profile_high)})},
      {"verdict", to_text(verdict)},
      {"reason", parameter.reason && verdict == parameter.verdict ? Json(to_text(*parameter.reason)) : Json(nullptr)},
      {"borderline", parameter.borderline},
      {"mcse", number(parameter.mcse)},
      {"map", number(parameter.map)},
      {"prior",
       {{"low", number(parameter.prior_low)},
        {"high", number(parameter.prior_high)},
        {"mean", number(parameter.prior_mean)},
        {"sd", number(parameter.prior_sd)}}},
      {"sentence", shown_sentence(result, parameter)},
      {"usable", result.doubt.empty() && result.fits},
      {"intervals", intervals_json(parameter)},
      {"holes", holes_json(parameter)},
      {"open_for_range_of",
       {{"low", parameter.low_pinned_by.empty() ? Json(nullptr) : Json(parameter.low_pinned_by)},
        {"high", parameter.high_pinned_by.empty() ? Json(nullptr) : Json(parameter.high_pinned_by)}}},
      {"word_probabilities", words_json(parameter)},
      {"width_shares",
       {{"measurement", number(parameter.share_measurement)},
        {"surrogate", number(parameter.share_surrogate)},
        {"structure", number(parameter.share_structure)},
        {"range", number(parameter.share_range)}}}};
}

Json nuisance_json(const NuisanceReport& nuisance) {
  return {{"name", nuisance.name},
          {"unit", nuisance.unit},
          {"mean", number(nuisance.mean)},
          {"sd", number(nuisance.sd)},
          {"q05", number(nuisance.q05)},
          {"q50", number(nuisance.q50)},
          {"q95", number(nuisance.q95)},
          {"rhat", number(nuisance.rhat)},
          {"ess_bulk", number(nuisance.ess_bulk)},
          {"ess_tail", number(nuisance.ess_tail)},
          {"prior", {{"mean", number(nuisance.prior_mean)}, {"sd", number(nuisance.prior_sd)}}}};
}

Json discrepancy_json(const DiscrepancyBand& band) {
  return {{"observation_set", band.observation_set},
          {"output", band.output},
          {"unit", band.unit},
          {"control", band.control},
          {"control_unit", band.control_unit},
          {"share", number(band.share)},
          {"x", numbers(band.x)},
          {"mean", numbers(band.mean)},
          {"q05", numbers(band.q05)},
          {"q95", numbers(band.q95)}};
}

Json traded_json(const TradedPair& traded) {
  Json points = Json::array();
  for (const auto& point : traded.equivalent) points.push_back(numbers(point));
  Json curves = Json::array();
  for (const auto& curve : traded.curves)
    curves.push_back({{"observation_set", curve.observation_set},
                      {"output", curve.output},
                      {"unit", curve.unit},
                      {"control", curve.control},
                      {"control_unit", curve.control_unit},
                      {"x", numbers(curve.x)},
                      {"mean", numbers(curve.mean)}});
  return {{"pair", Json::array({traded.first, traded.second})},
          {"parameters", traded.parameters},
          {"combination", traded.combination},
          {"form", to_text(traded.form)},
          {"value", number(traded.value)},
          {"error", number(traded.error)},
          {"unit", traded.unit},
          {"statement", traded.statement},
          {"equivalent", std::move(points)},
          {"equivalent_curves", std::move(curves)},
          {"correlation", number(traded.correlation)}};
}

Json comparison_json(const ModelComparison& comparison) {
  return {{"held", comparison.held},
          {"log_bayes_factor", number(comparison.log_bayes_factor)},
          {"error", number(comparison.error)},
          {"sampling_error", number(comparison.sampling_error)},
          {"surrogate_error", number(comparison.surrogate_error)},
          {"sentence", comparison.sentence}};
}

Json predictive_json(const PredictivePoint& point) {
  return {{"controls", numbers(point.controls)},
          {"output", point.output},
          {"mean", number(point.mean)},
          {"q05", number(point.q05)},
          {"q95", number(point.q95)},
          {"observed", number(point.observed)},
          {"standard_error", number(point.standard_error)},
          {"unit", point.unit},
          {"observation_set", point.observation_set}};
}

Json prediction_json(const PredictionReport& prediction) {
  Json points = Json::array();
  for (std::size_t i = 0; i < prediction.points.size(); ++i) {
    points.push_back(predictive_json(prediction.points[i]));
    points.back()["z"] = number(prediction.z[i]);
  }
  return {{"name", prediction.name},         {"observe", prediction.observed_sets},
          {"inside90", prediction.inside},   {"chi2", number(prediction.chi2)},
          {"p", number(prediction.p)},       {"predicts", prediction.predicts},
          {"sentence", prediction.sentence}, {"points", points}};
}

Json verification_json(const VerificationReport& round) {
  Json values = Json::array();
  for (const VerifiedValue& value : round.values)
    values.push_back({{"inputs", numbers(value.inputs)},
                      {"material", value.material},
                      {"output", value.output},
                      {"unit", value.unit},
                      {"point", value.label},
                      {"surrogate", number(value.predicted)},
                      {"surrogate_sd", number(value.predicted_sd)},
                      {"simulated", number(value.simulated)},
                      {"standard_error", number(value.standard_error)},
                      {"z", number(value.z)}});
  return {{"runs", round.runs},     {"points", round.points},     {"chi2", number(round.chi2)},
          {"dof", round.dof},       {"p", number(round.p)},       {"z_limit", number(round.z_limit)},
          {"agrees", round.agrees}, {"sentence", round.sentence}, {"values", values}};
}

Json case_json(const CaseReport& result) {
  Json json = {
      {"name", result.name},
      {"fit", {{"chi2", number(result.chi2)}, {"dof", result.dof}, {"ppp", number(result.ppp)}, {"fits", result.fits}}},
      {"parameters", Json::array()},
      {"correlation", Json::array()},
      {"log_evidence", number(result.log_evidence)},
      {"log_evidence_error", number(result.log_evidence_error)},
      {"comparisons", Json::array()},
      {"divergences", result.divergences},
      {"traded", Json::array()},
      {"predictive", Json::array()},
      {"headline", headline(result, Typography::ascii)},
      {"finding", result.finding},
      {"consequence", result.consequence},
      {"remedy", result.remedy},
      {"converged", result.converged},
      {"chains", result.chains},
      {"draws", result.draws},
      {"grid_difference", number(result.grid_difference)},
      {"collinearity", number(result.collinearity)},
      {"observed_sets", result.observed_sets},
      {"observed_notes", result.observed_notes},
      {"linked", result.linked},
      {"warnings", result.warnings},
      {"nuisances", Json::array()},
      {"discrepancies", Json::array()},
      {"cuts", result.cuts},
      {"sampler", result.sampler},
      {"search", result.search},
      {"energy_fraction", number(result.energy_fraction)},
      {"support", support_json(result.support)},
      {"without", without_json(result.without)},
      {"doubt", result.doubt.empty() ? Json(nullptr) : Json(result.doubt)},
      {"surrogate_to_measurement", number(result.surrogate_to_measurement)},
      {"modes", modes_json(result)},
      {"modes_parted_by", result.modes_parted_by},
      {"predictions", Json::array()},
      {"verification", Json::array()}};
  for (const auto& prediction : result.predictions) json["predictions"].push_back(prediction_json(prediction));
  for (const auto& round : result.verification) json["verification"].push_back(verification_json(round));
  for (const auto& parameter : result.parameters) json["parameters"].push_back(parameter_json(result, parameter));
  for (const auto& one : result.comparisons) json["comparisons"].push_back(comparison_json(one));
  for (const auto& nuisance : result.nuisances) json["nuisances"].push_back(nuisance_json(nuisance));
  for (const auto& band : result.discrepancies) json["discrepancies"].push_back(discrepancy_json(band));
  for (const auto& row : result.correlation) json["correlation"].push_back(numbers(row));
  for (const auto& traded : result.traded) json["traded"].push_back(traded_json(traded));
  for (const auto& point : result.predictive) json["predictive"].push_back(predictive_json(point));
  return json;
}

Json scan_json(const ErrorScan& scan) {
  Json json{{"case", scan.case_name}, {"relative_error", number(scan.relative_error)}};
  json.update(again_json(scan.parameters, [](const ParameterAgain& one) {
    return format_verdict(one.verdict, one.reason, one.borderline);
  }));
  json["ppp"] = number(scan.ppp);
  return json;
}

}  // namespace

nlohmann::ordered_json plans_json(const std::vector<CaseReport>& cases) {
  Json plans = Json::array();
  for (const CaseReport& one : cases)
    if (one.plan) {
      Json plan = {{"case", one.name}};
      plan.update(Json::parse(to_text(*one.plan)));
      plans.push_back(std::move(plan));
    }
  return plans;
}

nlohmann::ordered_json report_json(const CalibrationReport& report) {
  Json json = {{"format", 1},
               {"demcal", program_version(report)},
               {"status", has_warning(report) ? "warning" : "ok"},
               {"study", report.study_name},
               {"surrogates", Json::array()},
               {"cases", Json::array()},
               {"plan", plans_json(report.cases)},
               {"provenance", pairs(report.provenance)},
               {"warnings", first_lines(report)},
               {"error_scan", Json::array()},
               {"thresholds", pairs(report.thresholds)},
               {"notes", report.notes},
               {"findings", Json::array()},
               {"cautions", report.cautions}};
  for (const auto& finding : report.findings) json["findings"].push_back(finding_json(finding));
  for (const auto& surrogate : report.surrogates) json["surrogates"].push_back(surrogate_json(surrogate));
  for (const auto& result : report.cases) json["cases"].push_back(case_json(result));
  for (const auto& scan : report.error_scan) json["error_scan"].push_back(scan_json(scan));
  return json;
}

void write_report_json(const CalibrationReport& report, const std::string& path) {
  // Bytes that are no UTF-8 (a comment in a Latin-1 file) are replaced, not an error.
  data::write_atomically(path, report_json(report).dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace uq
