// From the text of a study to a case's unknowns and their posterior: scale, settings, and the nuisances of linked
// cases. The emulator is a formula and all is linear, so that the posteriors are known.
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "tests/temporary.hpp"
#include "uq/calibrate/calibrate.hpp"
#include "uq/infer/diagnostics.hpp"
#include "uq/verdict/contradiction.hpp"

namespace {

const std::string head =
    "[study]\nname = \"s\"\nseed = 5\n[parameters.friction]\nlow = 0\nhigh = 1\n[training]\ntable = \"runs.csv\"\n"
    "[outputs.torque]\nunit = \"N m\"\n[controls.fill]\nunit = \"g\"\nlow = 0\nhigh = 200\n"
    "[controls.speed]\nunit = \"rad/s\"\nlow = 0\nhigh = 10\n";
/// Four readings, sd 0.04 each: their mean has 0.02.
const std::string readings =
    "speed,fill,torque,torque_se\n1,100,0.47,0.04\n2,100,0.52,0.04\n3,100,0.53,0.04\n4,100,0.48,0.04\n";
constexpr double reading_sd = 0.04, mean_sd = 0.02;

std::string observe(const std::string& name, const std::string& lines = "") {
  return "[[observe]]\nname = \"" + name + "\"\nfile = \"" + name + ".csv\"\n" + lines;
}

std::string calibrate(const std::string& name, const std::string& set, const std::string& lines = "") {
  return "[[calibrate]]\nname = \"" + name + "\"\nobserve = [\"" + set + "\"]\nfree = [\"friction\"]\n" + lines;
}

data::Study read(const TemporaryFolder& folder, const std::string& text) {
  const data::StudyFile file = data::StudyFile::open(folder.write("study.toml", text));
  data::Study study = data::read_study(file);
  file.finish();
  return study;
}

/// torque = (friction + (fill - 100 g) / 1 kg) N m at any speed.
std::vector<uq::Emulator> formula() {
  uq::Emulator emulator{.material = "",
                        .output = 0,
                        .inputs = {{uq::InputKind::parameter, 0}, {uq::InputKind::control, 0}},
                        .constants = {},
                        .control_range = {},
                        .predict = {}};
  emulator.predict = [](const Eigen::MatrixXd& points) -> surrogate::Prediction {
    return {.mean = points.col(0) + 0.2 * (points.col(1).array() - 0.5).matrix(),
            .covariance = Eigen::MatrixXd::Zero(points.rows(), points.rows())};
  };
  return {emulator};
}

uq::SampledCase sample(const data::Study& study, std::size_t index = 0) {
  uq::CalibrateOptions options;
  options.mixture.draws = 4000;
  options.cut.draws = 4000;
  uq::SampledCase sampled = uq::sample_case(study, formula(), index, options);
  INFO(sampled.draws.reason);
  REQUIRE(sampled.draws.converged);
  return sampled;
}

std::vector<std::string> labels(const uq::CaseModel& model) {
  std::vector<std::string> found;
  for (const uq::Unknown& unknown : model.unknowns) found.push_back(unknown.label);
  return found;
}

struct Normal {
  double mean = 0.0, sd = 1.0;
};

/// The unknown's draws have this mean and sd.
void check_moments(const uq::SampledCase& sampled, const std::string& label, const Normal& law) {
  INFO(label);
  const std::vector<std::string> names = labels(*sampled.model);
  const auto k = std::find(names.begin(), names.end(), label) - names.begin();
  REQUIRE(k < sampled.model->dimension());
  Eigen::MatrixXd values = sampled.draws.coordinate(static_cast<int>(k));
  for (double& value : values.reshaped()) value = sampled.model->unknowns[k].value(value);
  CHECK(std::abs(values.mean() - law.mean) < 4.0 * uq::mean_mcse(values));
  CHECK(std::sqrt((values.array() - values.mean()).square().mean()) == Approx(law.sd).epsilon(0.04));
}

}  // namespace

TEST_CASE("what several sets of one meter have in common does not average out, within a case or over linked ones",
          "[uq]") {
  const TemporaryFolder folder;
  folder.write("first.csv", readings);
  folder.write("second.csv",
               "speed,fill,torque,torque_se\n5,100,0.46,0.04\n6,100,0.53,0.04\n7,100,0.54,0.04\n8,100,0.47,0.04\n");
  constexpr double common = 0.1;
  const auto sets = [](const std::string& meter) {
    const std::string lines = "common_error = \"0.1 N m\"\n" + meter;
    return observe("first", lines) + observe("second", lines);
  };
  const std::string both = calibrate("powder", "first\", \"second");
  const std::string linked = calibrate("powder", "second", "priors = { friction = { posterior = \"before\" } }\n") +
                             calibrate("before", "first");
  const double of_readings = mean_sd / std::sqrt(2.0);
  for (const std::string& cases : {both, linked}) {
    const uq::SampledCase apart = sample(read(folder, head + sets("") + cases));
    check_moments(apart, "friction", {0.5, std::hypot(of_readings, common / std::sqrt(2.0))});
    const uq::SampledCase shared = sample(read(folder, head + sets("meter = \"cell\"\n") + cases));
    CHECK(labels(*shared.model) == std::vector<std::string>{"friction", "cell_torque_offset"});
    check_moments(shared, "friction", {0.5, std::hypot(of_readings, common)});
    check_moments(shared, "cell_torque_offset", {0.0, common});
  }
}

TEST_CASE("a machine's torque is the slice's times the rig's scale, fixed or with a prior", "[uq]") {
  const TemporaryFolder folder;
  folder.write("bench.csv",
               "speed,fill,torque,torque_se\n1,100,9.4,0.8\n2,100,10.4,0.8\n3,100,10.6,0.8\n4,100,9.6,0.8\n");
  const auto rig = [](const std::string& scale) { return "[rig]\nkind = \"slice\"\n" + scale; };
  const std::string machine = observe("bench", "rig = \"machine\"\n") + calibrate("powder", "bench");

  const uq::SampledCase fixed = sample(read(folder, head + rig("scale = 20\n") + machine));
  CHECK(labels(*fixed.model) == std::vector<std::string>{"friction"});
  check_moments(fixed, "friction", {0.5, mean_sd});

  // Flat in friction: scale has weight N(20, 2^2) / scale, friction given it N(10 / scale, 0.4 / scale).
  const uq::SampledCase unknown = sample(read(folder, head + rig("scale = { mean = 20, sd = 2 }\n") + machine));
  CHECK(labels(*unknown.model) == std::vector<std::string>{"friction", "scale"});
  double mass = 0.0, scale = 0.0, first = 0.0, second = 0.0, scale_square = 0.0;
  for (double s = 8.0; s <= 32.0; s += 0.01) {
    const double weight = std::exp(-0.5 * std::pow((s - 20.0) / 2.0, 2)) / s;
    mass += weight;
    scale += weight * s;
    scale_square += weight * s * s;
    first += weight * 10.0 / s;
    second += weight * (0.4 * 0.4 + 10.0 * 10.0) / (s * s);
  }
  const auto law = [mass](double sum, double squares) {
    return Normal{sum / mass, std::sqrt(squares / mass - std::pow(sum / mass, 2))};
  };
  check_moments(unknown, "friction", law(first, second));
  check_moments(unknown, "scale", law(scale, scale_square));

  // Nothing joins a machine's torque with a bare slice.
  CHECK_THAT(failure_of(folder, [&] { read(folder, head + rig("") + machine); }),
             Catch::Contains("78: ") && Catch::Contains("is the whole machine, but the runs simulate a slice of it"));
}

TEST_CASE("a setting known within an uncertainty widens the posterior alike as an unknown and in the covariance",
          "[uq]") {
  // 1 g of fill is 0.001 N m.
  const TemporaryFolder folder;
  folder.write("bench.csv", readings);
  const Normal expected{0.5, std::hypot(mean_sd, 0.001 * 30.0)};
  const auto with = [&](const std::string& uncertainty) {
    return sample(read(folder, head + observe("bench", "uncertainty = { fill = " + uncertainty + " }\n") +
                                   calibrate("powder", "bench")));
  };
  const uq::SampledCase unknown = with("{ sd = \"30 g\", as = \"unknown\" }");
  CHECK(labels(*unknown.model) == std::vector<std::string>{"friction", "bench_fill"});
  check_moments(unknown, "friction", expected);
  check_moments(unknown, "bench_fill", {0.1, 0.03});  // kg: these readings say nothing of it
  const uq::SampledCase covariance = with("\"30 g\"");
  CHECK(labels(*covariance.model) == std::vector<std::string>{"friction"});
  check_moments(covariance, "friction", expected);
  // Nothing is known of a setting that the runs do not vary.
  const data::Study speed =
      read(folder, head + observe("bench", "uncertainty = { speed = \"0.1 rad/s\" }\n") + calibrate("powder", "bench"));
  CHECK_THAT(failure_of(folder, [&] { uq::build_case(speed, formula(), 0); }),
             Catch::Contains("78: ") && Catch::Contains("do not vary speed, so its uncertainty's effect is not known"));
}

TEST_CASE("a setting's error at points of several values is each point's own, or one that all share", "[uq]") {
  const TemporaryFolder folder;
  folder.write("bench.csv",
               "speed,fill,torque,torque_se\n1,70,0.44,0.04\n2,90,0.51,0.04\n3,110,0.54,0.04\n4,130,0.51,0.04\n");
  const auto with = [&](const std::string& as) {
    return sample(
        read(folder, head + observe("bench", "uncertainty = { fill = { sd = \"30 g\", as = \"" + as + "\" } }\n") +
                         calibrate("powder", "bench")));
  };
  check_moments(with("shared"), "friction", {0.5, std::hypot(mean_sd, 0.03)});
  check_moments(with("covariance"), "friction", {0.5, std::hypot(reading_sd, 0.03) / 2.0});
}

TEST_CASE("linked cases keep a meter's offset each, or share it, and the posterior is the joint one", "[uq]") {
  const TemporaryFolder folder;
  folder.write("first.csv", readings);
  folder.write("second.csv",
               "speed,fill,torque,torque_se\n1,100,0.56,0.04\n2,100,0.60,0.04\n3,100,0.62,0.04\n4,100,0.58,0.04\n");
  const double first_mean = 0.5, second_mean = 0.59;
  const std::string taken = "priors = { friction = { posterior = \"one\" } }\n";
  const auto study = [&](const std::string& one, const std::string& two) {
    return read(folder, head + observe("first") + observe("second") + calibrate("one", "first", one) +
                            calibrate("two", "second", two));
  };
  const std::string small = "offset = { sd = \"0.03 N m\" }\n", large = "offset = { sd = \"0.06 N m\" }\n";

  SECTION("each its own") {
    const uq::SampledCase two = sample(study(small, large + taken), 1);
    CHECK(labels(*two.model) == std::vector<std::string>{"friction", "offset", "one: offset"});
    CHECK(two.model->linked == std::vector<std::string>{"one"});
    // Two means with the errors of their offsets; an offset takes its share of what its mean is off.
    const double u = mean_sd * mean_sd + 0.03 * 0.03, v = mean_sd * mean_sd + 0.06 * 0.06;
    const double precision = 1.0 / u + 1.0 / v, friction = (first_mean / u + second_mean / v) / precision;
    check_moments(two, "friction", {friction, std::sqrt(1.0 / precision)});
    const auto offset = [&](double prior_sd, double mean, double total) {
      const double part = prior_sd * prior_sd / total;
      return Normal{part * (mean - friction), std::sqrt(part * mean_sd * mean_sd + part * part / precision)};
    };
    check_moments(two, "offset", offset(0.06, second_mean, v));
    check_moments(two, "one: offset", offset(0.03, first_mean, u));
  }
  SECTION("one meter: the offset is taken over with friction, and is one unknown") {
    const uq::SampledCase two = sample(study(small, "offset = { posterior = \"one\" }\n" + taken), 1);
    CHECK(labels(*two.model) == std::vector<std::string>{"friction", "offset"});
    CHECK(two.model->row_count() == 8);
    check_moments(two, "friction", {0.5 * (first_mean + second_mean), std::hypot(reading_sd / std::sqrt(8.0), 0.03)});
    check_moments(two, "offset", {0.0, 0.03});
  }
  SECTION("a cut: friction stays what the first case made of it, its meter included, and the second offset follows") {
    const std::string cut = "priors = { friction = { posterior = \"one\", cut = true } }\n";
    const uq::SampledCase two = sample(study(small, large + cut), 1);
    CHECK(labels(*two.model) == std::vector<std::string>{"friction", "offset"});
    CHECK(two.model->linked.empty());
    CHECK(two.model->row_count() == 4);
    const double friction_sd = std::hypot(mean_sd, 0.03);
    check_moments(two, "friction", {first_mean, friction_sd});
    const double part = 0.06 * 0.06 / (0.06 * 0.06 + mean_sd * mean_sd);
    check_moments(two, "offset",
                  {part * (second_mean - first_mean),
                   std::sqrt(part * mean_sd * mean_sd + part * part * friction_sd * friction_sd)});
  }
  SECTION("one unknown cut and another joined from one case is refused: they would not belong together") {
    const data::Study refused =
        study(small, "offset = { posterior = \"one\" }\npriors = { friction = { posterior = \"one\", cut = true } }\n");
    CHECK_THAT(failure_of(folder, [&] { uq::build_case(refused, formula(), 1); }),
               Catch::Contains("78: ") && Catch::Contains("cuts friction from 'one', with which it is also sampled") &&
                   Catch::Contains("cut all that comes from 'one', or nothing"));
  }
  SECTION("a meter's offset cannot be cut, and the message says what can") {
    const data::Study refused = study(small, "offset = { posterior = \"one\", cut = true }\n" + taken);
    CHECK_THAT(failure_of(folder, [&] { uq::build_case(refused, formula(), 1); }),
               Catch::Contains("78: ") && Catch::Contains("offset is cut from another case") &&
                   Catch::Contains("cut parameters only"));
  }
}

TEST_CASE("cases whose data contradict each other are told from data that fit nowhere", "[uq]") {
  const TemporaryFolder folder;
  folder.write("first.csv", readings);
  const auto finding = [&](const std::string& second) {
    folder.write("second.csv", "speed,fill,torque,torque_se\n" + second);
    const data::Study study =
        read(folder, head + observe("first") + observe("second") + calibrate("one", "first") +
                         calibrate("two", "second", "priors = { friction = { posterior = \"one\" } }\n"));
    const uq::CaseReport report = uq::report_case(study, sample(study, 1), {.error_scan = {}, .quadrature = false});
    CHECK_FALSE(report.fits);
    CHECK(report.parameters.at(0).verdict == uq::Verdict::does_not_fit);
    return report.finding + " " + report.remedy;
  };
  // 0.3 N m apart, 15 sd.
  CHECK_THAT(finding("1,100,0.78,0.04\n2,100,0.82,0.04\n3,100,0.83,0.04\n4,100,0.77,0.04\n"),
             Catch::Contains("On its own each of first and second fits: they contradict each other.") &&
                 Catch::Contains("the same powder, rig and units"));
  // The second set contradicts itself.
  CHECK_THAT(finding("1,100,0.2,0.04\n2,100,0.8,0.04\n3,100,0.2,0.04\n4,100,0.8,0.04\n"),
             Catch::Contains("On its own first fits; second does not. ") && Catch::Contains("Look at second first."));
}
