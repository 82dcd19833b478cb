#include "tests/uq/findings/report_fixture.hpp"

#include <algorithm>
#include <cmath>

#include "data/random.hpp"

namespace report_fixture {
namespace {

using namespace uq;

constexpr int plotted_draws = 1200;

std::vector<double> grid(double low, double high, int count) {
  std::vector<double> values;
  for (int i = 0; i < count; ++i) values.push_back(low + (high - low) * i / (count - 1));
  return values;
}

ParameterReport parameter(const std::string& name, const std::string& unit, std::pair<double, double> range,
                          double mean, double sd) {
  ParameterReport p;
  p.name = name;
  p.unit = unit;
  p.prior_low = range.first;
  p.prior_high = range.second;
  p.prior_mean = 0.5 * (range.first + range.second);
  p.prior_sd = (range.second - range.first) / std::sqrt(12.0);
  p.mean = mean;
  p.sd = sd;
  p.mcse = sd / 38.0;
  p.q05 = mean - 1.64 * sd;
  p.q50 = mean;
  p.q95 = mean + 1.64 * sd;
  p.map = mean - 0.1 * sd;
  p.rhat = 1.0012;
  p.ess_bulk = 1834.0;
  p.ess_tail = 1502.0;
  p.contraction = 1.0 - sd * sd / (p.prior_sd * p.prior_sd);
  p.profile_low = mean - 1.96 * sd;
  p.profile_high = mean + 1.96 * sd;
  p.profile_x = grid(std::max(range.first, mean - 4.0 * sd), std::min(range.second, mean + 4.0 * sd), 41);
  for (const double x : p.profile_x) p.profile_deviance.push_back(std::pow((x - p.map) / sd, 2));
  p.verdict = Verdict::identified;
  p.sentence = name + " is identified: its posterior is much narrower than its prior.";
  return p;
}

/// Six speeds, torque of about `level` mN m that changes by `slope` from 50 to 300 rpm, with errors of 3 %.
void add_torque(CaseReport& result, double level, double slope, std::uint32_t stream) {
  data::RandomStream random(11, data::Purpose::test, stream);
  PredictiveCurve curve{.output = "torque",
                        .unit = "mN m",
                        .control = "rpm",
                        .control_unit = "rpm",
                        .observation_set = result.name,
                        .x = grid(50.0, 300.0, 51),
                        .mean = {},
                        .q05 = {},
                        .q95 = {}};
  const auto mean = [&](double rpm) { return level * (1.0 + slope * (rpm - 50.0) / 250.0); };
  for (const double rpm : curve.x) {
    const double width = level * (0.012 + 0.012 * std::pow((rpm - 175.0) / 125.0, 2));
    curve.mean.push_back(mean(rpm));
    curve.q05.push_back(mean(rpm) - 1.64 * width);
    curve.q95.push_back(mean(rpm) + 1.64 * width);
  }
  for (const double rpm : {50.0, 100.0, 150.0, 200.0, 250.0, 300.0}) {
    const double error = 0.03 * mean(rpm);
    result.predictive.push_back({.controls = {{"rpm", rpm}},
                                 .output = "torque",
                                 .unit = "mN m",
                                 .mean = mean(rpm),
                                 .q05 = mean(rpm) * 0.97,
                                 .q95 = mean(rpm) * 1.03,
                                 .observed = mean(rpm) + error * random.normal(),
                                 .standard_error = error,
                                 .observation_set = result.name});
  }
  result.curves.push_back(curve);
  result.observed_sets = {result.name};
  result.observed_notes = {"Synthetic: DEM at the published fit, with noise of 3 % drawn with seed 11."};
  result.chi2 = 5.31;
  result.dof = 6 - static_cast<int>(result.parameters.size());
  result.ppp = 0.46;
  result.chains = 4;
  result.draws = 1000;
  result.log_evidence = -12.413;
  result.log_evidence_error = 0.021;
  result.fisher_condition = 34.2;
  result.collinearity = 2.13;
}

CaseReport one_parameter() {
  CaseReport result;
  result.name = "zirconia-800";
  result.parameters = {parameter("friction", "", {0.1, 0.8}, 0.4023, 0.0214)};
  result.correlation = {{1.0}};
  add_torque(result, 74.2, 0.07, 1);
  result.grid_difference = 0.013;
  data::RandomStream random(11, data::Purpose::test, 10);
  for (int i = 0; i < plotted_draws; ++i) result.draws_for_plot.push_back({0.4023 + 0.0214 * random.normal()});
  result.finding = "Friction is identified: 0.402 ± 0.021, from a range of 0.1 to 0.8.";
  result.consequence = "The DEM may be used with this friction wherever torque decides.";
  result.remedy = "None needed; fourteen more speeds would halve the error.";
  return result;
}

CaseReport linked_case() {
  CaseReport result;
  result.name = "zirconia-100";
  result.parameters = {parameter("friction", "", {0.1, 0.8}, 0.4011, 0.0203),
                       parameter("hamaker", "J", {0.0, 2e-17}, 2.07e-18, 4.1e-19)};
  result.parameters[1].verdict = Verdict::weakly_identified;
  result.parameters[1].borderline = true;
  result.parameters[1].reason = Reason::practical;
  result.correlation = {{1.0, -0.61}, {-0.61, 1.0}};
  add_torque(result, 88.0, 0.0, 2);
  result.grid_difference = 0.021;
  result.linked = {"zirconia-800"};
  data::RandomStream random(11, data::Purpose::test, 11);
  for (int i = 0; i < plotted_draws; ++i) {
    const double a = random.normal(), b = random.normal();
    result.draws_for_plot.push_back(
        {0.4011 + 0.0203 * a, 2.07e-18 + 4.1e-19 * (-0.61 * a + std::sqrt(1 - 0.61 * 0.61) * b)});
  }
  result.finding =
      "The Hamaker constant is weakly identified: (2.07 ± 0.41) × 10⁻¹⁸ J, given the friction of zirconia-800.";
  result.consequence = "Cohesion is known to about a fifth.";
  result.remedy = "Measure at a lower fill, where cohesion weighs more.";
  return result;
}

CaseReport ridge() {
  CaseReport result;
  result.name = "carrier";
  result.parameters = {parameter("friction", "", {0.1, 0.8}, 0.431, 0.171),
                       parameter("hamaker", "J", {0.0, 2e-17}, 9.4e-18, 4.2e-18)};
  const double product = 0.4 * std::pow(9.0, 0.9);
  data::RandomStream random(11, data::Purpose::test, 12);
  while (result.draws_for_plot.size() < plotted_draws) {
    const double friction = random.uniform(0.1, 0.8);
    const double hamaker = std::pow(product * (1.0 + 0.06 * random.normal()) / friction, 1.0 / 0.9) * 1e-18;
    if (hamaker < 2e-17) result.draws_for_plot.push_back({friction, hamaker});
  }
  ParameterReport& friction = result.parameters[0];
  ParameterReport& hamaker = result.parameters[1];
  for (ParameterReport* p : {&friction, &hamaker}) {
    p->verdict = Verdict::not_identified;
    p->reason = Reason::practical;
    p->contraction = 0.28;
    p->sentence = p->name + " is not identified: its profile stays below 3.84 over most of its range.";
  }
  friction.q05 = 0.21;
  friction.q95 = 0.74;
  friction.profile_low = 0.185;
  friction.profile_high.reset();
  friction.high_is_bound = true;
  friction.profile_x = grid(0.1, 0.8, 41);
  friction.profile_deviance.clear();
  for (const double x : friction.profile_x)
    friction.profile_deviance.push_back(x < 0.3 ? 290.0 * std::pow(0.3 - x, 2) : 0.8 * (x - 0.3));
  hamaker.q05 = 4.2e-18;
  hamaker.q95 = 1.72e-17;
  hamaker.map = 9.1e-18;
  hamaker.profile_low = 3.9e-18;
  hamaker.profile_high = 1.94e-17;
  hamaker.profile_x = grid(0.0, 2e-17, 41);
  hamaker.profile_deviance.clear();
  for (const double x : hamaker.profile_x)
    hamaker.profile_deviance.push_back(std::pow(std::log((x + 1e-19) / 9.1e-18) / 0.43, 2));
  result.correlation = {{1.0, -0.947}, {-0.947, 1.0}};
  TradedPair traded{.first = "friction",
                    .second = "hamaker",
                    .combination = "friction * hamaker^0.9",
                    .correlation = -0.947,
                    .equivalent = {}};
  for (const double x : {0.2, 0.3, 0.4, 0.55, 0.75}) {
    traded.equivalent.push_back({{"friction", x}, {"hamaker", std::pow(product / x, 1.0 / 0.9) * 1e-18}});
  }
  result.traded = {traded};
  add_torque(result, 151.0, -0.12, 3);
  result.grid_difference = 0.034;
  result.collinearity = 16.4;
  result.fisher_condition = 1180.0;
  result.finding =
      "Friction and the Hamaker constant are not identified by torque: friction * hamaker^0.9 is fixed to 6 %, "
      "while either may be anything along that ridge.";
  result.consequence = "A simulation with one point of the ridge predicts torque, but not flow or segregation.";
  result.remedy = "Measure the torque's fluctuation or the axial flow as well, or fix the friction by another test.";
  return result;
}

SurrogateReport surrogate(const std::string& material, double level, std::uint32_t stream) {
  SurrogateReport s;
  s.output = "torque";
  s.material = material;
  s.unit = "mN m";
  s.runs = 64;
  s.q2 = 0.987;
  s.q2_held_out = 0.981;
  s.coverage95 = 0.953;
  s.nugget_sd = 0.74;
  s.verdict = SurrogateWord::good;
  s.finding = "It predicts unseen runs to 2 % and its intervals are honest.";
  s.consequence = "It may stand in for the simulation.";
  s.remedy = "None needed.";
  s.inputs = {"friction", "hamaker", "rpm"};
  s.length_scales = {0.82, 0.61, 2.94};
  data::RandomStream random(11, data::Purpose::test, stream);
  for (int i = 0; i < s.runs; ++i) {
    const double value = level * random.uniform(0.7, 2.1);
    const double z = random.normal();
    s.observed.push_back(value);
    s.predicted.push_back(value - 0.03 * value * z);
    s.standardised.push_back(z);
    s.observed_se.push_back(0.02 * value);
  }
  s.notes = {"The length scale of rpm lies at its upper bound: torque hardly depends on it."};
  return s;
}

}  // namespace

CalibrationReport three_cases() {
  CalibrationReport report;
  report.study_name = "developer";
  report.study_description = "Three materials in an auger mixer: torque from 50 to 300 rpm.";
  report.study_file = "data/developer/study.toml";
  report.surrogates = {surrogate("zirconia-800", 74.0, 20), surrogate("carrier", 110.0, 21)};
  report.cases = {one_parameter(), linked_case(), ridge()};
  for (const CaseReport& result : report.cases) {
    for (const double error : {0.01, 0.03, 0.05}) {
      ErrorScan scan{.case_name = result.name, .relative_error = error, .parameters = {}, .ppp = 0.5};
      for (const ParameterReport& p : result.parameters) {
        scan.parameters.push_back({.name = p.name,
                                   .verdict = p.verdict,
                                   .reason = {},
                                   .borderline = false,
                                   .mean = p.mean,
                                   .sd = p.sd * error / 0.03});
      }
      report.error_scan.push_back(scan);
    }
  }
  report.thresholds = {
      {"contraction for identified", "at least 0.9"}, {"profile interval", "closed at 3.84"}, {"R-hat", "below 1.01"}};
  report.provenance = {{"demcal", "0.1.0"},
                       {"instruction set", "x86-64-v3"},
                       {"seed", "11"},
                       {"training table", "training.h5, xxh3 5f1d6b1f0c3a77e2, 128 rows"}};
  report.notes = {"The minimum separation of 1.5 nm is not in the source; the attraction scales with its square.",
                  "The walls attract as the grains do."};
  return report;
}

CalibrationReport four_parameters() {
  CalibrationReport report;
  report.study_name = "four";
  CaseReport result;
  result.name = "powder";
  for (const char* const name : {"friction", "rolling", "cohesion", "restitution"}) {
    result.parameters.push_back(parameter(name, "", {0.0, 1.0}, 0.5, 0.06));
  }
  data::RandomStream random(3, data::Purpose::test, 1);
  for (int i = 0; i < 400; ++i) {
    const double a = random.normal();
    result.draws_for_plot.push_back({0.5 + 0.06 * a, 0.5 + 0.06 * random.normal(),
                                     0.5 - 0.06 * a + 0.005 * random.normal(), 0.5 + 0.06 * random.normal()});
  }
  result.correlation = {{1, 0.02, -0.99, 0.01}, {0.02, 1, 0.03, 0.2}, {-0.99, 0.03, 1, 0.0}, {0.01, 0.2, 0.0, 1}};
  result.traded = {{.first = "cohesion",
                    .second = "friction",
                    .combination = "friction + cohesion",
                    .correlation = -0.99,
                    .equivalent = {}}};
  add_torque(result, 20.0, 0.1, 4);
  report.cases = {result};
  return report;
}

CalibrationReport misfit() {
  CalibrationReport report;
  report.study_name = "wrong model";
  CaseReport result = one_parameter();
  result.fits = false;
  result.ppp = 0.002;
  result.chi2 = 41.2;
  result.finding = "No friction reproduces the measured rise.";
  result.consequence = "No value of friction found here means anything.";
  result.remedy = "Check the fill and the offset of the torque sensor.";
  result.warnings = {"case " + result.name + ": the model does not fit the data"};
  report.cases = {result};
  return report;
}

std::size_t count(const std::string& text, const std::string& piece) {
  std::size_t found = 0;
  for (std::size_t at = 0; (at = text.find(piece, at)) != std::string::npos; at += piece.size()) ++found;
  return found;
}

}  // namespace report_fixture
