// The whole way from a study and its table to verdicts and files: the study on another code's runs that comes with
// demcal.
#include "uq/calibrate/calibrate.hpp"

#include <catch2/catch.hpp>
#include <cmath>

#include "data/csv.hpp"
#include "data/error.hpp"
#include "uq/calibrate/effort.hpp"
#include "uq/calibrate/posterior_nc.hpp"
#include "uq/infer/diagnostics.hpp"
#include "uq/posterior/prior.hpp"

using namespace uq;

namespace {

struct Input {
  data::Study study;
  data::RunTable table;
};

Input other_code(const std::vector<std::string>& overrides = {}) {
  const data::StudyFile file = data::StudyFile::open(DEMCAL_SOURCE_DIR "/data/other-code", overrides);
  Input input{.study = data::read_study(file), .table = {}};
  input.table = data::read_table(input.study.training.table, input.study).table;
  return input;
}

std::string message_of(const Input& input) {
  try {
    calibrate_all(input.study, input.table, {.error_scan = {}, .quadrature = false}).report;
  } catch (const data::InputError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("the study on another code's runs is calibrated: both parameters cover the truth and are traded", "[uq]") {
  const Input input = other_code();
  const Calibration found = calibrate_all(input.study, input.table, {.error_scan = {}});
  const CalibrationReport& report = found.report;
  CHECK_FALSE(report.warning);
  REQUIRE(report.cases.size() == 1);
  const CaseReport& powder = report.cases[0];
  CHECK(powder.converged);
  CHECK(powder.fits);
  REQUIRE(powder.grid_difference);
  CHECK(*powder.grid_difference < 0.1);
  REQUIRE(powder.parameters.size() == 2);
  for (const auto& parameter : powder.parameters) {
    INFO(parameter.sentence);
    const double truth = parameter.name == "friction" ? 0.4 : 4.0;
    CHECK(std::abs(parameter.mean - truth) < 3.0 * parameter.sd);
    CHECK(parameter.rhat < 1.01);
    CHECK(parameter.ess_bulk >= 1000.0);
    CHECK(parameter.verdict != Verdict::identified);
  }
  REQUIRE(powder.traded.size() == 1);
  CHECK(powder.traded[0].correlation < -0.9);
  CHECK(powder.predictive.size() == 6);
  REQUIRE(powder.curves.size() == 1);
  CHECK(powder.curves[0].x.front() >= 50.0);
}

TEST_CASE("a calibration is the same for any number of threads", "[uq][slow]") {
  const Input input = other_code();
  const auto once = [&](int threads) {
    return calibrate_all(input.study, input.table, {.error_scan = {}, .quadrature = false, .threads = threads})
        .report.cases[0]
        .draws_for_plot;
  };
  CHECK(once(1) == once(3));
}

TEST_CASE("a study without cases, a case without data and a table without enough runs are named", "[uq]") {
  Input input = other_code();
  input.table.rows.resize(4);
  CHECK(message_of(input).find("4 runs of torque, fewer than") != std::string::npos);
  input.table.rows.resize(1);
  CHECK(message_of(input).find("1 run of torque, too few to tell") != std::string::npos);
  input.table.rows.resize(6, input.table.rows.front());
  CHECK(message_of(input).find("6 runs of torque, all at the same point") != std::string::npos);
  input.table.rows.clear();
  CHECK(message_of(input).find("there are no training runs") != std::string::npos);
  input = other_code();
  input.study.cases.clear();
  CHECK(message_of(input).find("no [[calibrate]] case") != std::string::npos);
  input = other_code();
  input.study.cases[0].observe.clear();
  CHECK(message_of(input).find("case 'powder' observes nothing") != std::string::npos);
}

TEST_CASE("a parameter that no run varies, and one that is neither free nor fixed, are named", "[uq]") {
  Input input = other_code();
  for (auto& row : input.table.rows) row.inputs[1] = 2e-3;
  CHECK(message_of(input).find("frees cohesion, but no run of its materials varies it") != std::string::npos);
  input = other_code();
  input.study.cases[0].free = {"friction"};
  CHECK(message_of(input).find("neither frees nor fixes cohesion") != std::string::npos);
}

TEST_CASE("an observation outside the runs is named with its line", "[uq]") {
  Input input = other_code();
  input.study.observations[0].points[5].controls[0] *= 2.0;
  const std::string message = message_of(input);
  INFO(message);
  CHECK(message.find("speed is 600 rpm, but the runs of this material reach from") != std::string::npos);
  CHECK(message.find("bench.csv:") != std::string::npos);
}

TEST_CASE("a prior that excludes the data is named before sampling", "[uq]") {
  Input input = other_code();
  data::Prior narrow;
  narrow.kind = data::PriorKind::truncated_normal;
  narrow.low = 0.1;
  narrow.high = 0.8;
  narrow.mean = 0.12;
  narrow.sd = 0.002;
  input.study.cases[0].priors["friction"] = narrow;
  data::Prior low = narrow;
  low.low = 0.0;
  low.high = 10e-3;
  low.mean = 0.5e-3;
  low.sd = 0.1e-3;
  input.study.cases[0].priors["cohesion"] = low;
  const std::string message = message_of(input);
  INFO(message);
  CHECK(message.find("case 'powder': the priors of friction, cohesion only allow") != std::string::npos);
}

TEST_CASE("a case that takes another's posterior is sampled jointly with it, and a circle of them is named",
          "[uq][slow]") {
  Input input = other_code();
  // Half of the points to a case of its own that shares friction.
  data::ObservationSet second = input.study.observations[0];
  second.name = "bench2";
  second.points.erase(second.points.begin(), second.points.begin() + 3);
  input.study.observations[0].points.resize(3);
  input.study.observations.push_back(second);
  data::CalibrationCase other = input.study.cases[0];
  other.name = "other";
  other.observe = {"bench2"};
  data::Prior linked;
  linked.kind = data::PriorKind::posterior;
  linked.posterior_of = "powder";
  other.priors["friction"] = linked;
  input.study.cases.push_back(other);
  const Calibration found = calibrate_all(input.study, input.table, {.error_scan = {}, .quadrature = false});
  CHECK(found.report.cases[1].linked == std::vector<std::string>{"powder"});
  CHECK(found.cases[1].model->dimension() == 3);
  CHECK(found.cases[1].model->row_count() == 6);
  CHECK(found.cases[1].model->groups.size() == 1);  // one surrogate: its errors in both cases are counted together
  CHECK(found.report.cases[1].parameters.size() == 2);
  CHECK(found.report.cases[1].converged);

  data::Prior back = linked;
  back.posterior_of = "other";
  input.study.cases[0].priors["friction"] = back;
  const std::string message = message_of(input);
  INFO(message);
  CHECK(message.find("run in a circle: powder -> other -> powder") != std::string::npos);
  input.study.cases[0].priors.clear();
  input.study.cases[1].observe = {"bench"};
  CHECK(message_of(input).find("the data of 'bench' would count twice") != std::string::npos);
}

TEST_CASE("nuisances, a cut and the other sampler go from the study to the report", "[uq][slow]") {
  Input input = other_code();
  data::CalibrationCase& powder = input.study.cases[0];
  const CalibrateOptions quick{.error_scan = {}, .quadrature = false};
  const CaseReport plain = calibrate_all(input.study, input.table, quick).report.cases[0];
  CHECK(plain.sampler == "mixture");
  CHECK(plain.nuisances.empty());

  // Two samplers, one posterior.
  powder.sampler = data::Sampler::nuts;
  const CaseReport nuts = calibrate_all(input.study, input.table, quick).report.cases[0];
  CHECK(nuts.sampler == "nuts");
  CHECK(nuts.converged);
  CHECK(nuts.energy_fraction > 0.3);
  CHECK(std::isnan(nuts.log_evidence));
  for (std::size_t k = 0; k < 2; ++k) {
    const double error = std::hypot(nuts.parameters[k].mcse, plain.parameters[k].mcse);
    CHECK(std::abs(nuts.parameters[k].mean - plain.parameters[k].mean) < 4.5 * error);
    CHECK(nuts.parameters[k].sd == Approx(plain.parameters[k].sd).epsilon(0.08));
    CHECK(nuts.parameters[k].verdict == plain.parameters[k].verdict);
  }
  powder.sampler = data::Sampler::mixture;

  // A gain of 10 % widens what multiplies torque; the report lists it apart.
  data::Parameter gain{.name = "gain", .target = "gain", .low = 0.4, .high = 1.6};
  gain.prior = {.kind = data::PriorKind::normal, .low = 0.4, .high = 1.6, .mean = 1.0, .sd = 0.1};
  powder.nuisances = {{data::NuisanceKind::gain, 0, gain}};
  const CaseReport widened = calibrate_all(input.study, input.table, quick).report.cases[0];
  REQUIRE(widened.nuisances.size() == 1);
  CHECK(widened.nuisances[0].name == "gain");
  CHECK(widened.nuisances[0].sd == Approx(0.1).epsilon(0.15));
  CHECK(widened.parameters.size() == 2);
  CHECK(widened.correlation.size() == 2);
  CHECK(widened.fits);
  powder.nuisances.clear();

  // A case that takes friction, cut, from one whose data differ: friction keeps what the source made of it.
  data::ObservationSet second = input.study.observations[0];
  second.name = "bench2";
  for (auto& point : second.points) point.values[0] *= 1.15;
  input.study.observations.push_back(second);
  data::CalibrationCase other = powder;
  other.name = "other";
  other.observe = {"bench2"};
  data::Prior cut;
  cut.kind = data::PriorKind::posterior;
  cut.posterior_of = "powder";
  cut.cut = true;
  other.priors["friction"] = cut;
  input.study.cases.push_back(other);
  const Calibration found = calibrate_all(input.study, input.table, quick);
  const CaseReport& source = found.report.cases[0];
  const CaseReport& taken = found.report.cases[1];
  CHECK(taken.cuts == std::vector<std::string>{"friction from powder"});
  CHECK(taken.linked.empty());
  CHECK(taken.sampler == "cut");
  CHECK(taken.converged);
  CHECK(found.cases[1].model->row_count() == 6);
  const Eigen::MatrixXd kept = found.cases[1].draws.coordinate(0), given = found.cases[0].draws.coordinate(0);
  CHECK(std::abs(kept.mean() - given.mean()) < 4.0 * std::hypot(mean_mcse(kept), mean_mcse(given)));
  CHECK(taken.parameters[0].verdict == source.parameters[0].verdict);
  CHECK(taken.parameters[0].mean == source.parameters[0].mean);
  CHECK(taken.parameters[1].mean > source.parameters[1].mean);  // cohesion must explain the 15 %
}

TEST_CASE("a discrepancy takes what the model cannot explain, says how much, and leaves a fitting model little changed",
          "[uq][slow]") {
  Input input = other_code();
  data::CalibrationCase& powder = input.study.cases[0];
  const CalibrateOptions quick{.error_scan = {}, .quadrature = false};
  // A torque with a hump that no friction or cohesion gives.
  auto hump = input.study.observations[0];
  for (std::size_t i = 0; i < hump.points.size(); ++i) hump.points[i].values[0] *= i == 2 || i == 3 ? 1.2 : 1.0;
  const auto with_discrepancy = [&](const data::ObservationSet& set, bool on) {
    input.study.observations[0] = set;
    powder.nuisances.clear();
    if (on) {
      data::Parameter sd{.name = "discrepancy_sd", .target = "", .low = 0.0, .high = 0.5};
      sd.prior = {.kind = data::PriorKind::truncated_normal, .low = 0.0, .high = 0.5, .mean = 0.0, .sd = 0.1};
      data::Parameter length{
          .name = "discrepancy_length", .target = "", .low = 0.05, .high = 5.0, .scale = data::Scale::log};
      length.prior = {.kind = data::PriorKind::log_normal, .low = 0.05, .high = 5.0, .mean = 0.5, .sd = 0.7};
      powder.nuisances = {{data::NuisanceKind::discrepancy_sd, {}, sd},
                          {data::NuisanceKind::discrepancy_length, {}, length}};
    }
    return calibrate_all(input.study, input.table, quick).report.cases[0];
  };
  const data::ObservationSet good = input.study.observations[0];
  const CaseReport off = with_discrepancy(hump, false), on = with_discrepancy(hump, true);
  CHECK_FALSE(off.fits);
  CHECK(on.fits);
  CHECK(off.discrepancies.empty());
  REQUIRE(on.discrepancies.size() == 1);
  CHECK(on.discrepancies[0].share > 0.5);
  CHECK(on.warnings.size() == 1);
  const DiscrepancyBand& band = on.discrepancies[0];
  CHECK(band.mean[band.mean.size() / 2] > 0.5);  // mN m: the hump is 2
  const CaseReport fine = with_discrepancy(good, true), plain = with_discrepancy(good, false);
  REQUIRE(fine.discrepancies.size() == 1);
  CHECK(fine.discrepancies[0].share < on.discrepancies[0].share);
  for (std::size_t k = 0; k < 2; ++k) CHECK(fine.parameters[k].sd >= 0.95 * plain.parameters[k].sd);
}

TEST_CASE("the Bayes factor of a parameter held is that of the density ratio of Savage and Dickey", "[uq][slow]") {
  // J. M. Dickey, Ann. Math. Stat. 42 (1971) 204: with the other priors the same, evidence(held) / evidence(free) is
  // posterior density over prior density at the held value.
  Input input = other_code();
  const auto index = input.study.parameter_index("cohesion");
  REQUIRE(index);
  const data::Parameter& cohesion = input.study.parameters[*index];
  for (const double u : {0.3, 0.5}) {
    input.study.cases[0].held = {{"cohesion", cohesion.axis().from_unit(u)}};
    const Calibration found = calibrate_all(input.study, input.table, {.error_scan = {}, .quadrature = false});
    const SampledCase& sampled = found.cases[0];
    int column = 0;
    while (sampled.model->unknowns[column].label != "cohesion") ++column;
    const Eigen::MatrixXd draws = sampled.draws.coordinate(column);
    constexpr double half = 0.03;
    const double inside = static_cast<double>(((draws.array() - u).abs() < half).count());
    const double density = inside / static_cast<double>(draws.size()) / (2.0 * half);  // the prior's is one
    CAPTURE(u, density, inside);
    REQUIRE(found.report.cases[0].comparisons.size() == 1);
    const ModelComparison& comparison = found.report.cases[0].comparisons[0];
    CHECK(comparison.log_bayes_factor == Approx(-std::log(density)).margin(0.03 + 3.0 / std::sqrt(inside)));
    CHECK(comparison.sampling_error < 0.1);
    CHECK_FALSE(comparison.sentence.empty());
  }
}

TEST_CASE("equivalent points come with the curves that the model predicts there", "[uq]") {
  const Input input = other_code();
  const CalibrationReport report =
      calibrate_all(input.study, input.table, {.error_scan = {}, .quadrature = false}).report;
  const CaseReport& powder = report.cases.at(0);
  REQUIRE_FALSE(powder.traded.empty());
  const TradedPair& traded = powder.traded[0];
  REQUIRE(traded.curves.size() == traded.equivalent.size() * powder.curves.size());
  // They fit alike, so they lie in the band about the observed points.
  for (const PredictiveCurve& curve : traded.curves)
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      CHECK(curve.q05[i] == curve.mean[i]);
      const PredictiveCurve& band = powder.curves[0];
      CHECK(std::abs(curve.mean[i] - band.mean[i]) < 1.5 * (band.q95[i] - band.q05[i]));
    }
}

TEST_CASE("the draws as a CSV are those of the posterior, row by row", "[uq]") {
  const Input input = other_code();
  const Calibration found = calibrate_all(input.study, input.table, {.error_scan = {}, .quadrature = false});
  const SampledCase& sampled = found.cases[0];
  const data::Csv csv = data::parse_csv(draws_csv(sampled), "draws.csv");
  const auto& chains = sampled.draws.chains;
  REQUIRE(csv.rows.size() == chains.size() * static_cast<std::size_t>(chains[0].x.rows()));
  const Unknown& unknown = sampled.model->unknowns[0];
  const std::size_t column = csv.column(unknown.label);
  const double last = csv.number(csv.rows.back(), column);
  const Eigen::Index row = chains.back().x.rows() - 1;
  CHECK(last == Approx(unknown.prior.parameter().unit.from_si(unknown.value(chains.back().x(row, 0)))));
  CHECK(csv.number(csv.rows.back(), csv.column("lp")) == Approx(chains.back().log_density[row]));
}

TEST_CASE("one reading typed wrong is named, and nothing else is advised", "[uq]") {
  Input input = other_code();
  data::Observation& wrong = input.study.observations[0].points[3];
  wrong.values[0] *= 1.4;
  const CaseReport found =
      calibrate_all(input.study, input.table, {.error_scan = {}, .quadrature = false}).report.cases[0];
  CHECK_FALSE(found.fits);
  CHECK(found.lone_reading == "bench.csv:" + std::to_string(wrong.line));
  CHECK_THAT(found.finding, Catch::Contains("contradicts all others"));
  CHECK_THAT(found.remedy, Catch::StartsWith("Check that reading"));
}

TEST_CASE("a fit that data of the model's own would seldom give is called poor, and is not used without a look",
          "[uq]") {
  Input input = other_code();
  // Readings off in turn by 1.4 of their errors.
  const CaseReport clean =
      calibrate_all(input.study, input.table, {.error_scan = {}, .quadrature = false}).report.cases[0];
  double sign = 1.4;
  for (data::Observation& point : input.study.observations[0].points)
    point.values[0] += (sign = -sign) * point.standard_errors[0];
  const CaseReport found =
      calibrate_all(input.study, input.table, {.error_scan = {}, .quadrature = false}).report.cases[0];
  REQUIRE(found.fits);
  CHECK_THAT(clean.finding, !Catch::Contains("fit is poor"));
  CHECK_THAT(found.finding, Catch::Contains("The fit is poor: chi2"));
  CHECK_THAT(found.remedy, Catch::StartsWith("Look first at what the residuals have in common."));
}

TEST_CASE("the progress of a calibration goes from 0 to 1, and a case that takes longer has the longer part of it",
          "[uq]") {
  const Input input = other_code();
  std::vector<std::pair<std::string, double>> told;
  CalibrateOptions options{.error_scan = {}, .quadrature = false};
  options.progress = [&](const std::string& step, double share) { told.emplace_back(step, share); };
  calibrate_all(input.study, input.table, options);
  REQUIRE(told.size() > 3);
  CHECK(told.front().second == 0.0);
  CHECK(told.back().second == 1.0);
  double before = 0.0;
  for (const auto& [step, share] : told) {
    CHECK(share >= before - 1e-9);
    CHECK(share <= 1.0 + 1e-9);
    before = step == "surrogates" ? 0.0 : share;  // what they took is known once they are there
  }
  const data::CalibrationCase& many = input.study.cases[0];
  CHECK(sampling_seconds(input.study, many, input.table, {}) > 0.0);
  data::Study longer = input.study;
  std::vector<data::Observation>& points = longer.observations[0].points;
  const std::vector<data::Observation> once = points;
  for (data::Observation point : once) {
    point.controls[0] *= 0.99;
    points.push_back(point);
  }
  CHECK(sampling_seconds(longer, many, input.table, {}) > 2.0 * sampling_seconds(input.study, many, input.table, {}));
}

TEST_CASE("errors stated far too large are told by readings that lie too close to the model", "[uq]") {
  Input input = other_code();
  const auto with_errors = [&](double factor) {
    Input read = input;
    for (data::Observation& point : read.study.observations[0].points) point.standard_errors[0] *= factor;
    return calibrate_all(read.study, read.table, {.error_scan = {}, .quadrature = false}).report.cases[0];
  };
  const CaseReport wide = with_errors(20.0), stated = with_errors(1.0);
  CHECK_THAT(wide.finding, Catch::Contains("times closer to the model than their errors let expect"));
  CHECK_THAT(wide.remedy, Catch::Contains("common_error"));
  CHECK(wide.fits);
  CHECK_THAT(stated.finding, !Catch::Contains("closer to the model"));
}

TEST_CASE("repeats that lie together and far from the model are not counted as independent without a word", "[uq]") {
  Input input = other_code();
  data::Parameter noise{.name = "noise", .target = "", .low = 0.1, .high = 10.0, .scale = data::Scale::log};
  noise.prior = {.kind = data::PriorKind::log_normal, .low = 0.1, .high = 10.0, .mean = 1.0, .sd = 1.0};
  input.study.cases[0].nuisances = {{.kind = data::NuisanceKind::noise_scale, .output = {}, .parameter = noise}};
  const auto with_repeats = [&](double setting, double reading) {
    Input read = input;
    std::vector<data::Observation>& points = read.study.observations[0].points;
    const std::vector<data::Observation> once = points;
    points.clear();
    for (std::size_t i = 0; i < once.size(); ++i)
      for (int k = 0; k < 4; ++k) {
        points.push_back(once[i]);
        const double se = once[i].standard_errors[0];
        points.back().values[0] += (i % 2 == 0 ? setting : -setting) * se + (k % 2 == 0 ? reading : -reading) * se;
      }
    return calibrate_all(read.study, read.table, {.error_scan = {}, .quadrature = false}).report.cases[0];
  };
  const CaseReport shared = with_repeats(1.5, 0.1), independent = with_repeats(0.0, 1.0);
  CHECK_THAT(shared.finding, Catch::Contains("readings of one setting share an error, or the model is off"));
  CHECK_THAT(shared.consequence, Catch::Contains("24 readings of 6 settings were taken for 24 independent ones"));
  CHECK_THAT(shared.remedy, Catch::StartsWith("Give each setting one row"));
  REQUIRE(shared.warnings.size() == 1);
  CHECK_THAT(shared.warnings[0], Catch::Contains("F test"));
  CHECK_THAT(independent.finding, !Catch::Contains("share an error"));
  CHECK(independent.warnings.empty());
}

TEST_CASE("draws that have not converged carry no word", "[uq]") {
  const Input input = other_code();
  const std::vector<FittedSurrogate> fitted = fit_surrogates(input.study, input.table);
  SampledCase sampled = sample_case(input.study, emulators_of(fitted), 0);
  sampled.draws.converged = false;
  sampled.draws.reason = "R-hat 1.4";
  const CaseReport found = report_case(input.study, sampled);
  CHECK_THAT(found.finding, Catch::StartsWith("No verdict: the sampler has not converged"));
  for (const ParameterReport& one : found.parameters) CHECK(one.reason == Reason::unsupported);
  CHECK_THAT(found.consequence, !Catch::Contains("can be used"));
  CHECK(found.traded.empty());
}
