#include "data/study.hpp"

#include <catch2/catch.hpp>
#include <numbers>

#include "data/observations.hpp"
#include "tests/temporary.hpp"

namespace {

const std::string head =
    "[study]\nname = \"s\"\n[parameters.friction]\nlow = 0.1\nhigh = 0.8\n[parameters.cohesion]\nunit = \"mJ/m2\"\n"
    "low = 0\nhigh = 10\n[controls.speed]\nunit = \"rpm\"\nlow = 50\nhigh = 300\n[training]\ntable = \"runs.csv\"\n"
    "[outputs.torque]\nunit = \"mN m\"\n";  // 17 lines
const std::string bench = "# truth unknown\nspeed,torque,torque_se\n50,8.1,0.2\n310,9.3,0.3\n";
const std::string observe = "[[observe]]\nname = \"bench\"\nfile = \"bench.csv\"\n";  // 3 lines

data::Study read(const TemporaryFolder& folder, const std::string& text,
                 const std::vector<std::string>& overrides = {}) {
  const data::StudyFile file = data::StudyFile::open(folder.write("study.toml", text), overrides);
  data::Study study = data::read_study(file);
  file.finish();
  return study;
}

std::string problem(const std::string& text, const std::string& measured = bench) {
  const TemporaryFolder folder;
  folder.write("bench.csv", measured);
  return failure_of(folder, [&] { read(folder, text); });
}

std::string case_with(const std::string& lines) {
  return head + observe + "[[calibrate]]\nname = \"powder\"\nobserve = [\"bench\"]\n" + lines;
}

}  // namespace

TEST_CASE("the other-code study reads as it is shipped, in SI") {
  const data::StudyFile file = data::StudyFile::open(DEMCAL_SOURCE_DIR "/data/other-code");
  const data::Study study = data::read_study(file);
  CHECK_NOTHROW(file.finish());
  CHECK_NOTHROW(data::require_cases(study));
  CHECK(study.name == "other-code");
  CHECK(study.seed == 7);
  REQUIRE(study.parameters.size() == 2);
  CHECK(study.parameters[0].name == "friction");
  CHECK(study.parameters[0].prior.kind == data::PriorKind::uniform);
  CHECK(study.parameters[0].prior.low == 0.1);
  CHECK(study.parameters[0].prior.high == 0.8);
  CHECK(study.parameters[1].high == Approx(0.010));
  CHECK(study.parameters[1].prior.high == study.parameters[1].high);
  REQUIRE(study.controls.size() == 1);
  CHECK(study.controls[0].high == Approx(10.0 * std::numbers::pi));
  CHECK(study.training.engine == data::Engine::none);
  CHECK(study.training.table == std::string(DEMCAL_SOURCE_DIR) + "/data/other-code/runs.csv");
  CHECK(study.outputs.at(0).unit.symbol == "mN m");
  REQUIRE(study.observations.size() == 1);
  CHECK(study.observations[0].points.size() == 6);
  CHECK(study.observations[0].header.at(0).find("Synthetic") == 0);
  CHECK(study.observations[0].points[0].values[0] == Approx(9.4188e-3));
  CHECK(study.materials.size() == 1);
  CHECK(study.materials[0].name.empty());
  CHECK(study.cases.at(0).free == std::vector<std::string>{"friction", "cohesion"});
  CHECK(data::outside_training_range(study).empty());
}

TEST_CASE(
    "materials fix parameters, cases take priors from other cases, and only one section is asked of the DEM's reader") {
  const TemporaryFolder folder;
  folder.write("bench.csv", bench);
  const std::string text =
      head + "[rig]\n[materials.z-800]\nruns = 12\nfixed = { cohesion = \"0 J/m2\" }\n[materials.z-100]\n" +
      "[[observe]]\nname = \"a\"\nmaterial = \"z-800\"\nfile = \"bench.csv\"\n"
      "[[observe]]\nname = \"b\"\nmaterial = \"z-100\"\nfile = \"bench.csv\"\n"
      "[[calibrate]]\nname = \"first\"\nobserve = [\"a\"]\nfree = [\"friction\"]\n"
      "[[calibrate]]\nname = \"second\"\nobserve = [\"b\"]\nfree = [\"friction\", \"cohesion\"]\n"
      "priors = { friction = { posterior = \"first\" }, cohesion = { kind = \"log_normal\", median = 2, sd = 0.5 } }\n"
      "[[calibrate]]\nname = \"third\"\nobserve = [\"b\"]\nfree = [\"cohesion\"]\nfixed = { friction = 0.4 }\n";
  const data::StudyFile file = data::StudyFile::open(folder.write("study.toml", text));
  const data::Study study = data::read_study(file);
  file.root().child("rig");
  CHECK_NOTHROW(file.finish());
  CHECK(study.training.engine == data::Engine::demcal);
  CHECK(study.material("z-800").fixed.at("cohesion") == 0.0);
  CHECK(study.material("z-800").runs == 12);
  CHECK_FALSE(study.material("z-100").runs.has_value());
  CHECK(study.observations[1].material == "z-100");
  CHECK(study.cases[1].priors.at("friction").posterior_of == "first");
  CHECK(study.cases[1].priors.at("cohesion").mean == Approx(0.002));
  CHECK(study.cases[2].fixed.at("friction") == 0.4);
}

TEST_CASE("priors are read in the parameter's unit") {
  const TemporaryFolder folder;
  const auto prior = [&](const std::string& text) {
    const data::Study study = read(
        folder,
        "[training]\ntable = \"x.csv\"\n[parameters.a]\nunit = \"mJ/m2\"\nlow = 1\nhigh = 10\nprior = " + text + "\n");
    return study.parameters[0].prior;
  };
  const data::Prior normal = prior("{ kind = \"normal\", mean = 4, sd = \"500 uJ/m2\" }");
  CHECK(normal.mean == Approx(0.004));
  CHECK(normal.sd == Approx(0.0005));
  CHECK(normal.high == Approx(0.010));
  const data::Prior truncated = prior("{ kind = \"truncated_normal\", mean = 4, sd = 1, low = 2 }");
  CHECK(truncated.low == Approx(0.002));
  CHECK(truncated.high == Approx(0.010));
  const data::Prior beta = prior("{ kind = \"beta\", alpha = 2, beta = 3.5 }");
  CHECK(beta.alpha == 2.0);
  CHECK(beta.beta == 3.5);
  CHECK(failure_of(folder, [&] { prior("{ kind = \"uniform\", high = 11 }"); }) ==
        "78: study.toml:7: parameters.a.prior.high: 11 mJ/m2 is outside the parameter's range, 1 mJ/m2 to 10 mJ/m2 "
        "(narrow the prior or widen the range; nothing is simulated outside it)");
  CHECK(failure_of(folder, [&] { prior("{ kind = \"normal\", mean = 4, sd = 0 }"); }) ==
        "78: study.toml:7: parameters.a.prior.sd: 0 is not above 0 mJ/m2 (choose a value above 0 mJ/m2)");
  CHECK(failure_of(folder, [&] { prior("{ kind = \"normal\", mean = 40, sd = 1 }"); }).find("over three sd away") !=
        std::string::npos);
  CHECK(failure_of(folder, [&] { prior("{ kind = \"beta\", alpha = 1 }"); }) ==
        "78: study.toml:7: parameters.a.prior.beta: is missing (add a line like beta = 0.5)");
  CHECK(failure_of(folder, [&] { prior("{ mean = 4, sd = 1 }"); }) ==
        "78: study.toml:7: parameters.a.prior.kind: is missing (add a line kind = \"normal\", or one of uniform, "
        "log_uniform, normal, truncated_normal, log_normal, beta)");
  CHECK(failure_of(folder, [&] { prior("{ kind = \"gauss\", mean = 4, sd = 1 }"); }).find("sd") == std::string::npos);
  CHECK(failure_of(folder, [&] { prior("{ kind = \"gauss\" }"); }).find("is not one of the choices") !=
        std::string::npos);
}

TEST_CASE("an error in degrees Celsius is one in kelvins, wherever it stands") {
  const TemporaryFolder folder;
  folder.write("bench.csv", "temp,melt,melt_se\n20,50,0.5\n40,60,0.5\n");
  const data::Study study = read(folder, R"([training]
table = "x.csv"
[parameters.Ts]
unit = "degC"
low = 20
high = 90
prior = { kind = "normal", mean = "50 degC", sd = "10 degC" }
[controls.temp]
unit = "degC"
low = 10
high = "60 degC"
uncertainty = "2 degC"
[outputs.melt]
unit = "degC"
[[observe]]
name = "bench"
file = "bench.csv"
common_error = "1 degC"
[[calibrate]]
name = "powder"
observe = ["bench"]
free = ["Ts"]
offset = { mean = "-0.5 degC", sd = "0.5 degC" }
noise = { kind = "log_normal", absolute = true, median = "0.3 degC", sd = 0.2 }
)");
  CHECK(study.parameters[0].prior.mean == Approx(323.15));
  CHECK(study.parameters[0].prior.sd == Approx(10.0));
  CHECK(study.controls[0].high == Approx(333.15));
  CHECK(study.controls[0].uncertainty->spread.absolute == Approx(2.0));
  CHECK(study.observations[0].common_errors.at(0).spread.absolute == Approx(1.0));
  const data::Nuisance offset = study.cases[0].nuisances.at(0);
  CHECK(offset.parameter.prior.mean == Approx(-0.5));
  CHECK(offset.parameter.prior.sd == Approx(0.5));
  CHECK(offset.parameter.unit.from_si(0.25) == Approx(0.25));  // as it is shown
  CHECK(study.cases[0].nuisances.at(1).parameter.prior.mean == Approx(0.3));
}

TEST_CASE("a control may have a log scale, and then no value without a logarithm") {
  const TemporaryFolder folder;
  const auto with = [&](const std::string& low, const std::string& measured) {
    folder.write("bench.csv", "speed,torque,torque_se\n" + measured + ",1,0.1\n");
    return read(
        folder,
        "[training]\ntable = \"x.csv\"\n[parameters.a]\nlow = 0\nhigh = 1\n[controls.speed]\nunit = \"rpm\"\nlow = " +
            low + "\nhigh = 300\nscale = \"log\"\n[[observe]]\nname = \"bench\"\nfile = \"bench.csv\"\n" +
            "[[calibrate]]\nname = \"p\"\nobserve = [\"bench\"]\nfree = [\"a\"]\n");
  };
  const data::Control control = with("3", "30").controls.at(0);
  CHECK(control.axis().to_unit(control.unit.to_si(30.0)) == Approx(0.5));
  CHECK(failure_of(folder, [&] { with("0", "30"); }).find("controls.speed.low: 0 rpm has no logarithm") !=
        std::string::npos);
  CHECK(failure_of(folder, [&] { with("3", "0"); }).find("bench.csv:2") != std::string::npos);
  CHECK(failure_of(folder, [&] { with("3", "-2"); }).find("has no logarithm") != std::string::npos);
}

TEST_CASE("ranges and names of parameters are checked where they stand") {
  const auto with = [](const std::string& lines) { return problem("[training]\ntable = \"x.csv\"\n" + lines); };
  CHECK(with("[parameters.a]\nlow = 0.8\nhigh = 0.1\n") ==
        "78: study.toml:4: parameters.a.low: 0.8 is not below high, which is 0.1 (choose low < high)");
  CHECK(with("[parameters.a]\nlow = 0\nhigh = 1\nscale = \"log\"\n") ==
        "78: study.toml:4: parameters.a.low: 0 has no logarithm (choose low above 0, or scale = \"linear\")");
  CHECK(with("[parameters.a]\nhigh = 1\n") ==
        "78: study.toml:3: parameters.a.low: is missing (add a line like low = 0.5)");
  for (const char* unit : {"U/min", "mNm", "sek"})  // as instruments spell them
    CHECK(with("[parameters.a]\nunit = \"" + std::string(unit) + "\"\nlow = 0\nhigh = 1\n").empty());
  CHECK(with("[parameters.a]\nunit = \"qq\"\nlow = 0\nhigh = 1\n")
            .find("78: study.toml:4: parameters.a.unit: 'qq' is not a unit") == 0);
  CHECK(with("[parameters.a]\nunit = \"m\"\nlow = \"1 s\"\nhigh = 2\n").find("has the wrong unit") !=
        std::string::npos);
  CHECK(with("[parameters.\"a b\"]\nlow = 0\nhigh = 1\n") ==
        "78: study.toml:3: parameters.a b: is not a name (use letters, digits and _, beginning with a letter)");
  CHECK(with("[parameters.a]\nlow = 0\nhigh = 1\n[controls.a]\nlow = 0\nhigh = 1\n") ==
        "78: study.toml:6: controls.a: the name is taken by a parameter (choose another name)");
  CHECK(with("[parameters.draw]\nlow = 0\nhigh = 1\n").find("a dimension of the posterior's file") !=
        std::string::npos);
  CHECK(with("[parameters.seed]\nlow = 0\nhigh = 1\n").find("a column that the run table keeps for itself") !=
        std::string::npos);
  CHECK(with("[parameters.torque_se]\nlow = 0\nhigh = 1\n")
            .find("the column torque_se of its standard error is a parameter") != std::string::npos);
  CHECK(with("[parameters.a]\nlow = 0\nhgh = 1\n") ==
        "78: study.toml:3: parameters.a.high: is missing (add a line like high = 0.5)\n"
        "study.toml:5: parameters.a.hgh: is not a key that demcal knows (did you mean 'high'?)");
  CHECK(with("") == "78: study.toml: parameters: names no parameter (add a section like [parameters.friction])");
}

TEST_CASE("a study needs a table or a rig, and a case to calibrate") {
  CHECK(problem("[parameters.a]\nlow = 0\nhigh = 1\n").find("training.table: is missing, and there is no [rig]") !=
        std::string::npos);
  CHECK(problem("[parameters.a]\nlow = 0\nhigh = 1\n[training]\nengine = \"demcal\"\n")
            .find("has no [rig] to simulate") != std::string::npos);
  // A rig may be simulated without parameters, and not calibrated.
  CHECK(problem("[rig]\nkind = \"slice\"\n").find("names no parameter") == std::string::npos);
  CHECK(problem("[rig]\nkind = \"slice\"\n[[calibrate]]\nname = \"a\"\n").find("names no parameter") !=
        std::string::npos);
  const TemporaryFolder folder;
  const data::Study study = read(folder, head);
  CHECK(failure_of(folder, [&] { data::require_cases(study); }) ==
        "78: study.toml: has no measurements to calibrate against (add [[observe]] with a name and a file)\n"
        "study.toml: has no case to calibrate (add [[calibrate]] with name, observe and free)");
}

TEST_CASE("a case must give every parameter one role and name only what exists") {
  CHECK(problem(case_with("free = [\"friction\", \"cohesion\"]\n")).empty());
  CHECK(problem(case_with("free = [\"friction\"]\n")) ==
        "78: study.toml:24: calibrate.powder.free: leaves out 'cohesion', which is not fixed either (add it to free, "
        "or write fixed = { cohesion = VALUE })");
  CHECK(problem(case_with("free = [\"friction\", \"cohesion\"]\nfixed = { cohesion = 1 }\n")) ==
        "78: study.toml:24: calibrate.powder.free: 'cohesion' is both free and fixed (name it in one of them)");
  CHECK(problem(case_with("free = [\"friction\"]\nfixed = { cohesion = 11 }\n")) ==
        "78: study.toml:25: calibrate.powder.fixed: cohesion = 11 mJ/m2 is outside its range, 0 to 10 (choose a value "
        "inside, where there are runs)");
  CHECK(problem(case_with("free = [\"fricton\", \"cohesion\"]\nfixed = { friction = 0.4 }\n")) ==
        "78: study.toml:24: calibrate.powder.free: 'fricton' is not a parameter (did you mean 'friction'?)");
  CHECK(problem(case_with(
            "free = [\"friction\"]\nfixed = { cohesion = 1 }\npriors = { cohesion = { kind = \"uniform\" } }\n")) ==
        "78: study.toml:26: calibrate.powder.priors: 'cohesion' has a prior but is not free (add it to free, or remove "
        "its prior)");
  CHECK(
      problem(case_with("free = [\"friction\", \"cohesion\"]\npriors = { friction = { posterior = \"powder\" } }\n")) ==
      "78: study.toml:25: calibrate.powder.priors: the prior of friction leads back to this case (break the circle)");
  CHECK(
      problem(case_with("free = [\"friction\", \"cohesion\"]\npriors = { friction = { posterior = \"powdr\" } }\n")) ==
      "78: study.toml:25: calibrate.powder.priors: 'powdr' is not a case (did you mean 'powder'?)");
  CHECK(problem(head + "[[calibrate]]\nname = \"p\"\nobserve = [\"bnch\"]\nfree = [\"friction\"]\n") ==
        "78: study.toml:20: calibrate.p.observe: 'bnch' is not the name of an [[observe]] (the study has none)");
  CHECK(problem(head + observe + observe).find("78: study.toml:22: observe.bench.name: 'bench' is taken") == 0);
  CHECK(problem(case_with("free = [\"friction\", \"cohesion\"]\nfixed = { cohesiom = 1 }\n"))
            .find("fixed.cohesiom: is not a key that demcal knows (did you mean 'cohesion'?)") != std::string::npos);
}

TEST_CASE("what is wrong with an observation file is named with its line") {
  const std::string text = case_with("free = [\"friction\", \"cohesion\"]\n");
  CHECK(problem(text, "speed,torque\n50,8\n") ==
        "65: bench.csv:1: the column 'torque_se' is missing (the columns are speed, torque)");
  CHECK(problem(text, "torque,torque_se\n8,1\n") ==
        "65: bench.csv:1: the column 'speed' is missing (the columns are torque, torque_se)");
  CHECK(problem(text, "speed,troque\n50,8\n").find("65: bench.csv:1: the column 'torque' is missing") == 0);
  CHECK(problem(text, "speed,torque,torque_se\n50,8,0\n") ==
        "65: bench.csv:2: torque_se: 0 is not above 0 (give the standard error of the measured mean)");
  CHECK(problem(text, "speed,torque,torque_se\n50,nan,1\n") ==
        "65: bench.csv:2: torque: 'nan' is not a measured value (give a number, or remove the line)");
  CHECK(problem(text, "speed,torque,torque_se\n") ==
        "65: bench.csv: has a header but no rows (add the measured points)");
  CHECK(problem(head + "[[observe]]\nname = \"b\"\nfile = \"none.csv\"\n") ==
        "66: study.toml:20: observe.b.file: there is no file 'none.csv' (paths start at the study's folder)");
  CHECK(problem(head + "[[observe]]\nname = \"b\"\nfile = 3\n[[observe]]\nname = \"c\"\nfile = \"none.csv\"\n")
            .find("78: ") == 0);
}

TEST_CASE("an output that some rows of a file do not measure is left open there, and one that none does is not read") {
  const TemporaryFolder folder;
  const std::string text =
      head + "[outputs.angle]\nunit = \"degree\"\n[outputs.level]\n" + observe +
      "[[calibrate]]\nname = \"powder\"\nobserve = [\"bench\"]\nfree = [\"friction\", \"cohesion\"]\n";
  const std::string columns = "speed,torque,torque_se,angle,angle_se,level,level_se\n";
  folder.write("bench.csv", columns + "50,8,1,,,,\n100,,,40,2,,\n150,9,1,41,2,-,-\n");
  const data::ObservationSet set = read(folder, text).observations.at(0);
  CHECK(set.outputs == std::vector<std::size_t>{0, 1});
  CHECK(set.empty_outputs == std::vector<std::size_t>{2});
  REQUIRE(set.points.size() == 3);
  CHECK(data::points_with(set, 0) == std::vector<std::size_t>{0, 2});
  CHECK(data::points_with(set, 1) == std::vector<std::size_t>{1, 2});
  CHECK(set.points[1].values[1] == Approx(40.0 * std::numbers::pi / 180.0));
  // A row that measures nothing, and a value without its error, are mistakes.
  CHECK(problem(text, columns + "50,8,1,,,,\n100,,,,,,\n") ==
        "65: bench.csv:3: torque: '' is not a measured value (give a number, or remove the line)");
  CHECK(problem(text, columns + "50,8,1,40,,,\n") ==
        "65: bench.csv:2: angle_se: '' is not a measured value (give a number, or remove the line)");
  // Without a column of errors a noise of unknown size stands in their place.
  folder.write("bench.csv", "speed,torque,angle,angle_se\n50,8,40,2\n100,,41,2\n150,9,,\n");
  const data::Study noisy =
      read(folder, text + "noise = { absolute = true, mean = \"0.5 mN m\", sd = \"0.2 mN m\" }\n");
  CHECK(noisy.observations[0].points[0].standard_errors[0] > 0.0);
  CHECK(std::isnan(noisy.observations[0].points[1].standard_errors[0]));
}

TEST_CASE("observed controls outside their range are named, not refused") {
  const TemporaryFolder folder;
  folder.write("bench.csv", bench);
  const data::Study study = read(folder, case_with("free = [\"friction\", \"cohesion\"]\n"));
  const auto found = data::outside_training_range(study);
  REQUIRE(found.size() == 1);
  CHECK(found[0].place.find("bench.csv:4: speed") != std::string::npos);
  CHECK(found[0].what == "310 rpm is outside the training range, 50 to 300 rpm");
  // What rounding in another unit leaves beyond the range is none: 0.83333 Hz.
  folder.write("bench.csv", "speed [Hz],torque,torque_se\n0.83333,8,1\n5.00001,8,1\n");
  CHECK(data::outside_training_range(read(folder, case_with("free = [\"friction\", \"cohesion\"]\n"))).empty());
}

TEST_CASE("an override reaches the study") {
  const TemporaryFolder folder;
  folder.write("bench.csv", bench);
  const data::Study study =
      read(folder, case_with("free = [\"friction\"]\n"),
           {"study.seed=99", "calibrate.powder.fixed.cohesion=2 mJ/m2", "parameters.friction.high=0.9"});
  CHECK(study.seed == 99);
  CHECK(study.cases[0].fixed.at("cohesion") == Approx(0.002));
  CHECK(study.parameters[0].high == 0.9);
}
