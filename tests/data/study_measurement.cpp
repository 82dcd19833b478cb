// The keys that say what is not known of a measurement: units, defaults, and what is refused.
#include <catch2/catch.hpp>
#include <numbers>

#include "data/study.hpp"
#include "tests/temporary.hpp"

namespace {

const std::string head =
    "[study]\nname = \"s\"\n[parameters.friction]\nlow = 0.1\nhigh = 0.8\n[training]\ntable = \"runs.csv\"\n"
    "[outputs.torque]\nunit = \"mN m\"\n[outputs.flow]\nunit = \"g/s\"\n"
    "[controls.speed]\nunit = \"rpm\"\nlow = 50\nhigh = 300\n";  // 15 lines
const std::string bench = "speed,torque,torque_se\n50,8.1,0.2\n300,9.3,0.3\n";
const std::string observe = "[[observe]]\nname = \"bench\"\nfile = \"bench.csv\"\n";
const std::string powder = "[[calibrate]]\nname = \"powder\"\nobserve = [\"bench\"]\nfree = [\"friction\"]\n";

data::Study read(const TemporaryFolder& folder, const std::string& text, const std::string& measured = bench) {
  folder.write("bench.csv", measured);
  const data::StudyFile file = data::StudyFile::open(folder.write("study.toml", text));
  data::Study study = data::read_study(file);
  file.finish();
  return study;
}

data::Study study_with(const std::string& text, const std::string& measured = bench) {
  return read(TemporaryFolder(), text, measured);
}

data::CalibrationCase case_with(const std::string& lines) {
  return study_with(head + observe + powder + lines).cases.at(0);
}

std::string problem(const std::string& text, const std::string& measured = bench) {
  const TemporaryFolder folder;
  return failure_of(folder, [&] { read(folder, text, measured); });
}

bool says(const std::string& message, const std::string& part) {
  INFO(message);
  CHECK(message.find(part) != std::string::npos);
  return message.find(part) != std::string::npos;
}

}  // namespace

TEST_CASE("a study that says nothing of its meter has no unknown beside its parameters") {
  CHECK(case_with("").nuisances.empty());
  CHECK(case_with("discrepancy = false\n").nuisances.empty());
  CHECK(case_with("").sampler == data::Sampler::mixture);
}

TEST_CASE("offset and gain are normal about 0 and 1 unless they say otherwise, in the output's unit") {
  const auto offset = case_with("offset = { sd = \"200 uN m\" }\n").nuisances.at(0);
  CHECK(offset.kind == data::NuisanceKind::offset);
  CHECK(offset.output == std::optional<std::size_t>(0));
  CHECK(offset.parameter.prior.mean == 0.0);
  CHECK(offset.parameter.prior.sd == Approx(2e-4));
  CHECK(offset.parameter.low == Approx(-12e-4));
  CHECK(offset.parameter.unit.symbol == "mN m");
  const auto gain = case_with("gain = { mean = 1.02, sd = 0.01, low = 1 }\n").nuisances.at(0);
  CHECK(gain.kind == data::NuisanceKind::gain);
  CHECK(gain.parameter.prior.mean == 1.02);
  CHECK(gain.parameter.low == 1.0);
  CHECK(gain.parameter.high == Approx(1.08));
  const auto wide = case_with("gain = { sd = 0.5 }\n").nuisances.at(0);
  CHECK(wide.parameter.low == Approx(1e-3));  // a gain is above 0
  const auto even = case_with("offset = { kind = \"uniform\", low = \"0 mN m\", high = \"1 mN m\" }\n").nuisances.at(0);
  CHECK(even.parameter.prior.kind == data::PriorKind::uniform);
  CHECK(even.parameter.high == Approx(1e-3));
  CHECK(even.parameter.prior.high == Approx(1e-3));
}

TEST_CASE("unknown noise is a scale on the standard errors, or an absolute one in their place") {
  const auto unknown = case_with("noise = \"unknown\"\n").nuisances.at(0);
  CHECK(unknown.kind == data::NuisanceKind::noise_scale);
  CHECK(unknown.parameter.prior.kind == data::PriorKind::log_normal);
  CHECK_FALSE(unknown.output);
  const auto stated = case_with("noise = { kind = \"log_normal\", mean = 2, sd = 0.3 }\n").nuisances.at(0);
  CHECK(stated.parameter.prior.mean == 2.0);
  CHECK(stated.parameter.high == Approx(2.0 * std::exp(1.8)));
  const auto absolute =
      case_with("noise = { absolute = true, kind = \"log_normal\", mean = \"300 uN m\", sd = 0.5 }\n").nuisances.at(0);
  CHECK(absolute.kind == data::NuisanceKind::noise_sd);
  CHECK(absolute.parameter.prior.mean == Approx(3e-4));
  CHECK(absolute.output == std::optional<std::size_t>(0));
}

TEST_CASE("a noise that stands in the place of the standard errors needs none in the files, a scale on them does") {
  const std::string without = "speed,torque\n50,8.1\n300,9.3\n", missing = "the column 'torque_se' is missing";
  const std::string absolute = "noise = { absolute = true, kind = \"log_normal\", mean = \"300 uN m\", sd = 0.5 }\n";
  const data::Study study = study_with(head + observe + powder + absolute, without);
  REQUIRE(study.observations.at(0).points.size() == 2);
  CHECK(study.observations[0].points[1].values.at(0) == Approx(9.3e-3));
  CHECK(study.observations[0].points[1].standard_errors.at(0) == Approx(3e-4));  // what the prior says of it

  for (const std::string noise :
       {"", "noise = \"unknown\"\n", "noise = { kind = \"log_normal\", mean = 1, sd = 0.5 }\n"})
    says(problem(head + observe + powder + noise, without), missing);
  // Of another output; of one of two cases that read the set; of no case.
  const std::string of_flow =
      "noise = { absolute = true, output = \"flow\", kind = \"log_normal\", mean = \"1 g/s\", sd = 0.5 }\n";
  says(problem(head + observe + powder + of_flow, "speed,torque,flow,flow_se\n50,8.1,1,0.1\n300,9.3,2,0.1\n"), missing);
  const std::string second = "[[calibrate]]\nname = \"second\"\nobserve = [\"bench\"]\nfree = [\"friction\"]\n";
  says(problem(head + observe + powder + absolute + second, without), missing);
  CHECK(study_with(head + observe + powder + absolute + second + absolute, without).cases.size() == 2);
  says(problem(head + observe, without), missing);
}

TEST_CASE(
    "data that a case with a noise of its own predicts need no standard errors, and equal readings are not copies") {
  const std::string absolute = "noise = { absolute = true, kind = \"log_normal\", mean = \"300 uN m\", sd = 0.5 }\n";
  const TemporaryFolder folder;
  folder.write("more.csv", "speed,torque\n100,8.4\n100,8.4\n100,8.5\n");
  const data::Study study =
      read(folder, head + observe + "[[observe]]\nname = \"more\"\nfile = \"more.csv\"\n" + powder + absolute +
                       "[[predict]]\nname = \"held-out\"\nobserve = [\"more\"]\n");
  CHECK(study.observations.at(1).points.size() == 3);
  CHECK(study.observations[0].points[0].standard_errors.at(0) == Approx(2e-4));  // the file's own stay
}

TEST_CASE("a discrepancy has a scale and a length, stated or the usual ones") {
  const auto usual = case_with("discrepancy = true\n").nuisances;
  REQUIRE(usual.size() == 2);
  CHECK(usual[0].parameter.prior.sd == 0.1);
  CHECK(usual[1].parameter.prior.mean == 0.5);
  const auto stated = case_with("discrepancy = { sd = 0.05, length = 1, output = \"torque\" }\n").nuisances;
  CHECK(stated[0].parameter.prior.sd == 0.05);
  CHECK(stated[1].parameter.prior.mean == 1.0);
  CHECK(stated[0].output == std::optional<std::size_t>(0));
}

TEST_CASE("errors common to a set and of its controls are a share or a value with its unit") {
  const auto set = [](const std::string& lines, const std::string& control = "") {
    return study_with(head + control + observe + lines + powder).observations.at(0);
  };
  CHECK(set("common_error = \"2 %\"\n").common_errors.at(0).spread.relative == Approx(0.02));
  CHECK(set("common_error = 0.02\n").common_errors.at(0).spread.relative == Approx(0.02));
  CHECK(set("common_error = { torque = \"0.1 mN m\" }\n").common_errors.at(0).spread.absolute == Approx(1e-4));
  const data::SettingError own =
      set("uncertainty = { speed = \"2 rpm\" }\n", "uncertainty = \"1 %\"\n").setting_errors.at(0);
  CHECK(own.spread.absolute == Approx(2.0 * std::numbers::pi / 30.0));
  CHECK(own.spread.relative == 0.0);
  CHECK(set("", "uncertainty = \"1 %\"\n").setting_errors.at(0).spread.relative == Approx(0.01));
  CHECK(set("", "uncertainty = 3\n").setting_errors.at(0).spread.absolute == Approx(3.0 * std::numbers::pi / 30.0));
}

TEST_CASE("a common share holds of every output of the set, and a common value only where there is one") {
  const std::string both = "speed,torque,torque_se,flow,flow_se\n50,8.1,0.2,1,0.1\n300,9.3,0.3,2,0.1\n";
  const auto errors =
      study_with(head + observe + "common_error = \"3 %\"\n" + powder, both).observations[0].common_errors;
  REQUIRE(errors.size() == 2);
  for (std::size_t k = 0; k < 2; ++k) {
    CHECK(errors[k].output == k);
    CHECK(errors[k].spread.relative == Approx(0.03));
  }
  says(problem(head + observe + "common_error = \"0.1 mN m\"\n" + powder, both),
       "observe.bench.common_error: is a value with a unit, and 'bench' measures 2 outputs");
}

TEST_CASE("sets that name one meter state one common error") {
  const auto two = [](const std::string& first, const std::string& second) {
    const std::string again = observe + second;
    return head + observe + first + std::string(again).replace(again.find("bench"), 5, "other") + powder;
  };
  const std::string error = "common_error = \"2 %\"\n", meter = "meter = \"cell\"\n";
  CHECK(study_with(two(error + meter, error + meter)).observations.at(1).meter == "cell");
  CHECK(study_with(two(error, error)).observations.at(1).meter.empty());
  says(problem(two(error + meter, "common_error = \"3 %\"\n" + meter)),
       "common_error: of torque is not that of 'bench', though both are of the meter 'cell'");
  says(problem(two(meter, error)), "observe.bench.meter: 'cell' has no error that 'bench' could share");
  says(problem(two(error + "meter = \"a b\"\n", error)), "'a b' cannot be part of an unknown's name");
}

TEST_CASE("errors of two outputs that go together are named with their outputs and sets") {
  const std::string both = "speed,torque,torque_se,flow,flow_se\n50,8.1,0.2,3,0.1\n300,9.3,0.3,4,0.1\n";
  const auto with = [](const std::string& lines) {
    return head + observe + "[[observe.correlation]]\n" + lines + powder;
  };
  const std::string between = "between = [\"torque\", \"flow\"]\n";
  const data::ErrorCorrelation found =
      study_with(with(between + "value = -0.4\n"), both).observations.at(0).correlations.at(0);
  CHECK(found.output == 0);
  CHECK(found.other_output == 1);
  CHECK(found.other_set == "bench");
  CHECK(found.value == -0.4);
  says(problem(with(between + "value = 1\n"), both), "observe.bench.correlation");
  says(problem(with(between), both), "value: is missing");
  says(problem(with(between + "value = 0.4\n")), "'flow' is no output that 'bench' measures");
  says(problem(with("between = [\"torque\"]\nvalue = 0.4\n")), "names 1 outputs, but a correlation is of two");
  says(problem(with("between = [\"torque\", \"torque\"]\nvalue = 0.4\n")), "names torque twice");
  says(problem(with(between + "with = \"other\"\nvalue = 0.4\n"), both), "there is no observation set 'other'");
}

TEST_CASE("a control that the file has no column of is set for the whole set") {
  const data::Study study =
      study_with(head + observe + "settings = { speed = \"60 rpm\" }\n" + powder, "torque,torque_se\n8,1\n9,1\n");
  CHECK(study.observations[0].points.at(1).controls.at(0) == Approx(2.0 * std::numbers::pi));
  says(problem(head + observe + "settings = { speed = \"60 rpm\" }\n" + powder),
       "has a column speed, which the study also sets (keep one of the two)");
  const data::Study unknown = study_with(
      head + observe +
          "settings = { speed = \"60 rpm\" }\nuncertainty = { speed = { sd = \"2 rpm\", as = \"unknown\" } }\n" +
          powder,
      "torque,torque_se\n8,1\n9,1\n");
  CHECK(unknown.observations[0].setting_errors.at(0).as == data::SettingErrorAs::unknown);
}

TEST_CASE("what cannot be meant of a measurement is refused with its place") {
  const auto with = [](const std::string& lines) { return problem(head + observe + powder + lines); };
  CHECK(case_with("offset = { sd = 0.2 }\n").nuisances.at(0).parameter.prior.sd == Approx(2e-4));
  says(with("offset = { sd = \"2 rpm\" }\n"), "calibrate.powder.offset.sd: '2 rpm' has the wrong unit");
  says(with("offset = { sd = 0 }\n"), "offset.sd: 0 is not above 0");
  says(with("gain = { output = \"flow\", sd = 0.1 }\n"),
       "calibrate.powder.gain: acts on flow, which the case does not observe");
  says(with("gain = { kind = \"uniform\" }\n"), "gain.low: is missing, and this prior has no other bounds");
  says(with("noise = \"unkown\"\n"), "'unkown' is not one of the choices");
  says(with("discrepancy = \"yes\"\n"), "is neither true nor false");
  says(with("discrepancy = { sd = 2 }\n"), "discrepancy.sd: 2 is above the largest value 1");
  says(with("sampler = \"gibbs\"\n"), "calibrate.powder.sampler: 'gibbs' is not one of the choices");
  says(problem(head + observe + "common_error = \"2 rpm\"\n" + powder),
       "observe.bench.common_error: '2 rpm' has the wrong unit");
  says(problem(head + observe + "uncertainty = { speed = { sd = \"2 rpm\", as = \"unknown\" } }\n" + powder),
       "speed differs from point to point of 'bench', so it is not one unknown");
  std::string warm = head + observe + "uncertainty = { speed = \"2 %\" }\n" + powder;
  warm.replace(warm.find("unit = \"rpm\""), 12, "unit = \"degC\"");
  says(problem(warm), "observe.bench.uncertainty.speed: is a share of a value in degC, whose zero is arbitrary");
  std::string clash = head;
  clash.replace(clash.find("friction"), 8, "gain");
  std::string free_gain = powder;
  free_gain.replace(free_gain.find("friction"), 8, "gain");
  says(problem(clash + observe + free_gain + "gain = { sd = 0.1 }\n"), "is also the name of a parameter");
}

TEST_CASE("a machine's torque on a slice's runs needs a scale, fixed or with a prior") {
  const std::string rig = "[rig]\nkind = \"slice\"\n";
  const std::string machine = observe + "rig = \"machine\"\n";
  says(problem(head + rig + machine + powder),
       "observe.bench.rig: is the whole machine, but the runs simulate a slice of it, and nothing says how many");
  const data::Study fixed = study_with(head + rig + "scale = 20\n" + machine + powder);
  CHECK(fixed.observations[0].of_machine);
  CHECK(fixed.scale->value == 20.0);
  CHECK_FALSE(fixed.scale->unknown);
  CHECK_FALSE(study_with(head + rig + "scale = 20\n" + observe + powder).observations[0].of_machine);
  const data::Study unknown = study_with(head + rig + "scale = { mean = 20, sd = 1 }\n" + machine + powder);
  REQUIRE(unknown.scale->unknown);
  CHECK(unknown.scale->unknown->parameter.prior.sd == 1.0);
  says(problem(head + rig + "scale = 0\n" + machine + powder), "rig.scale: 0 is not above 0");
  says(problem(head + rig + "scale = 20\n" + machine + powder, "speed,torque,torque_se,flow,flow_se\n50,8,1,2,1\n"),
       "measures flow on the machine, and [rig] scale is of torque only");
}
